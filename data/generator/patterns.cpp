#include "data/generator/patterns.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int side = 512;

/// A number in [0, 1) for a lattice point.
double hashed(int x, int y, unsigned seed)
{
    std::uint32_t h =
        static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return static_cast<double>(h ^ h >> 15) / 4294967296.0;
}

int wrapped(double cell, int period)
{
    const int i = static_cast<int>(cell) % period;
    return i < 0 ? i + period : i;
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

double fraction(double x) { return x - std::floor(x); }

/// 1 well inside [from, to], 0 well outside.
double band(double x, double from, double to, double soft)
{
    return smooth(glm::clamp((x - from) / soft + 0.5, 0.0, 1.0)) * smooth(glm::clamp((to - x) / soft + 0.5, 0.0, 1.0));
}

} // namespace

image::RgbImage paint(int width, int height, const std::function<glm::dvec3(double, double)>& colour)
{
    image::RgbImage image { width, height, {} };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::dvec3 sum(0.0);
            for (const double dy : { 0.25, 0.75 }) {
                for (const double dx : { 0.25, 0.75 })
                    sum += 0.25 * colour((x + dx) / width, 1.0 - (y + dy) / height);
            }
            for (int c = 0; c < 3; ++c)
                image.rgb.push_back(static_cast<float>(glm::clamp(sum[c], 0.0, 1.0)));
        }
    }
    return image;
}

double noise(double x, double y, int period, unsigned seed)
{
    const double fx = std::floor(x), fy = std::floor(y);
    const double a = smooth(x - fx), b = smooth(y - fy);
    const auto at = [&](double dx, double dy) {
        return hashed(wrapped(fx + dx, period), wrapped(fy + dy, period), seed);
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), a), glm::mix(at(0, 1), at(1, 1), a), b);
}

double stripes(double x, int count) { return fraction(x * count) < 0.5 ? 0.0 : 1.0; }

image::RgbImage wood(const glm::dvec3& light, const glm::dvec3& dark, int planks, unsigned seed)
{
    return paint(side, side, [=](double u, double v) {
        const double plank = std::floor(v * planks), in = fraction(v * planks);
        const int number = static_cast<int>(plank);
        const double shift = hashed(number, 0, seed);
        const double bend = 0.35 * noise(4 * u, 4 * v + 7 * shift, 4, seed + 1);
        const double grain = 0.5 + 0.5 * std::sin(2 * pi * (64.0 * v + 3.0 * bend * planks));
        const double pores = noise(32 * u, 256 * v, 256, seed + 2);
        const double ends = fraction(2 * u + shift) < 0.004 ? 0.3 : 1.0;
        const double joint = in < 0.02 || in > 0.98 ? 0.3 : ends;
        const double tone = 0.5 * grain + 0.35 * pores + 0.3 * (shift - 0.5);
        return joint * glm::mix(light, dark, glm::clamp(tone, 0.0, 1.0));
    });
}

image::RgbImage checkedCloth(const glm::dvec3& ground, const glm::dvec3& colour, int count)
{
    return paint(side, side, [=](double u, double v) {
        const double mixed = 0.5 * (stripes(u, count) + stripes(v, count));
        const double thread = 0.75 + 0.25 * std::sin(2 * pi * 96 * u) * std::sin(2 * pi * 96 * v);
        return thread * glm::mix(ground, colour, mixed);
    });
}

image::RgbImage tiles(const glm::dvec3& colour, const glm::dvec3& joint, int count, unsigned seed)
{
    return paint(side, side, [=](double u, double v) {
        const double x = u * count, y = v * count;
        const double inside = band(fraction(x), 0.05, 0.95, 0.04) * band(fraction(y), 0.05, 0.95, 0.04);
        const double tone = 0.65 + 0.5 * hashed(static_cast<int>(x), static_cast<int>(y), seed);
        const double marble = 0.8 + 0.3 * noise(96 * u, 96 * v, 96, seed + 1);
        return glm::mix(joint, tone * marble * colour, inside);
    });
}

