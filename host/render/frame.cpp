#include "host/render/frame.h"

#include "kernels/shared/filter_params.h"
#include "kernels/shared/packed.h"
#include "kernels/shared/path.h"
#include "kernels/shared/wave.h"

#include <cmath>
#include <numeric>

namespace wedge::render {
namespace {

std::uint64_t strideFor(std::uint64_t width)
{
    const std::uint64_t blocks = (width + WEDGE_BLOCK_PIXELS - 1) / WEDGE_BLOCK_PIXELS;
    return blocks * WEDGE_BLOCK_PIXELS + WEDGE_ROW_PADDING;
}

std::uint64_t wholeParts(std::uint64_t elements)
{
    constexpr std::uint64_t part = device::partAlignment / sizeof(float);
    return (elements + part - 1) / part * part;
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

/// Elements of the counters of rays: one a pixel, or, where only their sums are of interest, one a pixel of a wave.
std::uint64_t rayCounters(const PlaneLayout& layout, const FrameShape& shape)
{
    return shape.lean ? WEDGE_WAVE_RECEIVERS : layout.size;
}

/// In the place of planes that a frame does not have.
template <class T>
device::Buffer<T> none()
{
    return device::Buffer<T>::over(cl::Buffer(), 0, "nothing");
}

/// Of a pixel of a term.
std::uint64_t deviationBytes(const TermShape& shape)
{
    return shape.deviations() * (shape.packed() ? sizeof(std::uint16_t) : sizeof(float));
}

} // namespace

PlaneLayout::PlaneLayout(int imageWidth, int imageHeight)
    : width(static_cast<std::uint32_t>(imageWidth))
    , height(static_cast<std::uint32_t>(imageHeight))
    , stride(static_cast<std::uint32_t>(strideFor(width)))
    , size(wholeParts(static_cast<std::uint64_t>(stride) * height + 2 * WEDGE_ROW_PADDING))
{
}

void Frame::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const FrameShape& shape)
{
    const std::uint64_t kept = shape.kept(), analysis = shape.ofAnalysis();
    planPlanes(plan, layout,
        { { "position", 3 }, { "normal", shape.normalPlanes() }, { "origin", 3 * kept }, { "depth", kept },
            { "pixel size", analysis }, { "diffuse", 3 * kept }, { "specular", 3 * kept }, { "emission", 3 },
            { "gloss", shape.packed() ? 0 : analysis }, { "geometric normal", kept }, { "object id", 1 },
            { "beauty", 3 * kept }, { "direct", 3 * kept }, { "direct noisy", 3 * kept }, { "indirect", 3 * kept },
            { "indirect noisy", 3 * kept }, { "samples", kept }, { "indirect samples", kept } });
    plan.addItems("rays", rayCounters(layout, shape), 2 * 4);
    if (shape.distributed) {
        planPlanes(plan, layout,
            { { "primary samples taken", 1 }, { "primary samples wanted", shape.packed() ? 0u : 1u }, { "hits", 1 },
                { "circles of confusion", shape.packed() ? 0u : 2u }, { "motion", shape.motionPlanes() },
                { "lens filter width", kept }, { "motion filter", 3 * kept }, { "emission squares", analysis },
                { "primary demand", kept }, { "point lights", 4 * shape.ofDeltaLights() } });
    }
}

Frame::Frame(
    const device::Device& device, device::TimedQueue& queue, const PlaneLayout& planes, const FrameShape& wanted)
    : layout(planes)
    , shape(wanted)
    , distributed(shape.distributed)
    , position(device, 3 * planes.size, "position")
    , normal(device, shape.normalPlanes() * planes.size, "normal")
    , origin(device, shape.kept() * 3 * planes.size, "origin")
    , depth(device, shape.kept() * planes.size, "depth")
    , pixelSize(device, shape.ofAnalysis() * planes.size, "pixel size")
    , diffuse(device, shape.kept() * 3 * planes.size, "diffuse")
    , specular(device, shape.kept() * 3 * planes.size, "specular")
    , emission(device, 3 * planes.size, "emission")
    , gloss(shape.packed() ? pixelSize : device::Buffer<float>(device, shape.ofAnalysis() * planes.size, "gloss"))
    , geometric(device, shape.kept() * planes.size, "geometric normal")
    , objectId(device, planes.size, "object id")
    , rays(device, rayCounters(planes, shape), "rays")
    , pathRays(device, rayCounters(planes, shape), "path rays")
    , beauty(shape.lean ? emission : device::Buffer<float>(device, 3 * planes.size, "beauty"))
    , direct(shape.lean ? emission : device::Buffer<float>(device, 3 * planes.size, "direct"))
    , directNoisy(device, shape.kept() * 3 * planes.size, "direct noisy")
    , indirect(shape.lean ? emission : device::Buffer<float>(device, 3 * planes.size, "indirect"))
    , indirectNoisy(device, shape.kept() * 3 * planes.size, "indirect noisy")
    , directDeviation(none<float>())
    , indirectDeviation(none<float>())
    , samples(device, shape.kept() * planes.size, "samples")
    , indirectSamples(device, shape.kept() * planes.size, "indirect samples")
    , receiverPixels(device, 0, "pixels of receivers")
    , receiverViews(device, 0, "views of receivers")
    , receiverTimes(device, 0, "times of receivers")
    , primaryTaken(device, planes.size, "primary samples taken")
    , hits(device, planes.size, "hits")
    , confusion(shape.packed() ? hits.part<float>(0, planes.size, "circles of confusion")
                               : device::Buffer<float>(device, 2 * planes.size, "circles of confusion"))
    , motion(device, shape.motionPlanes() * planes.size, "motion")
    , lensWidth(shape.lean ? pixelSize : device::Buffer<float>(device, planes.size, "lens filter width"))
    , motionWidth(
          shape.packed() ? motion : device::Buffer<float>(device, shape.kept() * planes.size, "motion filter width"))
    , motionDirection(
          shape.packed() ? motion : device::Buffer<float>(device, shape.kept() * 2 * planes.size, "motion direction"))
    , emissionSquares(device, shape.ofAnalysis() * planes.size, "emission squares")
    , primaryDemand(shape.lean ? emissionSquares : device::Buffer<float>(device, planes.size, "primary demand"))
    , primaryWanted(shape.packed() ? primaryDemand.part<std::uint32_t>(0, planes.size, "primary samples wanted")
                                   : device::Buffer<std::uint32_t>(device, planes.size, "primary samples wanted"))
    , delta(device, shape.ofDeltaLights() * 3 * planes.size, "point lights")
    , deltaSquares(device, shape.ofDeltaLights() * planes.size, "squares of point lights")
{
    // Padding is read by gathers: it has to be finite, and objectId 0 there stays for good.
    for (device::Buffer<float>* b :
        { &position, &normal, &origin, &depth, &pixelSize, &diffuse, &specular, &emission, &gloss }) {
        b->fill(queue, 0.0f);
    }
    objectId.fill(queue, 0u);
    geometric.fill(queue, 0u);
    clear(queue);
}

Frame::Frame(const PlaneLayout& planes)
    : layout(planes)
    , distributed(false)
    , position(none<float>())
    , normal(none<float>())
    , origin(none<float>())
    , depth(none<float>())
    , pixelSize(none<float>())
    , diffuse(none<float>())
    , specular(none<float>())
    , emission(none<float>())
    , gloss(none<float>())
    , geometric(none<std::uint32_t>())
    , objectId(none<std::uint32_t>())
    , rays(none<std::uint32_t>())
    , pathRays(none<std::uint32_t>())
    , beauty(none<float>())
    , direct(none<float>())
    , directNoisy(none<float>())
    , indirect(none<float>())
    , indirectNoisy(none<float>())
    , directDeviation(none<float>())
    , indirectDeviation(none<float>())
    , samples(none<std::uint32_t>())
    , indirectSamples(none<std::uint32_t>())
    , receiverPixels(none<std::uint32_t>())
    , receiverViews(none<std::uint32_t>())
    , receiverTimes(none<float>())
    , primaryTaken(none<std::uint32_t>())
    , hits(none<std::uint32_t>())
    , confusion(none<float>())
    , motion(none<float>())
    , lensWidth(none<float>())
    , motionWidth(none<float>())
    , motionDirection(none<float>())
    , emissionSquares(none<float>())
    , primaryDemand(none<float>())
    , primaryWanted(none<std::uint32_t>())
    , delta(none<float>())
    , deltaSquares(none<float>())
{
}

void Frame::clear(device::TimedQueue& queue)
{
    for (device::Buffer<float>* b : { &direct, &directNoisy, &indirect, &indirectNoisy }) {
        b->fill(queue, 0.0f);
    }
    for (device::Buffer<std::uint32_t>* b : { &samples, &indirectSamples, &rays, &pathRays }) {
        b->fill(queue, 0u);
    }
    for (device::Buffer<float>* b : { &position, &normal, &pixelSize, &depth, &diffuse, &specular, &emission, &gloss,
             &confusion, &motion, &lensWidth, &motionWidth, &delta, &deltaSquares, &emissionSquares }) {
        b->fill(queue, 0.0f);
    }
    for (device::Buffer<std::uint32_t>* b : { &objectId, &primaryTaken, &primaryWanted, &hits }) {
        b->fill(queue, 0u);
    }
}

std::uint32_t TermShape::omits() const
{
    return (extremes < 2 ? WEDGE_OMITS_EXTREMES : 0u) | (deviations() == 0 ? WEDGE_OMITS_DEVIATION : 0u);
}

bool TermShape::holds(const TermShape& other) const
{
    return sums >= other.sums && values >= other.values && extremes >= other.extremes && analysed >= other.analysed
        && distributed >= other.distributed && published >= other.published && lean == other.lean
        && light == other.light;
}

TermShape TermShape::with(const TermShape& other) const
{
    return { std::max(sums, other.sums), std::max(values, other.values), std::max(extremes, other.extremes),
        analysed || other.analysed, distributed || other.distributed, published || other.published, lean || other.lean,
        light || other.light };
}

std::uint64_t TermShape::textureBytes() const
{
    return distributed ? (shared::textureBits(packed(), light) + 7) / 8 : 0;
}

std::uint64_t TermShape::valueBytes() const
{
    return packed() ? (shared::valueBits(1, light) + 7) / 8 : values * sizeof(float);
}

void Term::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& shape)
{
    const std::uint64_t several = shape.distributed ? 1 : 0, kept = shape.lean ? 0 : 1, plain = shape.packed() ? 0 : 1;
    plan.addItems("value", layout.size, shape.valueBytes());
    plan.addItems("texture", layout.size, shape.textureBytes());
    planPlanes(plan, layout,
        {
            { "sums", shape.sums },
            { "samples taken", kept },
            { "slopes and distances", shape.extremes },
            { "plain mean", shape.measured() },
            { "squares", shape.measured() },
            { "texture squares", shape.measured() * plain },
            { "filter width", shape.analysed ? kept : 0 },
            { "demand", several * kept },
            { "samples wanted", plain },
            { "radiance", shape.published ? 3u : 0u },
        });
    plan.addItems("deviation", layout.size, deviationBytes(shape));
}

