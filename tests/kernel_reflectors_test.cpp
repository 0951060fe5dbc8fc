// reflectors.cl alone: distances of reflectors to widths and counts, against the same in double.
#include "kernels/shared/indirect.h"
#include "tests/reflector_support.h"

#include <algorithm>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

/// With counts of distances; lean: of several receivers a pixel, in fewer bits.
DeclaredFrame frameOf(const device::Device& device, int width, int height, bool lean = false)
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.bounces = 1;
    settings.antialias = lean;
    settings.indirect.counts = lean ? settings.indirect.counts : render::IndirectCounts::Spectrum;
    return DeclaredFrame(device, smallScene(), settings);
}

/// visibleBounds and visibleExtent one after the other, garbage in what they write.
float extentOf(DeclaredFrame& frame, const Planes<float>& position, const Planes<std::uint32_t>& objectId)
{
    PassBench first(frame, "visibleBounds"), second(frame, "visibleExtent");
    first.plane("position", position);
    first.plane("objectId", objectId);
    first.plane("bounds", std::vector(6 * WEDGE_EXTENT_STRIPES, 1e9f));
    first.run();
    second.plane("bounds", first.read<float>("bounds"));
    second.plane("extent", std::vector(1, -7.0f));
    second.run();
    return second.read<float>("extent").at(0);
}

/// What a pixel's first pass found, and what it shows.
struct Found {
    float nearest = 0, farthest = 0, inverse = 0;
    float pixelSize = 0.01f, exponent = 1;
    std::uint32_t taken = 16;
    std::uint32_t kind = WEDGE_BLINN_PHONG;

    shared::Gloss gloss() const { return shared::makeGloss(exponent, kind); }
};

/// Widths and counts of pixels in a row.
struct Widths {
    std::vector<float> beta;
    std::vector<std::uint32_t> wanted;
};

/// Of all of a frame's pixels, row by row, each of an object of its own or of that of the numbers given. p.meanOnly: of
/// a lean frame, with sums of inverse distances alone and without counts.
Widths widthsOf(DeclaredFrame& frame, shared::ReflectorParams p, float extent, const std::vector<Found>& pixels,
    const std::vector<std::uint32_t>& objects = {})
{
    const render::PlaneLayout& layout = frame.layout;
    REQUIRE(pixels.size() == std::size_t { layout.width } * layout.height);
    const shared::ReflectorParams sized = paramsFor(layout);
    std::tie(p.x1, p.width, p.y1, p.height, p.stride, p.planeSize) =
        std::tie(sized.x1, sized.width, sized.y1, sized.height, sized.stride, sized.planeSize);
    Planes<float> reflectors(layout, p.meanOnly != 0 ? 1 : 3, 0.0f), pixelSize(layout, 1, 0.0f);
    Planes<std::uint32_t> gloss(layout, 1, 0u), taken(layout, 1, 0u), objectId(layout, 1, 0u);
    std::size_t next = 0;
    everyPixel(layout, [&](int x, int y) {
        const Found& f = pixels[next++];
        if (p.meanOnly != 0)
            reflectors.at(x, y) = f.inverse;
        else
            reflectors.setVector(x, y, { f.nearest, f.farthest, f.inverse });
        pixelSize.at(x, y) = f.pixelSize;
        gloss.at(x, y) = shared::packGloss(f.gloss());
        taken.at(x, y) = f.taken;
        objectId.at(x, y) = objects.empty() ? static_cast<std::uint32_t>(next) : objects[next - 1];
    });
    const auto made = [&](const char* kernel) {
        PassBench pass(frame, kernel);
        pass.value("p", p);
        pass.plane("reflectors", reflectors);
        pass.plane("objectId", objectId);
        pass.plane("extent", std::vector(1, extent));
        pass.plane("pixelSize", pixelSize);
        pass.plane("gloss", gloss);
        pass.plane("taken", taken);
        pass.run();
        return pass;
    };
    const auto beta = made("reflectorWidths").pixels<float>("beta");
    const auto wanted = p.meanOnly != 0 ? taken : made("reflectorCounts").pixels<std::uint32_t>("wanted");
    Widths out;
    everyPixel(layout, [&](int x, int y) {
        out.beta.push_back(beta.at(x, y));
        out.wanted.push_back(wanted.at(x, y));
    });
    return out;
}

