// distributed.cl alone: filtered terms back into radiance.
#include "tests/distributed_support.h"
#include "tests/packed_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

/// A term and what filters made of it.
struct TermPlanes {
    Planes<float> texture, filteredTexture, value, filtered, beta, own, radiance;

    /// With p.packed texture and value are rounded as such; buffers of them have what textureOf() and valueOf() return.
    TermPlanes(const Region& region, std::mt19937& random, const shared::DistributedParams& p = {})
        : texture(planes(region, 3, random))
        , filteredTexture(planes(region, 3, random))
        , value(planes(region, 3, random))
        , filtered(planes(region, 3, random))
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
            texture.setVector(x, y, rounded(texture.vector(x, y), bitsOfTexture(p)));
            value.setVector(x, y, rounded(value.vector(x, y), bitsOfValue(p)));
            if (p.plainTexture == 0)
                filteredTexture.setVector(x, y, rounded(filteredTexture.vector(x, y), bitsOfTexture(p)));
        });
    }
    static std::uint32_t bitsOfTexture(const shared::DistributedParams& p)
    {
        return shared::textureBits(p.packed, p.values == 1);
    }
    static std::uint32_t bitsOfValue(const shared::DistributedParams& p)
    {
        return shared::valueBits(p.packed, p.values == 1);
    }
    Planes<float> textureOf(const shared::DistributedParams& p) const
    {
        return packedColours(texture, bitsOfTexture(p));
    }
    Planes<float> valueOf(const shared::DistributedParams& p) const { return packedColours(value, bitsOfValue(p)); }
    Planes<float> filteredTextureOf(const shared::DistributedParams& p) const
    {
        return p.plainTexture != 0 ? filteredTexture : packedColours(filteredTexture, bitsOfTexture(p));
    }
    static Planes<float> planes(const Region& region, std::size_t count, std::mt19937& random)
    {
        return filledPlanes(
            region, count, 1e30f, [&](int, int, std::size_t) { return random() % 7 == 0 ? 0 : uniform(random, 0, 2); });
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

/// How terms are kept: as of DistributedParams.
struct Kept {
    std::uint32_t published, packed, plainTexture;
};

/// What `launch(p, term, buffer of radiance)` leaves there, against expected(p, term, x, y) added to what was.
template <class Launch, class Expected>
void checkAdds(const Launch& launch, const Expected& expected)
{
    onEveryRegion(0, [&](KernelBench& bench, const Region& region, std::mt19937& random) {
        for (const Kept& kept : { Kept { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 1, 1 } })
            for (const std::uint32_t values : { 1u, 3u }) {
                CAPTURE(kept.published);
                CAPTURE(kept.packed);
                CAPTURE(values);
                shared::DistributedParams p = paramsOf(region);
                p.published = kept.published;
                p.packed = kept.packed;
                p.plainTexture = kept.plainTexture;
                p.values = values;
                const TermPlanes term(region, random, p);
                Output<float> radiance(bench, region, term.radiance);
                launch(bench, p, term, radiance.buffer());
                const Planes<float> found = radiance.read();
                everyPixel(region.window, [&](int x, int y) {
                    REQUIRE(nearTo(found.vector(x, y), term.radiance.vector(x, y) + expected(p, term, x, y)));
                });
            }
    });
}

} // namespace

TEST_CASE(
    "a filtered term adds the filtered texture times the filtered value, and of lights its own colour, where they are "
    "apart, elsewhere its own")
{
    checkAdds(
        [](KernelBench& bench, const shared::DistributedParams& p, const TermPlanes& term,
            const device::Buffer<float>& radiance) {
            const auto k = bench.buffer(term.textureOf(p).values),
                       filteredK = bench.buffer(term.filteredTextureOf(p).values),
                       e = bench.buffer(term.valueOf(p).values), filteredE = bench.buffer(term.filtered.values),
                       beta = bench.buffer(term.beta.values), own = bench.buffer(term.own.values);
            launchPixels(
                bench, "waves/distributed.cl", "addFilteredTerm", p, k, filteredK, e, filteredE, beta, own, radiance);
        },
        [](const shared::DistributedParams& p, const TermPlanes& term, int x, int y) {
            if (term.beta.at(x, y) < 0)
                return term.ownRadiance(p.published != 0, x, y);
            const glm::dvec3 k = term.filteredTexture.vector(x, y);
            if (p.values == 3)
                return k * term.filtered.vector(x, y);
            const glm::dvec3 one = k * static_cast<double>(term.filtered.at(x, y));
            if (p.published != 0)
                return one;
            // Of the colour that textures have which see the light differently each pixel keeps its own.
            const glm::dvec3 texture = term.texture.vector(x, y), own = term.ownRadiance(false, x, y);
            const double t = luminanceOf(texture);
            const glm::dvec3 colour = t > 0 ? own - texture * (luminanceOf(own) / t) : glm::dvec3(0);
            // As much of it as leaves no channel below 0: it has no luminance, and adds none.
            double kept = 1;
            for (int c = 0; c < 3; ++c)
                kept = one[c] + colour[c] < 0 ? std::min(kept, -one[c] / colour[c]) : kept;
            REQUIRE(std::fabs(luminanceOf(colour)) < 1e-9 * (1 + luminanceOf(own)));
            return one + kept * colour;
        });
}