Term::Term(const device::Device& device, device::TimedQueue& queue, const Frame& frame, const TermShape& planes)
    : shape(planes)
    , sums(device, frame.layout.size * planes.sums, "sums")
    , value(device, frame.layout.size * planes.valueBytes() / sizeof(float), "value")
    , taken(
          planes.lean ? frame.primaryTaken : device::Buffer<std::uint32_t>(device, frame.layout.size, "samples taken"))
    , extremes(device, frame.layout.size * planes.extremes, "slopes and distances")
    , texture(device, frame.layout.size * planes.textureBytes() / sizeof(float), "texture")
    , plain(device, planes.measured() * frame.layout.size, "plain mean")
    , squares(device, planes.measured() * frame.layout.size, "squares")
    , textureSquares(device, planes.packed() ? 0 : planes.measured() * frame.layout.size, "texture squares")
    , beta(planes.lean ? plain : device::Buffer<float>(device, planes.analysed ? frame.layout.size : 0, "filter width"))
    , demand(planes.lean ? squares : device::Buffer<float>(device, frame.layout.size, "demand"))
    , wanted(planes.packed() ? demand.part<std::uint32_t>(0, frame.layout.size, "samples wanted")
                             : device::Buffer<std::uint32_t>(device, frame.layout.size, "samples wanted"))
    , radiance(device, planes.published ? 3 * frame.layout.size : 0, "radiance of the term")
    , deviation(device, frame.layout.size * deviationBytes(planes) / sizeof(float), "deviation")
{
    beta.fill(queue, 0.0f);
    wanted.fill(queue, 0u);
    clear(queue);
}