struct Expected {
    double beta = -1, wanted = 0;
};

/// (4.15), (4.16), (4.21) of one pixel. side: the longer one of the image, pixels.
Expected expectedOf(const shared::ReflectorParams& p, double extent, const Found& f, std::size_t side)
{
    if (f.taken == 0)
        return {};
    const bool glossy = p.component == WEDGE_COMPONENT_GLOSSY;
    const double m = f.exponent, size = p.extent > 0 ? p.extent : extent;
    const double bandlimit = !glossy ? 2.8 : f.kind == WEDGE_PHONG ? 4.27 + 0.15 * m : 3.6 + 0.084 * m;
    const double gamma =
        glossy ? std::acos(std::pow(std::sqrt(0.5), 1 / std::max(m, 1.0))) / (0.5 * std::numbers::pi) : 0.4;
    const double harmonic = f.taken / std::max<double>(f.inverse, 1e-20);
    const double fraction =
        p.meanOnly != 0 ? p.meanFraction * harmonic : std::min<double>(p.meanFraction * harmonic, f.nearest);
    const double near = p.meanFraction > 0 ? fraction : f.nearest;
    // Of what is seen far behind a pixel's surface only four widths of the image, as wide as they are at the surface.
    const double seen = p.extent > 0 ? size : std::min(size, 4.0 * static_cast<double>(side) * f.pixelSize);
    const double zMin = std::max({ f.nearest > 0 ? near : size, p.leastReflector * seen, 1e-12 });
    const double zMax = std::max<double>(f.farthest, zMin);
    double omega = bandlimit / zMin;
    if (p.alpha > 0)
        omega = std::min<double>(omega, p.alpha / f.pixelSize);
    const double spatial = p.mu * bandlimit * f.pixelSize / zMin + p.alpha;
    const double angular = bandlimit * (1 + p.mu * zMax / zMin);
    const double count = gamma * spatial * spatial * angular * angular;
    return { p.fixedWidth > 0 ? p.fixedWidth * f.pixelSize : p.widthScale / (p.mu * omega),
        std::clamp<double>(count, 16, p.countCap) };
}

/// Distances of 16 rays, `hit` of which met something between 10^-spread and 10^spread metres away.
std::vector<Found> randomPixels(int count, int spread, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<Found> out;
    for (int i = 0; i < count; ++i) {
        Found f;
        f.taken = random() % 8 == 0 ? 0 : 16;
        const auto hits = random() % 3 == 0 ? random() % 2 : random() % 17;
        const double centre = uniform(random, -spread, spread);
        double nearest = 1e30, farthest = 0, inverse = 0;
        for (unsigned k = 0; k < hits; ++k) {
            const double z = std::pow(10.0, centre + uniform(random));
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
            inverse += 1 / z;
        }
        f.nearest = hits > 0 ? static_cast<float>(nearest) : 0.0f;
        f.farthest = static_cast<float>(farthest);
        f.inverse = static_cast<float>(inverse);
        f.pixelSize = static_cast<float>(std::pow(10.0, uniform(random, -3, -1)));
        f.exponent = static_cast<float>(std::pow(10.0, uniform(random, -1, 3)));
        f.kind = random() % 2 == 0 ? WEDGE_PHONG : WEDGE_BLINN_PHONG;
        out.push_back(f);
    }
    return out;
}

