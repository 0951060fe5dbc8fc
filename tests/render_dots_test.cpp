// Things that emit, far smaller than a pixel: how samples are shared out between pixels, and what comes of it.
#include "host/render/count_scale.h"
#include "tests/lamp_room.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 40, height = 30;

/// Demands as of pixels around, and what the pixels' own samples tell.
render::AskedSamples asked(const render::PlaneLayout& frame, const std::function<float(int, int)>& demand,
    const std::function<float(int, int)>& uncertainty)
{
    render::AskedSamples out;
    out.values.resize(frame.size);
    out.uncertainty.resize(frame.size);
    out.taken.assign(frame.size, 8);
    out.rays = 1;
    out.least = 9;
    out.room = 1e9f;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i =
                shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), frame.stride);
            out.values[i] = demand(x, y);
            out.uncertainty[i] = uncertainty(x, y);
        }
    return out;
}

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

TEST_CASE("counts are even where demands say nothing of the pixels that have them")
{
    const render::PlaneLayout frame(width, height);
    std::mt19937 random(3);
    std::vector<std::uint8_t> found(std::size_t { width } * height);
    for (std::uint8_t& f : found)
        f = random() % 25 == 0 ? 1 : 0; // pixels in which one of eight samples found something
    const auto at = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < width && y < height
            && found[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] != 0;
    };
    const auto around = [&](int x, int y) {
        int sum = 0;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                sum += (dx != 0 || dy != 0) && at(x + dx, y + dy) ? 1 : 0;
        return static_cast<float>(sum);
    };
    const auto counts = [&](const render::AskedSamples& a) {
        const std::vector<render::AskedSamples> all { a };
        const float scale = render::scaleOf(all, 28.0 * width * height, 256, frame);
        return render::evenCounts(all, scale, 256, frame);
    };
    const render::EvenCounts rare = counts(asked(frame, around, [&](int x, int y) { return at(x, y) ? 1.0f : 0.0f; }));
    CHECK(rare.share >= 0.75f);
    CHECK(rare.mean == doctest::Approx(28).epsilon(0.02));
    // A quarter that is uncertain, and knows it of its neighbours.
    const auto uncertain = [](int x, int) { return x < width / 4 ? 1.0f : 0.01f; };
    CHECK(counts(asked(
                     frame, [&](int x, int y) { return std::sqrt(uncertain(x, y)); }, uncertain))
              .share
        == 0);
}

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
