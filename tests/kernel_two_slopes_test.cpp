// filter.cl, two_slopes.cl and light/moments.h alone: gathers that follow second derivatives, what samples tell
// of these, and the slopes that filters of both go by.
#include "effects/area_lights/maaf.h"
#include "effects/area_lights/soft_shadows.h"
#include "tests/filter_run.h"
#include "tests/trace_support.h"

#include <array>

using namespace wedge;
using namespace wedge::test;

namespace {

const render::Settings twoSlopes = render::multipleAxisAligned(render::Maaf::TwoSlope, 16);

/// A share of light on a floor, a polynomial of fourth order, and its derivatives along x, z, xx, xz, zz.
std::array<double, 6> fieldAt(double x, double z)
{
    return { 0.5 + 0.1 * x - 0.2 * x * z + 0.3 * z * z + 0.4 * x * x * x - 0.5 * x * x * z * z + 0.6 * z * z * z * z,
        0.1 - 0.2 * z + 1.2 * x * x - x * z * z, -0.2 * x + 0.6 * z - x * x * z + 2.4 * z * z * z, 2.4 * x - z * z,
        -0.2 - 2 * x * z, 0.6 - x * x + 7.2 * z * z };
}

/// A floor of 5 cm pixels seen from above with that field, where filters are 0.1 m wide and slopes are 1.
FilterImage curvedField()
{
    FilterImage image = withoutLight(randomImage(41, 33, Shape::Flat, 3));
    image.params.shearU = shared::vec3(1, 0, 0);
    image.params.shearV = shared::vec3(0, 0, 1);
    image.params.surface = 0;
    image.gradients.emplace(image.value.layout, 5, 0.0f);
    for (int y = 0; y < image.height(); ++y)
        for (int i = 0; i < image.width(); ++i) {
            const double x = 0.05 * (i - 20), z = 0.05 * (y - 16);
            const auto field = fieldAt(x, z);
            image.position.setVector(i, y, { x, 0, z });
            image.normal.setVector(i, y, { 0, 1, 0 });
            image.pixelSize.at(i, y) = 0.05f;
            image.beta.at(i, y) = 0.1f;
            image.value.at(i, y) = static_cast<float>(field[0]);
            for (std::size_t k = 0; k < 5; ++k)
                image.gradients->at(i, y, k) = static_cast<float>(field[k + 1] * (k < 2 ? -0.625 : 0.125));
        }
    return image;
}

std::size_t indexOf(const FilterImage& image, int x, int y)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x);
}

/// One pass over a flat floor in double, of values and the polynomials that neighbours have; planes: value and moments.
std::vector<std::array<double, 6>> oraclePass(
    const FilterImage& image, const std::vector<std::array<double, 6>>& in, int dx, int dy)
{
    std::vector<std::array<double, 6>> out = in;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            double weights = 0;
            std::array<double, 6> sum {};
            for (int k = -6; k <= 6; ++k) {
                const int qx = x + k * dx, qy = y + k * dy;
                if (qx < 0 || qy < 0 || qx >= image.width() || qy >= image.height())
                    continue;
                const glm::dvec3 d = image.position.vector(qx, qy) - image.position.vector(x, y);
                const double beta = image.beta.at(x, y), u = d.x / beta, v = d.z / beta;
                const double w = std::exp(-0.5 * (u * u + v * v));
                const std::array<double, 6>& m = in[indexOf(image, qx, qy)];
                const shared::Vec3 along = image.params.shearU, across = image.params.shearV;
                const double a = u * along.x + v * along.z, b = u * across.x + v * across.z;
                weights += w;
                sum[0] += w * (m[0] + m[1] * a + m[2] * b + m[3] * a * a + 2 * m[4] * a * b + m[5] * b * b);
                sum[1] += w * (m[1] + 2 * (m[3] * a + m[4] * b));
                sum[2] += w * (m[2] + 2 * (m[4] * a + m[5] * b));
                for (std::size_t p = 3; p < 6; ++p)
                    sum[p] += w * m[p];
            }
            for (std::size_t p = 0; p < 6; ++p)
                out[indexOf(image, x, y)][p] = sum[p] / weights;
        }
    return out;
}

} // namespace

