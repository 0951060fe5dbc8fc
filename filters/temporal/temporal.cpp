#include "filters/temporal/temporal.h"

#include "host/graph/plan.h"
#include "host/render/effect.h"
#include "host/render/frame_builder.h"
#include "kernels/shared/temporal.h"

#include <chrono>
#include <cmath>
#include <span>

#include <glm/trigonometric.hpp>

namespace wedge::filters {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::writes;
using render::Settings;

namespace {

constexpr const char* pass = "filter over time";
constexpr const char* file = "filter/temporal.cl";
/// Normals of one surface, whose curvature is between two pixels, differ by no more.
constexpr float normalDegrees = 25.0f;

struct Noisy { }; ///< luminance before the filter
struct Blocks { }; ///< numbers of blocks of pixels

/// What a frame keeps in a plane.
struct KeptPlane {
    const char* name;
    const graph::Format& format;
};
constexpr KeptPlane keptPlanes[] = { { "kept depth", graph::floats }, { "kept normal", graph::counts },
    { "kept object", graph::counts }, { "kept direct light", render::packedColours },
    { "kept light before the filter", render::shortFloats }, { "kept variation", render::shortFloats },
    { "kept indirect light", render::packedColours } };
enum KeptIndex : std::size_t { Depth, Facing, Object, Direct, Before, Variation, Indirect, keptCount };

bool hasIndirect(const Settings& settings, const render::PreparedScene& scene)
{
    return render::countOf(render::Part::Indirect, render::frameTerms(settings, scene)) > 0;
}

std::size_t keptOf(bool indirect) { return indirect ? keptCount : std::size_t { Indirect }; }

bool equal(shared::Vec3 a, shared::Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool equalCameras(const shared::FrameParams& a, const shared::FrameParams& b)
{
    return equal(a.eye, b.eye) && equal(a.forward, b.forward) && equal(a.right, b.right) && equal(a.down, b.down);
}

void setCamera(shared::TemporalParams& p, const shared::FrameParams& camera)
{
    p.eye = camera.eye;
    p.forward = camera.forward;
    p.right = camera.right;
    p.down = camera.down;
}

} // namespace

struct TemporalFilter::Kept {
    std::optional<std::uint32_t> frame; ///< which it is; none: nothing yet
    shared::FrameParams camera {};
    std::shared_ptr<const ObjectPlaces> places;
    std::vector<device::Buffer<std::uint8_t>> planes; ///< keptPlanes
};

/// A frame's planes in the graph.
struct TemporalFilter::Handles {
    graph::Handle<render::Metres> depth;
    graph::Handle<render::Packed> facing;
    graph::Handle<render::ObjectId> object;
    graph::Handle<render::Value> direct, indirect;
    graph::Handle<Noisy> before;
    graph::Handle<render::Squares> variation;
};

/// The graph of one frame.
struct TemporalFilter::Declaration {
    Declaration(render::Renderer& theRenderer, const Settings& theSettings)
        : renderer(theRenderer)
        , settings(theSettings)
        , frame(theRenderer.frame())
        , graph(settings.width, settings.height, frame.layout.size)
        , f { graph, theRenderer.scene(), nullptr, settings, frame.layout, 1 }
        , indirect(hasIndirect(settings, theRenderer.scene()))
    {
        params.width = frame.layout.width;
        params.height = frame.layout.height;
        params.stride = frame.layout.stride;
        params.planeSize = static_cast<std::uint32_t>(frame.layout.size);
        params.blocksX = (params.width + WEDGE_TEMPORAL_BLOCK - 1) / WEDGE_TEMPORAL_BLOCK;
        params.blocksY = (params.height + WEDGE_TEMPORAL_BLOCK - 1) / WEDGE_TEMPORAL_BLOCK;
        params.indirect = indirect ? 1 : 0;
        params.published = settings.temporal == render::Temporal::Published ? 1 : 0;
        params.open = settings.integrator == render::Integrator::AmbientOcclusion ? 1 : 0;
        params.mixed = frame.distributed ? 1 : 0;
        params.measured = frame.has("directDeviation") ? 1 : 0;
        params.normalCosine = std::cos(glm::radians(normalDegrees));
        importFrame();
    }