image::RgbImage wallpaper(const glm::dvec3& ground, const glm::dvec3& first, const glm::dvec3& second, int count)
{
    return paint(side, side, [=](double u, double v) {
        const double x = fraction(u * count) - 0.5, y = fraction(v * count) - 0.5;
        const bool even = (static_cast<int>(u * count) + static_cast<int>(v * count)) % 2 == 0;
        const double away = std::sqrt(x * x + y * y), angle = std::atan2(y, x);
        const double petal = 0.3 * (0.6 + 0.4 * std::cos((even ? 5.0 : 8.0) * angle));
        const double pin = 0.85 + 0.15 * stripes(u, 8 * count);
        if (away < 0.08)
            return even ? second : first;
        return away < petal ? (even ? first : second) : pin * ground;
    });
}

image::RgbImage speckled(const glm::dvec3& colour, const glm::dvec3& specks, int count, unsigned seed)
{
    return paint(side, side, [=](double u, double v) {
        const double fine = noise(count * u, count * v, count, seed);
        const double broad = noise(8 * u, 8 * v, 8, seed + 1);
        const double speck = smooth(glm::clamp((fine - 0.62) / 0.12, 0.0, 1.0));
        return glm::mix((0.75 + 0.4 * broad) * colour, specks, speck);
    });
}

image::RgbImage veined(const glm::dvec3& blade, const glm::dvec3& vein)
{
    return paint(256, 128, [=](double u, double v) {
        const double across = std::abs(2.0 * v - 1.0);
        const double rib = 1.0 - smooth(glm::clamp(across / 0.08, 0.0, 1.0));
        const double branch = 0.5 + 0.5 * std::sin(2 * pi * (14 * u - 5 * across));
        const double fine = noise(64 * u, 32 * v, 64, 31);
        const double light = std::max(rib, smooth(glm::clamp((branch - 0.8) / 0.2, 0.0, 1.0)));
        return glm::mix((0.7 + 0.6 * fine) * blade, vein, light);
    });
}

image::RgbImage brushed(const glm::dvec3& colour, unsigned seed)
{
    return paint(256, 256, [=](double u, double v) {
        const double scratches = noise(8 * u, 256 * v, 256, seed), broad = noise(4 * u, 64 * v, 64, seed + 1);
        return (0.55 + 0.35 * scratches + 0.25 * broad) * colour;
    });
}

image::RgbImage bookBack(const glm::dvec3& colour, const glm::dvec3& gilt, unsigned seed)
{
    return paint(64, 256, [=](double u, double v) {
        const double leather = 0.7 + 0.5 * noise(32 * u, 128 * v, 128, seed);
        const bool bands = band(v, 0.08, 0.1, 0.005) + band(v, 0.86, 0.88, 0.005) + band(v, 0.9, 0.91, 0.005) > 0.5;
        const double line = fraction(v * 24);
        const bool title = v > 0.55 && v < 0.8 && u > 0.2 && u < 0.8 && line > 0.35 && line < 0.8
            && hashed(static_cast<int>(u * 20), static_cast<int>(v * 24), seed) > 0.4;
        return bands || title ? gilt : leather * colour;
    });
}

image::RgbImage carpet(const glm::dvec3& ground, const glm::dvec3& first, const glm::dvec3& second, int count)
{
    return paint(side, side, [=](double u, double v) {
        const double x = std::abs(fraction(u * count) - 0.5), y = std::abs(fraction(v * count) - 0.5);
        const double rhomb = x + y;
        const double tuft = 0.55 + 0.45 * std::abs(std::sin(pi * 96 * u) * std::sin(pi * 96 * v))
            + 0.2 * (noise(256 * u, 256 * v, 256, 41) - 0.5);
        const glm::dvec3 colour = rhomb < 0.15 ? second : rhomb < 0.3 ? ground : rhomb < 0.4 ? first : ground;
        return tuft * colour;
    });
}

image::RgbImage bricks(const glm::dvec3& brick, const glm::dvec3& mortar, int rows, unsigned seed)
{
    return paint(side, side, [=](double u, double v) {
        const double y = v * rows;
        const int row = static_cast<int>(y);
        const double x = fraction(u + (row % 2) * 0.5 * 2.0 / rows) * rows / 2.0;
        const double inside = band(fraction(x), 0.03, 0.97, 0.03) * band(fraction(y), 0.07, 0.93, 0.06);
        const double tone = 0.6 + 0.6 * hashed(static_cast<int>(x), row, seed);
        const double rough = 0.75 + 0.5 * noise(128 * u, 128 * v, 128, seed + 1);
        return glm::mix(mortar, tone * rough * brick, inside);
    });
}

} // namespace wedge::generator
