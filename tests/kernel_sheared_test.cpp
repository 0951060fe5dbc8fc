// filter.cl and shear.cl alone: gathers that follow gradients, gradients of samples, widths by counts and
// blurs.
#include "effects/area_lights/soft_shadows.h"
#include "host/render/filters/filter_graph.h"
#include "tests/filter_run.h"
#include "tests/trace_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

/// A floor of 5 cm pixels seen from above with a share of light h = 0.5 + a x^2 + b x z + c z^2 and its gradients,
/// where filters are 2 to 3 pixels wide.
FilterImage curvedField(double a, double b, double c)
{
    FilterImage image = withoutLight(randomImage(41, 33, Shape::Flat, 3));
    image.params.fitted = 1;
    image.params.most = 1.0f;
    image.params.shearU = shared::vec3(0.5f, 0, 0);
    image.params.shearV = shared::vec3(0, 0, 0.5f);
    image.gradients.emplace(image.value.layout, 2, 0.0f);
    for (int y = 0; y < image.height(); ++y)
        for (int i = 0; i < image.width(); ++i) {
            const double x = 0.05 * (i - 20), z = 0.05 * (y - 16);
            image.position.setVector(i, y, { x, 0, z });
            image.normal.setVector(i, y, { 0, 1, 0 });
            image.pixelSize.at(i, y) = 0.05f;
            image.beta.at(i, y) = 0.1f + 0.001f * static_cast<float>(i);
            image.value.at(i, y) = static_cast<float>(0.5 + a * x * x + b * x * z + c * z * z);
            image.gradients->at(i, y, 0) = static_cast<float>(2 * a * x + b * z);
            image.gradients->at(i, y, 1) = static_cast<float>(b * x + 2 * c * z);
        }
    return image;
}

/// The largest difference to the field that was filtered, of pixels `margin` away from the borders.
double worst(const FilterImage& image, const FilterResult& result, int margin)
{
    double out = 0;
    for (int y = margin; y < image.height() - margin; ++y)
        for (int x = margin; x < image.width() - margin; ++x)
            out = std::max<double>(out, std::fabs(result.value.at(x, y) - image.value.at(x, y)));
    return out;
}

} // namespace

TEST_CASE("a field of second order comes out as it is, and filters without its gradients flatten it")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = curvedField(0.2, -0.15, 0.3);
        const FilterResult result = filter(image);
        const double inside = worst(image, result, 8), anywhere = worst(image, result, 0);
        image.gradients.reset();
        const FilterResult other = filter(image);
        MESSAGE("off by up to ", inside, ", at borders ", anywhere, "; without gradients ", worst(image, other, 8));
        CHECK(worst(image, other, 8) > 3e-3);
        CHECK(inside < 1e-4);
        CHECK(anywhere < worst(image, other, 0)); // one-sided kernels see gradients elsewhere
    });
}

TEST_CASE("both passes gather what their definition in double gathers, by first derivatives and by second ones")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const auto& [channels, moments] :
            { std::pair<std::size_t, std::size_t>(1, 2), { 2, 2 }, { 1, 5 }, { 2, 5 } }) {
            double left = 0;
            unsigned images = 0;
            for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough })
                for (const std::uint32_t fitted : { 0u, 2u }) {
                    FilterImage image = randomImage(37, 21, shape, 11 + fitted, channels);
                    image.params.fitted = std::min<std::uint32_t>(fitted, static_cast<std::uint32_t>(channels));
                    image.params.shearU = shared::vec3(0.02f, 0.003f, -0.001f);
                    image.params.shearV = shared::vec3(-0.004f, 0.001f, 0.017f);
                    image.moments = moments;
                    image.gradients.emplace(image.value.layout, moments * channels, 0.0f);
                    std::mt19937 random(5);
                    for (float& g : image.gradients->values)
                        g = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random, -1, 1))));
                    for (float& w : image.slopeWidth.values)
                        w = static_cast<float>(uniform(random, 0.03, 0.3));
                    CAPTURE(image.moments);
                    CAPTURE(static_cast<int>(shape));
                    CAPTURE(fitted);
                    const OracleResult rows = oracleRows(image);
                    left += compare(image, filter(image, true), rows, static_cast<int>(channels));
                    left += compare(image, filter(image), oracleColumns(image, rows), static_cast<int>(channels));
                    images += 2;
                }
            CHECK(left / images < 0.1);
        }
    });
}

TEST_CASE("without gradients the filter is the other one, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const Shape shape : { Shape::Tilted, Shape::Steps, Shape::Rough }) {
            FilterImage image = randomImage(50, 19, shape, 7);
            image.params.fitted = 1;
            const FilterResult expected = filter(image);
            image.gradients.emplace(image.value.layout, 2, 0.0f);
            const FilterResult result = filter(image);
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) {
                    REQUIRE(result.value.at(x, y) == expected.value.at(x, y));
                    REQUIRE(result.effective.at(x, y) == expected.effective.at(x, y));
                }
        }
    });
}

TEST_CASE("NaN of gradients that are not gathered stays there")
{
    onEveryDevice([](const device::Device& device) { checkThatNaNStays(device, curvedField(0.2, 0.1, 0.1)); });
}

