// filter/components.cl alone, against the definition; what it filters: kernel_component_sums_test.
#include "effects/area_lights/maaf.h"
#include "kernels/shared/wedge.h"
#include "tests/component_basis.h"
#include "tests/filter_run.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Weights of a cosine and of a sine, mu of kernels/filter/components.cl: as printed, (10).
std::array<double, 2> printedWeights(int count, double bandwidth, int p, double sMin, double centre)
{
    const double x = centre * sMin / bandwidth, y = 2.0 * p / count, mu = std::exp(-0.5 * (x * x + y * y));
    return { mu, mu };
}

/// And refitted: from what fit_maaf.py wrote, whose rows are quarters of a power of two apart, of the weights of 1, of
/// the first cosine, of its sine, and so on.
std::array<double, 2> refittedWeights(int count, int p, double ratio)
{
    static const nlohmann::json all =
        nlohmann::json::parse(std::ifstream(WEDGE_KERNELS "/../benchmarks/spectra/maaf_weights.json"));
    const nlohmann::json& table = all["tables"][std::to_string(count)];
    const double row = 4 * std::log2(ratio);
    const auto below = static_cast<std::size_t>(row), above = below + 1;
    const auto at = [&](std::size_t k, std::size_t column) { return table[k]["weights"][column].get<double>(); };
    const auto between = [&](std::size_t column) {
        const double share = row - static_cast<double>(below);
        return share > 0 ? (1 - share) * at(below, column) + share * at(above, column) : at(below, column);
    };
    const auto pair = static_cast<std::size_t>(p);
    return { between(p > 0 ? 2 * pair - 1 : 0), between(2 * pair) };
}

/// c of kernels/filter/components.cl.
std::vector<double> coefficients(int count, double bandwidth, bool refitted, double sMin, double ratio, double d)
{
    const double sMax = sMin * ratio;
    std::vector<double> out;
    for (int p = 0; 2 * p < count; ++p) {
        const double inner = (2 * p - 1) / (count * sMax), outer = (2 * p + 1) / (count * sMin);
        const double centre = p > 0 ? 0.5 * bandwidth * (inner + outer) : 0.0;
        const double extent = p > 0 ? 0.5 * bandwidth * (outer - inner) : bandwidth / (count * sMin);
        const auto [cosine, sine] =
            refitted ? refittedWeights(count, p, ratio) : printedWeights(count, bandwidth, p, sMin, centre);
        const double g = extent * std::exp(-0.5 * extent * extent * d * d);
        if (p == 0) {
            out.push_back(cosine * g);
            continue;
        }
        out.push_back(2 * cosine * g * std::cos(centre * d));
        out.push_back(-2 * sine * g * std::sin(centre * d));
    }
    return out;
}

/// A filter's image, and what components there are of its pixels.
struct ComponentImage {
    ComponentImage(const FilterImage& base, int components)
        : image(base)
        , count(components)
        , channels(base.value.values.size() / base.value.layout.size)
        , ratio(base.value.layout, 1, 1.0f)
        , sums(base.value.layout, 2 * channels, 0.0f)
        , sinks(base.value.layout, channels * static_cast<std::size_t>(2 * components * components), 0.0f)
    {
        axes.bandwidth = components == 1 ? 1.0f : 2.0f;
        axes.centre = base.params.lightCentre;
        // Along the light, 0.5 and 0.4 m a standard deviation.
        const glm::dvec3 n = toGlm(base.params.lightNormal), u = glm::normalize(glm::cross(n, glm::dvec3(0.2, 0, 1)));
        axes.alongU = toVec3(u / 0.5);
        axes.alongV = toVec3(glm::cross(n, u) / 0.4);
    }
    std::size_t products() const { return static_cast<std::size_t>(count) * static_cast<std::size_t>(count); }

    FilterImage image;
    int count;
    std::size_t channels;
    shared::LightAxes axes {};
    float slopesPerWidth = 2.0f, floorPerPixel = 2.0f; ///< 1/m: of a light of sigma 0.5 m, k mu = alpha = 1
    bool refitted = false;
    Planes<float> ratio, sums, sinks; ///< kernels have 16 bits of ratios and sinks
};

/// What samples see: `value` of the light by lot, or of its side of lesser v.
enum class Sees { ByLot, AlongV };

