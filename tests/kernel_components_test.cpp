// light/components.h and filter_components*.cl alone: what samples add up to, and the filter against its definition.
#include "effects/area_lights/maaf.h"
#include "tests/filter_oracle.h"
#include "tests/trace_support.h"

#include <array>

using namespace wedge;
using namespace wedge::test;

namespace {

/// B_i of kernels/light/components.h.
double basis(int count, double bandwidth, int i, double y)
{
    const int pair = (i + 1) / 2;
    const double extent = bandwidth / count, angle = 2 * pair * extent * y;
    return std::exp(-0.5 * extent * extent * y * y) * (i == 0 ? 1.0 : i % 2 == 1 ? std::cos(angle) : std::sin(angle));
}

/// c of kernels/filter/components.h, as printed.
std::vector<double> coefficients(int count, double bandwidth, double sMin, double sMax, double d)
{
    std::vector<double> out;
    for (int p = 0; 2 * p < count; ++p) {
        const double inner = (2 * p - 1) / (count * sMax), outer = (2 * p + 1) / (count * sMin);
        const double centre = p > 0 ? 0.5 * bandwidth * (inner + outer) : 0.0;
        const double extent = p > 0 ? 0.5 * bandwidth * (outer - inner) : bandwidth / (count * sMin);
        const double x = centre * sMin / bandwidth, y = 2.0 * p / count;
        const double g = std::exp(-0.5 * (x * x + y * y)) * extent * std::exp(-0.5 * extent * extent * d * d);
        if (p == 0) {
            out.push_back(g);
            continue;
        }
        out.push_back(2 * g * std::cos(centre * d));
        out.push_back(-2 * g * std::sin(centre * d));
    }
    return out;
}

/// A filter's image, and what components there are of its pixels; channels: 1.
struct ComponentImage {
    ComponentImage(const FilterImage& base, int components)
        : image(base)
        , count(components)
        , ratio(base.value.layout, 1, 1.0f)
        , sums(base.value.layout, 2, 0.0f)
        , sinks(base.value.layout, static_cast<std::size_t>(2 * components * components), 0.0f)
    {
        axes.bandwidth = components == 1 ? 1.0f : 2.0f;
        axes.centre = base.params.lightCentre;
        // Along the light, 0.5 and 0.4 m a standard deviation.
        const glm::dvec3 n = toGlm(base.params.lightNormal), u = glm::normalize(glm::cross(n, glm::dvec3(0.2, 0, 1)));
        axes.alongU = toShared(u / 0.5);
        axes.alongV = toShared(glm::cross(n, u) / 0.4);
    }
    std::size_t products() const { return static_cast<std::size_t>(count) * static_cast<std::size_t>(count); }

    FilterImage image;
    int count;
    shared::LightAxes axes {};
    float slopesPerWidth = 2.0f; ///< 1/m
    Planes<float> ratio, sums, sinks; ///< kernels have 16 bits of ratios and sinks
};

/// Samples at random that see `value` of the light.
ComponentImage randomComponents(const FilterImage& base, int components)
{
    ComponentImage out(base, components);
    std::mt19937 random(3);
    for (int y = 0; y < base.height(); ++y)
        for (int x = 0; x < base.width(); ++x) {
            out.ratio.at(x, y) = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random, 1, 4))));
            double all = 0, seen = 0;
            std::vector<double> products(2 * out.products());
            for (int sample = 0; sample < 9; ++sample) {
                const double u = uniform(random, -2, 2), v = uniform(random, -2, 2), weight = uniform(random, 0.5, 1.5);
                const bool visible = uniform(random) < base.value.at(x, y);
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
            out.sums.at(x, y, 0) = static_cast<float>(all);
            out.sums.at(x, y, 1) = static_cast<float>(seen);
            out.image.value.at(x, y) = static_cast<float>(seen / all);
            for (std::size_t k = 0; k < products.size(); ++k)
                out.sinks.at(x, y, k) = shared::unpackShort(shared::packShort(static_cast<float>(products[k])));
        }
    return out;
}

