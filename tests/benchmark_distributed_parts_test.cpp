// What benchmarks of frames with lens and shutter compute with: blurs, heat maps, what rays are counted by.
#include "benchmarks/distributed/heat_map.h"
#include "benchmarks/distributed/image_blur.h"
#include "benchmarks/distributed/variant_curves.h"
#include "benchmarks/distributed/whole_image.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

namespace wedge::benchmark {
namespace {

double sum(const image::RgbImage& image) { return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0); }

TEST_CASE("a blurred point is a Gaussian of the asked width, in its own channel, and an even image stays")
{
    constexpr int side = 41;
    image::RgbImage point { side, side, std::vector<float>(3 * side * side, 0.0f) };
    const auto at = [](int x, int y, int c) { return static_cast<std::size_t>(3 * (y * side + x) + c); };
    point.rgb[at(20, 20, 1)] = 1.0f;
    CHECK(blurred(point, 0.0).rgb == point.rgb);
    for (const double sigma : { 1.0, 3.0 }) {
        const image::RgbImage out = blurred(point, sigma);
        CHECK(sum(out) == doctest::Approx(1.0));
        double variance = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                CHECK(out.rgb[at(x, y, 0)] == 0.0f);
                variance += static_cast<double>(out.rgb[at(x, y, 1)]) * (x - 20) * (x - 20);
            }
        }
        // What the cut at three standard deviations leaves of the variance is 97 %, or more.
        CHECK(std::sqrt(variance) == doctest::Approx(sigma).epsilon(0.02));
        CHECK(out.rgb[at(23, 20, 1)] == doctest::Approx(out.rgb[at(20, 17, 1)]));
    }
    const image::RgbImage even { 7, 3, std::vector<float>(63, 0.25f) };
    for (const float value : blurred(even, 5.0).rgb) {
        CHECK(value == doctest::Approx(0.25));
    }
}

TEST_CASE("heat maps go from black to white, ever lighter")
{
    const std::vector<float> values = { -1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 };
    const image::RgbImage map = heatMap(values, 11, 1, 0.0, 8.0, false);
    const auto light = [&](std::size_t i) {
        return 0.2126f * map.rgb[3 * i] + 0.7152f * map.rgb[3 * i + 1] + 0.0722f * map.rgb[3 * i + 2];
    };
    CHECK(light(0) == 0.0f);
    CHECK(light(1) == 0.0f);
    for (std::size_t i = 2; i < 10; ++i) {
        CHECK(light(i) > light(i - 1));
    }
    CHECK(light(9) == doctest::Approx(1.0));
    CHECK(light(10) == doctest::Approx(1.0));

    // Equal ratios are equal steps, what is not above 0 is black, and a map of one value is no division by 0.
    const image::RgbImage logs = heatMap({ 0, 1, 4, 16 }, 4, 1, 1.0, 16.0, true);
    const image::RgbImage steps = heatMap({ 0, 0, 1, 2 }, 4, 1, 0.0, 2.0, false);
    for (std::size_t i = 0; i < logs.rgb.size(); ++i) {
        CHECK(logs.rgb[i] == doctest::Approx(steps.rgb[i]));
    }
    CHECK(heatMap({ 3 }, 1, 1, 3.0, 3.0, false).rgb[0] == 0.0f);
}

TEST_CASE("rays are counted by all pixels, whether they see something or not")
{
    MeasurePlan plan;
    plan.width = 10;
    plan.height = 4;
    const WholeImage subject("name", plan, 1);
    render::FrameStatistics frame;
    frame.shadedPixels = 20;
    frame.primaryRays = 80;
    frame.shadowRays = 200;
    frame.indirectRays = 120;
    CHECK(subject.raysOf(frame) / subject.pixelsOf(frame) == 10.0);
}

TEST_CASE("curves are at the plan's budgets and the default one, each once")
{
    DistributedPlan plan;
    const WholeImage subject("name", plan, 1);
    const int usual = subject.usual().spp;
    plan.budgets = { 2 * usual, 64 * usual, usual };
    CHECK(budgetsOf(subject, plan) == std::vector<int> { usual, 2 * usual, 64 * usual });
    plan.budgets = { usual + 1 };
    CHECK(budgetsOf(subject, plan) == std::vector<int> { usual, usual + 1 });
    CHECK(subject.usual().bounces == 1);
    CHECK(subject.published().published);
    CHECK(subject.unfiltered(render::Sampler::Stratified, 64).spp == 64);
}

} // namespace
} // namespace wedge::benchmark
