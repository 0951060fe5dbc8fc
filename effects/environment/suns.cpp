#include "effects/environment/suns.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace wedge::render {
namespace {

/// A source's texels are brighter than this many times the mean over the sphere.
constexpr double brightness = 50.0;
/// It sends at least this part of all light, and its deviation along its longer axis is at most so many radians: what
/// sends less is sampled well enough, what is wider is no exception to the band limit.
constexpr double leastShare = 0.05, mostDeviation = 0.05;
/// Each source costs a shadow ray a sample.
constexpr std::size_t mostSuns = 4;
/// How far away they are, in diameters of the scene: at a scene's edge they are off by 1/200 of a radian. Slopes of
/// what occludes them are resolved from a ten-thousandth of a diameter on (WEDGE_SLOPE_MIN).
constexpr double distance = 100.0;

/// Texels and the lookup between them make suns fall off towards their edges: as a Gaussian that ends so many standard
/// deviations from its middle, between an even disc and a single texel.
constexpr double cut = 1.5;

constexpr double pi = 3.14159265358979323846;

/// Where a picture's texels are, and how much of the sphere the lookup, which goes linearly from each one's middle to
/// the next, gives to them.
class Texels {
public:
    explicit Texels(const EnvironmentPicture& p)
        : p_(p)
    {
    }
    std::size_t at(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(p_.width) + static_cast<std::size_t>(x);
    }
    glm::dvec3 colour(std::size_t i) const
    {
        return { p_.radiance[3 * i], p_.radiance[3 * i + 1], p_.radiance[3 * i + 2] };
    }
    double luminance(std::size_t i) const
    {
        return shared::luminance(shared::vec3(p_.radiance[3 * i], p_.radiance[3 * i + 1], p_.radiance[3 * i + 2]));
    }
    glm::dvec3 direction(int x, int y) const
    {
        const double angle = 2.0 * pi * ((x + 0.5) / p_.width - 0.5), down = pi * (y + 0.5) / p_.height;
        return std::cos(down) * glm::dvec3(p_.up)
            + std::sin(down) * (std::sin(angle) * glm::dvec3(p_.right) - std::cos(angle) * glm::dvec3(p_.back));
    }
    /// Steradians: the integral of the weight that the lookup gives to a texel of the row.
    double solidAngle(int y) const
    {
        const double step = pi / p_.height, middle = step * (y + 0.5);
        const double above =
            y > 0 ? (std::sin(middle) - std::sin(middle - step)) / step - std::cos(middle) : 1.0 - std::cos(middle);
        const double below = y + 1 < p_.height ? std::cos(middle) - (std::sin(middle + step) - std::sin(middle)) / step
                                               : 1.0 + std::cos(middle);
        return 2.0 * pi / p_.width * (above + below);
    }
    /// What a texel's own extent adds to the variance along columns and rows, radians^2.
    double variance() const { return pi / p_.height * pi / p_.height / 6.0; }

    int width() const { return p_.width; }
    int height() const { return p_.height; }

private:
    const EnvironmentPicture& p_;
};

struct Place {
    int x, y;
};

/// Calls for each of the eight texels around one, of which there are fewer at the poles.
template <class Function>
void around(const Texels& texels, Place at, Function&& call)
{
    for (int dy = -1; dy <= 1; ++dy) {
        const int y = at.y + dy;
        for (int dx = -1; y >= 0 && y < texels.height() && dx <= 1; ++dx) {
            if (dx != 0 || dy != 0) {
                call(Place { (at.x + dx + texels.width()) % texels.width(), y });
            }
        }
    }
}

/// Texels brighter than `bright` that touch each other, and the mean luminance of those around them.
struct Lobe {
    std::vector<Place> texels;
    double surroundings = 0;
};

Lobe lobeFrom(const Texels& texels, Place first, double bright, std::vector<bool>& met)
{
    Lobe out { { first }, 0 };
    met[texels.at(first.x, first.y)] = true;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < out.texels.size(); ++i) {
        around(texels, out.texels[i], [&](Place next) {
            const std::size_t n = texels.at(next.x, next.y);
            if (!(texels.luminance(n) > bright)) {
                sum += texels.luminance(n); // one that touches two of them counts twice
                ++count;
            } else if (!met[n]) {
                met[n] = true;
                out.texels.push_back(next);
            }
        });
    }
    out.surroundings = count > 0 ? sum / static_cast<double>(count) : bright;
    return out;
}

/// How much of a texel the surroundings account for.
double kept(const Texels& texels, const Lobe& lobe, std::size_t i)
{
    return std::min(1.0, lobe.surroundings / texels.luminance(i));
}

/// Of the Gaussian that is cut, along an axis on which it ends 1 from its middle.
double profileVariance()
{
    const double edge = std::exp(-0.5 * cut * cut) / std::sqrt(2.0 * pi);
    return (1.0 - 2.0 * cut * edge / std::erf(cut / std::sqrt(2.0))) / (cut * cut);
}

/// And its mean over that axis.
double profileMean() { return std::sqrt(0.5 * pi) * std::erf(cut / std::sqrt(2.0)) / cut; }

