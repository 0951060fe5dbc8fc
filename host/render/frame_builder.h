#pragma once

#include "host/graph/execution.h"
#include "host/graph/graph.h"
#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/kernel_types.h"
#include "host/render/outputs.h"
#include "host/render/prepared_scene.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/sample_filter.h"

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

// Formats of fewer bits, see kernels/core/formats.h.
inline constexpr graph::Format shortFloats { .name = "short1", .bytes = 2, .storage = "float", .blocks = true };
inline constexpr graph::Format shortPairs { .name = "short2", .bytes = 4, .storage = "float" };
constexpr graph::Format shortPlanes(std::string_view name, std::uint32_t count)
{
    return { .name = name, .bytes = 2 * count, .storage = "float", .whole = false };
}
inline constexpr graph::Format shortTriples = shortPlanes("short3", 3), shortQuadruples = shortPlanes("short4", 4);
/// Along both axes of a light, of as many channels.
constexpr graph::Format gradientsOf(std::uint32_t channels) { return channels == 2 ? shortQuadruples : shortPairs; }
inline constexpr graph::Format shortCounts { .name = "ushort1", .bytes = 2, .storage = "ushort" };
inline constexpr graph::Format shortRanges { .name = "range16", .bytes = 2, .storage = "float" };
inline constexpr graph::Format shortReflectors { .name = "reflectors32", .bytes = 4, .storage = "float" };
inline constexpr graph::Format wholeGloss { .name = "gloss32", .bytes = 4, .storage = "uint" };
inline constexpr graph::Format shortGloss { .name = "gloss16", .bytes = 2, .storage = "ushort" };
/// A pixel's samples by brightness (kernels/sinks/sample_bins.h), and shares of each bin.
inline constexpr graph::Format sampleBins {
    .name = "bins", .bytes = 2 * WEDGE_SAMPLE_BINS * WEDGE_BIN_NUMBERS, .storage = "ushort", .whole = false
};
inline constexpr graph::Format binShares = shortPlanes("shares", WEDGE_SAMPLE_BINS);
inline constexpr graph::Format tallySums { .name = "ulong1", .bytes = 8, .storage = "ulong", .whole = false };
/// Normals, alone or with those without their maps behind, in parts of 32 bits and of 10.
inline constexpr graph::Format normalPairs { .name = "normal192", .bytes = 24, .storage = "float", .blocks = true };
inline constexpr graph::Format packedNormals { .name = "normal32", .bytes = 4, .storage = "float", .blocks = true };
inline constexpr graph::Format packedNormalPairs { .name = "normal64", .bytes = 8, .storage = "float", .blocks = true };
inline constexpr graph::Format packedColours { .name = "colour48", .bytes = 6, .storage = "float", .blocks = true };
inline constexpr graph::Format packedFractions { .name = "fraction32", .bytes = 4, .storage = "uint" };

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

/// Who reads a plane of what primary rays find: passes that sample light there (WEDGE_RECEIVER_ARGUMENTS), the one that
/// adds a wave's receivers to their pixels (accumulateSurfaces), or both.
enum class ReadBy { Samplers, Pixels, Both };

/// What a frame adds up, and what it counts.
struct Sum {
    graph::Handle<Radiance> filtered, noisy;
    graph::Handle<Deviation> deviation;
    graph::Handle<Value> variance; ///< gathered, of terms that do; where there are any
    graph::Handle<Radiance> change; ///< by filters that are on its terms; where there are any
};
/// What a frame counts: of all terms, of indirect light, of all rays but the camera's, and of those of paths; and where
/// there is a filter of samples, those of indirect light that it leaves out because they are not finite. Of tallies
/// also pixels whose light was below 0, where shadows are subtracted.
template <class Kind>
struct Counted {
    graph::Handle<Kind> samples, indirectSamples, rays, pathRays, notFinite, clamped;
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

/// Which of the pixels that a launch covers a pass is to do: null, all.
using RowsOf = std::function<Window(const graph::Launch&)>;

/// What effects and filters declare their passes with. Its device memory may be absent for a graph that is planned and
/// not run.
struct FrameBuilder {
    graph::Graph& graph;
    const PreparedScene& description;
    const DeviceScene* scene; ///< null: the graph is not run
    const Settings& settings;
    PlaneLayout layout;
    std::size_t packetSize; ///< pixels of a work-item over tiles
    bool narrowLobes = false; ///< SceneTraits::narrowLobes, and the pixels are the receivers
    bool lean = false; ///< pixels that have several receivers keep little, see SampleShape::lean()
    Surfaces surfaces = {};
    Totals totals = {};
    /// Where passes add what layers show; null where none are read, and in frames of several receivers a pixel, which
    /// have none of passes' own.
    Outputs* layers = nullptr;
    std::optional<graph::Handle<Directions>> environmentSamples = {}; ///< pre-computed, where there are any

    /// Of normals, each in one number or in three. In scenes with normal maps the ones without them lie behind.
    graph::Format normals(bool inOne) const
    {
        const bool mapped = description.traits().normalMaps;
        return inOne ? (mapped ? packedNormalPairs : packedNormals) : mapped ? normalPairs : graph::vectors;
    }
    bool specular() const { return description.traits().specular; }
    bool analysed() const { return settings.method == Method::AxisAligned; }
    /// The formats of surfaces, for programs that gather over them, and more defines.
    device::Defines surfaceFormats(device::Defines more = {}) const;
    /// Of the whole image, margins included.
    shared::FrameParams wholeFrame() const;
    /// The pixels that the frame produces, where planes have them.
    Window output() const;
    /// Where kernels of analysis find pixels; the rectangle is to come.
    shared::AnalysisParams analysisParams() const;

