#include "host/render/frame.h"

#include "kernels/shared/filter_params.h"
#include "kernels/shared/path.h"

#include <cmath>
#include <numeric>

namespace wedge::render {
namespace {

std::uint64_t strideFor(std::uint64_t width)
{
    const std::uint64_t blocks = (width + WEDGE_BLOCK_PIXELS - 1) / WEDGE_BLOCK_PIXELS;
    return blocks * WEDGE_BLOCK_PIXELS + WEDGE_ROW_PADDING;
}

/// A step near the golden section of count and coprime to it, so that consecutive groups take distant tiles.
std::uint32_t tileStep(std::uint32_t count)
{
    std::uint32_t step = std::max(1u, static_cast<std::uint32_t>(0.618034 * count));
    while (std::gcd(step, count) != 1) {
        ++step;
    }
    return step;
}

constexpr std::uint64_t spreadPlanes = 4;

struct PlannedPlanes {
    const char* name;
    std::uint64_t planes;
};

void planPlanes(device::MemoryPlan& plan, const PlaneLayout& layout, std::initializer_list<PlannedPlanes> buffers)
{
    for (const PlannedPlanes& buffer : buffers) {
        plan.addItems(buffer.name, layout.size, 4 * buffer.planes);
    }
}

shared::Vec3 toVec3(glm::vec3 v) { return shared::vec3(v.x, v.y, v.z); }

} // namespace

PlaneLayout::PlaneLayout(int imageWidth, int imageHeight)
    : width(static_cast<std::uint32_t>(imageWidth))
    , height(static_cast<std::uint32_t>(imageHeight))
    , stride(static_cast<std::uint32_t>(strideFor(width)))
    , size(static_cast<std::uint64_t>(stride) * height + 2 * WEDGE_ROW_PADDING)
{
}

void Frame::plan(device::MemoryPlan& plan, const PlaneLayout& layout, bool distributed)
{
    planPlanes(plan, layout,
        { { "position", 3 }, { "normal", 3 }, { "origin", 3 }, { "depth", 1 }, { "pixel size", 1 }, { "diffuse", 3 },
            { "specular", 3 }, { "emission", 3 }, { "gloss", 1 }, { "geometric normal", 1 }, { "object id", 1 },
            { "rays", 1 }, { "path rays", 1 }, { "direct", 3 }, { "direct noisy", 3 }, { "indirect", 3 },
            { "indirect noisy", 3 }, { "beauty", 3 }, { "samples", 1 }, { "indirect samples", 1 } });
    if (distributed) {
        planPlanes(plan, layout,
            { { "primary samples taken", 1 }, { "primary samples wanted", 1 }, { "hits", 1 }, { "circles of confusion", 2 },
                { "motion", 3 }, { "blur", 4 }, { "primary demand", 1 }, { "point lights", 3 }, { "emission squares", 1 } });
    }
}

Frame::Frame(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& planes, bool several)
    : layout(planes)
    , distributed(several)
    , position(device, 3 * planes.size, "position")
    , normal(device, 3 * planes.size, "normal")
    , origin(device, 3 * planes.size, "origin")
    , depth(device, planes.size, "depth")
    , pixelSize(device, planes.size, "pixel size")
    , diffuse(device, 3 * planes.size, "diffuse")
    , specular(device, 3 * planes.size, "specular")
    , emission(device, 3 * planes.size, "emission")
    , gloss(device, planes.size, "gloss")
    , geometric(device, planes.size, "geometric normal")
    , objectId(device, planes.size, "object id")
    , rays(device, planes.size, "rays")
    , pathRays(device, planes.size, "path rays")
    , direct(device, 3 * planes.size, "direct")
    , directNoisy(device, 3 * planes.size, "direct noisy")
    , indirect(device, 3 * planes.size, "indirect")
    , indirectNoisy(device, 3 * planes.size, "indirect noisy")
    , beauty(device, 3 * planes.size, "beauty")
    , samples(device, planes.size, "samples")
    , indirectSamples(device, planes.size, "indirect samples")
    , receiverPixels(device, 0, "pixels of receivers")
    , receiverViews(device, 0, "views of receivers")
    , receiverTimes(device, 0, "times of receivers")
    , primaryTaken(device, several ? planes.size : 0, "primary samples taken")
    , primaryWanted(device, several ? planes.size : 0, "primary samples wanted")
    , hits(device, several ? planes.size : 0, "hits")
    , confusion(device, several ? 2 * planes.size : 0, "circles of confusion")
    , motion(device, several ? 3 * planes.size : 0, "motion")
    , lensWidth(device, several ? planes.size : 0, "lens filter width")
    , motionWidth(device, several ? planes.size : 0, "motion filter width")
    , motionDirection(device, several ? 2 * planes.size : 0, "motion direction")
    , primaryDemand(device, several ? planes.size : 0, "primary demand")
    , delta(device, several ? 3 * planes.size : 0, "point lights")
    , emissionSquares(device, several ? planes.size : 0, "emission squares")
{
    // Padding is read by gathers: it has to be finite, and objectId 0 there stays for good.
    for (device::Buffer<float>* b : { &position, &normal, &origin, &depth, &pixelSize, &diffuse, &specular, &emission, &gloss }) {
        b->fill(queue, 0.0f);
    }
    objectId.fill(queue, 0u);
    geometric.fill(queue, 0u);
    clear(queue);
}

void Frame::clear(device::TimedQueue& queue)
{
    direct.fill(queue, 0.0f);
    directNoisy.fill(queue, 0.0f);
    indirect.fill(queue, 0.0f);
    indirectNoisy.fill(queue, 0.0f);
    samples.fill(queue, 0u);
    indirectSamples.fill(queue, 0u);
    rays.fill(queue, 0u);
    pathRays.fill(queue, 0u);
    if (!distributed) {
        return;
    }
    for (device::Buffer<float>* b : { &position, &normal, &pixelSize, &depth, &diffuse, &specular, &emission, &gloss, &confusion, &motion, &lensWidth, &motionWidth, &delta, &emissionSquares }) {
        b->fill(queue, 0.0f);
    }
    for (device::Buffer<std::uint32_t>* b : { &objectId, &primaryTaken, &primaryWanted, &hits }) {
        b->fill(queue, 0u);
    }
}

bool TermShape::holds(const TermShape& other) const
{
    return sums >= other.sums && values >= other.values && extremes >= other.extremes && analysed >= other.analysed
        && distributed >= other.distributed && published >= other.published;
}

TermShape TermShape::with(const TermShape& other) const
{
    return { std::max(sums, other.sums), std::max(values, other.values), std::max(extremes, other.extremes),
        analysed || other.analysed, distributed || other.distributed, published || other.published };
}

void Term::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& shape)
{
    planPlanes(plan, layout,
        { { "sums", shape.sums }, { "value", shape.values }, { "samples taken", 1 }, { "samples wanted", 1 },
            { "slopes and distances", shape.extremes }, { "filter width", shape.analysed ? 1u : 0u } });
    if (shape.distributed) {
        planPlanes(plan, layout, { { "texture", 3 }, { "plain mean", 1 }, { "squares", 1 }, { "texture squares", 1 }, { "demand", 1 },
                { "radiance", shape.published ? 3u : 0u } });
    }
}

