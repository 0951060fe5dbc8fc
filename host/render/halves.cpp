#include "host/render/halves.h"

#include <cmath>
#include <limits>
#include <map>

namespace wedge::render {

using device::PassKind;
using graph::made;
using graph::reads;
using graph::value;
using graph::writes;

namespace {

constexpr const char* pass = "mean of halves";
constexpr const char* file = "frame/progressive.cl";

// Both halves' numbers are hashes of their seeds: any two seeds will do.
constexpr std::uint32_t secondSeed = 0x9e3779b9u;

} // namespace

double ErrorEstimate::rmse() const { return std::sqrt(noise + (std::isnan(bias) ? bias : std::max(bias, 0.0))); }

HalvesFrame::HalvesFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
    std::size_t packetSize, bool keepLayers, HalfMemories& memories, int before, int spp)
    : FrameGraph(settings, scene, keepLayers, true)
{
    const SampleShape shape = sampleShape(settings, scene, keepLayers);
    const auto taken = static_cast<std::uint32_t>(before == 0 ? 0 : halfAt(settings, before).spp);
    for (std::size_t i = 0; i < halves_.size(); ++i) {
        Half& half = halves_[i];
        half.settings = halfAt(settings, spp);
        half.settings.seed += static_cast<std::uint32_t>(i) * secondSeed;
        half.frame = std::make_unique<FrameBuilder>(
            FrameBuilder { graph_, scene, deviceScene, half.settings, layout_, packetSize });
        half.samples = std::make_unique<DistributedSamples>(
            *half.frame, shape, DistributedSamples::Before { &memories[i], taken, i == 1 });
    }
    // Each half follows the other's demands once that has any.
    halves_[0].samples->take(taken > 0 ? halves_[1].samples.get() : nullptr);
    halves_[1].samples->take(halves_[0].samples.get());
    for (const Half& half : halves_) {
        half.samples->compose();
    }
    const bool analysed = shape.analysed && settings.filtering != Filtering::None;
    estimateError(analysed);
    join();
}

graph::Version HalvesFrame::mean(const graph::Version& one, const graph::Version& other)
{
    FrameBuilder& f = *halves_[0].frame;
    const graph::Format format = graph_.resources()[one.resource].format;
    auto out = graph_.plane<Radiance>("mean of halves", format);
    f.pixels(pass, PassKind::Composite, { file, "meanOfHalves" },
        { f.rectangle(halves_[0].samples->params()), value("planes", format == graph::vectors ? 3u : 1u),
            reads("takenA", halves_[0].samples->taken()), reads("takenB", halves_[1].samples->taken()), reads("a", one),
            reads("b", other), writes("mean", out) });
    return out;
}

graph::Version HalvesFrame::sum(const graph::Version& one, const graph::Version& other)
{
    FrameBuilder& f = *halves_[0].frame;
    auto out = graph_.plane<Count>("sum of halves", graph::counts);
    f.pixels(pass, PassKind::Composite, { file, "sumOfHalves" },
        { f.rectangle(halves_[0].samples->params()), reads("a", one), reads("b", other), writes("sum", out) });
    return out;
}

graph::Version HalvesFrame::sumOfTraced(const graph::Version& one, const graph::Version& other)
{
    FrameBuilder& f = *halves_[0].frame;
    const graph::Resource& resource = graph_.resources()[one.resource];
    if (resource.plane) {
        // Of crops more pixels are sampled than shown, and all that was traced counts.
        auto out = graph_.plane<Count>("sum of halves", graph::counts);
        f.zero(out);
        graph_.add({ .name = pass,
            .kind = PassKind::Composite,
            .kernel = { file, "sumOfHalves" },
            .arguments = { f.rectangle(halves_[0].samples->params()), graph::readsAsIs("a", one),
                graph::readsAsIs("b", other), graph::updates("sum", out) },
            .domain = graph::Domain::Pixels,
            .everywhere = true });
        return out;
    }
    const std::uint64_t count = resource.elements;
    auto out = graph_.list<Count>("sum of halves", graph::counts, count);
    const auto items = static_cast<std::size_t>(count);
    graph_.add({ .name = pass,
        .kind = PassKind::Composite,
        .kernel = { file, "sumOfLists" },
        .arguments = { graph::made("count",
                           [count](const graph::Launch& launch) {
                               return launch.run.rehearsal() ? 0u : static_cast<std::uint32_t>(count);
                           }),
            graph::readsAsIs("a", one), graph::readsAsIs("b", other), writes("sum", out) },
        .domain = graph::Domain::Items,
        .count = [items](const graph::Launch&) { return items; },
        .mostItems = items });
    return out;
}