    /// FrameParams of the launch's pixels.
    graph::Argument frame(const RowsOf& rows = {}) const;
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
    /// What primary rays meet: all of that, and lights, if any are lit.
    std::vector<graph::Argument> met(bool lit) const;
    /// Calls visit(name in kernels, plane, format, who reads it) for all planes that primary rays fill in: of pixels
    /// that are the receivers, or of a wave's receivers. What pixels keep of those has formats of its own.
    template <class Points, class Visit>
    void eachFound(Points& p, const Visit& visit) const
    {
        visit("position", p.position, graph::vectors, ReadBy::Both);
        visit("normal", p.normal, normals(false), ReadBy::Both);
        visit("origin", p.origin, graph::vectors, ReadBy::Samplers);
        visit("geometric", p.geometric, graph::counts, ReadBy::Samplers);
        visit("objectId", p.objectId, graph::counts, ReadBy::Both);
        visit("depth", p.depth, graph::floats, ReadBy::Pixels);
        visit("pixelSize", p.pixelSize, graph::floats, ReadBy::Pixels);
        visit("diffuse", p.diffuse, graph::vectors, ReadBy::Pixels);
        visit("specular", p.specular, graph::vectors, ReadBy::Pixels);
        visit("emission", p.emission, graph::vectors, ReadBy::Pixels);
        visit("gloss", p.gloss, wholeGloss, ReadBy::Both);
        if constexpr (requires { p.view; }) {
            visit("view", p.view, graph::counts, ReadBy::Samplers);
            visit("time", p.time, graph::floats, ReadBy::Samplers);
            visit("motion", p.motion, graph::floatPlanes(2), ReadBy::Pixels);
            visit("rays", p.rays, graph::counts, ReadBy::Pixels);
            visit("pathRays", p.pathRays, graph::counts, ReadBy::Pixels);
        }
    }
    /// All of these: graph::writes or graph::updates.
    template <class Points>
    std::vector<graph::Argument> found(Points& points, graph::Argument (*fills)(std::string, graph::Version&)) const
    {
        std::vector<graph::Argument> out;
        eachFound(points, [&](const char* name, graph::Version& plane, const graph::Format&, ReadBy) {
            out.push_back(fills(name, plane));
        });
        return graph::together("found", std::move(out));
    }
    /// Those that are read, by samplers or by pixels.
    template <class Points>
    std::vector<graph::Argument> readBy(ReadBy reader, const Points& points) const
    {
        std::vector<graph::Argument> out;
        eachFound(points, [&](const char* name, const graph::Version& plane, const graph::Format&, ReadBy by) {
            if (by == reader || by == ReadBy::Both) {
                out.push_back(graph::reads(name, plane));
            }
        });
        return out;
    }
    /// A buffer that outlives the frame; null where the graph is not run.
    graph::Argument outside(std::string name, std::string_view type, const cl::Buffer* memory) const;
    /// One of the scene's.
    template <class T>
    graph::Argument ofScene(std::string name, std::string_view type, device::Buffer<T> DeviceScene::*member) const
    {
        return outside(std::move(name), type, scene != nullptr ? &(scene->*member).cl() : nullptr);
    }

    /// A pass over tiles of pixels that traces rays, which the user may stop in its middle. rows: as its frame() has
    /// them.
    void trace(std::string name, graph::KernelName kernel, std::vector<graph::Argument> arguments, bool everywhere,
        const std::function<double(const graph::Launch&)>& workUnits, const RowsOf& rows = {});
    /// A pass over the 16-pixel blocks of rows, or over pixels.
    void blocks(std::string_view name, device::PassKind kind, graph::KernelName kernel,
        std::vector<graph::Argument> arguments, const std::function<bool(const graph::Run&)>& condition = {});
    void pixels(std::string_view name, device::PassKind kind, graph::KernelName kernel,
        std::vector<graph::Argument> arguments, const std::function<bool(const graph::Run&)>& condition = {});
    /// A pass of that many items. ofShown: they are made of all that is shown; else of margins, too.
    void items(std::string_view name, device::PassKind kind, graph::KernelName kernel, std::size_t count,
        std::vector<graph::Argument> arguments, bool ofShown = false);
    /// Adds what pixels counted to the frame's tally of it, within the output or in the whole image, and to its plane
    /// of it, where that is wanted; null: there is none. mask: pixels that do not count have 0 there.
    void count(const graph::Version& counted, bool everywhere, graph::Handle<Tally>& tally,
        graph::Handle<Count>* plane = nullptr, const std::optional<graph::Version>& mask = {});
    /// Emission, direct and indirect light together. p: as kernels of pixels have it.
    graph::Handle<Radiance> sumOfParts(const graph::Argument& p, const char* name,
        const graph::Handle<Radiance>& emission, const graph::Handle<Radiance>& direct,
        const graph::Handle<Radiance>& indirect);
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

/// Where points lie, and on which objects.
inline Arguments places(const Surfaces& s, graph::Reach reach = {})
{
    return graph::together("places",
        { graph::reads("position", s.position, reach), graph::reads("normal", s.normal, reach),
            graph::reads("objectId", s.objectId, reach) });
}

/// Of a pass that takes samples how many are wanted, up to which the launch goes, and what counts them and their rays.
inline Arguments sampleCounts(
    const graph::Version& wanted, graph::Argument last, graph::Version& taken, const Arguments& rays)
{
    return graph::together(
        "samples", joined({ graph::reads("wanted", wanted), std::move(last), graph::updates("taken", taken) }, rays));
}

} // namespace wedge::render
