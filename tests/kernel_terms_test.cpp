// distributed.cl alone: filtered terms back into radiance.
#include "tests/distributed_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

/// A term and what filters made of it.
struct TermPlanes {
    Planes<float> texture, filteredTexture, value, filtered, shares, beta, own, radiance;

    TermPlanes(const Region& region, std::mt19937& random)
        : texture(planes(region, 3, random))
        , filteredTexture(planes(region, 3, random))
        , value(planes(region, 3, random))
        , filtered(planes(region, 3, random))
        , shares(filledPlanes(region, 2, 1e30f,
              [&](int, int, std::size_t plane) {
                  return random() % 4 == 0 ? 0 : uniform(random, 0, plane == 0 ? 1 : 3);
              }))
        , beta(filledPlanes(region, 1, 1e30f,
              [&](int, int, std::size_t) {
                  return random() % 2 == 0 ? -1.0 : random() % 3 == 0 ? 0.0 : uniform(random);
              }))
        , own(planes(region, 3, random))
        , radiance(planes(region, 3, random))
    {
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            if (random() % 9 == 0)
                texture.setVector(x, y, { 0, 0, 0 });
        });
    }
    /// Fills the planes that a pass has, and is then what the pass has of them.
    void fill(PassBench& pass, std::uint32_t values)
    {
        const std::size_t size = filtered.layout.size;
        filtered.values.resize(values * size);
        for (std::size_t i = 0; i < size && values == 3 && pass.has("shares"); ++i)
            for (std::size_t c = 0; beta.values[i] >= 0 && shares.values[i] == 0 && c < 3; ++c)
                value.values[c * size + i] = std::numeric_limits<float>::quiet_NaN(); // nobody looks at it
        for (const auto& [name, plane] : { std::pair("texture", &texture), { "filteredTexture", &filteredTexture },
                 { "value", &value }, { "filtered", &filtered }, { "shares", &shares }, { "beta", &beta },
                 { "termRadiance", &own }, { "radiance", &radiance } })
            if (pass.has(name)) {
                pass.plane(name, *plane);
                *plane = pass.pixels<float>(name);
            }
    }
    static Planes<float> planes(const Region& region, std::size_t count, std::mt19937& random)
    {
        return filledPlanes(
            region, count, 1e30f, [&](int, int, std::size_t) { return random() % 7 == 0 ? 0 : uniform(random, 0, 2); });
    }
    /// What was filtered, scaled, then moved towards the term's own: the channel, or of one number all in one.
    glm::dvec3 fallenBack(const shared::DistributedParams& p, int x, int y) const
    {
        const glm::dvec3 f = p.values == 3 ? filtered.vector(x, y) : glm::dvec3(filtered.at(x, y));
        if (p.published != 0)
            return f;
        const glm::dvec3 k = texture.vector(x, y), u = value.vector(x, y);
        const double t = luminanceOf(k), seen = t > 0 ? luminanceOf(k * u) / t : 0.0;
        const glm::dvec3 scaled = f * (1.0 + shares.at(x, y, 1));
        const double share = shares.at(x, y, 0);
        return share > 0 ? glm::mix(scaled, p.values == 3 ? u : glm::dvec3(seen), share) : scaled;
    }
    /// The term's radiance as sampled.
    glm::dvec3 ownRadiance(bool published, int x, int y) const
    {
        return published ? own.vector(x, y) : texture.vector(x, y) * value.vector(x, y);
    }
};

bool nearTo(glm::dvec3 found, glm::dvec3 expected)
{
    return glm::length(found - expected) <= 1e-6 * (1 + glm::length(expected));
}

/// What a pass adds to `radiance`, against expected(p, term, x, y), in frames of all kinds.
template <class Expected>
void checkAdds(const std::string& kernel, const Expected& expected)
{
    struct Frames {
        Kept kept;
        bool published, blurs; ///< else filtered textures are those of the term
    };
    for (const Frames& kind : { Frames { Kept::Full, false, true }, { Kept::Full, true, true },
             { Kept::Lean, false, false }, { Kept::Lean, false, true } }) {
        render::Settings settings = kind.published ? render::asPublished() : render::axisAligned(16);
        settings.distributed.blur = kind.blurs;
        const auto test = [&](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
            for (const std::uint32_t values : { 1u, 3u }) {
                CAPTURE(values);
                shared::DistributedParams p = paramsOf(region);
                p.published = kind.published ? 1 : 0;
                p.values = values;
                TermPlanes term(region, random);
                RegionPass pass(frame, kernel, { "radiance" }, termOf(values));
                REQUIRE(pass.has("termRadiance") == kind.published);
                REQUIRE(pass.has("shares") == (kernel == "addFilteredTerm" && !kind.published));
                term.fill(pass, values);
                pass.runIn(region, p);
                const auto found = pass.floats("radiance");
                everyPixel(region.window, [&](int x, int y) {
                    REQUIRE(nearTo(found.vector(x, y), term.radiance.vector(x, y) + expected(p, term, x, y)));
                });
            }
        };
        onEveryRegion(0, kind.kept, test, settings);
    }
}

} // namespace

