#include "data/generator/lottery/stage.h"
#include "data/generator/patterns.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace wedge::generator {
namespace {

constexpr int width = 256, height = 128;
constexpr double pi = std::numbers::pi;

using Radiance = std::function<glm::dvec3(const glm::dvec3&)>;

/// A lat-long map of what is seen in each direction, up in the first row, scaled to a mean luminance over the sphere.
image::RgbImage mapOf(const Radiance& radiance, double mean)
{
    image::RgbImage map { width, height, {} };
    map.rgb.reserve(3u * width * height);
    double sum = 0, weights = 0;
    for (int y = 0; y < height; ++y) {
        const double down = pi * (y + 0.5) / height;
        for (int x = 0; x < width; ++x) {
            const double around = 2 * pi * (x + 0.5) / width;
            const glm::dvec3 seen =
                radiance({ std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around) });
            sum += std::sin(down) * glm::dot(seen, glm::dvec3(0.2126, 0.7152, 0.0722));
            weights += std::sin(down);
            for (int c = 0; c < 3; ++c)
                map.rgb.push_back(static_cast<float>(seen[c]));
        }
    }
    for (float& c : map.rgb)
        c *= static_cast<float>(mean * weights / sum);
    return map;
}

/// 1 towards the middle of a patch of a radius in radians, 0 beyond it, with a soft rim.
double patch(const glm::dvec3& to, const glm::dvec3& middle, double radius)
{
    const double angle = std::acos(glm::clamp(glm::dot(to, middle), -1.0, 1.0));
    return glm::clamp(2 - 2 * angle / radius, 0.0, 1.0);
}

Radiance clearSky(Random& random)
{
    const glm::dvec3 zenith = within(random, { 0.1, 0.2, 0.5 }, { 0.4, 0.5, 1.0 }),
                     horizon = within(random, glm::dvec3(0.5), glm::dvec3(1.2)),
                     ground = within(random, glm::dvec3(0.05), glm::dvec3(0.4));
    const double fall = random.uniform(0.3, 1.5);
    return [=](const glm::dvec3& to) { return to.y < 0 ? ground : glm::mix(horizon, zenith, std::pow(to.y, fall)); };
}

Radiance cloudySky(Random& random)
{
    const auto seed = static_cast<unsigned>(whole(random, 0, 1 << 20));
    const int bumps = whole(random, 3, 12);
    const double contrast = random.uniform(1, 6);
    const glm::dvec3 dark = within(random, glm::dvec3(0.02), glm::dvec3(0.3)),
                     bright = within(random, glm::dvec3(0.7), glm::dvec3(1.0));
    return [=](const glm::dvec3& to) {
        // Over a dome, seen from below: no seam and no pole.
        const double scale = bumps / (0.3 + std::abs(to.y));
        const double n = 0.6 * noise(scale * to.x + 100, scale * to.z + 100, 256, seed)
            + 0.4 * noise(3 * scale * to.x + 300, 3 * scale * to.z + 300, 1024, seed + 1);
        return glm::mix(dark, bright, std::pow(n, contrast)) * (to.y < 0 ? 0.3 : 1.0);
    };
}

/// That has `share` times the light of all else.
Radiance withSun(const Radiance& sky, Random& random)
{
    glm::dvec3 middle = direction(random);
    middle.y = std::max(0.1, std::abs(middle.y));
    middle = glm::normalize(middle);
    const double radius = logarithmic(random, 0.03, 0.1), share = logarithmic(random, 0.3, 4);
    const double bright = share * 0.5 * 4 * pi / (0.6 * pi * radius * radius);
    const glm::dvec3 tint = within(random, { 0.9, 0.6, 0.3 }, glm::dvec3(1.0));
    return [=](const glm::dvec3& to) { return sky(to) + bright * patch(to, middle, radius) * tint; };
}

Radiance lampsAround(Random& random)
{
    struct Lamp {
        glm::dvec3 middle, radiance;
        double radius;
    };
    std::vector<Lamp> lamps(static_cast<std::size_t>(logarithmic(random, 4, 30)));
    for (Lamp& lamp : lamps) {
        lamp.middle = direction(random);
        lamp.middle.y = chance(random, 0.8) ? std::abs(lamp.middle.y) : lamp.middle.y;
        lamp.radius = logarithmic(random, 0.03, 0.5);
        lamp.radiance = within(random, glm::dvec3(0.4), glm::dvec3(1.0)) * logarithmic(random, 0.05, 1)
            / (lamp.radius * lamp.radius);
    }
    const glm::dvec3 rest = within(random, glm::dvec3(0.005), glm::dvec3(0.1));
    return [=](const glm::dvec3& to) {
        glm::dvec3 sum = rest;
        for (const Lamp& lamp : lamps)
            sum += patch(to, lamp.middle, lamp.radius) * lamp.radiance;
        return sum;
    };
}

} // namespace

void makeSky(LotteryScene& s, Random random)
{
    random.uniform(0, 1); // kind and quads: traits
    random.uniform(0, 1);
    const double mean = random.uniform(0.3, 0.8);
    switch (s.traits.sky) {
    case Sky::None:
        break;
    case Sky::Even: {
        const glm::vec3 c(within(random, glm::dvec3(0.7), glm::dvec3(1.0)) * mean);
        s.scene.sky = { 1, 1, { c.r, c.g, c.b } };
        break;
    }
    case Sky::Clear:
        s.scene.sky = mapOf(clearSky(random), mean);
        break;
    case Sky::Clouds:
        s.scene.sky = mapOf(cloudySky(random), mean);
        break;
    case Sky::Sun: {
        const Radiance sky = clearSky(random);
        s.scene.sky = mapOf(withSun(sky, random), mean);
        break;
    }
    case Sky::Lamps:
        s.scene.sky = mapOf(lampsAround(random), mean);
        break;
    }
}

} // namespace wedge::generator
