#include "host/render/seen_lights.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::value;
using graph::writes;

std::optional<graph::Handle<Radiance>> seenLights(FrameBuilder& frame, const shared::CameraParams& camera)
{
    const scene::Scene& scene = frame.description;
    if (scene::cameraMoves(scene) || (camera.pixelFilter == WEDGE_PIXEL_CENTRE && camera.apertureRadius <= 0)
        || !std::ranges::any_of(scene.areaLights, [](const auto& l) { return l.visible; })) {
        return {};
    }
    const std::size_t count = scene.areaLights.size();
    const graph::Argument lights = frame.ofScene("lights", "AreaLight", &DeviceScene::areaLights);
    auto windows = frame.graph.list<Pixels>("windows of lights", graph::floatPlanes(6), count);
    auto known = frame.graph.plane<Radiance>("lights through pixels", packedColours);
    frame.items("lights", PassKind::Trace, { "waves/seen_lights.cl", "windowsOfLights" }, count,
        { frame.frame(), value("camera", camera), lights, value("lightCount", static_cast<std::uint32_t>(count)),
            writes("windows", windows) });
    frame.pixels("lights", PassKind::Trace, { "waves/seen_lights.cl", "seenLights" },
        joined({ frame.frame(), value("camera", camera) }, frame.hierarchy(),
            Arguments { lights, value("lightCount", static_cast<std::uint32_t>(count)), reads("windows", windows),
                writes("known", known) }));
    return known;
}

} // namespace wedge::render
