// A frame as a graph: resources, and passes that declare what they do with them. Written once, in the order in which
// the passes run; what is left out, which pixels each pass covers, who shares memory with whom, and what kernels are
// handed are derived from it (plan.h, interface.h, execution.h).
#pragma once

#include "host/device/kernel.h"
#include "host/device/program.h"
#include "host/device/queue.h"
#include "host/graph/format.h"
#include "host/graph/layout.h"
#include "host/window.h"
#include "kernels/shared/pixel_grid.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::graph {

class Graph;
class Run;

/// One state of a resource's contents: each pass that changes them makes the next.
struct Version {
    std::uint32_t graph = 0; ///< which Graph's, 0 for none's
    std::uint32_t resource = 0;
    std::uint32_t number = 0; ///< 0: nothing has been written yet
};

/// A version of a resource that holds a Quantity: a type without members, for the compiler to tell handles apart.
template <class Quantity>
struct Handle : Version {
};

/// OpenCL's name for a type that kernels take by value, empty where nobody has said: specialise it for structs.
template <class T>
inline constexpr std::string_view kernelType = "";
template <>
inline constexpr std::string_view kernelType<float> = "float";
template <>
inline constexpr std::string_view kernelType<std::int32_t> = "int";
template <>
inline constexpr std::string_view kernelType<std::uint32_t> = "uint";
template <>
inline constexpr std::string_view kernelType<shared::PixelGrid> = "PixelGrid";

enum class Access {
    Read,
    Write, ///< what was there before is of no interest
    Update, ///< reads and writes: one memory object
};

/// How many of the frame's pixels lie along each side of one of a plane's: of Half each side has half of the pixels,
/// rounded up, and the plane a quarter of them.
enum class Scale { Full = 1, Half = 2, Quarter = 4, Eighth = 8, Sixteenth = 16, ThirtySecond = 32 };

/// How far from a pixel its neighbours are read, in pixels to both sides: those of the plane that is read.
struct Reach {
    int x = 0, y = 0;
};
constexpr Reach wholeImage { std::numeric_limits<int>::max(), std::numeric_limits<int>::max() };
constexpr Reach around(int pixels) { return { pixels, pixels }; }

/// What the launch of a kernel covers: of its pass's window one band of rows, or nothing in rehearsals.
struct Launch {
    const Run& run;
    Window window;
};

/// One argument of a pass's kernel, made by value() and the functions after it.
struct Argument {
    std::string name;
    std::string type = {}; ///< of values, OpenCL's
    std::function<std::vector<std::byte>(const Launch&)> value = {}; ///< null: a use
    Access access = Access::Read;
    Version version = {}; ///< read, or made
    Reach reach = {};
    bool tally = false; ///< for whose sake no pass covers a pixel
    Version* handle = nullptr; ///< of who declares what changes a resource: becomes the new version
    std::shared_ptr<const Format> absent = {}; ///< of a resource that there is none of
    std::string group = {}; ///< which it is of, if any
    bool member = false; ///< of the structure that the group is to kernels
    std::size_t mostItems = 0; ///< of a list's length: the most that it can be (lists.h); 0: no length
    bool changing = false; ///< of values: another one in a later run makes only what goes by it anew

    bool isUse() const { return !value && absent == nullptr; }
};

/// A value that make(launch) returns.
template <class Make>
Argument made(std::string name, const Make& make)
{
    using T = std::decay_t<decltype(make(std::declval<const Launch&>()))>;
    static_assert(device::KernelValue<T>);
    return { std::move(name), std::string(kernelType<T>), [make](const Launch& launch) {
                const T value = make(launch);
                const auto* bytes = reinterpret_cast<const std::byte*>(&value);
                return std::vector<std::byte>(bytes, bytes + sizeof(T));
            } };
}

/// A value that is the same for all launches.
template <device::KernelValue T>
Argument value(std::string name, const T& constant)
{
    return made(std::move(name), [constant](const Launch&) { return constant; });
}

/// The same of a value that may be another one when the graph is run again, for the sake of which its plan keeps what
/// the passes after it need (rerun.h). Is made before a run begins, and so knows nothing of it.
template <class Make>
Argument changing(std::string name, const Make& make)
{
    Argument out = made(std::move(name), [make](const Launch&) { return make(); });
    out.changing = true;
    return out;
}

/// Memory that no pass of any graph changes. type: what its pointer points to, OpenCL's.
inline Argument outside(std::string name, std::string_view type, const cl::Buffer& memory)
{
    // Holds it: drivers need not.
    return { std::move(name), "__global const " + std::string(type) + " *", [memory = memory](const Launch&) {
                const cl_mem handle = memory();
                const auto* bytes = reinterpret_cast<const std::byte*>(&handle);
                return std::vector<std::byte>(bytes, bytes + sizeof(cl_mem));
            } };
}

/// What the pixel and its neighbours within `reach` pixels hold, or a list. Of a plane of another scale than the
/// pass's: all pixels that the pass's one lies over, in part or whole, and their neighbours.
inline Argument reads(std::string name, const Version& version, Reach reach = {})
{
    return { std::move(name), {}, {}, Access::Read, version, reach };
}