    void importFrame()
    {
        const auto import = [&]<class Quantity>(
                                const char* name, graph::Handle<Quantity>& handle, const graph::Format& format) {
            handle = graph.imported<Quantity>(name, format, frame.find(name).memory);
        };
        import("position", f.surfaces.position, graph::vectors);
        import("normal", f.surfaces.normal, graph::vectors);
        import("albedo", f.surfaces.diffuse, graph::vectors);
        import("specular", f.surfaces.specular, graph::vectors);
        import("objectId", f.surfaces.objectId, graph::counts);
        import("direct", f.totals.direct.filtered, graph::vectors);
        import("directNoisy", f.totals.direct.noisy, graph::vectors);
        import("beauty", f.totals.beauty, graph::vectors);
        const bool measured = params.measured != 0;
        if (measured) {
            import("directDeviation", f.totals.direct.deviation, render::shortFloats);
        }
        if (indirect) {
            import("indirect", f.totals.indirect.filtered, graph::vectors);
            import("indirectNoisy", f.totals.indirect.noisy, graph::vectors);
        }
        if (measured && indirect) {
            import("indirectDeviation", f.totals.indirect.deviation, render::shortFloats);
        }
    }

    Handles handlesOf(const Kept& kept)
    {
        const auto one = [&]<class Quantity>(graph::Handle<Quantity>& handle, KeptIndex index) {
            handle =
                graph.imported<Quantity>(keptPlanes[index].name, keptPlanes[index].format, kept.planes[index].cl());
        };
        Handles out;
        one(out.depth, Depth);
        one(out.facing, Facing);
        one(out.object, Object);
        one(out.direct, Direct);
        one(out.before, Before);
        one(out.variation, Variation);
        if (indirect) {
            one(out.indirect, Indirect);
        }
        return out;
    }

    template <class Quantity>
    static graph::Argument readsIf(
        bool there, const char* name, const graph::Handle<Quantity>& handle, const graph::Format& format)
    {
        return there ? reads(name, handle) : graph::absent(name, format);
    }

    /// Keeps the frame in `own`.
    void keep(Handles& own, const shared::FrameParams& camera)
    {
        const render::Surfaces& s = f.surfaces;
        const render::Totals& t = f.totals;
        setCamera(params, camera);
        f.pixels(pass, PassKind::Filter, { file, "keepFrame" },
            render::joined({ f.rectangle(params), reads("diffuse", s.diffuse), reads("specular", s.specular) },
                render::places(s),
                graph::together("light",
                    { reads("direct", t.direct.filtered), reads("directNoisy", t.direct.noisy),
                        readsIf(indirect, "indirect", t.indirect.filtered, graph::vectors),
                        readsIf(indirect, "indirectNoisy", t.indirect.noisy, graph::vectors),
                        readsIf(params.measured != 0, "directDeviation", t.direct.deviation, render::shortFloats),
                        readsIf(params.measured != 0 && indirect, "indirectDeviation", t.indirect.deviation,
                            render::shortFloats) }),
                graph::together("kept",
                    { updates("depth", own.depth), updates("facing", own.facing), updates("object", own.object),
                        updates("directLight", own.direct),
                        indirect ? updates("indirectLight", own.indirect)
                                 : graph::absent("indirectLight", render::packedColours),
                        updates("noisy", own.before), updates("variation", own.variation) })));
        f.pixels(pass, PassKind::Filter, { file, "findVariation" },
            { f.rectangle(params), reads("noisy", own.before, graph::around(1)),
                reads("object", own.object, graph::around(1)), updates("variation", own.variation) });
        want(own.depth, own.facing, own.object, own.direct, own.before, own.variation);
        if (indirect) {
            want(own.indirect);
        }
    }

    template <class... Quantities>
    void want(const graph::Handle<Quantities>&... handles)
    {
        (graph.want(handles, graph.image()), ...);
    }

    /// A pass over blocks of pixels; `blocks` is its kernel's second parameter.
    void blocks(const char* kernel, std::vector<graph::Argument> uses)
    {
        const std::uint32_t count = params.blocksX * params.blocksY;
        std::vector<graph::Argument> arguments = { f.rectangle(params),
            graph::made("blocks", [count](const graph::Launch& l) { return l.run.rehearsal() ? 0u : count; }) };
        arguments.insert(arguments.end(), uses.begin(), uses.end());
        graph.add({ .name = pass,
            .kind = PassKind::Filter,
            .kernel = { file, kernel },
            .arguments = std::move(arguments),
            .domain = graph::Domain::Items,
            .count = [count](const graph::Launch&) { return std::size_t { count }; },
            .mostItems = count });
    }

    void startSums()
    {
        sum = graph.plane<render::Value>("sum of differences", graph::floatPlanes(indirect ? 6 : 3));
        counts = graph.plane<render::Share>("frames that see the surface", graph::floats);
        f.zero(sum, counts);
    }