/// Every setting of the parameters that the widths hang on.
std::vector<shared::ReflectorParams> settings()
{
    std::vector<shared::ReflectorParams> out;
    for (const std::uint32_t component : { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_GLOSSY, WEDGE_COMPONENT_AMBIENT })
        for (const float meanFraction : { 0.0f, 0.3f })
            for (const float alpha : { 0.0f, 0.65f })
                for (const float extent : { 0.0f, 20.0f })
                    for (const float fixedWidth : { 0.0f, 2.5f }) {
                        shared::ReflectorParams p = paramsFor(render::PlaneLayout(1, 1));
                        p.component = component;
                        p.meanFraction = meanFraction;
                        p.alpha = alpha;
                        p.extent = extent;
                        p.fixedWidth = fixedWidth;
                        out.push_back(p);
                    }
    return out;
}

/// Pixels of `width` that found what the object's pixels around did in the mean, or, where there are none, they
/// themselves.
std::vector<Found> pooled(
    const std::vector<Found>& pixels, const std::vector<std::uint32_t>& objects, int width, bool glossy)
{
    const int height = static_cast<int>(pixels.size()) / width;
    std::vector<Found> out = pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            double inverse = 0, rays = 0, leasts = 0, count = 0;
            for (int py = std::max(0, y - 2); py <= std::min(height - 1, y + 2); ++py)
                for (int px = std::max(0, x - 2); px <= std::min(width - 1, x + 2); ++px) {
                    const std::size_t k = static_cast<std::size_t>(py) * width + px;
                    if (k == i || objects[k] != objects[i] || pixels[k].taken == 0
                        || (glossy && !(pixels[k].inverse > 0)))
                        continue;
                    inverse += pixels[k].inverse;
                    rays += pixels[k].taken;
                    leasts += pixels[k].nearest > 0 ? 1 / pixels[k].nearest : 0;
                    count += 1;
                }
            if (count == 0)
                continue;
            out[i].inverse = static_cast<float>(pixels[i].taken * inverse / rays);
            out[i].nearest = static_cast<float>(leasts > 0 ? count / leasts : 0);
        }
    return out;
}

void checkWidths(DeclaredFrame& frame, const shared::ReflectorParams& p, float extent, const std::vector<Found>& pixels)
{
    const Widths found = widthsOf(frame, p, extent, pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Expected expected = expectedOf(p, extent, pixels[i], pixels.size());
        CAPTURE(pixels[i].nearest);
        CAPTURE(pixels[i].farthest);
        CAPTURE(pixels[i].exponent);
        CAPTURE(pixels[i].kind);
        CAPTURE(p.component);
        REQUIRE(std::isfinite(found.beta[i]));
        REQUIRE(close(found.beta[i], expected.beta, 1e-4));
        if (p.meanOnly == 0)
            REQUIRE(std::fabs(found.wanted[i] - expected.wanted) <= 0.501 + 1e-3 * expected.wanted);
    }
}

} // namespace

TEST_CASE("the visible extent is the largest side of what is seen; holes do not count, and nothing seen has none")
{
    onEveryDevice([](const device::Device& device) {
        unsigned seed = 1;
        for (const glm::ivec2 pixels :
            { glm::ivec2(1, 1), { 1, 70 }, { 70, 1 }, { 16, 32 }, { 47, 29 }, { 33, 131 } }) {
            DeclaredFrame frame = frameOf(device, pixels.x, pixels.y);
            for (const double holes : { 0.0, 0.3, 0.97, 1.0 }) {
                std::mt19937 random(++seed);
                const render::PlaneLayout& layout = frame.layout;
                Planes<float> position(layout, 3, 0.0f);
                Planes<std::uint32_t> objectId(layout, 1, 0u);
                glm::dvec3 least(1e30), largest(-1e30);
                everyPixel(layout, [&](int x, int y) {
                    position.setVector(x, y, 1e7 * unitVector(random)); // not to be read where there is nothing
                    if (uniform(random) < holes)
                        return;
                    const glm::dvec3 at(uniform(random, 5, 9), uniform(random, -8, -3), uniform(random, -2, 1));
                    objectId.at(x, y) = 1 + static_cast<std::uint32_t>(random() % 3);
                    position.setVector(x, y, at);
                    least = glm::min(least, position.vector(x, y));
                    largest = glm::max(largest, position.vector(x, y));
                });
                const glm::dvec3 size = glm::max(largest - least, glm::dvec3(0));
                CAPTURE(pixels.x);
                CAPTURE(pixels.y);
                CAPTURE(holes);
                CHECK(extentOf(frame, position, objectId)
                    == doctest::Approx(std::max({ size.x, size.y, size.z })).epsilon(1e-6));
            }
        }
    });
}

