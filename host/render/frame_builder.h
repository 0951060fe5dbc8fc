#pragma once

#include "host/graph/execution.h"
#include "host/graph/graph.h"
#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/kernel_types.h"
#include "host/render/prepared_scene.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::render {

// What planes hold. Vectors are three planes of floats, one after the other.
struct Position { }; ///< metres, in the world
struct Normal { };
struct Packed { }; ///< a normal in one number
struct Metres { };
struct ObjectId { }; ///< from 1; 0: nothing was hit
struct Reflectance { };
struct Gloss { }; ///< kind and exponent of what is reflected, packGloss()
struct Radiance { };
struct Deviation { }; ///< numbers whose squares are variances in the mean
struct Count { };
struct Tally { }; ///< sums of counts, WEDGE_TALLY_STRIPES of them
struct Sums { }; ///< of a term's samples, see light_sampling.h and path_sampling.h
struct Value { }; ///< of a term, what is filtered: visibility or irradiance
struct Extremes { }; ///< least and largest slopes of occluders, or distances of reflectors
struct Logarithms { };
struct Uncertainty { }; ///< variance over the equal pixels that a filter gathers, see demand.cl
struct Demand { };
struct Share { }; ///< numbers from 0 to 1, or that others are multiplied by

struct Texture { }; ///< of a term, see accumulate.h
struct Squares { }; ///< mean squares of luminances, or what is made of them
struct Pixels { }; ///< lengths in the image
struct Listed { }; ///< of waves' lists, see waves.cl
struct Directions { }; ///< to what is beyond the scene, see kernels/shared/environment.h

// Formats of packed planes, see kernels/core/packed_planes.h.
inline constexpr graph::Format shortFloats { "short1", 2, "float", "", "", "" };
inline constexpr graph::Format shortPairs { "short2", 4, "float", "", "", "" };
inline constexpr graph::Format shortTriples { "short3", 6, "float", "", "", "" };
inline constexpr graph::Format shortQuadruples { "short4", 8, "float", "", "", "" };
/// Along both axes of a light, of as many channels.
constexpr graph::Format gradientsOf(std::uint32_t channels) { return channels == 2 ? shortQuadruples : shortPairs; }
inline constexpr graph::Format shortCounts { "ushort1", 2, "uint", "", "", "" };
inline constexpr graph::Format shortGloss { "gloss16", 2, "uint", "", "", "" };
inline constexpr graph::Format tallySums { "ulong1", 8, "ulong", "", "", "" };
inline constexpr graph::Format packedNormals { "normal32", 4, "float", "", "", "" };
inline constexpr graph::Format packedNormalPairs { "normal64", 8, "float", "", "", "" };
inline constexpr graph::Format packedColours { "colour48", 6, "float", "", "", "" };
inline constexpr graph::Format packedFractions { "fraction32", 4, "float", "", "", "" };

/// What the camera sees through each pixel, see kernels/frame/primary.cl; or means over the receivers of pixels that
/// have several.
struct Surfaces {
    graph::Handle<Position> position, origin;
    graph::Handle<Normal> normal;
    graph::Handle<Packed> geometric;
    graph::Handle<ObjectId> objectId;
    graph::Handle<Metres> depth, pixelSize;
    graph::Handle<Reflectance> diffuse, specular;
    graph::Handle<Radiance> emission;
    graph::Handle<Gloss> gloss;
};

/// What a frame adds up, and what it counts.
struct Sum {
    graph::Handle<Radiance> filtered, noisy;
    graph::Handle<Deviation> deviation;
    graph::Handle<Value> variance; ///< gathered, of terms that do; where there are any
};
/// What a frame counts: of all terms, of indirect light, of all rays but the camera's, and of those of paths.
template <class Kind>
struct Counted {
    graph::Handle<Kind> samples, indirectSamples, rays, pathRays;
};
struct Totals : Counted<Count> {
    Sum direct, indirect;
    Counted<Tally> tallies; ///< where the pixels are the receivers
    graph::Handle<Radiance> beauty;
};

/// What a term's passes tell those after them, on the host, while they run.
struct TermState {
    bool analysed = false; ///< its first pass was completed: it has widths
};

/// What effects and filters declare their passes with. Its device memory may be absent for a graph that is planned and
/// not run.
struct FrameBuilder {
    graph::Graph& graph;
    const PreparedScene& description;
    const DeviceScene* scene; ///< null: the graph is not run
    const Settings& settings;
    PlaneLayout layout;
    std::size_t packetSize; ///< pixels of a work-item over tiles
    cl::Buffer unused; ///< for parameters that nothing is read from, or written to
    bool narrowLobes = false; ///< SceneTraits::narrowLobes, and the pixels are the receivers
    bool packed = false; ///< planes of pixels that have several receivers are packed, see kernels/waves/accumulate.h
    Surfaces surfaces = {};
    Totals totals = {};
    /// By names of layers of terms, each with its term's (effect.h), what terms keep for them; null where no layers are
    /// read.
    std::map<std::string, graph::Handle<Value>>* termLayers = nullptr;
    std::optional<graph::Handle<Directions>> environmentSamples = {}; ///< pre-computed, where there are any