void Scratch::plan(device::MemoryPlan& plan, const PlaneLayout& layout, std::uint32_t values)
{
    planPlanes(plan, layout,
        { { "rows filtered", values }, { "filtered", values }, { "effective count of rows", 1 },
            { "effective count", 1 }, { "logarithms", spreadPlanes }, { "logarithms spread along rows", spreadPlanes },
            { "logarithms spread", spreadPlanes }, { "demand", 1 } });
}

Scratch::Scratch(
    const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, std::uint32_t planes)
    : values(planes)
    , rowsFiltered(device, planes * layout.size, "rows filtered")
    , filtered(device, planes * layout.size, "filtered")
    , rowsEffective(device, layout.size, "effective count of rows")
    , effective(device, layout.size, "effective count")
    , logs(device, spreadPlanes * layout.size, "logarithms")
    , rowsSpread(device, spreadPlanes * layout.size, "logarithms spread along rows")
    , spread(device, spreadPlanes * layout.size, "logarithms spread")
    , demand(device, layout.size, "demand")
    , slopes(rowsSpread)
    , width(rowsSpread)
    , error(effective)
    , visibility(logs.part<float>(0, layout.size, "visibility"))
    , narrowRows(demand)
    , wideRows(rowsFiltered)
    , compared(spread)
    , narrowCounts(rowsSpread)
    , weights(logs.part<float>(2 * layout.size, layout.size, "weights"))
    , motionWidth(device, 0, "motion filter width")
    , motionDirection(device, 0, "motion direction")
    , ofTexture(rowsSpread)
    , ofAllTextures(spread)
    , bounds(device, 6 * WEDGE_EXTENT_STRIPES, "visible bounds")
    , extent(device, 1, "visible extent")
{
    for (device::Buffer<float>* b :
        { &rowsFiltered, &filtered, &rowsEffective, &effective, &logs, &rowsSpread, &spread, &demand }) {
        b->fill(queue, 0.0f);
    }
}