/// What there is of it where the pass is run: nothing is made for its sake.
inline Argument readsAsIs(std::string name, const Version& version)
{
    return { std::move(name), {}, {}, Access::Read, version, {}, true };
}

/// All of the window's pixels, or of the list, anew.
inline Argument writes(std::string name, Version& version)
{
    return { std::move(name), {}, {}, Access::Write, version, {}, false, &version };
}

/// Some of them, or after reading them: in place.
inline Argument updates(std::string name, Version& version)
{
    return { std::move(name), {}, {}, Access::Update, version, {}, false, &version };
}

/// In place, where the pass is run for the sake of something else: numbers that say what it cost.
inline Argument tallies(std::string name, Version& version)
{
    return { std::move(name), {}, {}, Access::Update, version, {}, true, &version };
}

/// What belongs together, under one name: a pass that is handed it is handed one thing. Kernels know the arguments by
/// their own names.
std::vector<Argument> together(const std::string& name, std::vector<Argument> arguments);

/// The same of planes that kernels have a structure of: each is the parameter GROUP_NAME, and LOAD_GROUP(size, at, out)
/// and STORE_GROUP(size, at, in) read and write its members NAME; those that are only read are not written.
std::vector<Argument> group(const std::string& name, std::vector<Argument> arguments);

/// There is no resource of that name: the kernel has no parameter for it, reads zero as that format has it, and
/// writes nothing.
inline Argument absent(std::string name, const Format& format = floats)
{
    Argument out { std::move(name) };
    out.absent = std::make_shared<const Format>(format);
    return out;
}

/// What a pass is launched over.
enum class Domain {
    Blocks, ///< one item for 16 pixels of a row of the window, which for that begins and ends at such blocks
    Pixels, ///< one item a pixel
    Tiles, ///< `count` tiles of itemsOfTile items, in batches of bounded time; the kernel's last argument, added to
           ///< those of the pass, is the first group of a batch
    Items, ///< `count` items of a list, or as many as the device knows of (countedBy(), lists.h)
    Host, ///< no kernel: the host does a step
};

/// What becomes of the samples that a kernel takes, see kernels/sinks/sums.h: a header of kernels/, and X of its
/// functions beginX(), takeX() and finishX(). They are handed arguments of the pass, by name.
struct Sink {
    std::string file, name;
    std::vector<std::string> begin = {}, take = {}, finish = {};
    bool onlyFinishes = false; ///< it keeps nothing, and has no other function
    device::Defines defines = {}; ///< what its header is compiled with
};

struct KernelName {
    std::string file, name;
    std::vector<Sink> sinks = {}; ///< of kernels that have any; what they are handed are the pass's last arguments
    device::Defines defines = {}; ///< what tells its program from others of the file
};

/// One step of a frame.
struct Pass {
    std::string name;
    device::PassKind kind = device::PassKind::Trace;
    KernelName kernel = {};
    std::vector<Argument> arguments = {}; ///< in the order of the kernel's parameters
    std::vector<Argument> absent = {}; ///< of those, what is absent: the graph's to say
    Domain domain = Domain::Blocks;
    Scale scale = Scale::Full; ///< of the pixels that its window is of, and of the planes that it changes
    std::function<std::size_t(const Launch&)> count = {}; ///< of tiles or items
    std::size_t itemsOfTile = 0;
    std::size_t mostItems = 0; ///< of a list: what rehearsals launch; where no host counts, the graph's to say
    std::size_t mostOfGroup = 16; ///< of a list: items of a work-group
    std::function<double(const Launch&)> workUnits = {}; ///< of the frame's progress: tiles
    std::function<void(Run&)> step = {}; ///< of the host
    bool everywhere = false; ///< covers all that is shown, whatever part of its results is wanted
    bool ofShown = false; ///< makes lists of all that is shown; others' are of margins, too
    /// Makes one resource and reads none: it is run right before the first pass that uses what it makes, so that memory
    /// is not taken before.
    bool constant = false;
    bool always = false; ///< is run although nobody wants what it makes
    bool stoppable = false; ///< may end in the middle where the run is stopped; others, once begun, are finished
    /// Is left out where this is false when its turn comes; what it makes then is what was there before. Null: never.
    std::function<bool(const Run&)> condition = {};
    int loop = -1; ///< whose body it is in: the graph's to say
};

/// A body of passes that is run several times.
struct Loop {
    std::string name;
    std::function<std::size_t(Run&)> count; ///< asked when its turn comes
    bool repeats = true; ///< false: count is 0 or 1, so that nothing is carried around
    /// Pixels: all passes of the body, and of loops in it, cover one window, which begins at multiples of this. 0: each
    /// covers what is wanted of it.
    int tile = 0;
    int parent = -1; ///< the loop around it
    std::size_t first = 0, end = 0; ///< its passes
};

