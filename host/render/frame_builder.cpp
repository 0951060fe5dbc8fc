#include "host/render/frame_builder.h"

#include "host/graph/execution.h"
#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

using device::PassKind;
using graph::Launch;
using graph::reads;
using graph::Run;

shared::FrameParams FrameBuilder::wholeFrame() const
{
    return frameParams(description, layout, graph.image(), frameSeed(settings));
}

Window FrameBuilder::output() const
{
    const Window w = outputWindow(settings);
    const int margin = static_cast<int>(layout.margin);
    return { w.x0 + margin, w.y0 + margin, w.x1 + margin, w.y1 + margin };
}

shared::AnalysisParams FrameBuilder::analysisParams() const
{
    shared::AnalysisParams p {};
    p.width = layout.width;
    p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    return p;
}

graph::Argument FrameBuilder::frame(const RowsOf& rows) const
{
    return graph::made(
        "frame", [&scene = description, layout = layout, seed = frameSeed(settings), rows](const Launch& launch) {
            return frameParams(scene, layout, rows ? rows(launch) : launch.window, seed);
        });
}

graph::Argument FrameBuilder::outside(std::string name, std::string_view type, const cl::Buffer* memory) const
{
    return graph::outside(std::move(name), type, memory != nullptr ? *memory : cl::Buffer());
}

device::Defines FrameBuilder::surfaceFormats(device::Defines more) const
{
    const auto of = [this](const char* name, const graph::Version& plane) {
        return std::pair(std::string(name), std::string(graph.resources()[plane.resource].format.name));
    };
    more.push_back(of("WEDGE_NORMAL_FORMAT", surfaces.normal));
    more.push_back(of("WEDGE_SIZE_FORMAT", surfaces.pixelSize));
    return more;
}

std::vector<graph::Argument> FrameBuilder::hierarchy() const
{
    return graph::together("hierarchy",
        { ofScene("nodes", "TraversalNode", &DeviceScene::nodes),
            ofScene("blocks", "TriangleBlock", &DeviceScene::blocks) });
}

std::vector<graph::Argument> FrameBuilder::geometry() const
{
    using S = DeviceScene;
    return graph::together("geometry",
        { ofScene("positions", "float", &S::positions), ofScene("normals", "float", &S::normals),
            ofScene("texcoords", "float", &S::texcoords), ofScene("indices", "uint", &S::indices),
            ofScene("materialIds", "uint", &S::materialIds), ofScene("materials", "MaterialData", &S::materials),
            ofScene("textures", "TextureData", &S::textures), ofScene("texels", "uint", &S::texels),
            ofScene("srgbToLinear", "float", &S::srgbToLinear),
            ofScene("positionsAtClose", "float", &S::positionsAtClose),
            ofScene("normalsAtClose", "float", &S::normalsAtClose) });
}

std::vector<graph::Argument> FrameBuilder::beyond() const
{
    return graph::together("beyond",
        { ofScene("environment", "EnvironmentMap", &DeviceScene::environment),
            ofScene("environmentTable", "float", &DeviceScene::environmentTable) });
}

std::vector<graph::Argument> FrameBuilder::met(bool lit) const
{
    const auto lights = static_cast<std::uint32_t>(lit ? description.areaLights.size() : 0);
    return graph::together("met",
        joined(hierarchy(), geometry(),
            Arguments { ofScene("objectIds", "uint", &DeviceScene::objectIds),
                ofScene("lights", "AreaLight", &DeviceScene::areaLights), graph::value("lightCount", lights) },
            beyond()));
}

void FrameBuilder::precomputeDirections()
{
    if (settings.environment.sampling != EnvironmentSampling::Precomputed || description.picture() == nullptr) {
        return;
    }
    constexpr std::uint32_t cells = WEDGE_ENVIRONMENT_CELLS;
    auto samples = graph.list<Directions>(
        "environment samples", graph::floats, std::uint64_t { cells } * cells * WEDGE_ENVIRONMENT_SAMPLE_FLOATS);
    const auto rows = [](const Launch& launch) -> std::uint32_t { return launch.run.rehearsal() ? 0 : cells; };
    items("environment samples", PassKind::Trace, { "light/environment_samples.cl", "precomputeDirections" }, cells,
        joined({ graph::made("rows", rows), graph::value("seed", frameSeed(settings)) }, beyond(),
            Arguments { graph::writes("samples", samples) }));
    environmentSamples = samples;
}

