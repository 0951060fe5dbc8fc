// A scene on a device with its G-buffer, for tests of the kernels that trace rays.
#pragma once

#include "bvh/host_traverse.h"
#include "host/graph/interface.h"
#include "host/render/device_scene.h"
#include "host/render/sinks.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"
#include "tests/render_support.h"

#include <string>
#include <tuple>
#include <vector>

namespace wedge::test {

/// What kernels take for WEDGE_SURFACE_PARAMETERS.
inline auto surfaceArguments(const render::DeviceScene& s)
{
    return std::tie(s.positions, s.normals, s.texcoords, s.indices, s.materialIds, s.materials, s.textures, s.texels,
        s.srgbToLinear, s.positionsAtClose, s.normalsAtClose);
}

/// What primary.cl fills in, and the counters of rays, all 0.
struct SurfaceBuffers {
    SurfaceBuffers(KernelBench& bench, const render::PlaneLayout& layout)
        : position(floats(bench, layout, 3))
        , normal(floats(bench, layout, 3))
        , origin(floats(bench, layout, 3))
        , depth(floats(bench, layout, 1))
        , pixelSize(floats(bench, layout, 1))
        , diffuse(floats(bench, layout, 3))
        , specular(floats(bench, layout, 3))
        , emission(floats(bench, layout, 3))
        , geometric(counts(bench, layout))
        , objectId(counts(bench, layout))
        , gloss(counts(bench, layout))
        , rays(counts(bench, layout))
        , pathRays(counts(bench, layout))
    {
    }
    /// What kernels take for WEDGE_RECEIVER_ARGUMENTS, the pixels being the receivers.
    auto receivers() const { return std::tie(position, normal, origin, geometric, objectId, gloss); }

    device::Buffer<float> position, normal, origin, depth, pixelSize, diffuse, specular, emission;
    device::Buffer<std::uint32_t> geometric, objectId, gloss, rays, pathRays;

private:
    static device::Buffer<float> floats(KernelBench& bench, const render::PlaneLayout& layout, std::size_t planes)
    {
        return bench.filled(planes * layout.size, 0.0f);
    }
    static device::Buffer<std::uint32_t> counts(KernelBench& bench, const render::PlaneLayout& layout)
    {
        return bench.filled(layout.size, 0u);
    }
};

/// The program of a kernel whose samples go to these sinks, which are handed values, and planes of floats of these
/// names. All else it is handed is what frames hand it.
inline device::ProgramSource withSinks(const device::Device& device, const std::string& file, const std::string& kernel,
    const std::vector<graph::Sink>& sinks, const std::vector<std::string>& planes,
    const std::vector<graph::Argument>& values = {})
{
    graph::Graph graph(1, 1, 1);
    graph::Pass pass { .name = "samples", .kernel = { file, kernel, sinks }, .arguments = values };
    for (const std::string& name : planes) {
        auto plane = graph.plane<render::Sums>(name, graph::floats);
        pass.arguments.push_back(graph::updates(name, plane));
    }
    const std::string name = "pass/" + kernel + ".h", text = graph::sinkText(graph, pass);
    device::ProgramSource out = productProgram(device, file, kernel);
    std::string& all = out.generated.at(name);
    const auto parametersOf = [](const std::string& of) {
        const std::string macro = "#define WEDGE_SINK_PARAMETERS ";
        REQUIRE(of.find(macro) != std::string::npos);
        const auto from = of.find(macro) + macro.size();
        return of.substr(from, of.find('\n', from) - from);
    };
    const std::string before = parametersOf(all);
    const auto list = all.find(before); // at the end of PARAMETERS
    REQUIRE(list != std::string::npos);
    all.replace(list, before.size(), parametersOf(text));
    all = all.substr(0, all.find('\n', list) + 1) + text;
    for (const graph::Sink& sink : sinks) {
        out.defines.insert(out.defines.end(), sink.defines.begin(), sink.defines.end());
    }
    return out;
}

/// One scene's buffers, and the tracing kernels over them as the renderer launches them.
class TracedScene {
public:
    TracedScene(
        const scene::Scene& sceneData, const device::Device& device, int width, int height, const Defines& defines = {})
        : scene(sceneData)
        , bench(device, defines)
        , tree(bvh::build({ scene.geometry.positions, scene.geometry.indices }), familyOf(defines))
        , hierarchy(tree.bvh)
        , onDevice(scene, tree, device, bench.queue)
        , layout(width, height)
        , frame(bench, layout)
        , params(render::frameParams(scene, layout, { 0, 0, width, height }, 5))
        , specular(isDefined(defines, "WEDGE_SPECULAR"))
        , sums(device, layout.size * (specular ? 4 : 2), "sums")
        , value(device, layout.size * (specular ? 2 : 1), "value")
        , parts(device, layout.size, "parts")
        , slopes(device, layout.size * 2, "slopes")
        , taken(device, layout.size, "taken")
        , wanted(device, layout.size, "wanted")
        , firstWanted(device, layout.size, "wanted of a first pass")
    {
        for (device::Buffer<float>* b : { &sums, &value, &parts, &slopes })
            b->fill(bench.queue, 0.0f);
        taken.fill(bench.queue, 0u);
        wanted.fill(bench.queue, 0u);
    }