Planes<float> filtered(KernelBench& bench, const ComponentImage& in)
{
    const FilterImage& image = in.image;
    const auto out = bench.filled(image.value.layout.size, -7.0f), effective = bench.filled(out.size(), -7.0f);
    bench.passes.rows("filter", device::PassKind::Filter, "filter/filter_components" + std::to_string(in.count) + ".cl",
        "filterComponents", image.params, WEDGE_BLOCK_PIXELS, in.axes, in.slopesPerWidth, 0u,
        bench.buffer(image.value.values), bench.buffer(image.beta.values), bench.buffer(inShorts(image.slopeWidth)),
        bench.buffer(inShorts(in.ratio)), bench.buffer(image.position.values), bench.buffer(image.normal.values),
        bench.buffer(image.pixelSize.values), bench.buffer(image.objectId.values), bench.buffer(in.sums.values),
        bench.buffer(inShorts(in.sinks)), out, effective);
    return planesOf(image.value.layout, bench.read(out));
}

/// A floor on which all filters are about a tenth of a metre wide, and pixels smaller.
FilterImage wideFilters(Shape shape)
{
    FilterImage image = randomImage(37, 21, shape, 7);
    image.params.most = 1.0f;
    image.params.maxRadius = 12;
    std::mt19937 random(9);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const auto width = static_cast<float>(uniform(random, 0.07, 0.12));
            image.beta.at(x, y) = x % 11 == 3 ? 0.0f : 0.1f;
            image.slopeWidth.at(x, y) = shared::unpackShort(shared::packShort(width));
            image.pixelSize.at(x, y) = y == 4 ? 1.0f : 0.05f + 0.01f * static_cast<float>(x % 2);
        }
    return image;
}

/// The filter in double; -1 where a rounding may decide what is gathered.
double oracle(const ComponentImage& in, int x, int y)
{
    const FilterImage& image = in.image;
    const shared::FilterParams& p = image.params;
    const double width = image.slopeWidth.at(x, y);
    if (!(image.beta.at(x, y) > 0) || image.objectId.at(x, y) == 0
        || 0.5 * width * in.slopesPerWidth < image.pixelSize.at(x, y))
        return image.value.at(x, y);
    const GatherGeometry geometry(image, x, y);
    const double sMin = width * in.slopesPerWidth, sMax = sMin * in.ratio.at(x, y), bandwidth = in.axes.bandwidth;
    double widest = in.count * sMin / bandwidth;
    for (int q = 1; 2 * q < in.count; ++q)
        widest = std::max(widest, 2 * in.count / (bandwidth * ((2 * q + 1) / sMin - (2 * q - 1) / sMax)));
    double seen = 0, all = 0, size = 0;
    bool doubt = false;
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
            const std::vector<double> ofU = coefficients(in.count, bandwidth, sMin, sMax, u),
                                      ofV = coefficients(in.count, bandwidth, sMin, sMax, v);
            double ofAll = 0, ofSeen = 0;
            for (int i = 0; i < in.count; ++i)
                for (int k = 0; k < in.count; ++k) {
                    const std::size_t plane =
                        static_cast<std::size_t>(i) * static_cast<std::size_t>(in.count) + static_cast<std::size_t>(k);
                    const double c = ofU[static_cast<std::size_t>(i)] * ofV[static_cast<std::size_t>(k)];
                    ofAll += c * in.sinks.at(qx, qy, plane);
                    ofSeen += c * in.sinks.at(qx, qy, plane + in.products());
                }
            all += area * ofAll / in.sums.at(qx, qy);
            seen += area * ofSeen / in.sums.at(qx, qy);
            size += area * std::fabs(ofAll) / in.sums.at(qx, qy);
        }
    doubt |= std::fabs(all / size - 0.05) < 1e-3;
    return doubt ? -1.0 : all > 0.05 * size ? std::clamp(seen / all, 0.0, 1.0) : image.value.at(x, y);
}

} // namespace

