#include "benchmarks/frame_memory/frame_bytes.h"

#include "host/render/device_scene.h"
#include "host/render/hierarchy.h"
#include "host/render/renderer.h"

namespace wedge::benchmark {

std::uint64_t frameBytes(
    const scene::Scene& described, const device::DeviceInfo& device, const render::Settings& settings, bool keepLayers)
{
    const render::PreparedScene scene(described);
    const render::Options options;
    const render::Hierarchy hierarchy =
        render::buildHierarchy(scene, options.bvh, render::resolveTraversal(options.traversal, device));
    device::MemoryPlan ofScene;
    render::DeviceScene::plan(ofScene, scene, hierarchy);
    return render::Renderer::plan(scene, hierarchy, settings, keepLayers, graph::slabRulesOf(device)).total()
        - ofScene.total();
}

} // namespace wedge::benchmark