    void primary()
    {
        bench.passes.tiles("primary", device::PassKind::Trace, "frame/primary.cl", "primary", params, 1.0,
            onDevice.nodes, onDevice.blocks, surfaceArguments(onDevice), onDevice.objectIds, onDevice.areaLights,
            static_cast<std::uint32_t>(onDevice.areaLightList.size()), onDevice.environment, onDevice.environmentTable,
            frame.position, frame.normal, frame.origin, frame.geometric, frame.objectId, frame.depth, frame.pixelSize,
            frame.diffuse, frame.specular, frame.emission, frame.gloss);
    }
    /// p.firstPass samples of each pixel, the first of their light.
    void firstPass(const shared::SampleParams& p)
    {
        taken.fill(bench.queue, 0u);
        for (device::Buffer<float>* b : { &sums, &slopes })
            b->fill(bench.queue, 0.0f);
        firstWanted.fill(bench.queue, p.firstPass);
        using namespace render;
        const device::ProgramSource program = withSinks(bench.device, "light/area_light.cl", "sampleShadows",
            { sinks::sums(), sinks::means(), sinks::parts(), sinks::slopes() }, { "sums", "value", "parts", "slopes" });
        bench.passes.tiles("first", device::PassKind::Trace, program, "sampleShadows", params, 1.0, p,
            onDevice.areaLightList[p.light], onDevice.nodes, onDevice.blocks, frame.receivers(), firstWanted,
            p.firstPass, taken, frame.rays, sums, value, parts, slopes);
    }
    void secondPass(const shared::SampleParams& p, std::uint32_t last)
    {
        namespace sinks = render::sinks;
        const device::ProgramSource program = withSinks(bench.device, "light/area_light.cl", "sampleShadows",
            { sinks::sums(), sinks::means(), sinks::parts() }, { "sums", "value", "parts" });
        bench.passes.tiles("second", device::PassKind::Trace, bench.passes.find(program, "sampleShadows"), params, 1.0,
            p, onDevice.areaLightList[p.light], onDevice.nodes, onDevice.blocks, frame.receivers(), wanted, last, taken,
            frame.rays, sums, value, parts);
    }
    template <class T>
    Planes<T> read(const device::Buffer<T>& buffer)
    {
        return planesOf(layout, bench.read(buffer));
    }

    /// The ray through the pixel's centre.
    bvh::Ray cameraRay(int x, int y) const
    {
        const shared::Vec3 d =
            shared::cameraDirection(params.forward, params.right, params.down, static_cast<float>(params.width),
                static_cast<float>(params.height), static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        return { params.eye, 0.0f, d, std::numeric_limits<float>::infinity() };
    }

    template <class Visit>
    void everyPixel(const Visit& visit) const
    {
        for (int y = 0; y < static_cast<int>(layout.height); ++y)
            for (int x = 0; x < static_cast<int>(layout.width); ++x)
                visit(x, y);
    }

    const render::PreparedScene scene;
    KernelBench bench;
    render::Hierarchy tree;
    const bvh::Bvh& hierarchy;
    render::DeviceScene onDevice;
    render::PlaneLayout layout;
    SurfaceBuffers frame;
    shared::FrameParams params;
    bool specular;
    device::Buffer<float> sums, value, parts, slopes; ///< parts: two numbers of 16 bits
    device::Buffer<std::uint32_t> taken, wanted, firstWanted;
};

} // namespace wedge::test
