// Things that emit, far smaller than a pixel: how samples are shared out between pixels, and what comes of it.
#include "tests/lamp_room.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 40, height = 30;

/// Dots of a tenth of a pixel in the dark.
SceneBuilder dots(bool lens)
{
    SceneBuilder b;
    b.camera({ 0, 0, 0 }, { 0, 0, -1 });
    const std::uint32_t glow = addGlow(b, glm::vec3(100));
    std::mt19937 random(9);
    const double step = 2 * std::tan(0.5 * glm::radians(double { b.scene.camera.verticalFov })) / height;
    for (int i = 0; i < 200; ++i) {
        const double z = uniform(random, 3, 8);
        const glm::vec3 at(
            0.48 * width * step * z * uniform(random, -1, 1), 0.48 * height * step * z * uniform(random, -1, 1), -z);
        const auto half = static_cast<float>(0.05 * step * z);
        b.quad(at, { half, 0, 0 }, { 0, half, 0 }, glow);
    }
    b.scene.camera.apertureRadius = lens ? 0.05f : 0.0f;
    b.scene.camera.focusDistance = 4;
    return b;
}

} // namespace

TEST_CASE("dots of a tenth of a pixel have the light of plain samples, and no larger error")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true }) {
            CAPTURE(lens);
            const SceneBuilder b = dots(lens);
            const auto of = [&](const render::Settings& method, int runs) {
                render::Settings settings = sized(method, width, height);
                settings.bounces = 0;
                settings.antialias = true;
                return lightOf(b, device, settings, runs);
            };
            constexpr int runs = 12;
            const Moments reference = of(render::monteCarlo(4096), 2), plain = of(render::monteCarlo(28), runs),
                          filtered = of(render::axisAligned(28), runs);
            const auto off = [&](const Moments& m) {
                double sum = 0;
                for (std::size_t i = 0; i < m.size(); ++i)
                    sum += runs * m.variance[i] + std::pow(m.mean[i] - reference.mean[i], 2);
                return std::sqrt(sum / static_cast<double>(m.size()));
            };
            CHECK(off(filtered) < off(plain));
            double variance = 0;
            for (const double v : filtered.variance)
                variance += v;
            const double deviation = std::sqrt(variance) / static_cast<double>(filtered.size());
            CAPTURE(deviation);
            CHECK(std::abs(filtered.average() - reference.average()) < 4 * deviation); // four deviations
        }
    });
}
