#include "host/render/filters/gaussian.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/glm.hpp>

namespace wedge::render {
namespace {

constexpr std::uint32_t allPlanes = std::numeric_limits<std::uint32_t>::max();

} // namespace

shared::FilterParams filterParams(
    const Settings& settings, const shared::FrameParams& frame, const image::Window& window)
{
    shared::FilterParams p {};
    p.eye = frame.eye;
    p.forward = frame.forward;
    p.right = frame.right;
    p.down = frame.down;
    p.normalCosine = std::cos(glm::radians(settings.normalDegrees));
    p.cut = settings.cut;
    p.narrower = settings.narrower ? 1 : 0;
    p.surface = settings.surface ? 1 : 0;
    p.fitted = settings.fitted && settings.filtering == Filtering::Adaptive ? allPlanes : 0;
    p.most = std::numeric_limits<float>::infinity();
    p.maxRadius = static_cast<std::uint32_t>(settings.maxRadius);
    p.width = frame.width;
    p.height = frame.height;
    p.stride = frame.stride;
    p.planeSize = frame.planeSize;
    setRectangle(p, window);
    return p;
}

shared::FilterParams filterParams(const Settings& settings, const shared::FrameParams& frame,
    const shared::AreaLight& light, const image::Window& window)
{
    shared::FilterParams p = filterParams(settings, frame, window);
    p.lightCentre = light.centre;
    p.lightNormal = light.normal;
    p.oblique = settings.oblique ? 1 : 0;
    if (settings.shading != Shading::Inside) {
        p.most = 1.0f; // of visibilities
    }
    return p;
}

shared::FilterParams publishedParams(
    const Settings& settings, const shared::FrameParams& frame, const image::Window& window)
{
    shared::FilterParams p = filterParams(settings, frame, window);
    p.narrower = 1;
    return p;
}

} // namespace wedge::render