TEST_CASE("a field of fourth order comes out as it is, which first derivatives alone leave flatter")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = curvedField();
        image.slopeWidth = Planes<float>(image.value.layout, 1, 1.0f); // s = 1
        const auto worst = [&](const FilterResult& result) {
            double off = 0;
            for (int y = 8; y < image.height() - 8; ++y)
                for (int x = 8; x < image.width() - 8; ++x)
                    off = std::max<double>(off, std::fabs(result.value.at(x, y) - image.value.at(x, y)));
            return off;
        };
        const double both = worst(filter(image));
        Planes<float> first(image.value.layout, 2, 0.0f);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (std::size_t k = 0; k < 2; ++k)
                    first.at(x, y, k) = image.gradients->at(x, y, k) / -0.625f;
        image.gradients = first;
        image.params.shearU = shared::vec3(0.5f, 0, 0);
        image.params.shearV = shared::vec3(0, 0, 0.5f);
        const double one = worst(filter(image));
        MESSAGE("off by up to ", both, ", by first derivatives alone ", one);
        CHECK(both < 6e-5); // of 16 bits
        CHECK(both < 0.5 * one);
    });
}

TEST_CASE("both passes of the filter pass polynomials on as their definition in double does")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = curvedField();
        image.params.cut = 6;
        image.params.maxRadius = 6;
        image.params.shearU = shared::vec3(0.5f, 0, 0.2f);
        image.params.shearV = shared::vec3(-0.3f, 0, 0.4f);
        std::mt19937 random(4);
        std::vector<std::array<double, 6>> in;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                image.slopeWidth.at(x, y) = 0.0625f; // narrower than the filter, which then counts
                image.value.at(x, y) = static_cast<float>(uniform(random, 0.2, 0.8));
                std::array<double, 6> all { image.value.at(x, y) };
                for (std::size_t k = 0; k < 5; ++k) {
                    float& m = image.gradients->at(x, y, k);
                    m = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random, -1, 1))));
                    all[k + 1] = m;
                }
                in.push_back(all);
            }
        const auto expected = oraclePass(image, oraclePass(image, in, 1, 0), 0, 1);
        const FilterResult found = filter(image);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                REQUIRE(std::fabs(found.value.at(x, y) - expected[indexOf(image, x, y)][0])
                    < 3e-3); // moments of rows have 16 bits
    });
}

TEST_CASE("NaN of moments that are not gathered stays there")
{
    onEveryDevice([](const device::Device& device) { checkThatNaNStays(device, curvedField()); });
}

TEST_CASE("moments that samples tell are how what is seen changes where the light moves, twice")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 40, 30, twoSlopes);
        shared::AreaLight light = traced.light(0);
        light.cut = 3; // its ends are next to nothing
        // Turned, so that shadows of boxes have mixed derivatives.
        light.halfU = shared::vec3(0.4f, 0, 0.3f);
        light.halfV = shared::vec3(-0.3f, 0, 0.4f);
        light.erfCut = static_cast<float>(std::erf(light.cut / std::sqrt(2.0)));
        shared::SampleParams params {};
        params.shading = WEDGE_SHADING_RATIO;
        params.sampler = WEDGE_SAMPLER_SOBOL;
        const auto sampled = [&](const shared::AreaLight& at) {
            Samples samples(traced, "sampleShadows", "second pass");
            samples.value("params", params);
            samples.value("light", at);
            samples.value("scores", render::momentsOf(at));
            for (const std::uint32_t last : { 1024u, 16384u })
                samples.upTo(last, 16384);
            return samples;
        };
        const Samples own = sampled(light);
        const auto sums = own.pixels<float>("sums"), found = own.pixels<float>("moments");
        const auto moved = [&](float u, float v) {
            shared::AreaLight at = light;
            at.centre = vecAdd(light.centre, vecAdd(vecScale(light.halfU, u), vecScale(light.halfV, v)));
            return sampled(at).pixels<float>("sums");
        };
        constexpr float step = 0.25f; // of local coordinates
        const Planes<float> plusU = moved(step, 0), minusU = moved(-step, 0), plusV = moved(0, step),
                            minusV = moved(0, -step), both = moved(step, step), neither = moved(-step, -step),
                            left = moved(-step, step), right = moved(step, -step);
        // Samples are noisy, and products of both axes' scores most: on the whole they are what differences are.
        std::array<double, 5> common {}, squares {};
        traced.everyPixel([&](int x, int y) {
            const auto lit = [&](const Planes<float>* of) { return of->at(x, y) > 0; };
            if (!std::ranges::all_of(
                    std::array { &sums, &plusU, &minusU, &plusV, &minusV, &both, &neither, &left, &right }, lit))
                return;
            const auto share = [&](const Planes<float>& of) { return of.at(x, y, 1) / of.at(x, y); };
            const double h = share(sums);
            const double expected[] = { (share(plusU) - share(minusU)) / (2 * step),
                (share(plusV) - share(minusV)) / (2 * step), (share(plusU) - 2 * h + share(minusU)) / (step * step),
                (share(both) + share(neither) - share(left) - share(right)) / (4 * step * step),
                (share(plusV) - 2 * h + share(minusV)) / (step * step) };
            for (std::size_t k = 0; k < 5; ++k) {
                common[k] += found.at(x, y, k) / sums.at(x, y) * expected[k];
                squares[k] += expected[k] * expected[k];
            }
        });
        for (std::size_t k = 0; k < 5; ++k) {
            MESSAGE("moment ", k, " is ", common[k] / squares[k], " of what it should be");
            CHECK(std::fabs(common[k] / squares[k] - 1) < 0.15);
            CHECK(squares[k] > 3);
        }
    });
}