TEST_CASE("the filter of components is what its definition in double is")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const int count : { 1, 3, 5, 7 })
            for (const Shape shape : { Shape::Flat, Shape::Steps, Shape::Tilted }) {
                CAPTURE(count);
                CAPTURE(static_cast<int>(shape));
                const ComponentImage in = randomComponents(wideFilters(shape), count);
                const Planes<float> found = filtered(bench, in);
                int wrong = 0, left = 0, changed = 0;
                for (int y = 0; y < in.image.height(); ++y)
                    for (int x = 0; x < in.image.width(); ++x) {
                        const double expected = oracle(in, x, y);
                        left += expected < 0 ? 1 : 0;
                        changed += found.at(x, y) != in.image.value.at(x, y) ? 1 : 0;
                        if (expected >= 0 && std::fabs(found.at(x, y) - expected) > 2e-3 && ++wrong <= 3)
                            CHECK_MESSAGE(false, x << "," << y << ": " << found.at(x, y) << " and not " << expected);
                    }
                CHECK(wrong == 0);
                CHECK(left < 100);
                CHECK(changed > 500);
            }
    });
}

TEST_CASE("what is the same everywhere stays so, whatever the samples and the neighbours that are left out")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
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
                    const Planes<float> found = filtered(bench, in);
                    for (int y = 0; y < in.image.height(); ++y)
                        for (int x = 0; x < in.image.width(); ++x)
                            REQUIRE(found.at(x, y) == doctest::Approx(value).epsilon(1e-5));
                }
    });
}

TEST_CASE("one component is the axis-aligned filter of the same width")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
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
        in.slopesPerWidth = static_cast<float>(1 / sigma); // widths of sigma s
        for (int y = 0; y < base.height(); ++y)
            for (int x = 0; x < base.width(); ++x) {
                // Binary fractions, of which 16 bits lose nothing.
                in.image.value.at(x, y) = static_cast<float>((7 * x + 3 * y) % 17) / 16.0f;
                in.sums.at(x, y, 0) = in.sinks.at(x, y, 0) = 8.0f;
                in.sums.at(x, y, 1) = in.sinks.at(x, y, 1) = 8.0f * in.image.value.at(x, y);
            }
        const Planes<float> found = filtered(bench, in);
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
        KernelBench bench(device);
        ComponentImage in = randomComponents(wideFilters(Shape::Tilted), 5);
        const Planes<float> found = filtered(bench, in);
        in.axes.alongU = shared::vecScale(in.axes.alongU, -1.0f);
        for (std::size_t i = 2; i < 5; i += 2) // sines along u
            for (std::size_t k = 0; k < 5; ++k)
                for (int y = 0; y < in.image.height(); ++y)
                    for (int x = 0; x < in.image.width(); ++x)
                        for (const std::size_t part : { std::size_t { 0 }, in.products() })
                            in.sinks.at(x, y, part + 5 * i + k) *= -1.0f;
        const Planes<float> turned = filtered(bench, in);
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x)
                REQUIRE(found.at(x, y) == doctest::Approx(turned.at(x, y)).epsilon(1e-5));
    });
}

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
        TracedScene traced(b.scene, device, 17, 9);
        traced.primary();
        shared::SampleParams params {};
        params.shading = WEDGE_SHADING_SEPARATE; // samples weigh the same
        params.sampler = WEDGE_SAMPLER_SOBOL;
        const shared::AreaLight& onDevice = traced.onDevice.areaLightList[0];
        for (const int count : { 3, 5 }) {
            const std::size_t products = static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
            const shared::LightAxes axes = render::axesOf(onDevice, count);
            const std::string sink = sinkOf({ render::sinks::sums(), render::sinks::components(count) },
                { "sums", "components" }, { graph::value("axes", shared::LightAxes {}) });
            const auto components = traced.bench.filled(products * traced.layout.size, 0.0f);
            traced.sums.fill(traced.bench.queue, 0.0f);
            traced.taken.fill(traced.bench.queue, 0u);
            traced.wanted.fill(traced.bench.queue, 4096u);
            for (const std::uint32_t last : { 1024u, 4096u })
                traced.bench.passes.tiles("samples", device::PassKind::Trace,
                    traced.bench.passes.find("light/area_light.cl", "sampleShadows", sink), traced.params, 1.0, params,
                    onDevice, traced.onDevice.nodes, traced.onDevice.blocks, traced.frame.receivers(), traced.wanted,
                    last, traced.taken, traced.frame.rays, axes, traced.sums, components);
            const Planes<float> found = ofShorts(traced.layout, 2 * products, traced.bench.read(components)),
                                sums = traced.read(traced.sums);
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