    /// Of normals, each in one number or in three. In scenes with normal maps the ones without them lie behind.
    graph::Format normals(bool inOne) const
    {
        const bool mapped = description.traits().normalMaps;
        return inOne ? (mapped ? packedNormalPairs : packedNormals) : mapped ? graph::floatPlanes(6) : graph::vectors;
    }
    bool specular() const { return description.traits().specular; }
    bool analysed() const { return settings.method == Method::AxisAligned; }
    /// What programs that read packed planes or plain ones are compiled with.
    device::Defines packing() const { return packed ? device::Defines { { "WEDGE_PACKED", "" } } : device::Defines {}; }
    /// Of the whole image.
    shared::FrameParams wholeFrame() const;
    /// Where kernels of analysis find pixels; the rectangle is to come.
    shared::AnalysisParams analysisParams() const;

    /// FrameParams of the launch's pixels.
    graph::Argument frame() const;
    /// Those parameters with the launch's rectangle.
    template <class Params>
    graph::Argument rectangle(const Params& params) const
    {
        return graph::made("p", [params](const graph::Launch& launch) {
            Params p = params;
            setRectangle(p, launch.window);
            return p;
        });
    }
    /// The hierarchy.
    std::vector<graph::Argument> hierarchy() const;
    /// By the names of WEDGE_SURFACE_ARGUMENTS.
    std::vector<graph::Argument> geometry() const;
    /// By the names of WEDGE_BEYOND_ARGUMENTS.
    std::vector<graph::Argument> beyond() const;
    /// Declares the frame's pre-computed samples of what is beyond the scene, where there is a map and the settings
    /// want them: before any pass that chooses lights.
    void precomputeDirections();
    /// By the names of WEDGE_RECEIVER_ARGUMENTS, the pixels being the receivers.
    std::vector<graph::Argument> receivers() const;
    /// A buffer that outlives the frame; null: none, and nothing reads it.
    graph::Argument outside(std::string name, std::string_view type, const cl::Buffer* memory) const;
    /// In the place of a plane that nothing is read from, or, nowhere(), written to. format: which that would have,
    /// so that kernels are compiled once with it and without.
    graph::Argument nothing(std::string name, const graph::Format& format = graph::floats) const;
    graph::Argument nowhere(std::string name, const graph::Format& format = graph::floats) const;
    /// One of the scene's.
    template <class T>
    graph::Argument ofScene(std::string name, std::string_view type, device::Buffer<T> DeviceScene::*member) const
    {
        return outside(std::move(name), type, scene != nullptr ? &(scene->*member).cl() : nullptr);
    }

    /// A pass over tiles of pixels that traces rays, which the user may stop in its middle.
    void trace(std::string name, graph::KernelName kernel, std::vector<graph::Argument> arguments, bool everywhere,
        const std::function<double(const graph::Launch&)>& workUnits);
    /// A pass over the 16-pixel blocks of rows, or over pixels.
    void blocks(std::string_view name, device::PassKind kind, graph::KernelName kernel,
        std::vector<graph::Argument> arguments, const std::function<bool(const graph::Run&)>& condition = {});
    void pixels(std::string_view name, device::PassKind kind, graph::KernelName kernel,
        std::vector<graph::Argument> arguments, const std::function<bool(const graph::Run&)>& condition = {});
    /// A pass of that many items.
    void items(std::string_view name, device::PassKind kind, graph::KernelName kernel, std::size_t count,
        std::vector<graph::Argument> arguments);
    /// Adds what pixels counted to the frame's tally of it, within the output or in the whole image, and to its plane
    /// of it, where that is wanted; null: there is none.
    void count(const graph::Handle<Count>& counted, bool everywhere, graph::Handle<Tally>& tally,
        graph::Handle<Count>* plane = nullptr);
    /// A step on the host, whatever is wanted.
    void host(std::string name, const std::function<void(graph::Run&)>& step, std::vector<graph::Argument> uses = {});
    /// Fills planes with zeros.
    template <class... Quantities>
    void zero(graph::Handle<Quantities>&... handles)
    {
        (fill("zeros", handles, std::uint32_t { 0 }), ...);
    }
    /// Fills a plane, or several, with a number.
    template <class T>
    void fill(const char* name, graph::Version& version, T number)
    {
        static_assert(sizeof(T) == sizeof(std::uint32_t));
        const graph::Version resource = version;
        host(name, graph::writes("plane", version),
            [resource, number](graph::Run& run) { run.buffer<T>(resource).fill(run.queue(), number); });
    }

private:
    void host(const char* name, graph::Argument use, const std::function<void(graph::Run&)>& step);
};

/// Lists of arguments, one after the other.
template <class... Lists>
std::vector<graph::Argument> joined(std::vector<graph::Argument> first, const Lists&... others)
{
    (first.insert(first.end(), others.begin(), others.end()), ...);
    return first;
}

using Arguments = std::vector<graph::Argument>;

} // namespace wedge::render