TEST_CASE("a filtered term adds the filtered texture times the filtered value, which falls back to its own")
{
    // What lights add has their own colour besides.
    unsigned untouched = 0, scaled = 0, moved = 0;
    checkAdds("addFilteredTerm", [&](const shared::DistributedParams& p, const TermPlanes& term, int x, int y) {
        if (term.beta.at(x, y) < 0)
            return term.ownRadiance(p.published != 0, x, y); // it is not taken apart
        const bool fallsBack = p.published == 0, own = term.shares.at(x, y, 0) > 0;
        untouched += fallsBack && !own && term.shares.at(x, y, 1) == 0 ? 1 : 0;
        scaled += fallsBack && !own && term.shares.at(x, y, 1) != 0 ? 1 : 0;
        moved += fallsBack && own ? 1 : 0;
        const glm::dvec3 one = term.filteredTexture.vector(x, y) * term.fallenBack(p, x, y);
        if (p.values == 3 || p.published != 0)
            return one;
        // Of the colour that textures have which see the light differently each pixel keeps its own.
        const glm::dvec3 texture = term.texture.vector(x, y), radiance = term.ownRadiance(false, x, y);
        const double t = luminanceOf(texture);
        const glm::dvec3 colour = t > 0 ? radiance - texture * (luminanceOf(radiance) / t) : glm::dvec3(0);
        // As much of it as leaves no channel below 0: it has no luminance, and adds none.
        double kept = 1;
        for (int c = 0; c < 3; ++c)
            kept = one[c] + colour[c] < 0 ? std::min(kept, -one[c] / colour[c]) : kept;
        REQUIRE(std::fabs(luminanceOf(colour)) < 1e-9 * (1 + luminanceOf(radiance)));
        return one + kept * colour;
    });
    CHECK(untouched > 100);
    CHECK(scaled > 100);
    CHECK(moved > 100);
}

TEST_CASE("a term without a filter adds texture times value, or as published what is kept of it")
{
    checkAdds("addTerm", [](const shared::DistributedParams& p, const TermPlanes& term, int x, int y) {
        return term.ownRadiance(p.published != 0, x, y);
    });
}

TEST_CASE("a light's visibility: of its channels the mean that keeps the radiance's luminance; as published the first")
{
    const auto test = [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        for (const std::uint32_t published : { 0u, 1u }) {
            CAPTURE(published);
            shared::DistributedParams p = paramsOf(region);
            p.published = published;
            TermPlanes term(region, random);
            RegionPass pass(frame, "visibilityOf", { "visibility" });
            term.fill(pass, 1);
            pass.runIn(region, p);
            const auto found = pass.floats("visibility");
            everyPixel(region.window, [&](int x, int y) {
                if (published != 0) {
                    REQUIRE(found.at(x, y) == term.value.at(x, y));
                    return;
                }
                const double t = luminanceOf(term.texture.vector(x, y));
                REQUIRE(agree(t * found.at(x, y), luminanceOf(term.ownRadiance(false, x, y)), 1e-5, 1e-6));
                REQUIRE((t > 0 || found.at(x, y) == 0));
            });
        }
    };
    onEveryRegion(30, test);
}

TEST_CASE("planes add up")
{
    onEveryRegion(50, Kept::Full, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const TermPlanes term(region, random);
        const Planes<float>&a = term.texture, &b = term.value, &c = term.own;
        RegionPass parts(frame, "addPlane", { "sum" });
        const Planes<float> part = TermPlanes::planes(region, 1, random), sum = TermPlanes::planes(region, 1, random);
        parts.plane("part", part);
        parts.plane("sum", sum);
        parts.runIn(region, paramsOf(region));
        RegionPass all(frame, "addAll", { "beauty" });
        all.plane("emission", a);
        all.plane("direct", b);
        all.plane("indirect", c);
        all.runIn(region, paramsOf(region));
        const auto added = parts.floats("sum"), beauty = all.floats("beauty");
        everyPixel(region.window, [&](int x, int y) {
            REQUIRE(added.at(x, y) == sum.at(x, y) + part.at(x, y));
            REQUIRE(nearTo(beauty.vector(x, y), a.vector(x, y) + b.vector(x, y) + c.vector(x, y)));
        });
    });
}

TEST_CASE("images add up, and a term's value is the same unpacked")
{
    onEveryRegion(60, Kept::Lean, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        RegionPass pass(frame, "unpackImage", { "out" });
        pass.plane("in", TermPlanes::planes(region, 3, random));
        pass.runIn(region, paramsOf(region));
        const TermPlanes term(region, random);
        RegionPass images(frame, "addImage", { "sum" });
        images.plane("image", term.own);
        images.plane("sum", term.radiance);
        images.runIn(region, paramsOf(region));
        const auto in = pass.floats("in"), out = pass.floats("out"), added = images.floats("sum");
        everyPixel(region.window, [&](int x, int y) {
            REQUIRE(out.vector(x, y) == in.vector(x, y));
            REQUIRE(nearTo(added.vector(x, y), term.radiance.vector(x, y) + term.own.vector(x, y)));
        });
    });
}

TEST_CASE(
    "counts of a lean frame's term: those wanted where the pixel had new primary samples, else those of the first pass")
{
    onEveryRegion(70, Kept::Lean, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const auto counts = [&](std::uint32_t least, std::uint32_t most) {
            return filledPlanes(region, 1, 1u << 20,
                [&](int, int, std::size_t) { return least + static_cast<std::uint32_t>(random()) % (most - least); });
        };
        const Planes<std::uint32_t> primary = counts(6, 12), wanted = counts(1, 100);
        constexpr std::uint32_t first = 8;
        RegionPass<std::uint32_t> pass(frame, "settleCounts", { "counts" });
        pass.value("first", first);
        pass.plane("primaryTaken", primary);
        pass.plane("counts", wanted);
        pass.runIn(region, paramsOf(region));
        const auto found = pass.pixels<std::uint32_t>("counts");
        everyPixel(region.window, [&](int x, int y) {
            REQUIRE(found.at(x, y) == (primary.at(x, y) > first ? wanted.at(x, y) : primary.at(x, y)));
        });
    });
}
