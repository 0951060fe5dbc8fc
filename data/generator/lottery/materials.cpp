#include "data/generator/lottery/stage.h"
#include "data/generator/patterns.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::generator {
namespace {

glm::vec3 colour(Random& random, double lo, double hi)
{
    const double level = random.uniform(lo, hi), tint = chance(random, 0.5) ? 0.8 : 0.15;
    const glm::dvec3 hue = within(random, glm::dvec3(-tint), glm::dvec3(tint));
    return glm::vec3(glm::clamp(level * (1.0 + hue), 0.02, 0.9));
}

/// Lambert, or with a highlight beside the diffuse part; sharp: of an exponent that the hard case asks for.
void addMaterial(LotteryScene& s, Random& random, const std::string& name, bool sharp, std::vector<std::string>& list)
{
    scene::Material m = matt(name, colour(random, 0.2, 0.9));
    const bool glossy = sharp || chance(random, 0.4), phong = chance(random, 0.4);
    const double exponent = sharp ? logarithmic(random, 201, 2000) : logarithmic(random, 3, 200);
    const float strength = static_cast<float>(random.uniform(0.05, 0.5));
    if (s.traits.textures && chance(random, 0.4))
        m = textured(s.scene, name, pattern(random), glm::vec3(static_cast<float>(random.uniform(0.5, 1))));
    if (glossy) {
        m.specular = glm::vec3(strength);
        m.diffuse *= 1.0f - strength;
        m.exponent = static_cast<float>(exponent);
        m.name = fmt::format("{}_{}", phong ? "phong" : "blinn", name);
    }
    list.push_back(m.name);
    s.scene.materials.push_back(std::move(m));
}

} // namespace

image::RgbImage pattern(Random& random)
{
    const glm::dvec3 light = colour(random, 0.5, 0.9), dark = colour(random, 0.05, 0.3),
                     third = colour(random, 0.1, 0.7);
    const int kind = whole(random, 0, 5), count = whole(random, 3, 12);
    const auto seed = static_cast<unsigned>(whole(random, 1, 1000));
    switch (kind) {
    case 0:
        return wood(light, dark, count, seed);
    case 1:
        return checkedCloth(light, dark, count);
    case 2:
        return tiles(light, dark, count, seed);
    case 3:
        return wallpaper(light, dark, third, count);
    case 4:
        return bricks(light, dark, count, seed);
    default:
        return speckled(light, dark, 4 * count, seed);
    }
}

void makeMaterials(LotteryScene& s, Random random)
{
    const int surfaces = whole(random, 1, 3), things = whole(random, 2, 6);
    for (int i = 0; i < surfaces; ++i)
        addMaterial(s, random, fmt::format("surface{}", i), s.traits.sharp && i == 0, s.surfaces);
    for (int i = 0; i < things; ++i)
        addMaterial(s, random, fmt::format("thing{}", i), s.traits.sharp && i < 2, s.materials);
}

} // namespace wedge::generator
