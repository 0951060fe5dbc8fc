#include "host/render/filters/gaussian.h"

#include <cmath>

#include <glm/glm.hpp>

namespace wedge::render {

shared::FilterParams filterParams(const Settings& settings, const shared::FrameParams& frame,
    const shared::AreaLight& light, const image::Window& window)
{
    shared::FilterParams p {};
    p.eye = frame.eye;
    p.forward = frame.forward;
    p.right = frame.right;
    p.down = frame.down;
    p.lightCentre = light.centre;
    p.lightNormal = light.normal;
    p.normalCosine = std::cos(glm::radians(settings.normalDegrees));
    p.cut = settings.cut;
    p.oblique = settings.oblique ? 1 : 0;
    p.narrower = settings.narrower ? 1 : 0;
    p.maxRadius = static_cast<std::uint32_t>(settings.maxRadius);
    p.width = frame.width;
    p.height = frame.height;
    p.stride = frame.stride;
    p.planeSize = frame.planeSize;
    setRectangle(p, window);
    return p;
}

void gaussianFilter(Passes& passes, std::string_view pass, device::PassKind kind, const Settings& settings,
    const shared::FrameParams& frameParams, const shared::AreaLight& light, const image::Window& window,
    const Frame& frame, Term& term)
{
    const int width = static_cast<int>(frame.layout.width);
    const int height = static_cast<int>(frame.layout.height);
    // The columns' taps reach rows above and below the window, which the rows pass has to have done.
    const image::Window columns = blockWindow(window, 0, width, height);
    const image::Window rows { columns.x0, std::max(0, window.y0 - settings.maxRadius), columns.x1,
        std::min(height, window.y1 + settings.maxRadius) };
    passes.rows(pass, kind, "filter.cl", "filterRows", filterParams(settings, frameParams, light, rows),
        WEDGE_BLOCK_PIXELS, term.value, term.beta, frame.position, frame.normal, frame.objectId, term.rowsFiltered,
        term.rowsEffective);
    passes.rows(pass, kind, "filter.cl", "filterColumns", filterParams(settings, frameParams, light, columns),
        WEDGE_BLOCK_PIXELS, term.rowsFiltered, term.beta, frame.position, frame.normal, frame.objectId,
        term.rowsEffective, term.filtered, term.effective);
}

} // namespace wedge::render