void FrameBuilder::trace(std::string name, graph::KernelName kernel, std::vector<graph::Argument> arguments,
    bool everywhere, const std::function<double(const Launch&)>& workUnits, const RowsOf& rows)
{
    const auto tiles = [&scene = description, layout = layout, rows](const Launch& launch) -> std::size_t {
        return frameParams(scene, layout, rows ? rows(launch) : launch.window, 0).tileCount;
    };
    graph.add({ .name = std::move(name),
        .kind = PassKind::Trace,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Tiles,
        .count = tiles,
        .itemsOfTile = WEDGE_TILE_PIXELS / packetSize,
        .workUnits = workUnits,
        .everywhere = everywhere,
        .stoppable = true });
}

void FrameBuilder::blocks(std::string_view name, PassKind kind, graph::KernelName kernel,
    std::vector<graph::Argument> arguments, const std::function<bool(const Run&)>& condition)
{
    graph.add({ .name = std::string(name),
        .kind = kind,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .condition = condition });
}

void FrameBuilder::pixels(std::string_view name, PassKind kind, graph::KernelName kernel,
    std::vector<graph::Argument> arguments, const std::function<bool(const Run&)>& condition)
{
    graph.add({ .name = std::string(name),
        .kind = kind,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Pixels,
        .condition = condition });
}

void FrameBuilder::items(std::string_view name, PassKind kind, graph::KernelName kernel, std::size_t count,
    std::vector<graph::Argument> arguments, bool ofShown)
{
    graph.add({ .name = std::string(name),
        .kind = kind,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Items,
        .count = [count](const Launch&) { return count; },
        .mostItems = count,
        .mostOfGroup = 1, // each item has much to do
        .ofShown = ofShown });
}

void FrameBuilder::count(const graph::Version& counted, bool everywhere, graph::Handle<Tally>& tally,
    graph::Handle<Count>* plane, const std::optional<graph::Version>& mask)
{
    shared::AnalysisParams p = analysisParams();
    setRectangle(p, everywhere ? graph.image() : output());
    items("composite", PassKind::Composite, { "frame/tally.cl", "addToTally" }, WEDGE_TALLY_STRIPES,
        { graph::value("p", p), graph::readsAsIs("counts", counted),
            mask ? graph::readsAsIs("mask", *mask) : graph::absent("mask", graph::counts),
            graph::updates("tally", tally) });
    if (plane != nullptr) {
        auto sum = graph.plane<Count>("counts", graph::counts);
        blocks("composite", PassKind::Composite, { "frame/tally.cl", "addCounts" },
            { rectangle(analysisParams()), graph::readsAsIs("counts", counted), reads("before", *plane),
                graph::writes("sum", sum) });
        *plane = sum;
    }
}

graph::Handle<Radiance> FrameBuilder::sumOfParts(const graph::Argument& p, const char* name,
    const graph::Handle<Radiance>& emission, const graph::Handle<Radiance>& direct,
    const graph::Handle<Radiance>& indirect)
{
    auto sum = graph.plane<Radiance>(name, graph::vectors);
    pixels("composite", PassKind::Composite, { "frame/sums.cl", "addAll" },
        { p, reads("emission", emission), reads("direct", direct), reads("indirect", indirect),
            graph::writes("beauty", sum) });
    return sum;
}

void FrameBuilder::host(std::string name, const std::function<void(Run&)>& step, std::vector<graph::Argument> uses)
{
    graph.add({ .name = std::move(name),
        .arguments = std::move(uses),
        .domain = graph::Domain::Host,
        .step = step,
        .always = true });
}

void FrameBuilder::host(const char* name, graph::Argument use, const std::function<void(Run&)>& step)
{
    const graph::Scale scale = graph.resources()[use.version.resource].scale;
    graph.add({ .name = name,
        .kind = PassKind::Transfer,
        .arguments = { std::move(use) },
        .domain = graph::Domain::Host,
        .scale = scale,
        .step = step,
        .constant = true });
}

} // namespace wedge::render