Surfaces HalvesFrame::joinedSurfaces()
{
    FrameBuilder& f = *halves_[0].frame;
    const graph::Argument p = f.rectangle(halves_[0].samples->params());
    Surfaces s;
    s.objectId = graph_.plane<ObjectId>("object id", graph::counts);
    f.pixels(pass, PassKind::Composite, { file, "joinObjects" },
        { p, reads("objectA", f.surfaces.objectId), reads("objectB", halves_[1].frame->surfaces.objectId),
            writes("object", s.objectId) });
    if (!keepsLayers_) {
        return s;
    }
    s.position = graph_.plane<Position>("position", graph::vectors);
    s.normal = graph_.plane<Normal>("normal", graph::vectors);
    s.pixelSize = graph_.plane<Metres>("pixel size", graph::floats);
    s.depth = graph_.plane<Metres>("depth", graph::floats);
    const auto half = [](const char* name, const DistributedSamples& samples) {
        const Surfaces& own = samples.frame().surfaces;
        const auto of = [name](const char* plane) { return std::string(plane) + name; };
        return graph::together(name,
            { reads(of("hits"), samples.hits()), reads(of("position"), own.position), reads(of("normal"), own.normal),
                reads(of("pixelSize"), own.pixelSize), reads(of("depth"), own.depth) });
    };
    f.pixels(pass, PassKind::Composite, { file, "joinSurfaces" },
        joined({ p }, half("A", *halves_[0].samples), half("B", *halves_[1].samples),
            Arguments { writes("position", s.position), writes("normal", s.normal), writes("pixelSize", s.pixelSize),
                writes("depth", s.depth) }));
    return s;
}

void HalvesFrame::join()
{
    const Surfaces s = joinedSurfaces();
    const std::map<std::string, graph::Version> surfaces { { "objectId", s.objectId }, { "position", s.position },
        { "normal", s.normal }, { "pixelSize", s.pixelSize }, { "depth", s.depth } };
    std::array<Outputs, 2> halves;
    for (std::size_t i = 0; i < halves.size(); ++i) {
        halves_[i].samples->show(halves[i]);
    }
    for (std::size_t i = 0; i < halves[0].all().size(); ++i) {
        Output output = halves[0].all()[i];
        const graph::Version &one = output.version, &other = halves[1].all()[i].version;
        switch (output.join) {
        case Join::First:
            break;
        case Join::Mean:
            output.version = mean(one, other);
            break;
        case Join::Sum:
            output.version = sum(one, other);
            break;
        case Join::SumOfTraced:
            output.version = sumOfTraced(one, other);
            break;
        case Join::Surface:
            output.version = surfaces.at(output.layer);
            break;
        }
        outputs_.add(std::move(output));
    }
    if (keepsLayers_) {
        showWidths(*halves_[0].frame, *halves_[0].samples, s.pixelSize);
    }
    finish(*halves_[0].frame);
}

void HalvesFrame::estimateError(bool analysed)
{
    FrameBuilder& f = *halves_[0].frame;
    noise_ = graph_.plane<Squares>("noise", graph::floats);
    bias_ = graph_.plane<Squares>("bias", graph::floats);
    // What filters of samples and of terms take away is not in the image, and no noise.
    const bool kept = sampleFilterOf(settings_).filter != nullptr || hasStage(settings_.filters, Stage::Terms);
    const auto filtered = [analysed, kept, state = halves_[0].samples->state()](const graph::Launch&) -> std::uint32_t {
        return kept || (analysed && state->analysed) ? 1 : 0;
    };
    std::vector<graph::Argument> arguments { f.rectangle(halves_[0].samples->params()), made("filtered", filtered) };
    arguments.push_back(reads("beautyA", halves_[0].frame->totals.beauty));
    arguments.push_back(reads("plainA", halves_[0].samples->plainImage()));
    arguments.push_back(reads("beautyB", halves_[1].frame->totals.beauty));
    arguments.push_back(reads("plainB", halves_[1].samples->plainImage()));
    arguments.push_back(writes("noise", noise_));
    arguments.push_back(writes("bias", bias_));
    f.pixels(pass, PassKind::Composite, { file, "errorOfHalves" }, arguments);
    graph_.want(noise_, outputWindow(settings_));
    graph_.want(bias_, outputWindow(settings_));
}

ErrorEstimate HalvesFrame::error(const graph::Execution& execution, device::TimedQueue& queue) const
{
    if (!halves_[0].samples->state()->complete || !halves_[1].samples->state()->complete) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        return { unknown, unknown };
    }
    const std::vector<float> noise = execution.output<float>(noise_).downloadAll(queue);
    const std::vector<float> bias = execution.output<float>(bias_).downloadAll(queue);
    const Window window = outputWindow(settings_);
    ErrorEstimate sum { 0, 0 };
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const std::size_t i = layout_.index(x, y);
            sum.noise += noise[i];
            sum.bias += bias[i];
        }
    }
    const double pixels = static_cast<double>(window.width()) * window.height();
    return { sum.noise / pixels, sum.bias / pixels };
}

} // namespace wedge::render
