#include "filters/temporal/temporal.h"

#include "host/device/buffer.h"
#include "host/graph/execution.h"
#include "host/render/distributed_samples.h"
#include "host/render/effect.h"
#include "host/render/frame_builder.h"
#include "kernels/shared/temporal.h"

#include <cmath>
#include <optional>
#include <span>

#include <glm/trigonometric.hpp>

namespace wedge::filters {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::writes;
using render::Arguments;
using render::joined;
using render::Settings;

namespace {

constexpr const char* pass = "filter over time";
constexpr const char* file = "filter/temporal.cl";
/// Normals of one surface, whose curvature is between two pixels, differ by no more.
constexpr float normalDegrees = 25.0f;

struct Noisy { }; ///< luminance before the filter
struct Blocks { }; ///< numbers of blocks of pixels
struct Motions { }; ///< motionsBetween()

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

bool haveMoved(const std::shared_ptr<const ObjectPlaces>& from, const std::shared_ptr<const ObjectPlaces>& to)
{
    return from && to && from != to && !areStill(*from, *to);
}

} // namespace

struct TemporalFilter::Kept {
    std::optional<std::uint32_t> frame; ///< which it is; none: nothing yet
    shared::FrameParams camera {};
    std::shared_ptr<const ObjectPlaces> places;
    std::vector<device::Buffer<std::uint8_t>> planes; ///< keptPlanes, once allocated
    std::uint64_t size = 0; ///< elements of a plane
};

/// Those of one frame.
class TemporalFilter::Passes {
public:
    Passes(TemporalFilter& filter, render::FrameBuilder& frame);

    void declare();

private:
    /// A kept frame's planes in the graph.
    struct Planes {
        graph::Handle<render::Metres> depth;
        graph::Handle<render::Packed> facing;
        graph::Handle<render::ObjectId> object;
        graph::Handle<render::Value> direct, indirect;
        graph::Handle<Noisy> before;
        graph::Handle<render::Squares> variation;
    };
    /// What a frame differs by from an earlier one, pixel by pixel.
    struct Differences {
        graph::Handle<render::Value> light;
        graph::Handle<Noisy> noise;
        graph::Handle<render::Squares> variations;
        graph::Handle<render::Share> share;
    };

    Kept& slotOf(std::uint32_t frame) const { return filter_.kept_.at(frame % windowOf(f_.settings.temporal)); }
    Planes planesOf(const Kept& kept) const;
    template <class Quantity>
    static graph::Argument readsIf(
        bool there, const char* name, const graph::Handle<Quantity>& handle, const graph::Format& format)
    {
        return there ? reads(name, handle) : graph::absent(name, format);
    }
    /// A pass over blocks of pixels; `blocks` is its kernel's second parameter.
    void blocks(const char* kernel, const Arguments& uses);

    void keep();
    Arguments frameLight() const;
    void startSums();
    /// Adds a frame that was kept, if it was.
    void add(const Kept& earlier);
    /// moved: whether any object has, known once they are there.
    graph::Handle<Motions> motionsTo(const Kept& earlier, const std::shared_ptr<bool>& moved);
    Differences differencesFrom(const Kept& earlier);
    graph::Handle<Blocks> weightsOf(const Differences& differences);
    void finish();