/// Samples at random.
ComponentImage randomComponents(const FilterImage& base, int components, Sees sees = Sees::ByLot)
{
    ComponentImage out(base, components);
    std::mt19937 random(3);
    for (int y = 0; y < base.height(); ++y)
        for (int x = 0; x < base.width(); ++x) {
            out.ratio.at(x, y) = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random, 1, 4))));
            for (std::size_t channel = 0; channel < out.channels; ++channel) {
                double all = 0, seen = 0;
                std::vector<double> products(2 * out.products());
                for (int sample = 0; sample < 9; ++sample) {
                    const double u = uniform(random, -2, 2), v = uniform(random, -2, 2),
                                 weight = uniform(random, 0.5, 1.5);
                    const double lot = sees == Sees::ByLot ? uniform(random) : 0.5 + 0.25 * v;
                    const bool visible = lot < base.value.at(x, y, channel);
                    all += weight;
                    seen += visible ? weight : 0.0;
                    for (int i = 0; i < components; ++i)
                        for (int k = 0; k < components; ++k) {
                            const double b = basis(components, out.axes.bandwidth, i, u)
                                * basis(components, out.axes.bandwidth, k, v) * std::exp(0.5 * (u * u + v * v));
                            const std::size_t at = static_cast<std::size_t>(i) * static_cast<std::size_t>(components)
                                + static_cast<std::size_t>(k);
                            products[at] += weight * b;
                            products[at + out.products()] += visible ? weight * b : 0.0;
                        }
                }
                out.sums.at(x, y, 2 * channel) = static_cast<float>(all);
                out.sums.at(x, y, 2 * channel + 1) = static_cast<float>(seen);
                out.image.value.at(x, y, channel) = static_cast<float>(seen / all);
                for (std::size_t k = 0; k < products.size(); ++k)
                    out.sinks.at(x, y, 2 * channel * out.products() + k) =
                        shared::unpackShort(shared::packShort(static_cast<float>(products[k])));
            }
        }
    return out;
}

/// parts: what pairs of components have of the first channel, if they are asked for
FilterResult filterBoth(render::Renderer& renderer, const ComponentImage& in, Planes<float>* parts = nullptr)
{
    using namespace render;
    const FilterImage& image = in.image;
    FilterGraph declared(renderer, image, false);
    declared.settings.components = in.count;
    declared.settings.maaf = in.refitted ? Maaf::Refitted : Maaf::Printed;
    const auto pairs = static_cast<std::uint32_t>(in.count + 1) / 2;
    auto ofPairs = declared.there<Value>("pairs", graph::floatPlanes(pairs * pairs));
    Gathered out = filteredPlanes(declared.builder, declared.channels);
    componentFilter(declared.builder, image.params, paramsOf(image.value.layout),
        deviceLight(renderer.scene().areaLights[0]),
        declared.there<Value>("value", graph::floatPlanes(declared.channels)),
        declared.there<Metres>("beta", graph::floats),
        { declared.there<Sums>("sums", graph::floatPlanes(2 * declared.channels)),
            declared.there<Value>("components", componentsFormat(in.count, declared.channels)),
            declared.there<Metres>("slopeWidth", shortFloats), declared.there<Share>("ratio", shortFloats) },
        out, parts != nullptr ? &ofPairs : nullptr);
    PassBench pass = passOf(renderer, declared, "filterComponents", image);
    pass.value("light", in.axes);
    pass.value("slopesPerWidth", in.slopesPerWidth);
    pass.value("floorPerPixel", in.floorPerPixel);
    pass.plane("value", image.value);
    pass.plane("slopeWidth", image.slopeWidth);
    pass.plane("ratio", in.ratio);
    pass.plane("sums", in.sums);
    pass.plane("components", in.sinks);
    if (parts != nullptr)
        pass.plane("parts", std::vector(pass.read<float>("parts").size(), -7.0f));
    pass.run();
    if (parts != nullptr)
        *parts = pass.pixels<float>("parts");
    return { pass.pixels<float>("filtered"), pass.pixels<float>("effective") };
}

Planes<float> filtered(render::Renderer& renderer, const ComponentImage& in) { return filterBoth(renderer, in).value; }

/// What 16 bits keep of the width of slope s under that light, where a pixel is so large.
float slopeWidthOf(double s, float pixelSize)
{
    return shared::unpackShort(
        shared::packShort(shared::filterWidth(static_cast<float>(s), 0.5f, pixelSize, 1.0f, 1.0f, 1.0f)));
}