TEST_CASE("the visible extent counts every row, and both ends of a row")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = frameOf(device, 17, 3 * WEDGE_EXTENT_STRIPES + 1);
        const render::PlaneLayout& layout = frame.layout;
        Planes<std::uint32_t> objectId(layout, 1, 0u);
        everyPixel(layout, [&](int x, int y) { objectId.at(x, y) = 1; });
        for (int y = 0; y < static_cast<int>(layout.height); ++y) {
            Planes<float> position(layout, 3, 1.0f);
            position.at(y % 2 == 0 ? 0 : 16, y, static_cast<std::size_t>(y) % 3) = y % 4 < 2 ? 3.5f : -1.5f;
            CAPTURE(y);
            REQUIRE(extentOf(frame, position, objectId) == 2.5f);
        }
    });
}

TEST_CASE("widths are (4.16) and counts (4.21) of the least distance, or of a fraction of the harmonic mean")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = frameOf(device, 150, 1);
        for (const shared::ReflectorParams& p : settings())
            checkWidths(frame, p, 4.0f, randomPixels(150, 3, 9));
    });
}

TEST_CASE("widths of lean frames: from the mean alone, with sizes and exponents of 16 bits")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = frameOf(device, 150, 1, true);
        std::vector<Found> pixels = randomPixels(150, 3, 10);
        for (Found& f : pixels) {
            f.pixelSize = shared::unpackShort(shared::packShort(f.pixelSize));
            f.exponent = shared::unpackGlossShort(shared::packGlossShort(f.gloss())).exponent;
        }
        for (shared::ReflectorParams p : settings()) {
            p.meanOnly = 1;
            if (p.meanFraction > 0)
                checkWidths(frame, p, 4.0f, pixels);
        }
    });
}

TEST_CASE("distances that say little: none, all the same, 0, tiny and huge ones, and pixels without a term")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<Found> pixels = {
            { 0, 0, 0 }, // no ray hit anything
            { 2, 2, 16 / 2.0f }, { 2, 2, 1 / 2.0f }, // z_min = z_max; of all rays and of one
            { 1e-30f, 1e-30f, 16e20f }, // as a reflector at the pixel itself is stored
            { 1e-30f, 5, 16e20f }, { 1e-12f, 1e12f, 1e12f }, { 1e20f, 1e30f, 1e-20f }, { 1e20f, 1e30f, 0 },
            { 1, 2, 10, 0.01f, 5, 0 }, { 0, 0, 0, 0.01f, 5, 0 }, // without a term
            { 1, 2, 10, 1e-6f }, { 1, 2, 10, 1e3f }, // tiny and huge pixels
            { 1, 2, 10, 0.01f, 5, 1 }, // a single sample
        };
        DeclaredFrame frame = frameOf(device, static_cast<int>(pixels.size()), 1), one = frameOf(device, 1, 1);
        for (const shared::ReflectorParams& p : settings())
            for (const float extent : { 0.0f, 4.0f, 1e6f })
                checkWidths(frame, p, extent, pixels);
        // Where no ray hit anything, the width is that of a reflector as far as the image is large.
        const Widths none = widthsOf(one, paramsFor(one.layout), 4.0f, { { 0, 0, 0, 0.01f } });
        CHECK(none.beta[0] == doctest::Approx(0.5 / (0.9 * 2.8 / 4)).epsilon(1e-5));
    });
}

