#pragma once

#include "benchmarks/rays/embree_scene.h"
#include "benchmarks/rays/surface.h"
#include "benchmarks/rays/workers.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"

#include <vector>

namespace wedge::benchmark {

/// The frame of `wedge render --method mc` with Embree: primary rays, surfaces, the same samples of the area lights,
/// a shadow ray each, and the diffuse shading. For matt, untextured scenes whose lights the camera does not see and
/// which have area lights alone.
class EmbreeFrame {
public:
    /// scene must outlive this. Sides in pixels are multiples of 8.
    EmbreeFrame(const scene::Scene& scene, int width, int height, int samples, std::uint32_t seed);

    /// packets: 16 rays of a 4x4 block at a time, else one.
    void render(const EmbreeScene& embree, bool packets, Workers& workers);

    /// Linear RGB, row by row, of the last render().
    const std::vector<float>& rgb() const { return rgb_; }

private:
    /// A pixel on its way.
    struct Shaded {
        int x, y;
        SurfacePoint surface;
        shared::Vec3 reflected; ///< sum over lights
        float visible; ///< sum over the samples of one light
        bool hit;
    };
    /// A sample of a light as a pixel sees it; weight 0: no ray is needed.
    struct Sample {
        shared::Vec3 ray;
        float weight;
    };

    Shaded startPixel(std::size_t i) const;
    shared::Vec3 direction(const Shaded& pixel) const;
    Sample sample(const Shaded& pixel, std::size_t index, int k) const;
    void endLight(Shaded& pixel, std::size_t light) const;
    void store(const Shaded& pixel);
    void renderPixel(RTCScene scene, std::size_t i);
    void renderBlock(RTCScene scene, std::size_t first);

    const scene::Scene& scene_;
    HostSurfaces surfaces_;
    shared::FrameParams frame_;
    std::vector<shared::AreaLight> lights_;
    int width_, samples_;
    std::vector<float> rgb_;
};

} // namespace wedge::benchmark