TEST_CASE("second scores have the moments of a second derivative, whatever the cut")
{
    for (const float cut : { 1.0f, 2.0f, 3.0f }) {
        shared::AreaLight light {};
        light.profile = WEDGE_PROFILE_GAUSSIAN;
        light.cut = cut;
        light.halfU = shared::vec3(1, 0, 0);
        light.halfV = shared::vec3(0, 0, 1);
        const shared::LightMoments found = render::momentsOf(light);
        double mass = 0, zeroth = 0, second = 0;
        for (int i = 0; i < 20000; ++i) {
            const float a = (static_cast<float>(i) + 0.5f) / 10000.0f - 1.0f;
            const double l = shared::lightProfile(a, 0, light.profile, cut), q = shared::secondScoreOf(found, a);
            mass += l;
            zeroth += l * q;
            second += l * q * a * a;
        }
        CHECK(std::fabs(zeroth / mass) < 2e-3);
        CHECK(second / mass == doctest::Approx(2).epsilon(2e-3));
    }
}

TEST_CASE("slopes, ratios and widths are what their definitions make of them")
{
    onEveryDevice([](const device::Device& device) {
        for (const int radius : { 1, 2 }) {
            DeclaredFrame frame(device, smallScene(), sized(twoSlopes, 21, 9));
            const render::PlaneLayout& layout = frame.layout;
            const shared::AnalysisParams p = paramsOf(layout);
            Planes<float> slopes(layout, 2, 0.0f), logs(layout, 3, 0.0f), spread(layout, 3, 0.0f),
                beta(layout, 1, 0.0f);
            Planes<std::uint32_t> objectId(layout, 1, 0u);
            std::mt19937 random(6);
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 21; ++x) {
                    objectId.at(x, y) = x < 12 ? 1u : 2u;
                    const bool occluded = (x + 2 * y) % 3 != 0;
                    slopes.at(x, y) = occluded ? static_cast<float>(uniform(random, 0.1, 1)) : 0.0f;
                    slopes.at(x, y, 1) = slopes.at(x, y) * static_cast<float>(uniform(random, 1, 9));
                    logs.at(x, y) = occluded ? std::log2(slopes.at(x, y)) : 0.0f;
                    logs.at(x, y, 1) = occluded ? 1.0f : 0.0f;
                    spread.at(x, y, 1) = x > 17 ? 0.0f : static_cast<float>(uniform(random, 0.1, 3));
                    spread.at(x, y, 0) = -spread.at(x, y, 1);
                    spread.at(x, y, 2) =
                        spread.at(x, y, 0) + spread.at(x, y, 1) * static_cast<float>(uniform(random, -1, 3));
                    beta.at(x, y) = y == 0 ? -1.0f : 0.1f * static_cast<float>(y);
                }
            PassBench smooth(frame, "smoothLargest"), ratios(frame, "slopeRatios"), widen(frame, "widenBetweenSlopes"),
                slopeWidths(frame, "widthOfMeanSlope");
            smooth.value("radius", radius);
            smooth.plane("slopes", slopes);
            smooth.plane("objectId", objectId);
            smooth.plane("logSlopes", logs);
            ratios.plane("spread", spread);
            widen.plane("beta", beta);
            slopeWidths.plane("slopeWidth", beta);
            const auto run = [&](PassBench& pass, const PassBench& after) {
                pass.take(after);
                pass.value("p", p);
                pass.run();
            };
            run(smooth, smooth);
            run(ratios, smooth);
            run(widen, ratios);
            run(slopeWidths, ratios);
            const auto smoothed = smooth.pixels<float>("logSlopes"), ratio = ratios.pixels<float>("ratio"),
                       wider = widen.pixels<float>("beta"), ofMean = slopeWidths.pixels<float>("slopeWidth");
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 21; ++x) {
                    CAPTURE(x);
                    CAPTURE(y);
                    double sum = 0, count = 0;
                    for (int qy = std::max(0, y - radius); qy <= std::min(8, y + radius); ++qy)
                        for (int qx = std::max(0, x - radius); qx <= std::min(20, x + radius); ++qx)
                            if (slopes.at(qx, qy, 1) > 0 && objectId.at(qx, qy) == objectId.at(x, y)) {
                                sum += std::log2(slopes.at(qx, qy, 1));
                                ++count;
                            }
                    const bool has = logs.at(x, y, 1) > 0;
                    REQUIRE(smoothed.at(x, y, 2) == doctest::Approx(has ? sum / count : 0.0).epsilon(1e-3).scale(1));
                    const double own = smoothed.at(x, y, 2) - logs.at(x, y),
                                 near = spread.at(x, y, 1) > 0
                        ? (spread.at(x, y, 2) - spread.at(x, y)) / spread.at(x, y, 1)
                        : 0.0;
                    const double r = std::clamp(std::exp2(has ? own : near), 1.0, 4.0);
                    REQUIRE(ratio.at(x, y) == doctest::Approx(r).epsilon(0.005));
                    const double exact = ratio.at(x, y), mean = 2 * exact / (1 + exact);
                    const double between = exact > 1 ? std::min(mean, 0.6 * exact / (exact - 1)) : mean;
                    REQUIRE(wider.at(x, y) == doctest::Approx(y == 0 ? -1.0 : 0.1 * y * between).epsilon(1e-4));
                    const double before = shared::unpackShort(shared::packShort(beta.at(x, y)));
                    REQUIRE(ofMean.at(x, y) == doctest::Approx(before * mean / between).epsilon(0.005));
                }
        }
    });
}