Term::Term(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, const TermShape& planes)
    : shape(planes)
    , sums(device, layout.size * planes.sums, "sums")
    , value(device, layout.size * planes.values, "value")
    , taken(device, layout.size, "samples taken")
    , wanted(device, layout.size, "samples wanted")
    , extremes(device, layout.size * planes.extremes, "slopes and distances")
    , beta(device, planes.analysed ? layout.size : 0, "filter width")
    , texture(device, planes.distributed ? 3 * layout.size : 0, "texture")
    , plain(device, planes.distributed ? layout.size : 0, "plain mean")
    , squares(device, planes.distributed ? layout.size : 0, "squares")
    , textureSquares(device, planes.distributed ? layout.size : 0, "texture squares")
    , demand(device, planes.distributed ? layout.size : 0, "demand")
    , radiance(device, planes.published ? 3 * layout.size : 0, "radiance of the term")
{
    beta.fill(queue, 0.0f);
    wanted.fill(queue, 0u);
    clear(queue);
}

void Scratch::plan(device::MemoryPlan& plan, const PlaneLayout& layout, std::uint32_t values)
{
    planPlanes(plan, layout,
        { { "rows filtered", values }, { "filtered", values }, { "effective count of rows", 1 }, { "effective count", 1 },
            { "logarithms", spreadPlanes }, { "logarithms spread along rows", spreadPlanes },
            { "logarithms spread", spreadPlanes }, { "demand", 1 } });
}