// Who lives when, each with its first plane. Widths of a light: slopes 0, demand 3 (eroded slopes, then what is lit),
// logs 4, rowsSpread 2, spread 0, width 2; of indirect light: slopes 0, width 2. Counts: motionWidth 1, ofAllTextures
// 5, demand 3, and, for one term after the other, ofTexture 0, logs 4 (variance), and one plane of the gather's each:
// 0, 3 and 2. Filters of the image: the gather's, and of lights logs 4 (visibility, then the direction of shadows'
// motion) and error 2. Before them, to widen: wideRows 0, compared 1 (then variances), rowsEffective 2 (then factors,
// then shares), narrowRows 3 (then squares), visibility 4 (then differences), narrowCounts 5 (then weights).
Scratch::Scratch(const device::Device& device, const PlaneLayout& layout, const device::Buffer<float>& memory)
    : values(3)
    , rowsFiltered(memory.part<float>(0, 3 * layout.size, "rows filtered"))
    , filtered(memory.part<float>(3 * layout.size, 3 * layout.size, "filtered"))
    , rowsEffective(memory.part<float>(2 * layout.size, layout.size, "effective count of rows"))
    , effective(rowsEffective)
    , logs(memory.part<float>(4 * layout.size, 2 * layout.size, "logarithms"))
    , rowsSpread(memory.part<float>(2 * layout.size, 2 * layout.size, "logarithms spread along rows"))
    , spread(memory.part<float>(0, 2 * layout.size, "logarithms spread"))
    , demand(memory.part<float>(3 * layout.size, layout.size, "demand"))
    , slopes(memory.part<float>(0, layout.size, "slopes and distances"))
    , width(rowsEffective)
    , error(rowsEffective)
    , visibility(memory.part<float>(4 * layout.size, layout.size, "visibility"))
    , narrowRows(demand)
    , wideRows(slopes)
    , compared(memory.part<float>(layout.size, layout.size, "width to compare with"))
    , narrowCounts(memory.part<float>(5 * layout.size, layout.size, "equal samples of narrow filters"))
    , weights(narrowCounts)
    , motionWidth(memory.part<float>(layout.size, layout.size, "motion filter width"))
    , motionDirection(demand)
    , ofTexture(slopes)
    , ofAllTextures(memory.part<float>(5 * layout.size, layout.size, "variance of textures"))
    , bounds(device, 6 * WEDGE_EXTENT_STRIPES, "visible bounds")
    , extent(device, 1, "visible extent")
{
}

void Term::clear(device::TimedQueue& queue)
{
    sums.fill(queue, 0.0f);
    value.fill(queue, 0.0f);
    extremes.fill(queue, 0.0f);
    if (!shape.lean) {
        taken.fill(queue, 0u);
    }
    if (shape.distributed) {
        texture.fill(queue, 0.0f);
        plain.fill(queue, 0.0f);
        squares.fill(queue, 0.0f);
        textureSquares.fill(queue, 0.0f);
        radiance.fill(queue, 0.0f);
        deviation.fill(queue, 0.0f);
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

shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed)
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
