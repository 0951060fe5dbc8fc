#pragma once

#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/passes.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/wave.h"

#include <vector>

namespace wedge::render {

/// Receivers of distributed frames: their lists, and what is found at each (kernels/waves.cl). Pixels that see a scene
/// through a lens or a shutter have many, and no memory for all at once: they are traced in waves of a bounded number,
/// each of which is added to its pixels before the next.
class Waves {
public:
    static constexpr std::uint32_t capacity = WEDGE_WAVE_RECEIVERS;
    /// Elements from plane to plane: not a power of two, whose multiples caches confuse.
    static constexpr std::uint32_t planeSize = capacity + device::partAlignment / sizeof(float);

    /// Bytes of what lies in their memory, and the rest.
    static std::uint64_t bytes(const TermShape& term, bool deltaLights);
    static void planTiles(device::MemoryPlan& plan, const PlaneLayout& layout);

    /// term: planes that the receivers' terms need. memory: what is on no use between the waves of one pass and those
    /// of the next lies there, from the start on.
    Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term, bool deltaLights,
        const device::Buffer<float>& memory);
    /// With memory of their own, and point or directional lights.
    Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term);

    /// The waves in which the pixels of frame get their primary samples up to frame.primaryWanted, or up to `last`
    /// samples. settings: sampler, firstPass and shading; the rest is filled in. They are for those pixels until the
    /// next schedule.
    /// Takes back what the pixels of a tile want beyond what fits in a wave. params: of the whole image.
    static void limitTiles(Passes& passes, const shared::FrameParams& params, const Frame& frame);

    std::vector<shared::WaveParams> schedule(Passes& passes, const shared::FrameParams& params,
        const shared::CameraParams& camera, const Frame& frame, shared::WaveParams settings, std::uint32_t last);

    const shared::CameraParams& camera() const { return camera_; }

    /// Lists the wave's receivers and traces their primary rays. lit: with area lights in view.
    void trace(Passes& passes, const DeviceScene& scene, const Frame& frame, const shared::WaveParams& wave, bool lit,
        double workUnits);

    /// Shares the samples of a term that the wave's pixels take now out to their receivers, and clears those' sums.
    void share(Passes& passes, const Term& term, const shared::WaveParams& wave);

    /// Adds the receivers' surfaces to their pixels: the last that is done with a wave.
    void accumulateSurfaces(Passes& passes, Frame& frame, const shared::WaveParams& wave);

    /// What passes over the wave's receivers take for FrameParams.
    shared::FrameParams receiverParams(const shared::WaveParams& wave) const;

    /// A pass over the pixels of the wave's tiles.
    template <class... Args>
    void pixels(Passes& passes, const std::string& kernel, const shared::WaveParams& wave, const Args&... args)
    {
        passes.list("accumulate", device::PassKind::Trace, "accumulate.cl", kernel,
            std::size_t { wave.tiles } * WEDGE_TILE_PIXELS, params_, wave, args...);
    }

    /// What kernels take for WEDGE_RECEIVER_PARAMETERS.
    auto receivers() const
    {
        return std::tie(position, normal, origin, geometric, objectId, gloss, pixelOf, view, time);
    }

    TermShape shape;
    device::Buffer<float> position, normal, origin;
    device::Buffer<std::uint32_t> geometric, objectId;
    device::Buffer<float> gloss;
    device::Buffer<std::uint32_t> pixelOf, sampleOf, shareOf, view; ///< see waves.cl
    device::Buffer<float> time, diffuse, specular, emission, pixelSize, depth, motion; ///< see wave_primary.cl
    device::Buffer<float> sums, value, extremes; ///< of one term
    device::Buffer<std::uint32_t> taken, wanted, rays, pathRays;
    device::Buffer<float> unshadowed; ///< shading by a light, see wave_light.cl
    device::Buffer<float> radiance, radianceNoisy; ///< of point and directional lights
    device::Buffer<std::uint32_t> tileReceivers, tileFirst; ///< one a tile
    device::Buffer<std::uint32_t> pixelFirst, pixelCount; ///< one a pixel of the wave's tiles

private:
    /// Planes of receivers, one buffer after the other, in one memory.
    struct Pieces {
        const device::Buffer<float>& memory;
        std::size_t planes = 0; ///< taken so far

        template <class T>
        device::Buffer<T> take(std::size_t count, const std::string& name);
    };
    Waves(const device::Device& device, const PlaneLayout& layout, const TermShape& term, bool deltaLights,
        Pieces pieces);

    shared::FrameParams params_ {}; ///< of the pixels
    shared::CameraParams camera_ {};
};

} // namespace wedge::render