/// A floor on which most filters are about a tenth of a metre wide, and pixels smaller.
FilterImage wideFilters(Shape shape, std::size_t channels = 1)
{
    FilterImage image = randomImage(37, 21, shape, 7, channels);
    image.params.most = 1.0f;
    image.params.maxRadius = 12;
    std::mt19937 random(9);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            image.beta.at(x, y) = x % 11 == 3 ? 0.0f : 0.1f;
            image.pixelSize.at(x, y) = y == 4 ? 1.0f : 0.05f + 0.01f * static_cast<float>(x % 2);
            image.slopeWidth.at(x, y) = slopeWidthOf(uniform(random, 0.11, 0.24), image.pixelSize.at(x, y));
        }
    return image;
}

/// What the filter in double makes of a pixel's channel. doubt: a rounding may decide what is gathered.
struct Expected {
    double value = 0, count = 1;
    bool doubt = false;
    std::vector<double> parts; ///< by pairs of components along u and v
};

Expected oracle(const ComponentImage& in, int x, int y, std::size_t channel = 0)
{
    const FilterImage& image = in.image;
    const shared::FilterParams& p = image.params;
    const double width = image.slopeWidth.at(x, y);
    const double sMin = width * in.slopesPerWidth, ratio = in.ratio.at(x, y), sMax = sMin * ratio,
                 bandwidth = in.axes.bandwidth;
    const double above = sMin / ((1 + sMin) * in.floorPerPixel * image.pixelSize.at(x, y));
    const auto pairs = static_cast<std::size_t>(in.count + 1) / 2;
    Expected own { image.value.at(x, y, channel), 1, std::fabs(above - 1.05) < 1e-4, {} };
    own.parts.assign(pairs * pairs, 0.0);
    own.parts[0] = own.value;
    if (!(image.beta.at(x, y) > 0) || image.objectId.at(x, y) == 0 || above <= 1.05)
        return own;
    const GatherGeometry geometry(image, x, y);
    const std::size_t first = 2 * channel * in.products();
    double widest = in.count * sMin / bandwidth;
    for (int q = 1; 2 * q < in.count; ++q)
        widest = std::max(widest, 2 * in.count / (bandwidth * ((2 * q + 1) / sMin - (2 * q - 1) / sMax)));
    double seen = 0, all = 0, size = 0, squares = 0;
    std::vector<double> parts(pairs * pairs, 0.0);
    bool doubt = own.doubt;
    const int radius = static_cast<int>(p.maxRadius);
    for (int qy = std::max(0, y - radius); qy <= std::min(image.height() - 1, y + radius); ++qy)
        for (int qx = std::max(0, x - radius); qx <= std::min(image.width() - 1, x + radius); ++qx) {
            const double facing = glm::dot(image.normal.vector(x, y), image.normal.vector(qx, qy));
            if (image.objectId.at(qx, qy) != image.objectId.at(x, y) || !(image.beta.at(qx, qy) >= 0))
                continue;
            doubt |= std::fabs(facing - p.normalCosine) < 1e-5;
            const double area = geometry.surface(x, y, qx, qy, &doubt);
            if (facing < p.normalCosine || area == 0)
                continue;
            const glm::dvec3 offset = geometry.offset(image.position.vector(qx, qy) - image.position.vector(x, y));
            const double there = image.slopeWidth.at(qx, qy);
            const double closer = image.beta.at(qx, qy) > 0 && there < width && p.narrower != 0 ? width / there : 1.0;
            const double u = closer * glm::dot(offset, toGlm(in.axes.alongU)),
                         v = closer * glm::dot(offset, toGlm(in.axes.alongV));
            const double distance = std::hypot(u, v) / (p.cut * widest);
            doubt |= std::fabs(distance - 1) < 1e-4;
            if (distance > 1)
                continue;
            const std::vector<double> ofU = coefficients(in.count, bandwidth, in.refitted, sMin, ratio, u),
                                      ofV = coefficients(in.count, bandwidth, in.refitted, sMin, ratio, v);
            const double perSample = area / in.sums.at(qx, qy, 2 * channel);
            double ofAll = 0, ofSeen = 0;
            for (int i = 0; i < in.count; ++i)
                for (int k = 0; k < in.count; ++k) {
                    const std::size_t plane = first + static_cast<std::size_t>(i) * static_cast<std::size_t>(in.count)
                        + static_cast<std::size_t>(k);
                    const double c = ofU[static_cast<std::size_t>(i)] * ofV[static_cast<std::size_t>(k)];
                    ofAll += c * in.sinks.at(qx, qy, plane);
                    const double part = c * in.sinks.at(qx, qy, plane + in.products());
                    ofSeen += part;
                    parts[static_cast<std::size_t>((i + 1) / 2) * pairs + static_cast<std::size_t>((k + 1) / 2)] +=
                        perSample * part;
                }
            all += perSample * ofAll;
            seen += perSample * ofSeen;
            size += perSample * std::fabs(ofAll);
            squares += perSample * ofAll * perSample * ofAll;
        }
    doubt |= std::fabs(all / size - 0.05) < 1e-3;
    const bool known = all > 0.05 * size;
    for (double& part : parts)
        part /= all;
    return { known ? std::clamp(seen / all, 0.0, 1.0) : own.value, known ? all * all / squares : 1.0, doubt,
        known ? parts : own.parts };
}

