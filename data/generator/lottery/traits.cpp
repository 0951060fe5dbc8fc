#include "data/generator/lottery/traits.h"

#include "data/generator/lottery/draw.h"

namespace wedge::generator {

LotteryTraits lotteryTraits(std::uint32_t seed, int version)
{
    Random random = stream(seed, Stream::Traits);
    LotteryTraits t;
    t.lowLights = chance(random, 0.35);
    t.sharp = chance(random, 0.35);
    t.open = chance(random, 0.35);
    t.oneGroup = chance(random, 0.35);
    t.bounces = chance(random, 0.5) ? 1 : 0;
    // When seeds were frozen, what emits lit others by paths alone.
    t.smallEmitters = chance(random, t.bounces > 0 ? 0.6 : 0.12);
    t.textures = chance(random, 0.5);
    t.antialias = chance(random, 0.35);
    t.lens = chance(random, 0.2);
    t.motion = chance(random, 0.15);
    const double many = random.uniform(0, 1);
    t.lights = many < 0.4 ? 1
        : many < 0.7      ? whole(random, 2, 3)
        : many < 0.9      ? whole(random, 4, 8)
                          : whole(random, 9, 16);
    t.things = static_cast<int>(logarithmic(random, 5, 50));
    Random ofLamps = stream(seed, Stream::Lamps);
    if (version == 2 && chance(ofLamps, 0.35)) {
        t.lamps = static_cast<Lamps>(whole(ofLamps, 1, 3));
        t.quads = chance(ofLamps, 0.5);
    }
    if (version == 3) {
        Random ofSky = stream(seed, Stream::Sky);
        t.open = true;
        t.sky = static_cast<Sky>(whole(ofSky, 1, 5));
        t.quads = chance(ofSky, 0.25);
    }
    return t;
}

std::vector<std::string> hardCases(const LotteryTraits& t)
{
    std::vector<std::string> out;
    const auto add = [&](bool there, const char* name) {
        if (there)
            out.emplace_back(name);
    };
    add(t.lowLights, "low_lights");
    add(t.sharp, "sharp");
    add(t.open, "open");
    add(t.smallEmitters, "small_emitters");
    add(t.oneGroup, "one_group");
    add(t.lamps == Lamps::Large, "large_lamps");
    add(t.lamps == Lamps::Small, "small_lamps");
    add(t.lamps == Lamps::Textured, "textured_lamp");
    add(t.sky == Sky::Even, "even_sky");
    add(t.sky == Sky::Clear, "clear_sky");
    add(t.sky == Sky::Clouds, "clouds");
    add(t.sky == Sky::Sun, "sun");
    add(t.sky == Sky::Lamps, "sky_of_lamps");
    return out;
}

} // namespace wedge::generator