TEST_CASE("exponents outside of the fit's range give widths and counts within bounds")
{
    onEveryDevice([](const device::Device& device) {
        shared::ReflectorParams p = paramsFor(render::PlaneLayout(1, 1));
        p.component = WEDGE_COMPONENT_GLOSSY;
        std::vector<Found> pixels, sharp;
        for (const float exponent : { 0.0f, 0.1f, 1.0f, 3.9f, 4.0f, 50.0f, 51.0f, 1000.0f })
            for (const std::uint32_t kind : { WEDGE_PHONG, WEDGE_BLINN_PHONG })
                pixels.push_back({ 1, 3, 8, 0.01f, exponent, 16, kind });
        DeclaredFrame frame = frameOf(device, static_cast<int>(pixels.size()), 1);
        checkWidths(frame, p, 4, pixels);
        for (const float exponent : { 1e4f, 1e6f, 1e8f, 1e20f, 1e37f })
            for (const std::uint32_t kind : { WEDGE_PHONG, WEDGE_BLINN_PHONG })
                sharp.push_back({ 1, 3, 8, 0.01f, exponent, 16, kind });
        DeclaredFrame ofSharp = frameOf(device, static_cast<int>(sharp.size()), 1);
        const Widths found = widthsOf(ofSharp, p, 4, sharp);
        for (std::size_t i = 0; i < sharp.size(); ++i) {
            // Their bandlimit is the pixel's at most.
            CAPTURE(sharp[i].exponent);
            const double least = 0.5 * 0.01 / (0.9 * 0.3);
            REQUIRE(close(found.beta[i], std::max(least, expectedOf(p, 4, sharp[i], sharp.size()).beta), 1e-4));
            REQUIRE(found.wanted[i] >= 16);
            REQUIRE(found.wanted[i] <= 256);
        }
    });
}

TEST_CASE("widths go by what the object's other pixels around found, as published by each pixel's own rays")
{
    onEveryDevice([](const device::Device& device) {
        constexpr int width = 23, height = 11;
        DeclaredFrame full = frameOf(device, width, height), lean = frameOf(device, width, height, true);
        const std::vector<Found> pixels = randomPixels(width * height, 2, 31);
        std::mt19937 random(32);
        std::vector<std::uint32_t> objects;
        objects.reserve(width * height);
        for (int i = 0; i < width * height; ++i)
            objects.push_back(1 + static_cast<std::uint32_t>(i % width / 8 + random() % 2));
        struct Setting {
            std::uint32_t meanOnly;
            float meanFraction;
            std::uint32_t component;
        };
        for (const Setting& setting :
            { Setting { 0, 0.0f, WEDGE_COMPONENT_DIFFUSE }, { 0, 0.3f, WEDGE_COMPONENT_DIFFUSE },
                { 1, 0.3f, WEDGE_COMPONENT_DIFFUSE }, { 0, 0.3f, WEDGE_COMPONENT_GLOSSY } }) {
            const std::vector<Found> together =
                pooled(pixels, objects, width, setting.component == WEDGE_COMPONENT_GLOSSY);
            shared::ReflectorParams p = paramsFor(render::PlaneLayout(1, 1));
            p.meanFraction = setting.meanFraction;
            p.meanOnly = setting.meanOnly;
            p.component = setting.component;
            const Widths found = widthsOf(setting.meanOnly != 0 ? lean : full, p, 20, pixels, objects);
            int changed = 0;
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const Expected own = expectedOf(p, 20, pixels[i], width),
                               around = expectedOf(p, 20, together[i], width);
                CAPTURE(found.beta[i]);
                CAPTURE(own.beta);
                CAPTURE(around.beta);
                CAPTURE(setting.meanOnly);
                CAPTURE(setting.meanFraction);
                const double wanted = setting.meanFraction == 0 ? own.beta : around.beta;
                REQUIRE(close(found.beta[i], wanted, setting.meanOnly != 0 ? 5e-3 : 1e-4));
                changed += close(own.beta, around.beta, 0.01) ? 0 : 1;
            }
            CHECK(changed > 20);
        }
    });
}