    TemporalFilter& filter_;
    render::FrameBuilder& f_;
    graph::Graph& g_;
    std::uint32_t number_;
    bool indirect_;
    bool mixed_; ///< pixels have several receivers
    bool measured_; ///< they know their own noise
    Kept& slot_; ///< the frame's own
    Planes own_;
    shared::FrameParams camera_;
    shared::TemporalParams params_ {};
    graph::Handle<render::Value> sum_;
    graph::Handle<render::Share> counts_;
};

TemporalFilter::Passes::Passes(TemporalFilter& filter, render::FrameBuilder& frame)
    : filter_(filter)
    , f_(frame)
    , g_(frame.graph)
    , number_(frame.settings.frame.value_or(0))
    , indirect_(hasIndirect(frame.settings, frame.description))
    , mixed_(render::isDistributed(frame.settings, frame.description))
    , measured_(!mixed_ && render::usesFallback(frame.settings))
    , slot_(slotOf(number_))
    , camera_(frame.wholeFrame())
{
    params_.width = f_.layout.width;
    params_.height = f_.layout.height;
    params_.stride = f_.layout.stride;
    params_.planeSize = static_cast<std::uint32_t>(f_.layout.size);
    params_.blocksX = (params_.width + WEDGE_TEMPORAL_BLOCK - 1) / WEDGE_TEMPORAL_BLOCK;
    params_.blocksY = (params_.height + WEDGE_TEMPORAL_BLOCK - 1) / WEDGE_TEMPORAL_BLOCK;
    params_.indirect = indirect_ ? 1 : 0;
    params_.published = f_.settings.temporal == render::Temporal::Published ? 1 : 0;
    params_.open = f_.settings.integrator == render::Integrator::AmbientOcclusion ? 1 : 0;
    params_.mixed = mixed_ ? 1 : 0;
    params_.measured = measured_ ? 1 : 0;
    params_.normalCosine = std::cos(glm::radians(normalDegrees));
    params_.objects = static_cast<std::uint32_t>(f_.description.geometry.objectNames.size());
    setCamera(params_, camera_);
    own_ = planesOf(slot_);
}

TemporalFilter::Passes::Planes TemporalFilter::Passes::planesOf(const Kept& kept) const
{
    const auto one = [&]<class Quantity>(graph::Handle<Quantity>& handle, KeptIndex index) {
        const cl::Buffer memory = f_.scene != nullptr ? kept.planes.at(index).cl() : cl::Buffer();
        handle = g_.imported<Quantity>(keptPlanes[index].name, keptPlanes[index].format, memory);
    };
    Planes out;
    one(out.depth, Depth);
    one(out.facing, Facing);
    one(out.object, Object);
    one(out.direct, Direct);
    one(out.before, Before);
    one(out.variation, Variation);
    if (indirect_) {
        one(out.indirect, Indirect);
    }
    return out;
}

void TemporalFilter::Passes::declare()
{
    f_.host(pass, [&slot = slot_, &places = filter_.places_, camera = camera_](Run& run) {
        if (!run.rehearsal()) {
            slot.frame.reset();
            slot.camera = camera;
            slot.places = places;
        }
    });
    keep();
    f_.host(pass, [&slot = slot_, number = number_](Run& run) {
        if (!run.rehearsal() && !run.cut()) {
            slot.frame = number;
        }
    });
    g_.only(
        pass, [&filters = filter_.filters_](const Run& run) { return filters && !run.cut(); },
        [&] {
            startSums();
            // One at least, so that the first frame of a sequence builds the programs of all.
            const std::uint32_t window = windowOf(f_.settings.temporal);
            for (std::uint32_t back = 1; back <= std::clamp(number_, 1u, window - 1); ++back) {
                const Kept& earlier = slotOf(number_ % window + window - back);
                const auto seen = [&earlier, back, number = number_](
                                      const Run&) { return number >= back && earlier.frame == number - back; };
                g_.only(pass, seen, [&] { add(earlier); });
            }
            finish();
        });
}

Arguments TemporalFilter::Passes::frameLight() const
{
    const render::Totals& t = f_.totals;
    return graph::together("light",
        { reads("direct", t.direct.filtered), reads("directNoisy", t.direct.noisy),
            readsIf(indirect_, "indirect", t.indirect.filtered, graph::vectors),
            readsIf(indirect_, "indirectNoisy", t.indirect.noisy, graph::vectors),
            readsIf(measured_, "directDeviation", t.direct.deviation, render::shortFloats),
            readsIf(measured_ && indirect_, "indirectDeviation", t.indirect.deviation, render::shortFloats) });
}

void TemporalFilter::Passes::keep()
{
    const render::Surfaces& s = f_.surfaces;
    f_.pixels(pass, PassKind::Filter, { file, "keepFrame" },
        joined({ f_.rectangle(params_), reads("diffuse", s.diffuse), reads("specular", s.specular) }, render::places(s),
            frameLight(),
            graph::together("kept",
                { updates("depth", own_.depth), updates("facing", own_.facing), updates("object", own_.object),
                    updates("directLight", own_.direct),
                    indirect_ ? updates("indirectLight", own_.indirect)
                              : graph::absent("indirectLight", render::packedColours),
                    updates("noisy", own_.before), updates("variation", own_.variation) })));
    f_.pixels(pass, PassKind::Filter, { file, "findVariation" },
        { f_.rectangle(params_), reads("noisy", own_.before, graph::around(1)),
            reads("object", own_.object, graph::around(1)), updates("variation", own_.variation) });
    for (const graph::Version* plane :
        { static_cast<const graph::Version*>(&own_.depth), static_cast<const graph::Version*>(&own_.facing),
            static_cast<const graph::Version*>(&own_.object), static_cast<const graph::Version*>(&own_.direct),
            static_cast<const graph::Version*>(&own_.before), static_cast<const graph::Version*>(&own_.variation) }) {
        g_.want(*plane, g_.image());
    }
    if (indirect_) {
        g_.want(own_.indirect, g_.image());
    }
}

void TemporalFilter::Passes::blocks(const char* kernel, const Arguments& uses)
{
    const std::uint32_t count = params_.blocksX * params_.blocksY;
    g_.add({ .name = pass,
        .kind = PassKind::Filter,
        .kernel = { file, kernel },
        .arguments = joined(
            { f_.rectangle(params_),
                graph::made("blocks", [count](const graph::Launch& l) { return l.run.rehearsal() ? 0u : count; }) },
            uses),
        .domain = graph::Domain::Items,
        .count = [count](const graph::Launch&) { return std::size_t { count }; },
        .mostItems = count });
}

void TemporalFilter::Passes::startSums()
{
    sum_ = g_.plane<render::Value>("sum of differences", graph::floatPlanes(indirect_ ? 6 : 3));
    counts_ = g_.plane<render::Share>("frames that see the surface", graph::floats);
    f_.zero(sum_, counts_);
}

graph::Handle<Motions> TemporalFilter::Passes::motionsTo(const Kept& earlier, const std::shared_ptr<bool>& moved)
{
    const std::uint64_t floats = std::uint64_t { std::max(params_.objects, 1u) } * WEDGE_TEMPORAL_MOTION;
    auto motions = g_.list<Motions>("motions", graph::floats, floats);
    g_.add({ .name = pass,
        .kind = PassKind::Transfer,
        .arguments = { writes("motions", motions) },
        .domain = graph::Domain::Host,
        .step =
            [motions, moved, &earlier, &places = filter_.places_](Run& run) {
                *moved = !run.rehearsal() && haveMoved(places, earlier.places);
                if (*moved) {
                    run.buffer<float>(motions).upload(
                        run.queue(), std::span<const float>(motionsBetween(*places, *earlier.places)));
                }
            },
        .constant = true });
    return motions;
}

TemporalFilter::Passes::Differences TemporalFilter::Passes::differencesFrom(const Kept& earlier)
{
    const Planes then = planesOf(earlier);
    Differences out { g_.plane<render::Value>("difference of frames", graph::floatPlanes(indirect_ ? 6 : 3)),
        g_.plane<Noisy>("difference before the filter", graph::floats),
        g_.plane<render::Squares>("variation of both", graph::floats),
        g_.plane<render::Share>("whether the surface was seen", graph::floats) };
    const auto moved = std::make_shared<bool>(false);
    const auto params = [params = params_, camera = camera_, moved, &earlier](const graph::Launch& launch) {
        shared::TemporalParams p = params;
        render::setRectangle(p, launch.window);
        setCamera(p, earlier.camera);
        p.cameraStill = equalCameras(camera, earlier.camera) ? 1 : 0;
        p.objectsStill = *moved ? 0 : 1;
        return p;
    };
    f_.pixels(pass, PassKind::Filter, { file, "differFromFrame" },
        joined({ graph::made("p", params), reads("motions", motionsTo(earlier, moved)),
                   reads("position", f_.surfaces.position), reads("normal", f_.surfaces.normal) },
            graph::together("kept",
                { reads("object", own_.object), reads("directLight", own_.direct),
                    readsIf(indirect_, "indirectLight", own_.indirect, render::packedColours),
                    reads("noisy", own_.before), reads("variation", own_.variation) }),
            graph::together("earlier",
                { reads("earlierDepth", then.depth, graph::wholeImage),
                    reads("earlierFacing", then.facing, graph::wholeImage),
                    reads("earlierObject", then.object, graph::wholeImage),
                    reads("earlierDirect", then.direct, graph::wholeImage),
                    indirect_ ? reads("earlierIndirect", then.indirect, graph::wholeImage)
                              : graph::absent("earlierIndirect", render::packedColours),
                    reads("earlierNoisy", then.before, graph::wholeImage),
                    reads("earlierVariation", then.variation, graph::wholeImage) }),
            Arguments { writes("difference", out.light), writes("noise", out.noise),
                writes("variations", out.variations), writes("share", out.share) }));
    return out;
}

graph::Handle<Blocks> TemporalFilter::Passes::weightsOf(const Differences& differences)
{
    const std::uint64_t all = std::uint64_t { params_.blocksX } * params_.blocksY;
    auto sums = g_.list<Blocks>("sums of blocks", graph::floatPlanes(4), all);
    auto weights = g_.list<Blocks>("weights of blocks", graph::floats, all);
    blocks("sumBlocks",
        { reads("noise", differences.noise), reads("variations", differences.variations),
            reads("share", differences.share), writes("sums", sums) });
    blocks("weighBlocks", { reads("sums", sums), writes("weights", weights) });
    return weights;
}

void TemporalFilter::Passes::add(const Kept& earlier)
{
    const Differences differences = differencesFrom(earlier);
    const bool weighed = params_.published == 0;
    const graph::Handle<Blocks> weights = weighed ? weightsOf(differences) : graph::Handle<Blocks>();
    f_.pixels(pass, PassKind::Filter, { file, "addFrame" },
        { f_.rectangle(params_), reads("difference", differences.light), reads("share", differences.share),
            readsIf(weighed, "weights", weights, graph::floats), updates("sum", sum_), updates("counts", counts_) });
}

void TemporalFilter::Passes::finish()
{
    render::Totals& t = f_.totals;
    f_.pixels(pass, PassKind::Filter, { file, "finishTemporal" },
        { f_.rectangle(params_), reads("diffuse", f_.surfaces.diffuse), reads("specular", f_.surfaces.specular),
            reads("sum", sum_), reads("counts", counts_), updates("direct", t.direct.filtered),
            indirect_ ? updates("indirect", t.indirect.filtered) : graph::absent("indirect", graph::vectors),
            updates("beauty", t.beauty) });
}

TemporalFilter::TemporalFilter(const device::Device& device)
    : device_(device)
    , kept_(temporalWindow)
{
}

TemporalFilter::~TemporalFilter() = default;

void TemporalFilter::next(std::shared_ptr<const ObjectPlaces> places, bool filters)
{
    places_ = std::move(places);
    filters_ = filters;
}

void TemporalFilter::addTo(device::MemoryPlan& plan, const Settings& settings, const render::PreparedScene& scene) const
{
    const render::PlaneLayout layout = render::frameLayout(settings, scene);
    for (std::size_t i = 0; i < keptOf(hasIndirect(settings, scene)); ++i) {
        // Allocated one by one.
        for (std::uint32_t k = 0; k < windowOf(settings.temporal); ++k) {
            plan.addItems(keptPlanes[i].name, layout.size, keptPlanes[i].format.bytes);
        }
    }
}

void TemporalFilter::allocate(const Settings& settings, const render::PreparedScene& scene)
{
    const render::PlaneLayout layout = render::frameLayout(settings, scene);
    const std::size_t planes = keptOf(hasIndirect(settings, scene));
    for (std::uint32_t k = 0; k < windowOf(settings.temporal); ++k) {
        Kept& kept = kept_.at(k);
        if (kept.planes.size() == planes && kept.size == layout.size) {
            continue;
        }
        kept.frame.reset();
        kept.planes.clear(); // before there are more
        kept.size = layout.size;
        for (std::size_t i = 0; i < planes; ++i) {
            kept.planes.emplace_back(device_, layout.size * keptPlanes[i].format.bytes, keptPlanes[i].name);
        }
    }
}

void TemporalFilter::declare(render::FrameBuilder& frame) { Passes(*this, frame).declare(); }

} // namespace wedge::filters
