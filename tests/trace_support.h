// A frame with what its primary rays find, for tests of the kernels that trace rays.
#pragma once

#include "bvh/host_traverse.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"
#include "tests/pass_bench.h"

#include <limits>
#include <string>
#include <vector>

namespace wedge::test {

/// A frame whose pixels are the receivers, after its primary rays.
class TracedScene : public DeclaredFrame {
public:
    TracedScene(const scene::Scene& scene, const device::Device& device, int width, int height,
        const render::Settings& settings = render::axisAligned(16), const render::Options& options = renderOptions())
        : DeclaredFrame(device, scene, sized(settings, width, height), false, options)
        , found(*this, "primary")
        , params(found.own<shared::FrameParams>("frame"))
    {
        found.run();
    }

    /// Of what primary rays find.
    Planes<float> floats(const std::string& name) const { return found.pixels<float>(name); }
    Planes<std::uint32_t> counts(const std::string& name) const { return found.pixels<std::uint32_t>(name); }
    const bvh::Bvh& hierarchy() const { return tree.bvh; }
    const shared::AreaLight& light(std::size_t number) const { return onDevice.areaLightList[number]; }

    /// The ray through the pixel's centre.
    bvh::Ray cameraRay(int x, int y) const
    {
        const shared::Vec3 d =
            shared::cameraDirection(params.forward, params.right, params.down, static_cast<float>(params.width),
                static_cast<float>(params.height), static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        return { params.eye, 0.0f, d, std::numeric_limits<float>::infinity() };
    }

    template <class Visit>
    void everyPixel(const Visit& visit) const
    {
        test::everyPixel(layout, visit);
    }

    PassBench found;
    const shared::FrameParams params;
};

/// A pass that takes samples where primary rays ended, launched any number of times.
class Samples : public PassBench {
public:
    Samples(TracedScene& traced, const std::string& kernel, const std::string& pass = "", std::size_t nth = 0)
        : PassBench(traced, kernel, pass, nth)
    {
        take(traced.found);
    }
    /// Up to `last`, of so many that are wanted of each pixel.
    void upTo(std::uint32_t last, std::uint32_t wanted) { upTo(last, std::vector(layout.size, wanted)); }
    void upTo(std::uint32_t last, const std::vector<std::uint32_t>& wanted)
    {
        plane("wanted", wanted);
        value("lastSample", last);
        run();
    }
};

} // namespace wedge::test