Scratch::Scratch(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, std::uint32_t planes)
    : values(planes)
    , rowsFiltered(device, planes * layout.size, "rows filtered")
    , filtered(device, planes * layout.size, "filtered")
    , rowsEffective(device, layout.size, "effective count of rows")
    , effective(device, layout.size, "effective count")
    , logs(device, spreadPlanes * layout.size, "logarithms")
    , rowsSpread(device, spreadPlanes * layout.size, "logarithms spread along rows")
    , spread(device, spreadPlanes * layout.size, "logarithms spread")
    , demand(device, layout.size, "demand")
    , bounds(device, 6 * WEDGE_EXTENT_STRIPES, "visible bounds")
    , extent(device, 1, "visible extent")
    , histogramCounts(device, WEDGE_DEMAND_STRIPES * WEDGE_DEMAND_BINS, "demand histogram")
    , histogramPixels(device, WEDGE_DEMAND_STRIPES, "shaded pixels")
    , binCounts(device, WEDGE_DEMAND_BINS, "demand bins")
    , histogramSums(device, WEDGE_DEMAND_STRIPES * WEDGE_DEMAND_BINS, "demand sums")
    , binSums(device, WEDGE_DEMAND_BINS, "demand bin sums")
    , countScale(device, 1, "count scale")
{
    for (device::Buffer<float>* b : { &rowsFiltered, &filtered, &rowsEffective, &effective, &logs, &rowsSpread, &spread, &demand }) {
        b->fill(queue, 0.0f);
    }
}

void Term::clear(device::TimedQueue& queue)
{
    sums.fill(queue, 0.0f);
    value.fill(queue, 0.0f);
    extremes.fill(queue, 0.0f);
    taken.fill(queue, 0u);
    if (shape.distributed) {
        texture.fill(queue, 0.0f);
        plain.fill(queue, 0.0f);
        squares.fill(queue, 0.0f);
        textureSquares.fill(queue, 0.0f);
        radiance.fill(queue, 0.0f);
    }
}

namespace {

struct Axes {
    glm::vec3 eye, forward, right, down; ///< as in FrameParams
};

/// height: of the image in pixels.
Axes axesOf(const scene::Camera& camera, std::uint32_t height)
{
    const glm::vec3 forward = glm::normalize(camera.lookAt - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::vec3 down = -glm::cross(right, forward);
    // Pixels are square: the vertical field of view sets the step in both directions.
    const float step = 2.0f * std::tan(0.5f * glm::radians(camera.verticalFov)) / static_cast<float>(height);
    return { camera.eye, forward, right * step, down * step };
}

} // namespace

shared::FrameParams frameParams(const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed)
{
    const Axes axes = axesOf(scene::middleCamera(scene), layout.height);
    shared::FrameParams p {};
    p.width = layout.width;
    p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    setRectangle(p, window);
    p.tilesX = (p.x1 - p.x0 + WEDGE_TILE - 1) / WEDGE_TILE;
    p.tileCount = p.tilesX * ((p.y1 - p.y0 + WEDGE_TILE - 1) / WEDGE_TILE);
    p.tileStep = tileStep(p.tileCount);
    p.seed = seed;
    p.eye = toVec3(axes.eye);
    p.forward = toVec3(axes.forward);
    p.right = toVec3(axes.right);
    p.down = toVec3(axes.down);
    p.background = toVec3(scene.background);
    return p;
}

shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, bool antialias)
{
    const scene::Camera& camera = scene.camera;
    const Axes open = axesOf(camera, height);
    const Axes close = axesOf(scene.cameraAtClose.value_or(camera), height);
    shared::CameraParams p {};
    p.eye = toVec3(open.eye);
    p.forward = toVec3(open.forward);
    p.right = toVec3(open.right);
    p.down = toVec3(open.down);
    p.eyeMotion = toVec3(close.eye - open.eye);
    p.forwardMotion = toVec3(close.forward - open.forward);
    p.rightMotion = toVec3(close.right - open.right);
    p.downMotion = toVec3(close.down - open.down);
    p.apertureRadius = camera.apertureRadius;
    p.focusDistance = scene::distanceInFocus(camera);
    p.gaussianAperture = camera.apertureProfile == scene::ApertureProfile::Gaussian ? 1 : 0;
    p.gaussianShutter = scene.shutterProfile == scene::ShutterProfile::Gaussian ? 1 : 0;
    p.pixelFilter = antialias ? 1.0f : 0.0f;
    p.erfCut = std::erf(WEDGE_APERTURE_CUT / std::sqrt(2.0f));
    p.shutter = scene::geometryMoves(scene) || scene::cameraMoves(scene) ? 1 : 0;
    p.pixelStep = glm::length(open.right);
    return p;
}

} // namespace wedge::render