/// Holds what the device makes of it against the definition.
void checkAgainstOracle(render::Renderer& renderer, const ComponentImage& in)
{
    Planes<float> parts(in.image.value.layout, 1, 0.0f);
    const FilterResult found = filterBoth(renderer, in, &parts);
    for (std::size_t channel = 0; channel < in.channels; ++channel) {
        CAPTURE(channel);
        int wrong = 0, left = 0, changed = 0;
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x) {
                const Expected expected = oracle(in, x, y, channel);
                const float value = found.value.at(x, y, channel), count = found.effective.at(x, y);
                left += expected.doubt ? 1 : 0;
                changed += value != in.image.value.at(x, y, channel) ? 1 : 0;
                bool fits = std::fabs(value - expected.value) <= 2e-3
                    && (channel > 0 || std::fabs(count / expected.count - 1) <= 1e-2);
                for (std::size_t k = 0; channel == 0 && k < expected.parts.size(); ++k)
                    fits &=
                        std::fabs(parts.at(x, y, k) - expected.parts[k]) <= 2e-3 * (1 + std::fabs(expected.parts[k]));
                if (!expected.doubt && !fits && ++wrong <= 3)
                    CHECK_MESSAGE(false,
                        x << "," << y << ": " << value << " of " << count << " and not " << expected.value << " of "
                          << expected.count);
            }
        CHECK(wrong == 0);
        CHECK(left < 100);
        CHECK(changed > 400);
    }
}

} // namespace

TEST_CASE("the filter of components is what its definition in double is")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        for (const bool refitted : { false, true })
            for (const int count : { 1, 3, 5, 7 })
                for (const Shape shape : { Shape::Flat, Shape::Steps, Shape::Tilted })
                    for (const Sees sees : { Sees::ByLot, Sees::AlongV }) {
                        if (refitted && count == 1)
                            continue; // one weight is none
                        CAPTURE(refitted);
                        CAPTURE(count);
                        CAPTURE(static_cast<int>(shape));
                        CAPTURE(static_cast<int>(sees));
                        ComponentImage in = randomComponents(wideFilters(shape), count, sees);
                        in.refitted = refitted;
                        checkAgainstOracle(renderer, in);
                    }
    });
}

TEST_CASE("and so are both numbers of pixels that lobes reflect, too")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(glossyScene(), device, renderOptions());
        for (const bool refitted : { false, true })
            for (const int count : { 3, 5 }) {
                CAPTURE(refitted);
                CAPTURE(count);
                ComponentImage in = randomComponents(wideFilters(Shape::Steps, 2), count, Sees::AlongV);
                in.refitted = refitted;
                checkAgainstOracle(renderer, in);
            }
    });
}

