#include "host/render/filters/gaussian.h"

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace wedge::render {

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
    return p;
}

shared::FilterParams publishedParams(
    const Settings& settings, const shared::FrameParams& frame, const image::Window& window)
{
    shared::FilterParams p = filterParams(settings, frame, window);
    p.narrower = 1;
    return p;
}

void gaussianFilter(Passes& passes, const FilterRun& run, shared::FilterParams params, const image::Window& window,
    const Frame& frame, const device::Buffer<float>& value, const device::Buffer<float>& beta, Scratch& scratch,
    device::Buffer<float>& filtered)
{
    const int width = static_cast<int>(frame.layout.width);
    const int height = static_cast<int>(frame.layout.height);
    const int reach = static_cast<int>(params.maxRadius);
    // The columns' taps reach rows above and below the window, which the rows pass has to have done.
    const image::Window columns = blockWindow(window, 0, width, height);
    const image::Window rows { columns.x0, std::max(0, window.y0 - reach), columns.x1,
        std::min(height, window.y1 + reach) };
    const std::string program = (frame.shape.packed() ? "packed_" : "") + run.program;
    setRectangle(params, rows);
    passes.rows(run.pass, run.kind, program, "filterRows", params, WEDGE_BLOCK_PIXELS, value, beta, frame.position,
        frame.normal, frame.objectId, scratch.rowsFiltered, scratch.rowsEffective);
    setRectangle(params, columns);
    passes.rows(run.pass, run.kind, program, "filterColumns", params, WEDGE_BLOCK_PIXELS, scratch.rowsFiltered, beta,
        frame.position, frame.normal, frame.objectId, scratch.rowsEffective, filtered, scratch.effective);
}

} // namespace wedge::render