TEST_CASE("moments become the factors of a polynomial")
{
    onEveryDevice([](const device::Device& device) {
        for (const std::uint32_t channels : { 1u, 2u }) {
            DeclaredFrame frame(device, channels == 2 ? glossyScene() : smallScene(), sized(twoSlopes, 19, 5));
            const render::PlaneLayout& layout = frame.layout;
            Planes<float> sums(layout, 2 * channels, 0.0f), moments(layout, 5 * channels, 0.0f);
            std::mt19937 random(2);
            for (float& v : moments.values)
                v = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random, -1, 1))));
            for (int y = 0; y < 5; ++y)
                for (int x = 1; x < 19; ++x) // pixels of the first column see nothing of the light
                    for (std::uint32_t c = 0; c < channels; ++c)
                        sums.at(x, y, 2 * c) = static_cast<float>(uniform(random, 1, 20));
            PassBench pass(frame, "shadowGradients");
            pass.plane("sums", sums);
            pass.plane("gradients", moments);
            pass.run();
            const auto found = pass.pixels<float>("gradients");
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 19; ++x)
                    for (std::uint32_t k = 0; k < 5 * channels; ++k) {
                        const double all = sums.at(x, y, 2 * (k / 5)), factor = k % 5 < 2 ? -0.625 : 0.125;
                        const double expected = all > 0 ? factor * moments.at(x, y, k) / all : 0.0;
                        REQUIRE(std::fabs(found.at(x, y, k) - expected) <= std::fabs(expected) / 250);
                    }
        }
    });
}
