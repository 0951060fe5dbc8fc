// What filters of images that are on a term are handed, and what becomes of what they make: frame/composite.cl,
// waves/distributed.cl.
#include "kernels/shared/indirect.h"
#include "tests/distributed_support.h"

#include <array>
#include <cmath>
#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr float noNumber = std::numeric_limits<float>::quiet_NaN();

render::Settings withTermFilter()
{
    render::Settings s = render::axisAligned(16);
    s.bounces = 1;
    s.filters = { { "colour", { 0.5f, 0.5f, 0.5f, 1 }, { "indirectDiffuse" } } };
    return s;
}

bool nearTo(double found, double expected) { return std::fabs(found - expected) <= 1e-6 * (1 + std::fabs(expected)); }

} // namespace

TEST_CASE("arrivingAtPixels, addTermChange: no number without the term; what changes is reflected, or shown on white")
{
    onEveryDevice([](const device::Device& device) {
        for (const glm::ivec2 size : { glm::ivec2(1, 1), glm::ivec2(37, 5) }) {
            const int width = size.x, height = size.y;
            const Region region(width, height, { 0, 0, width, height }, render::PlaneLayout(width, height));
            std::mt19937 random(8);
            const auto colours = [&] {
                return filledPlanes(region, 3, 0.0f, [&](int, int, std::size_t) { return uniform(random); });
            };
            const auto taken = filledPlanes(
                region, 1, 0u, [&](int, int, std::size_t) { return width > 1 && random() % 6 == 0 ? 0 : 3; });
            const Planes<float> reflectance = colours();
            DeclaredFrame frame(device, smallScene(), sized(withTermFilter(), width, height));
            for (const std::uint32_t component : { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_AMBIENT }) {
                CAPTURE(component);
                const bool ambient = component == WEDGE_COMPONENT_AMBIENT;
                Planes<float> value(region.layout, 4, 0.0f), after = colours();
                const Planes<float> some = colours();
                everyPixel(region.window, [&](int x, int y) {
                    for (std::size_t c = 0; c < 3; ++c) {
                        // What was never sampled holds anything.
                        value.at(x, y, c) = taken.at(x, y) > 0 ? some.at(x, y, c) : 7.0f;
                        after.at(x, y, c) = taken.at(x, y) > 0 ? after.at(x, y, c) : noNumber;
                    }
                });
                PassBench arrives(frame, "arrivingAtPixels"), changes(frame, "addTermChange");
                arrives.value("component", component);
                arrives.plane("taken", taken);
                arrives.plane("value", value);
                arrives.run();
                const auto before = arrives.pixels<float>("arrives");
                changes.value("component", component);
                changes.plane("taken", taken);
                changes.plane("reflectance", reflectance);
                changes.plane("before", before);
                changes.plane("after", after);
                changes.plane("change", std::vector<float>(3 * region.layout.size, 0.25f));
                changes.run();
                const auto found = changes.pixels<float>("change");
                everyPixel(region.window, [&](int x, int y) {
                    for (std::size_t c = 0; c < 3; ++c) {
                        if (taken.at(x, y) == 0) {
                            REQUIRE(std::isnan(before.at(x, y, c)));
                            REQUIRE(found.at(x, y, c) == 0.25f);
                            continue;
                        }
                        const double shown = ambient ? 1.0 - value.at(x, y, c) : value.at(x, y, c);
                        REQUIRE(nearTo(before.at(x, y, c), shown));
                        const double k = ambient ? 1.0 : reflectance.at(x, y, c);
                        REQUIRE(nearTo(found.at(x, y, c), 0.25 + k * (after.at(x, y, c) - shown)));
                    }
                });
            }
        }
    });
}

