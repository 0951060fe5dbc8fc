#include "host/render/waves.h"

namespace wedge::render {

using device::PassKind;

namespace {

// Tiles of the padded image: no rectangle of pixels has more.
std::uint64_t mostTiles(const PlaneLayout& layout)
{
    const std::uint64_t across = (layout.width + WEDGE_TILE - 1) / WEDGE_TILE;
    return across * ((layout.height + WEDGE_TILE - 1) / WEDGE_TILE);
}

constexpr std::uint64_t surfacePlanes = 3 * 6 + 2 + 12; // vectors; motion; single planes

} // namespace

void Waves::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& term)
{
    const std::uint64_t planes = surfacePlanes + 8 + term.sums + term.values + term.extremes + 4;
    plan.addItems("receivers", capacity, 4 * planes);
    plan.addItems("tiles", mostTiles(layout), 8);
}

Waves::Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term)
    : shape(term)
    , position(device, 3 * capacity, "receivers' positions")
    , normal(device, 3 * capacity, "receivers' normals")
    , origin(device, 3 * capacity, "receivers' origins")
    , geometric(device, capacity, "receivers' geometric normals")
    , objectId(device, capacity, "receivers' object ids")
    , gloss(device, capacity, "receivers' gloss")
    , pixelOf(device, capacity, "receivers' pixels")
    , sampleOf(device, capacity, "receivers' samples")
    , shareOf(device, capacity, "receivers' shares")
    , view(device, capacity, "receivers' views")
    , time(device, capacity, "receivers' times")
    , diffuse(device, 3 * capacity, "receivers' diffuse")
    , specular(device, 3 * capacity, "receivers' specular")
    , emission(device, 3 * capacity, "receivers' emission")
    , pixelSize(device, capacity, "receivers' pixel sizes")
    , depth(device, capacity, "receivers' depths")
    , motion(device, 2 * capacity, "receivers' motion")
    , sums(device, term.sums * capacity, "receivers' sums")
    , value(device, term.values * capacity, "receivers' values")
    , extremes(device, term.extremes * capacity, "receivers' slopes and distances")
    , taken(device, capacity, "receivers' samples taken")
    , wanted(device, capacity, "receivers' samples wanted")
    , rays(device, capacity, "receivers' rays")
    , pathRays(device, capacity, "receivers' path rays")
    , unshadowed(device, 2 * capacity, "receivers' unshadowed shading")
    , radiance(device, 3 * capacity, "receivers' radiance")
    , radianceNoisy(device, 3 * capacity, "receivers' unfiltered radiance")
    , tileReceivers(device, mostTiles(layout), "receivers of tiles")
    , tileFirst(device, mostTiles(layout), "first receivers of tiles")
    , pixelFirst(device, capacity, "first receivers of pixels")
    , pixelCount(device, capacity, "receivers of pixels")
{
}

std::vector<shared::WaveParams> Waves::schedule(Passes& passes, const shared::FrameParams& params,
    const shared::CameraParams& camera, const Frame& frame, shared::WaveParams settings, std::uint32_t last)
{
    camera_ = camera;
    params_ = params;
    settings.planeSize = capacity;
    settings.lastSample = last;
    passes.list("lists", PassKind::Trace, "waves.cl", "countReceivers", params.tileCount, params, settings,
        frame.primaryTaken, frame.primaryWanted, tileReceivers);
    if (passes.rehearsal()) {
        return { settings };
    }
    std::vector<std::uint32_t> counts(params.tileCount), first(params.tileCount);
    tileReceivers.download(passes.queue(), counts);
    std::vector<shared::WaveParams> waves;
    constexpr std::uint32_t tilesOfWave = capacity / WEDGE_TILE_PIXELS;
    for (std::uint32_t tile = 0; tile < params.tileCount; ++tile) {
        const bool fits = !waves.empty() && waves.back().tiles < tilesOfWave && waves.back().receivers + counts[tile] <= capacity;
        if (!fits) {
            waves.push_back(settings);
            waves.back().firstTile = tile;
        }
        first[tile] = waves.back().receivers;
        waves.back().receivers += counts[tile];
        ++waves.back().tiles;
    }
    tileFirst.upload(passes.queue(), first);
    std::erase_if(waves, [](const shared::WaveParams& wave) { return wave.receivers == 0; });
    return waves;
}

shared::FrameParams Waves::receiverParams(const shared::WaveParams& wave) const
{
    shared::FrameParams p = params_;
    p.planeSize = wave.planeSize;
    p.receivers = wave.receivers;
    p.tileCount = (wave.receivers + WEDGE_TILE_PIXELS - 1) / WEDGE_TILE_PIXELS;
    return p;
}

void Waves::trace(Passes& passes, const DeviceScene& scene, const Frame& frame, const shared::WaveParams& wave,
    bool lit, double workUnits)
{
    passes.list("lists", PassKind::Trace, "waves.cl", "listReceivers", wave.tiles, params_, wave, frame.primaryTaken,
        frame.primaryWanted, tileFirst, pixelOf, sampleOf, shareOf, pixelFirst, pixelCount);
    shared::FrameParams traced = params_;
    traced.tileCount = receiverParams(wave).tileCount;
    passes.tiles("primary rays", PassKind::Trace, "wave_primary.cl", "wavePrimary", traced, workUnits, camera_, wave,
        scene.nodes, scene.blocks, surfaceArguments(scene), scene.objectIds, scene.areaLights,
        static_cast<std::uint32_t>(lit ? scene.areaLightList.size() : 0), pixelOf, sampleOf, frame.primaryWanted, position,
        normal, origin, geometric, objectId, gloss, view, time, diffuse, specular, emission, pixelSize, depth, motion, rays,
        pathRays);
}

void Waves::share(Passes& passes, const Term& term, const shared::WaveParams& wave)
{
    passes.list("lists", PassKind::Trace, "waves.cl", "shareSamples", wave.receivers, params_, wave, pixelOf, shareOf,
        term.taken, term.wanted, shape.sums, shape.extremes, taken, wanted, sums, extremes);
}

void Waves::accumulateSurfaces(Passes& passes, Frame& frame, const shared::WaveParams& wave)
{
    pixels(passes, "accumulateSurfaces", wave, camera_, pixelFirst, pixelCount, objectId, position, normal,
        gloss, diffuse, specular, emission, pixelSize, depth, motion, rays, pathRays, frame.primaryTaken, frame.hits,
        frame.objectId, frame.position, frame.normal, frame.gloss, frame.diffuse, frame.specular, frame.emission, frame.emissionSquares,
        frame.pixelSize, frame.depth, frame.confusion, frame.motion, frame.rays, frame.pathRays);
}

} // namespace wedge::render