    /// Adds a frame that was kept. motions: from this frame to that, empty: no object has moved.
    void add(const Handles& own, const Kept& kept, bool cameraStill, const std::vector<float>& motions,
        const cl::Buffer& motionMemory)
    {
        const std::uint64_t all = std::uint64_t { params.blocksX } * params.blocksY;
        const Handles earlier = handlesOf(kept);
        setCamera(params, kept.camera);
        params.cameraStill = cameraStill ? 1 : 0;
        params.objectsStill = motions.empty() ? 1 : 0;
        params.objects = static_cast<std::uint32_t>(renderer.scene().geometry.objectNames.size());
        auto difference = graph.plane<render::Value>("difference of frames", graph::floatPlanes(indirect ? 6 : 3));
        auto noise = graph.plane<Noisy>("difference before the filter", graph::floats);
        auto variations = graph.plane<render::Squares>("variation of both", graph::floats);
        auto share = graph.plane<render::Share>("whether the surface was seen", graph::floats);
        auto weights = graph.list<Blocks>("weights of blocks", graph::floats, all);
        const graph::Argument p = f.rectangle(params);
        f.pixels(pass, PassKind::Filter, { file, "differFromFrame" },
            render::joined({ p, f.outside("motions", "float", &motionMemory), reads("position", f.surfaces.position),
                               reads("normal", f.surfaces.normal) },
                graph::together("kept",
                    { reads("object", own.object), reads("directLight", own.direct),
                        readsIf(indirect, "indirectLight", own.indirect, render::packedColours),
                        reads("noisy", own.before), reads("variation", own.variation) }),
                graph::together("earlier",
                    { reads("earlierDepth", earlier.depth, graph::wholeImage),
                        reads("earlierFacing", earlier.facing, graph::wholeImage),
                        reads("earlierObject", earlier.object, graph::wholeImage),
                        reads("earlierDirect", earlier.direct, graph::wholeImage),
                        indirect ? reads("earlierIndirect", earlier.indirect, graph::wholeImage)
                                 : graph::absent("earlierIndirect", render::packedColours),
                        reads("earlierNoisy", earlier.before, graph::wholeImage),
                        reads("earlierVariation", earlier.variation, graph::wholeImage) }),
                render::Arguments { writes("difference", difference), writes("noise", noise),
                    writes("variations", variations), writes("share", share) }));
        const bool weighed = params.published == 0;
        if (weighed) {
            auto sums = graph.list<Blocks>("sums of blocks", graph::floatPlanes(4), all);
            blocks("sumBlocks",
                { reads("noise", noise), reads("variations", variations), reads("share", share),
                    writes("sums", sums) });
            blocks("weighBlocks", { reads("sums", sums), writes("weights", weights) });
        }
        f.pixels(pass, PassKind::Filter, { file, "addFrame" },
            { p, reads("difference", difference), reads("share", share),
                readsIf(weighed, "weights", weights, graph::floats), updates("sum", sum), updates("counts", counts) });
    }

    void finish()
    {
        render::Totals& t = f.totals;
        f.pixels(pass, PassKind::Filter, { file, "finishTemporal" },
            { f.rectangle(params), reads("diffuse", f.surfaces.diffuse), reads("specular", f.surfaces.specular),
                reads("sum", sum), reads("counts", counts), updates("direct", t.direct.filtered),
                indirect ? updates("indirect", t.indirect.filtered) : graph::absent("indirect", graph::vectors),
                updates("beauty", t.beauty) });
        want(t.direct.filtered, t.beauty);
        if (indirect) {
            want(t.indirect.filtered);
        }
    }