TEST_CASE("a term without a filter adds texture times value, or as published what is kept of it")
{
    checkAdds(
        [](KernelBench& bench, const shared::DistributedParams& p, const TermPlanes& term,
            const device::Buffer<float>& radiance) {
            const auto k = bench.buffer(term.textureOf(p).values), e = bench.buffer(term.valueOf(p).values),
                       own = bench.buffer(term.own.values);
            launchPixels(bench, "waves/distributed.cl", "addTerm", p, k, e, own, radiance);
        },
        [](const shared::DistributedParams& p, const TermPlanes& term, int x, int y) {
            return term.ownRadiance(p.published != 0, x, y);
        });
}

TEST_CASE("a light's visibility: of its channels the mean that keeps the radiance's luminance; as published the first")
{
    onEveryRegion(30, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        for (const auto& [published, packed] : { std::pair(0u, 0u), { 1u, 0u }, { 0u, 1u } }) {
            CAPTURE(packed);
            shared::DistributedParams p = paramsOf(region);
            p.published = published;
            p.packed = packed;
            const TermPlanes term(region, random, p);
            Output<float> visibility(bench, region, 1);
            const auto k = bench.buffer(term.textureOf(p).values), e = bench.buffer(term.valueOf(p).values);
            launchPixels(bench, "waves/distributed.cl", "visibilityOf", p, k, e, visibility.buffer());
            const Planes<float> found = visibility.read();
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
    });
}

TEST_CASE("planes add up")
{
    onEveryRegion(50, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        const TermPlanes term(region, random);
        const shared::DistributedParams p = paramsOf(region);
        Output<float> sum(bench, region, term.radiance), all(bench, region, 3);
        const auto k = bench.buffer(term.texture.values), e = bench.buffer(term.value.values),
                   own = bench.buffer(term.own.values);
        launchPixels(bench, "waves/distributed.cl", "addPlane", p, own, sum.buffer());
        launchPixels(bench, "waves/distributed.cl", "addAll", p, k, e, own, all.buffer());
        const Planes<float> added = sum.read(), beauty = all.read();
        everyPixel(region.window, [&](int x, int y) {
            REQUIRE(added.at(x, y) == term.radiance.at(x, y) + term.own.at(x, y));
            REQUIRE(added.at(x, y, 1) == term.radiance.at(x, y, 1));
            REQUIRE(nearTo(
                beauty.vector(x, y), term.texture.vector(x, y) + term.value.vector(x, y) + term.own.vector(x, y)));
        });
    });
}

TEST_CASE("images add up, and a term's value is the same unpacked")
{
    onEveryRegion(60, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        for (const std::uint32_t packed : { 0u, 1u })
            for (const std::uint32_t values : { 1u, 3u }) {
                CAPTURE(packed);
                CAPTURE(values);
                shared::DistributedParams p = paramsOf(region);
                p.packed = packed;
                p.values = values;
                const TermPlanes term(region, random, p);
                Output<float> sum(bench, region, term.radiance), unpacked(bench, region, 3);
                const auto own = bench.buffer(term.own.values), value = bench.buffer(term.valueOf(p).values);
                launchPixels(bench, "waves/distributed.cl", "addImage", p, own, sum.buffer());
                launchPixels(bench, "waves/distributed.cl", "unpackImage", p, value, unpacked.buffer());
                const Planes<float> added = sum.read(), image = unpacked.read();
                everyPixel(region.window, [&](int x, int y) {
                    REQUIRE(nearTo(added.vector(x, y), term.radiance.vector(x, y) + term.own.vector(x, y)));
                    REQUIRE(image.vector(x, y) == term.value.vector(x, y));
                });
            }
    });
}

TEST_CASE(
    "counts of a lean frame's term: those wanted where the pixel had new primary samples, else those of the first pass")
{
    onEveryRegion(70, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        const auto counts = [&](std::uint32_t least, std::uint32_t most) {
            return filledPlanes(region, 1, 1u << 20,
                [&](int, int, std::size_t) { return least + static_cast<std::uint32_t>(random()) % (most - least); });
        };
        const Planes<std::uint32_t> primary = counts(6, 12), wanted = counts(1, 100);
        constexpr std::uint32_t first = 8;
        Output<std::uint32_t> settled(bench, region, wanted);
        const auto taken = bench.buffer(primary.values);
        launchPixels(bench, "waves/distributed.cl", "settleCounts", paramsOf(region), first, taken, settled.buffer());
        const Planes<std::uint32_t> found = settled.read();
        everyPixel(region.window, [&](int x, int y) {
            REQUIRE(found.at(x, y) == (primary.at(x, y) > first ? wanted.at(x, y) : primary.at(x, y)));
        });
    });
}