TEST_CASE(
    "arrivingAtWaves: a term's value, filtered and fallen back where it is taken apart; no number without texture")
{
    for (const Kept kept : { Kept::Full, Kept::Lean })
        for (const bool analysed : { true, false }) {
            CAPTURE(analysed);
            unsigned fallen = 0, apart = 0, own = 0;
            const auto test = [&](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
                const auto planes = [&](std::size_t count, double share) {
                    return filledPlanes(region, count, 1e30f,
                        [&](int, int, std::size_t) { return uniform(random) < share ? 0.0 : uniform(random, 0, 2); });
                };
                Planes<float> texture = planes(3, 0), value = planes(3, 0.1), filtered = planes(3, 0.1),
                              shares = planes(2, 0.4), beta = planes(1, 0.3);
                everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                    shares.at(x, y) = std::min(shares.at(x, y), 1.0f);
                    beta.at(x, y) -= random() % 3 == 0 ? 3.0f : 0.0f;
                    if (random() % 5 == 0)
                        texture.setVector(x, y, { 0, 0, 0 });
                });
                RegionPass pass(frame, "arrivingAtWaves", { "arrives" }, analysed ? 0 : 1);
                REQUIRE(pass.has("filtered") == analysed);
                for (const auto& [name, plane] : { std::pair("texture", &texture), { "value", &value },
                         { "filtered", &filtered }, { "shares", &shares }, { "beta", &beta } })
                    if (pass.has(name)) {
                        pass.plane(name, *plane);
                        *plane = pass.pixels<float>(name);
                    }
                pass.runIn(region, paramsOf(region));
                const auto found = pass.floats("arrives");
                everyPixel(region.window, [&](int x, int y) {
                    const double share = shares.at(x, y), ratio = shares.at(x, y, 1);
                    const bool isApart = analysed && beta.at(x, y) >= 0;
                    for (std::size_t c = 0; c < 3; ++c) {
                        if (luminanceOf(texture.vector(x, y)) == 0) {
                            REQUIRE(std::isnan(found.at(x, y, c)));
                            continue;
                        }
                        const double scaled = filtered.at(x, y, c) * (1 + ratio), u = value.at(x, y, c);
                        REQUIRE(nearTo(found.at(x, y, c), isApart ? scaled + share * (u - scaled) : u));
                    }
                    fallen += isApart && share > 0 ? 1 : 0;
                    apart += isApart && share == 0 ? 1 : 0;
                    own += isApart ? 0 : 1;
                });
            };
            onEveryRegion(70, kept, test, withTermFilter());
            CHECK(own > 300);
            CHECK((fallen > 300) == analysed);
            CHECK((apart > 100) == analysed);
        }
}

TEST_CASE("addChange: what filters change, reflected, on radiance that is never below 0")
{
    struct Kind {
        Kept kept;
        bool analysed;
    };
    for (const Kind kind :
        { Kind { Kept::Full, true }, { Kept::Lean, true }, { Kept::Full, false }, { Kept::Lean, false } }) {
        const bool analysed = kind.analysed;
        unsigned cut = 0, without = 0;
        const auto test = [&](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
            const auto planes = [&] {
                return filledPlanes(region, 3, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 2); });
            };
            Planes<float> texture = planes(), before = planes(), after = planes(), radiance = planes(),
                          filteredTexture = planes(), beta = filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) {
                              return random() % 3 == 0 ? -1.0 : uniform(random);
                          });
            everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                if (random() % 5 == 0) {
                    texture.setVector(x, y, { 0, 0, 0 });
                    before.setVector(x, y, { noNumber, noNumber, noNumber });
                }
            });
            RegionPass pass(frame, "addChange", { "radiance" }, analysed ? 0 : 1);
            REQUIRE(pass.has("filteredTexture") == analysed);
            REQUIRE(pass.has("beta") == analysed);
            for (const auto& [name, plane] :
                { std::pair("texture", &texture), { "filteredTexture", &filteredTexture }, { "beta", &beta } })
                if (pass.has(name)) {
                    pass.plane(name, *plane);
                    *plane = pass.pixels<float>(name);
                }
            pass.plane("before", before);
            pass.plane("after", after);
            pass.plane("radiance", radiance);
            pass.runIn(region, paramsOf(region));
            const auto found = pass.floats("radiance");
            everyPixel(region.window, [&](int x, int y) {
                const bool has = luminanceOf(texture.vector(x, y)) > 0, apart = analysed && beta.at(x, y) >= 0;
                const Planes<float>& k = apart ? filteredTexture : texture;
                without += has ? 0 : 1;
                for (std::size_t c = 0; c < 3; ++c) {
                    const double sum = has ? radiance.at(x, y, c)
                            + static_cast<double>(k.at(x, y, c)) * (after.at(x, y, c) - before.at(x, y, c))
                                           : radiance.at(x, y, c);
                    cut += sum < 0 ? 1 : 0;
                    REQUIRE(nearTo(found.at(x, y, c), std::max(sum, 0.0)));
                }
            });
        };
        onEveryRegion(80, kind.kept, test, withTermFilter());
        CHECK(cut > 100);
        CHECK(without > 100);
    }
}