TEST_CASE("gradients that samples tell are how what is seen changes where the light moves")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 40, 30);
        // Gaussian, and cut where its ends are next to nothing.
        shared::AreaLight light = traced.light(0);
        light.cut = 3;
        light.erfCut = static_cast<float>(std::erf(light.cut / std::sqrt(2.0)));
        shared::SampleParams params {};
        params.shading = WEDGE_SHADING_RATIO;
        params.sampler = WEDGE_SAMPLER_SOBOL;
        const auto sampled = [&](const shared::AreaLight& at) {
            Samples samples(traced, "sampleShadows", "second pass");
            samples.value("params", params);
            samples.value("light", at);
            samples.value("score", render::scoreOf(at).score);
            for (const std::uint32_t last : { 1024u, 4096u })
                samples.upTo(last, 4096);
            return samples;
        };
        const auto seen = [&](const shared::AreaLight& at) { return sampled(at).pixels<float>("sums"); };
        const Samples own = sampled(light);
        const auto sums = own.pixels<float>("sums"), found = own.pixels<float>("gradients");
        for (const std::size_t axis : { 0u, 1u }) {
            constexpr float step = 0.1f; // of local coordinates
            shared::AreaLight before = light, after = light;
            const shared::Vec3 way = vecScale(axis == 0 ? light.halfU : light.halfV, step);
            before.centre = vecSub(light.centre, way);
            after.centre = vecAdd(light.centre, way);
            const Planes<float> less = seen(before), more = seen(after);
            double off = 0, all = 0;
            traced.everyPixel([&](int x, int y) {
                if (!(sums.at(x, y) > 0 && less.at(x, y) > 0 && more.at(x, y) > 0))
                    return;
                const auto share = [&](const Planes<float>& of) { return of.at(x, y, 1) / of.at(x, y); };
                const double expected = (share(more) - share(less)) / (2 * step);
                off += std::fabs(found.at(x, y, axis) / sums.at(x, y) - expected);
                all += std::fabs(expected);
            });
            MESSAGE("gradients are off by ", off / all, " of what they add up to, ", all);
            CHECK(off < 0.1 * all);
            CHECK(all > 20);
        }
    });
}

TEST_CASE("gradients are means of what samples add up to, and widths follow counts and how wide shadows are")
{
    onEveryDevice([](const device::Device& device) {
        for (const std::uint32_t channels : { 1u, 2u }) {
            DeclaredFrame frame(
                device, channels == 2 ? glossyScene() : smallScene(), sized(render::axisAligned(16), 19, 5));
            const render::PlaneLayout& layout = frame.layout;
            shared::AnalysisParams p = paramsOf(layout);
            p.k = 3;
            p.mu = 1.5f;
            Planes<float> sums(layout, 2 * channels, 0.0f), scores(layout, 2 * channels, 0.0f), beta(layout, 1, 0.0f);
            Planes<std::uint32_t> taken(layout, 1, 0u);
            Planes<float> size(layout, 1, 0.0f);
            std::mt19937 random(2);
            for (float& v : scores.values)
                v = static_cast<float>(uniform(random, -1, 1));
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 19; ++x) {
                    for (std::uint32_t c = 0; c < channels; ++c) {
                        // Pixels of the first column see nothing of the light.
                        sums.at(x, y, 2 * c) = x == 0 ? 0.0f : static_cast<float>(uniform(random, 1, 20));
                        sums.at(x, y, 2 * c + 1) = sums.at(x, y, 2 * c) * static_cast<float>(uniform(random));
                    }
                    beta.at(x, y) = x % 3 == 0 ? -1.0f : 0.1f * static_cast<float>(y);
                    taken.at(x, y) = static_cast<std::uint32_t>(x);
                    // Blurs of 2, and of 48 to 120 pixels.
                    size.at(x, y) = p.k * p.mu * 0.1f * static_cast<float>(y)
                        / (x % 2 == 0 ? 2.0f : 24.0f * static_cast<float>(y + 1));
                }
            PassBench gradients(frame, "shadowGradients"), narrow(frame, "narrowSheared");
            gradients.value("p", p);
            gradients.plane("sums", sums);
            gradients.plane("gradients", scores);
            gradients.run();
            narrow.value("p", p);
            narrow.value("mean", 28.0f);
            narrow.value("countPower", 0.2f);
            narrow.value("wideBlur", 12.0f);
            narrow.value("blurPower", 0.4f);
            narrow.plane("taken", taken);
            narrow.plane("pixelSize", size);
            narrow.plane("beta", beta);
            narrow.run();
            const auto found = gradients.pixels<float>("gradients"), before = narrow.pixels<float>("slopeWidth"),
                       after = narrow.pixels<float>("beta");
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 19; ++x) {
                    for (std::uint32_t c = 0; c < channels; ++c)
                        for (std::uint32_t axis = 0; axis < 2; ++axis) {
                            const double score = shared::unpackShort(shared::packShort(scores.at(x, y, 2 * c + axis)));
                            const double expected = x == 0 ? 0.0 : score / sums.at(x, y, 2 * c);
                            REQUIRE(std::fabs(found.at(x, y, 2 * c + axis) - expected) <= std::fabs(expected) / 256);
                        }
                    REQUIRE(before.at(x, y) == shared::unpackShort(shared::packShort(beta.at(x, y))));
                    const double blur = x % 2 == 0 ? 2.0 : 24.0 * (y + 1);
                    const double expected = beta.at(x, y) > 0 ? beta.at(x, y) * std::pow(28.0 / std::max(1, x), 0.2)
                            * std::min(1.0, std::pow(12.0 / blur, 0.4))
                                                              : beta.at(x, y);
                    REQUIRE(after.at(x, y) == doctest::Approx(expected).epsilon(1e-5));
                }
        }
    });
}