/// Memory that passes work on.
struct Resource {
    std::string name;
    Format format;
    std::uint64_t elements = 0;
    bool plane = false; ///< of pixels
    int loop = -1; ///< the loop whose own it is
    std::optional<cl::Buffer> imported; ///< lives elsewhere
    std::uint32_t newest = 0; ///< version
    std::optional<Window> wanted; ///< at the end
    Scale scale = Scale::Full; ///< of planes

    std::uint64_t bytes() const;
};

class Graph {
public:
    /// Of the pixels that planes have. planeElements: of each plane, padding included; planes of other scales lie as
    /// PlaneLayout says. margin: so many of these pixels along each border are beyond the image that is shown.
    Graph(int width, int height, std::uint64_t planeElements, int margin = 0);
    Graph(const Graph&) = delete; // passes and handles know it
    Graph& operator=(const Graph&) = delete;

    /// Elements of pixels. Declared inside a loop's body: the body's own, whose contents no iteration hands on.
    template <class Quantity>
    Handle<Quantity> plane(std::string name, const Format& format, Scale scale = Scale::Full)
    {
        return { declare({ std::move(name), format, planeElements(scale), true, loop_, {}, 0, {}, scale }) };
    }
    /// As many elements of anything.
    template <class Quantity>
    Handle<Quantity> list(std::string name, const Format& format, std::uint64_t elements)
    {
        return { declare({ std::move(name), format, elements, false, loop_, {}, 0, {} }) };
    }
    /// What outlives the frame, with contents. elements: 0 for a plane of pixels.
    template <class Quantity>
    Handle<Quantity> imported(
        std::string name, const Format& format, const cl::Buffer& memory, std::uint64_t elements = 0)
    {
        return { declare(
            { std::move(name), format, elements == 0 ? planeElements_ : elements, elements == 0, -1, memory, 1, {} }) };
    }
    /// The same of a plane of any scale.
    template <class Quantity>
    Handle<Quantity> imported(std::string name, const Format& format, const cl::Buffer& memory, Scale scale)
    {
        return { declare({ std::move(name), format, planeElements(scale), true, -1, memory, 1, {}, scale }) };
    }

    /// What a kernel knows of the pixels of a scale, a shared::PixelGrid: for passes over pixels of their own scale,
    /// and for each other one that they read planes of. The frame's planes have to lie as PlaneLayout says.
    Argument grid(std::string name, Scale scale) const;

    /// Appends a pass, and makes new versions of what it changes. Throws std::logic_error with the names of the pass
    /// and the resource where it uses one wrongly.
    void add(Pass pass);

    /// Runs body() once, now, to declare what is run count(run) times. What it changes of resources from outside is
    /// carried from one iteration to the next.
    template <class Body>
    void loop(std::string name, std::function<std::size_t(Run&)> count, const Body& body)
    {
        enter({ .name = std::move(name), .count = std::move(count) });
        body();
        leave();
    }
    /// The same of passes that are to cover one window (Loop::tile): the least that holds what is wanted of each.
    template <class Body>
    void tiledLoop(std::string name, int tile, std::function<std::size_t(Run&)> count, const Body& body)
    {
        enter({ .name = std::move(name), .count = std::move(count), .tile = tile });
        body();
        leave();
    }
    /// Runs body() once, now, to declare what is run once where condition(run) is true when its turn comes, and else is
    /// left out: what it changes then is what was there before, or nothing known.
    template <class Body>
    void only(std::string name, std::function<bool(Run&)> condition, const Body& body)
    {
        const auto count = [condition = std::move(condition)](Run& run) { return condition(run) ? 1u : 0u; };
        enter({ .name = std::move(name), .count = count, .repeats = false });
        body();
        leave();
    }

    /// The newest version is wanted at the end, over those of its pixels.
    void want(const Version& version, const Window& window);

    const std::deque<Pass>& passes() const { return passes_; }
    const std::vector<Loop>& loops() const { return loops_; }
    const std::vector<Resource>& resources() const { return resources_; }
    Window image() const { return image_; }
    /// All pixels of a scale.
    Window image(Scale scale) const;
    /// Of these the ones of the image that is shown: all, but for margins.
    Window shown(Scale scale = Scale::Full) const { return converted(shown_, Scale::Full, scale); }
    /// How planes of a scale lie; of Full as the frame's have to, for what asks.
    PlaneLayout layout(Scale scale) const;
    /// The pixels of scale `to` that lie over those of a window, in part or whole.
    Window converted(const Window& window, Scale from, Scale to) const;
    /// Whether a loop is that loop or inside it; -1 is outside of all, and so holds all.
    bool holds(int loop, int inner) const;

private:
    Version declare(Resource resource);
    std::uint64_t planeElements(Scale scale) const;
    void enter(Loop loop);
    void leave();
    /// Throws unless the pass may use it, and use it so.
    Resource& checkedUse(const Pass& pass, const Argument& use);

    std::uint32_t id_;
    Window image_, shown_;
    std::uint64_t planeElements_;
    std::vector<Resource> resources_;
    std::deque<Pass> passes_;
    std::vector<Loop> loops_;
    int loop_ = -1; ///< whose body is being declared
};

} // namespace wedge::graph
