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

void Frame::plan(device::MemoryPlan& plan, const PlaneLayout& layout)
{
    planPlanes(plan, layout,
        { { "position", 3 }, { "normal", 3 }, { "origin", 3 }, { "depth", 1 }, { "pixel size", 1 }, { "diffuse", 3 },
            { "specular", 3 }, { "emission", 3 }, { "gloss", 1 }, { "geometric normal", 1 }, { "object id", 1 },
            { "rays", 1 }, { "path rays", 1 }, { "direct", 3 }, { "direct noisy", 3 }, { "indirect", 3 },
            { "indirect noisy", 3 }, { "beauty", 3 }, { "samples", 1 }, { "indirect samples", 1 } });
}

Frame::Frame(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& planes)
    : layout(planes)
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
}

bool TermShape::holds(const TermShape& other) const
{
    return sums >= other.sums && values >= other.values && extremes >= other.extremes && analysed >= other.analysed;
}

TermShape TermShape::with(const TermShape& other) const
{
    return { std::max(sums, other.sums), std::max(values, other.values), std::max(extremes, other.extremes),
        analysed || other.analysed };
}

void Term::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& shape)
{
    planPlanes(plan, layout,
        { { "sums", shape.sums }, { "value", shape.values }, { "samples taken", 1 }, { "samples wanted", 1 },
            { "slopes and distances", shape.extremes } });
    if (shape.analysed) {
        planPlanes(plan, layout,
            { { "filter width", 1 }, { "rows filtered", shape.values }, { "filtered", shape.values },
                { "effective count of rows", 1 }, { "effective count", 1 }, { "logarithms", spreadPlanes },
                { "logarithms spread along rows", spreadPlanes }, { "logarithms spread", spreadPlanes }, { "demand", 1 } });
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
    , rowsFiltered(device, planes.analysed ? value.size() : 0, "rows filtered")
    , filtered(device, planes.analysed ? value.size() : 0, "filtered")
    , rowsEffective(device, planes.analysed ? layout.size : 0, "effective count of rows")
    , effective(device, planes.analysed ? layout.size : 0, "effective count")
    , logs(device, planes.analysed ? spreadPlanes * layout.size : 0, "logarithms")
    , rowsSpread(device, planes.analysed ? spreadPlanes * layout.size : 0, "logarithms spread along rows")
    , spread(device, planes.analysed ? spreadPlanes * layout.size : 0, "logarithms spread")
    , demand(device, planes.analysed ? layout.size : 0, "demand")
    , bounds(device, 6 * WEDGE_EXTENT_STRIPES, "visible bounds")
    , extent(device, 1, "visible extent")
    , histogramCounts(device, WEDGE_DEMAND_STRIPES * WEDGE_DEMAND_BINS, "demand histogram")
    , histogramPixels(device, WEDGE_DEMAND_STRIPES, "shaded pixels")
    , binCounts(device, WEDGE_DEMAND_BINS, "demand bins")
    , histogramSums(device, WEDGE_DEMAND_STRIPES * WEDGE_DEMAND_BINS, "demand sums")
    , binSums(device, WEDGE_DEMAND_BINS, "demand bin sums")
    , countScale(device, 1, "count scale")
{
    for (device::Buffer<float>* b : { &rowsFiltered, &filtered, &rowsEffective, &effective, &logs, &rowsSpread, &spread, &demand, &beta }) {
        b->fill(queue, 0.0f);
    }
    wanted.fill(queue, 0u);
    clear(queue);
}

void Term::clear(device::TimedQueue& queue)
{
    sums.fill(queue, 0.0f);
    value.fill(queue, 0.0f);
    extremes.fill(queue, 0.0f);
    taken.fill(queue, 0u);
}

shared::FrameParams frameParams(const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed)
{
    const scene::Camera& camera = scene.camera;
    const glm::vec3 forward = glm::normalize(camera.lookAt - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::vec3 down = -glm::cross(right, forward);
    // Pixels are square: the vertical field of view sets the step in both directions.
    const float step = 2.0f * std::tan(0.5f * glm::radians(camera.verticalFov)) / static_cast<float>(layout.height);
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
    p.eye = toVec3(camera.eye);
    p.forward = toVec3(forward);
    p.right = toVec3(right * step);
    p.down = toVec3(down * step);
    p.background = toVec3(scene.background);
    return p;
}

} // namespace wedge::render