/// The rectangle of a lobe's direction, second moments and excess over its surroundings.
Sun sunOf(const Texels& texels, const Lobe& lobe, double irradiance)
{
    glm::dvec3 colour(0.0), mean(0.0);
    double total = 0;
    for (const Place& at : lobe.texels) {
        const std::size_t i = texels.at(at.x, at.y);
        const glm::dvec3 excess = (1.0 - kept(texels, lobe, i)) * texels.solidAngle(at.y) * texels.colour(i);
        const double l = (1.0 - kept(texels, lobe, i)) * texels.solidAngle(at.y) * texels.luminance(i);
        colour += excess;
        mean += l * texels.direction(at.x, at.y);
        total += l;
    }
    const glm::dvec3 towards = glm::normalize(mean);
    const glm::dvec3 aside = std::abs(towards.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(towards, aside)), b = glm::cross(towards, a);
    double aa = texels.variance(), ab = 0, bb = texels.variance();
    for (const Place& at : lobe.texels) {
        const std::size_t i = texels.at(at.x, at.y);
        const double l = (1.0 - kept(texels, lobe, i)) * texels.solidAngle(at.y) * texels.luminance(i) / total;
        const glm::dvec3 d = texels.direction(at.x, at.y);
        const double u = glm::dot(d, a), v = glm::dot(d, b);
        aa += l * u * u;
        ab += l * u * v;
        bb += l * v * v;
    }
    const double half = 0.5 * (aa + bb), root = std::hypot(0.5 * (aa - bb), ab),
                 turn = 0.5 * std::atan2(2 * ab, aa - bb);
    const double longer = std::sqrt((half + root) / profileVariance()),
                 shorter = std::sqrt(std::max(half - root, 0.25 * half) / profileVariance());
    const double c = std::cos(turn), s = std::sin(turn);
    Sun sun;
    sun.towards = glm::vec3(towards);
    sun.halfU = glm::vec3(longer * (c * a + s * b));
    sun.halfV = glm::vec3(shorter * (c * b - s * a));
    const double solidAngle = 4.0 * std::atan(longer * shorter / std::sqrt(1.0 + longer * longer + shorter * shorter));
    sun.radiance = glm::vec3(colour / solidAngle);
    sun.share = total / irradiance;
    return sun;
}

} // namespace

void separateSuns(EnvironmentPicture& picture)
{
    const Texels texels(picture);
    double irradiance = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            irradiance += texels.solidAngle(y) * texels.luminance(texels.at(x, y));
        }
    }
    const double bright = brightness * irradiance / (4.0 * pi);
    std::vector<bool> met(picture.radiance.size() / 3);
    std::vector<std::pair<Sun, Lobe>> found;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t i = texels.at(x, y);
            if (met[i] || !(texels.luminance(i) > bright)) {
                continue;
            }
            Lobe lobe = lobeFrom(texels, { x, y }, bright, met);
            const Sun sun = sunOf(texels, lobe, irradiance);
            if (sun.share >= leastShare && glm::length(sun.halfU) <= mostDeviation / std::sqrt(profileVariance())) {
                found.emplace_back(sun, std::move(lobe));
            }
        }
    }
    std::ranges::stable_sort(found, std::greater<> {}, [](const auto& f) { return f.first.share; });
    found.resize(std::min(found.size(), mostSuns));
    if (!found.empty()) {
        picture.shown = picture.radiance;
    }
    std::vector<float> rest = picture.radiance;
    for (const auto& [sun, lobe] : found) {
        picture.suns.push_back(sun);
        for (const Place& at : lobe.texels) {
            const std::size_t i = texels.at(at.x, at.y);
            const auto part = static_cast<float>(kept(texels, lobe, i));
            std::ranges::for_each_n(rest.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, [&](float& c) { c *= part; });
        }
    }
    picture.radiance = std::move(rest);
}

std::vector<scene::AreaLight> sunLights(const EnvironmentPicture& picture, const scene::Bounds& bounds)
{
    std::vector<scene::AreaLight> out;
    if (bounds.empty()) {
        return out;
    }
    const glm::vec3 middle = 0.5f * (bounds.lo + bounds.hi);
    const float far = static_cast<float>(distance) * std::max(glm::length(bounds.hi - bounds.lo), 1e-6f);
    for (const Sun& sun : picture.suns) {
        scene::AreaLight light;
        light.name = fmt::format("sun {} of the environment", out.size() + 1);
        light.centre = middle + far * sun.towards;
        light.halfU = far * sun.halfU;
        light.halfV = far * sun.halfV;
        if (glm::dot(glm::cross(light.halfU, light.halfV), sun.towards) > 0.0f) {
            std::swap(light.halfU, light.halfV); // its front is towards the scene
        }
        light.radiance = sun.radiance / static_cast<float>(profileMean() * profileMean());
        light.profile = scene::LightProfile::Gaussian;
        light.cut = static_cast<float>(cut);
        light.twoSided = false;
        light.visible = false; // the picture is
        out.push_back(light);
    }
    return out;
}

} // namespace wedge::render
