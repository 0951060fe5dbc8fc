#include "host/render/seen_lights.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::value;
using graph::writes;

namespace {

constexpr int mostApproximated = 64; ///< samples a pixel of frames for which shares of pixels known to 1e-3 will do

} // namespace

std::optional<graph::Handle<Radiance>> seenLights(FrameBuilder& frame, const shared::CameraParams& camera)
{
    const scene::Scene& scene = frame.description;
    const bool centre = camera.pixelFilter == WEDGE_PIXEL_CENTRE;
    const bool plain = centre ? camera.apertureRadius > 0 : camera.pixelFilter == WEDGE_PIXEL_BOX;
    if (!plain || scene::cameraMoves(scene)
        || !std::ranges::any_of(scene.areaLights, [](const auto& l) { return l.visible; })) {
        return {};
    }
    // What is known to 1e-3 alone would be most of the error of many samples.
    const bool approximate = !frame.settings.progressive && frame.settings.spp <= mostApproximated;
    const std::size_t count = scene.areaLights.size();
    const graph::Argument lights = frame.ofScene("lights", "AreaLight", &DeviceScene::areaLights);
    auto windows = frame.graph.list<Pixels>("windows of lights", graph::floatPlanes(6), count);
    auto known = frame.graph.plane<Radiance>("lights through pixels", packedColours);
    frame.items("lights", PassKind::Trace, { "waves/seen_lights.cl", "windowsOfLights" }, count,
        { frame.frame(), value("camera", camera), value("approximate", approximate ? 1u : 0u), lights,
            value("lightCount", static_cast<std::uint32_t>(count)), writes("windows", windows) });
    frame.pixels("lights", PassKind::Trace, { "waves/seen_lights.cl", "seenLights" },
        joined({ frame.frame(), value("camera", camera) }, frame.hierarchy(),
            Arguments { lights, value("lightCount", static_cast<std::uint32_t>(count)), reads("windows", windows),
                writes("known", known) }));
    return known;
}

} // namespace wedge::render
