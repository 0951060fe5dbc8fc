#include "host/render/waves.h"

#include <cassert>

namespace wedge::render {

using device::PassKind;

namespace {

// Tiles of the padded image: no rectangle of pixels has more.
std::uint64_t mostTiles(const PlaneLayout& layout)
{
    const std::uint64_t across = (layout.width + WEDGE_TILE - 1) / WEDGE_TILE;
    return across * ((layout.height + WEDGE_TILE - 1) / WEDGE_TILE);
}

// Surfaces: vectors, motion, single planes; samples and rays; lists; shading by a light.
constexpr std::uint64_t surfacePlanes = 3 * 6 + 2 + 10, otherPlanes = 4 + 2 + 2;

} // namespace

std::uint64_t Waves::bytes(const TermShape& term, bool deltaLights)
{
    return sizeof(float) * planeSize
        * (surfacePlanes + otherPlanes + term.sums + term.values + term.extremes + (deltaLights ? 6u : 0u));
}

void Waves::planTiles(device::MemoryPlan& plan, const PlaneLayout& layout)
{
    plan.addItems("tiles", mostTiles(layout), 8);
}

template <class T>
device::Buffer<T> Waves::Pieces::take(std::size_t count, const std::string& name)
{
    if (count == 0) {
        // Some buffer that nothing is written to.
        return memory.part<T>(0, 0, name);
    }
    planes += count;
    return memory.part<T>((planes - count) * planeSize, count * planeSize, name);
}

Waves::Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term, bool deltaLights,
    const device::Buffer<float>& memory)
    : Waves(device, layout, term, deltaLights, Pieces { memory })
{
}

Waves::Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term)
    : Waves(device, layout, term, true, device::Buffer<float>(device, bytes(term, true) / sizeof(float), "receivers"))
{
}

Waves::Waves(
    const device::Device& device, const PlaneLayout& layout, const TermShape& term, bool deltaLights, Pieces pieces)
    : shape(term)
    , position(pieces.take<float>(3, "receivers' positions"))
    , normal(pieces.take<float>(3, "receivers' normals"))
    , origin(pieces.take<float>(3, "receivers' origins"))
    , geometric(pieces.take<std::uint32_t>(1, "receivers' geometric normals"))
    , objectId(pieces.take<std::uint32_t>(1, "receivers' object ids"))
    , gloss(pieces.take<float>(1, "receivers' gloss"))
    , pixelOf(pieces.take<std::uint32_t>(1, "receivers' pixels"))
    , sampleOf(pieces.take<std::uint32_t>(1, "receivers' samples"))
    , shareOf(pieces.take<std::uint32_t>(1, "receivers' shares"))
    , view(pieces.take<std::uint32_t>(1, "receivers' views"))
    , time(pieces.take<float>(1, "receivers' times"))
    , diffuse(pieces.take<float>(3, "receivers' diffuse"))
    , specular(pieces.take<float>(3, "receivers' specular"))
    , emission(pieces.take<float>(3, "receivers' emission"))
    , pixelSize(pieces.take<float>(1, "receivers' pixel sizes"))
    , depth(pieces.take<float>(1, "receivers' depths"))
    , motion(pieces.take<float>(2, "receivers' motion"))
    , sums(pieces.take<float>(term.sums, "receivers' sums"))
    , value(pieces.take<float>(term.values, "receivers' values"))
    , extremes(pieces.take<float>(term.extremes, "receivers' slopes and distances"))
    , taken(pieces.take<std::uint32_t>(1, "receivers' samples taken"))
    , wanted(pieces.take<std::uint32_t>(1, "receivers' samples wanted"))
    , rays(pieces.take<std::uint32_t>(1, "receivers' rays"))
    , pathRays(pieces.take<std::uint32_t>(1, "receivers' path rays"))
    , unshadowed(pieces.take<float>(2, "receivers' unshadowed shading"))
    , radiance(pieces.take<float>(deltaLights ? 3 : 0, "receivers' radiance"))
    , radianceNoisy(pieces.take<float>(deltaLights ? 3 : 0, "receivers' unfiltered radiance"))
    , tileReceivers(device, mostTiles(layout), "receivers of tiles")
    , tileFirst(device, mostTiles(layout), "first receivers of tiles")
    , pixelFirst(pieces.take<std::uint32_t>(1, "first receivers of pixels"))
    , pixelCount(pieces.take<std::uint32_t>(1, "receivers of pixels"))
{
    assert(pieces.planes * planeSize * sizeof(float) == bytes(term, deltaLights));
}

void Waves::limitTiles(Passes& passes, const shared::FrameParams& params, const Frame& frame)
{
    passes.list("counts", PassKind::Analysis, "waves.cl", "limitTiles", params.tileCount, params, capacity,
        frame.primaryTaken, frame.primaryWanted);
}

std::vector<shared::WaveParams> Waves::schedule(Passes& passes, const shared::FrameParams& params,
    const shared::CameraParams& camera, const Frame& frame, shared::WaveParams settings, std::uint32_t last)
{
    camera_ = camera;
    params_ = params;
    settings.planeSize = planeSize;
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
        const bool fits =
            !waves.empty() && waves.back().tiles < tilesOfWave && waves.back().receivers + counts[tile] <= capacity;
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
        static_cast<std::uint32_t>(lit ? scene.areaLightList.size() : 0), pixelOf, sampleOf, frame.primaryWanted,
        position, normal, origin, geometric, objectId, gloss, view, time, diffuse, specular, emission, pixelSize, depth,
        motion, rays, pathRays);
}

void Waves::share(Passes& passes, const Term& term, const shared::WaveParams& wave)
{
    passes.list("lists", PassKind::Trace, "waves.cl", "shareSamples", wave.receivers, params_, wave, pixelOf, shareOf,
        term.taken, term.wanted, shape.sums, shape.extremes, taken, wanted, sums, extremes);
}

void Waves::accumulateSurfaces(Passes& passes, Frame& frame, const shared::WaveParams& wave)
{
    pixels(passes, "accumulateSurfaces", wave, camera_, pixelFirst, pixelCount, objectId, position, normal, gloss,
        diffuse, specular, emission, pixelSize, depth, motion, rays, pathRays, frame.primaryTaken, frame.hits,
        frame.objectId, frame.position, frame.normal, frame.gloss, frame.diffuse, frame.specular, frame.emission,
        frame.emissionSquares, frame.pixelSize, frame.depth, frame.confusion, frame.motion, frame.rays, frame.pathRays);
}

} // namespace wedge::render
