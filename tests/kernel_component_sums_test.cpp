// light/components.h alone: what samples add up to, by components.
#include "tests/component_basis.h"
#include "tests/trace_support.h"

#include <array>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("components of samples are the light's integrals of the basis, of what is seen and of all")
{
    onEveryDevice([](const device::Device& device) {
        // A floor under a light of which a quad just below it hides the half of positive u.
        SceneBuilder b;
        b.newObject();
        b.quad({ 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 });
        b.newObject();
        b.quad({ 0.4f, 1.9995f, 0 }, { 0.4f, 0, 0 }, { 0, 0, 0.8f });
        scene::AreaLight& light =
            b.light({ 0, 2, 0 }, { 0.3f, 0, 0 }, { 0, 0, 0.5f }, scene::LightProfile::Gaussian, 2);
        light.radiance = { 5, 5, 5 };
        b.camera({ 0, 1, 0.8f }, { 0, 0, 0 });
        shared::SampleParams params {};
        params.shading = WEDGE_SHADING_SEPARATE; // samples weigh the same
        params.sampler = WEDGE_SAMPLER_SOBOL;
        for (const int count : { 3, 5 }) {
            const std::size_t products = static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
            render::Settings settings = render::multipleAxisAligned(render::Maaf::Refitted, 16);
            settings.components = count;
            TracedScene traced(b.scene, device, 17, 9, settings);
            Samples samples(traced, "sampleShadows", "second pass");
            samples.value("params", params);
            for (const std::uint32_t last : { 1024u, 4096u })
                samples.upTo(last, 4096);
            const auto found = samples.pixels<float>("components"), sums = samples.pixels<float>("sums");
            // Of one axis: integrals of B over those of the profile, over all of it and over its negative half.
            std::vector<std::array<double, 2>> expected(static_cast<std::size_t>(count));
            double mass = 0;
            for (int k = 0; k < 4000; ++k) {
                const double y = -2 + 4 * (k + 0.5) / 4000;
                mass += std::exp(-0.5 * y * y);
                for (int i = 0; i < count; ++i) {
                    expected[static_cast<std::size_t>(i)][0] += basis(count, 2, i, y);
                    expected[static_cast<std::size_t>(i)][1] += y < 0 ? basis(count, 2, i, y) : 0.0;
                }
            }
            int pixels = 0;
            traced.everyPixel([&](int x, int y) {
                if (!(sums.at(x, y) > 0))
                    return;
                ++pixels;
                for (std::size_t part = 0; part < 2; ++part)
                    for (std::size_t k = 0; k < products; ++k) {
                        const std::size_t i = k / static_cast<std::size_t>(count),
                                          j = k % static_cast<std::size_t>(count);
                        const double want = expected[i][part] * expected[j][0] / (mass * mass);
                        const double got = found.at(x, y, part * products + k) / sums.at(x, y);
                        REQUIRE(std::fabs(got - want) < 0.03);
                    }
            });
            CHECK(pixels > 50);
        }
    });
}