TEST_CASE("nothing is gathered where a deviation of the light spans less than a pixel in shadows")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        FilterImage base = wideFilters(Shape::Flat);
        Planes<float> slope(base.value.layout, 1, 0.0f);
        std::mt19937 random(12);
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x) {
                base.beta.at(x, y) = 0.1f;
                slope.at(x, y) = static_cast<float>(std::exp2(uniform(random, -5, -1)));
                base.slopeWidth.at(x, y) = slopeWidthOf(slope.at(x, y), base.pixelSize.at(x, y));
            }
        const ComponentImage in = randomComponents(base, 3);
        const FilterResult found = filterBoth(renderer, in);
        int narrow = 0, wide = 0;
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x) {
                // 0.5 m of light are 0.5 s of shadow, before which occluders are 1 + s times a pixel small.
                const double s = slope.at(x, y), pixels = 0.5 * s / ((1 + s) * base.pixelSize.at(x, y));
                CAPTURE(pixels);
                if (pixels < 1) {
                    REQUIRE(found.value.at(x, y) == in.image.value.at(x, y));
                    REQUIRE(found.effective.at(x, y) == 1.0f);
                    ++narrow;
                } else if (pixels > 1.06) {
                    REQUIRE(found.effective.at(x, y) > 1.0f);
                    ++wide;
                }
            }
        CHECK(narrow > 100);
        CHECK(wide > 100);
    });
}

TEST_CASE("what is the same everywhere stays so, whatever the samples and the neighbours that are left out")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        for (const int count : { 3, 5, 7 })
            for (const float value : { 0.0f, 0.5f, 1.0f })
                for (const Shape shape : { Shape::Steps, Shape::Rough }) {
                    ComponentImage in = randomComponents(wideFilters(shape), count);
                    for (int y = 0; y < in.image.height(); ++y)
                        for (int x = 0; x < in.image.width(); ++x) {
                            in.image.value.at(x, y) = value;
                            for (std::size_t k = 0; k < in.products(); ++k)
                                in.sinks.at(x, y, k + in.products()) = value * in.sinks.at(x, y, k);
                        }
                    const Planes<float> found = filtered(renderer, in);
                    for (int y = 0; y < in.image.height(); ++y)
                        for (int x = 0; x < in.image.width(); ++x)
                            REQUIRE(found.at(x, y) == doctest::Approx(value).epsilon(1e-5));
                }
    });
}

TEST_CASE("one component is the axis-aligned filter of the same width")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        FilterImage base = wideFilters(Shape::Steps);
        base.params.narrower = 0;
        base.params.surface = 0;
        base.params.cut = 4;
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x) {
                base.beta.at(x, y) = base.slopeWidth.at(x, y) = 0.125f;
                base.pixelSize.at(x, y) = 0.05f;
            }
        ComponentImage in = randomComponents(base, 1);
        const double sigma = 0.4; // of both axes
        in.axes.alongU = shared::vecScale(in.axes.alongU, 0.5f / 0.4f);
        in.slopesPerWidth = in.floorPerPixel = static_cast<float>(1 / sigma); // widths of sigma s
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x) {
                // Binary fractions, of which 16 bits lose nothing.
                in.image.value.at(x, y) = static_cast<float>((7 * x + 3 * y) % 17) / 16.0f;
                in.sums.at(x, y, 0) = in.sinks.at(x, y, 0) = 8.0f;
                in.sums.at(x, y, 1) = in.sinks.at(x, y, 1) = 8.0f * in.image.value.at(x, y);
            }
        const Planes<float> found = filtered(renderer, in);
        const std::vector<double> expected = oracleSquare(in.image);
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x)
                REQUIRE(found.at(x, y)
                    == doctest::Approx(expected[static_cast<std::size_t>(y * base.width() + x)]).epsilon(1e-3));
    });
}

TEST_CASE("a component and its mirror image are one: turning both the light's axes and the ways around changes nothing")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        ComponentImage in = randomComponents(wideFilters(Shape::Tilted), 5);
        const Planes<float> found = filtered(renderer, in);
        in.axes.alongU = shared::vecScale(in.axes.alongU, -1.0f);
        for (std::size_t i = 2; i < 5; i += 2) // sines along u
            for (std::size_t k = 0; k < 5; ++k)
                for (int y = 0; y < in.image.height(); ++y)
                    for (int x = 0; x < in.image.width(); ++x)
                        for (const std::size_t part : { std::size_t { 0 }, in.products() })
                            in.sinks.at(x, y, part + 5 * i + k) *= -1.0f;
        const Planes<float> turned = filtered(renderer, in);
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x)
                REQUIRE(found.at(x, y) == doctest::Approx(turned.at(x, y)).epsilon(1e-5));
    });
}