    render::Renderer& renderer;
    const Settings& settings;
    const render::Frame& frame;
    graph::Graph graph;
    render::FrameBuilder f;
    bool indirect;
    shared::TemporalParams params {};
    graph::Handle<render::Value> sum;
    graph::Handle<render::Share> counts;
};

TemporalFilter::TemporalFilter(const device::Device& device)
    : device_(device)
    , kept_(temporalWindow)
    , memory_(device_)
{
}

TemporalFilter::~TemporalFilter() = default;

TemporalFilter::Kept& TemporalFilter::slotOf(std::uint32_t frame, const Settings& settings)
{
    return kept_.at(frame % windowOf(settings.temporal));
}

void TemporalFilter::addTo(device::MemoryPlan& plan, const Settings& settings, const render::PreparedScene& scene)
{
    const render::PlaneLayout layout(settings.width, settings.height);
    const bool indirect = hasIndirect(settings, scene);
    for (std::size_t i = 0; i < keptOf(indirect); ++i) {
        // Allocated one by one.
        for (std::uint32_t k = 0; k < windowOf(settings.temporal); ++k) {
            plan.addItems(keptPlanes[i].name, layout.size, keptPlanes[i].format.bytes);
        }
    }
    const std::uint64_t planes = indirect ? 12 : 6;
    plan.addItems("sums of the filter over time", layout.size, (planes + 4) * sizeof(float));
    plan.addItems("weights of the filter over time", layout.size / (WEDGE_TEMPORAL_BLOCK * WEDGE_TEMPORAL_BLOCK),
        5 * sizeof(float));
    plan.addItems("motions", std::uint64_t { windowOf(settings.temporal) } * scene.geometry.objectNames.size(),
        WEDGE_TEMPORAL_MOTION * sizeof(float));
}

void TemporalFilter::keep(render::Renderer& renderer, const Settings& settings,
    std::shared_ptr<const ObjectPlaces> places, render::FrameStatistics& statistics)
{
    run(renderer, settings, std::move(places), false, &statistics);
}

void TemporalFilter::filter(render::Renderer& renderer, const Settings& settings,
    std::shared_ptr<const ObjectPlaces> places, render::FrameStatistics& statistics)
{
    run(renderer, settings, std::move(places), true, &statistics);
}

void TemporalFilter::rehearse(render::Renderer& renderer, const Settings& settings)
{
    run(renderer, settings, nullptr, true, nullptr);
}

void TemporalFilter::show(
    render::Renderer& renderer, const Settings& settings, const std::function<void(const graph::Graph&)>& look)
{
    run(renderer, settings, nullptr, true, nullptr, look);
}

void TemporalFilter::allocate(Kept& kept, const Declaration& d) const
{
    for (std::size_t i = kept.planes.size(); i < keptOf(d.indirect); ++i) {
        kept.planes.emplace_back(device_, d.frame.layout.size * keptPlanes[i].format.bytes, keptPlanes[i].name);
    }
}

void TemporalFilter::declareMeans(Declaration& d, const Handles& handles, std::uint32_t number, bool rehearsal,
    std::vector<device::Buffer<float>>& motions)
{
    const Kept& own = slotOf(number, d.settings);
    const auto add = [&](const Kept& kept) {
        const bool moved =
            own.places && kept.places && own.places != kept.places && !areStill(*own.places, *kept.places);
        const std::vector<float> motion = moved ? motionsBetween(*own.places, *kept.places) : std::vector<float>();
        device::Buffer<float>& memory = motions.emplace_back(device_, motion.size(), "motions");
        if (moved) {
            memory.upload(d.renderer.queue(), std::span<const float>(motion));
        }
        d.add(handles, kept, equalCameras(own.camera, kept.camera), motion, memory.cl());
    };
    d.startSums();
    bool before = false;
    for (std::uint32_t frame = number; frame-- > firstOfWindow(number, d.settings.temporal);) {
        if (slotOf(frame, d.settings).frame == frame) {
            add(slotOf(frame, d.settings));
            before = true;
        }
    }
    if (!before) {
        // Programs are of the kernels that a graph has. Each frame declares all, so that none builds its own amid a
        // sequence: where nothing is filtered, or no frame was before, passes that are not run.
        Kept& next = slotOf(number + 1, d.settings);
        allocate(next, d);
        d.graph.only(
            "filter over time", [rehearsal](const graph::Run&) { return rehearsal; }, [&] { add(next); });
    }
    d.finish();
}

void TemporalFilter::run(render::Renderer& renderer, const Settings& settings,
    std::shared_ptr<const ObjectPlaces> places, bool filters, render::FrameStatistics* statistics,
    const std::function<void(const graph::Graph&)>& look)
{
    const auto start = std::chrono::steady_clock::now();
    const bool rehearsal = statistics == nullptr;
    const std::uint32_t number = settings.frame.value_or(0);
    device::TimedQueue& queue = renderer.queue();
    Declaration d(renderer, settings);
    Kept& own = slotOf(number, settings);
    allocate(own, d);
    own.frame = rehearsal ? std::nullopt : std::optional(number);
    own.camera = render::frameParams(renderer.scene(), d.frame.layout, d.graph.image(), 0);
    own.places = std::move(places);
    Handles handles = d.handlesOf(own);
    d.keep(handles, own.camera);
    std::vector<device::Buffer<float>> motions;
    d.graph.only(
        "filter over time", [filters](const graph::Run&) { return filters; },
        [&] { declareMeans(d, handles, number, rehearsal, motions); });
    if (look) {
        look(d.graph);
        return;
    }
    const graph::Plan plan(d.graph, device::partAlignment, renderer.slabRules());
    graph::Execution execution(plan, memory_, renderer.kernels(), queue);
    if (rehearsal) {
        execution.rehearse();
        queue.finish();
        queue.takeRecords();
        queue.forgetCosts();
        return;
    }
    execution.run();
    queue.finish();
    for (device::PassRecord& record : queue.takeRecords()) {
        statistics->deviceMilliseconds += record.milliseconds;
        statistics->passes.push_back(std::move(record));
    }
    device::MemoryPlan memory;
    addTo(memory, settings, renderer.scene());
    statistics->memoryBytes += memory.total();
    statistics->wallMilliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace wedge::filters
