// A floor under a sun right above, and what throws a shadow on it that has a closed form.
#pragma once

#include "tests/render_support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace wedge::test::floors {

inline constexpr int width = 256, height = 192;
inline constexpr float eyeHeight = 1.9f;
/// Metres along each side of a pixel on the floor.
inline const double pixel = 2 * eyeHeight * std::tan(std::numbers::pi / 6) / height;

inline render::Settings settings(int w = width, int h = height) { return sized(render::monteCarlo(1), w, h); }

inline scene::ShadowStyle style(float inflation = 0, float softness = 0, float abstraction = 0, float brightness = 0)
{
    scene::ShadowStyle out;
    out.inflation = inflation;
    out.softness = softness;
    out.abstraction = abstraction;
    out.brightness = glm::vec3(brightness);
    return out;
}

/// A floor of 80 % under a sun right above, seen from straight above, from below what throws the shadow.
inline SceneBuilder underSun(float side = 10)
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = glm::vec3(0.8f);
    b.quad({ 0, 0, 0 }, { 0, 0, side }, { side, 0, 0 });
    b.newObject();
    b.camera({ 0, eyeHeight, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 60);
    b.scene.directionalLights.push_back({ { 0, -1, 0 }, glm::vec3(1.0f) });
    return b;
}

/// Of that floor where nothing hides the sun.
inline constexpr double lit = 0.8 / std::numbers::pi;

/// In shadow is what has x < 0, turned by so many radians.
inline scene::Scene halfPlane(double turn = 0)
{
    SceneBuilder b = underSun();
    const double c = std::cos(turn), s = std::sin(turn);
    const glm::vec3 along(s, 0, c), across(c, 0, -s);
    b.quad(glm::vec3(0, 2, 0) - 10.0f * across, 10.0f * along, 10.0f * across);
    return b.scene;
}

/// A disk of that radius is in shadow.
inline scene::Scene disk(float radius, glm::vec3 middle = { 0, 2, 0 }, int sides = 256)
{
    SceneBuilder b = underSun();
    for (int k = 0; k < sides; ++k) {
        const auto corner = [&](int at) {
            const double angle = 2 * std::numbers::pi * at / sides;
            return middle + radius * glm::vec3(std::cos(angle), 0, std::sin(angle));
        };
        b.triangle(middle, corner(k + 1), corner(k));
    }
    return b.scene;
}

inline std::vector<float> rendered(const device::Device& device, scene::Scene scene, const scene::ShadowStyle& style,
    const render::Settings& s = settings())
{
    scene.directionalLights.front().styles = { style };
    render::Renderer renderer(scene, device, renderOptions());
    return renderPixels(renderer, s);
}

/// The share of light in each pixel.
inline std::vector<double> shares(const std::vector<float>& image)
{
    std::vector<double> out;
    out.reserve(image.size() / 3);
    for (std::size_t i = 0; i < image.size(); i += 3)
        out.push_back(image[i] / lit);
    return out;
}

inline double at(const std::vector<double>& shares, int x, int y)
{
    return shares[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
}

/// Where in a row the share comes to one half from below, metres from the middle.
inline double edgeInRow(const std::vector<double>& shares, int y)
{
    for (int x = 1; x < width; ++x) {
        const double before = at(shares, x - 1, y), here = at(shares, x, y);
        if (before < 0.5 && here >= 0.5)
            return (x - 0.5 * width - 0.5 + (0.5 - before) / (here - before)) * pixel;
    }
    return 1e9;
}

/// Square metres in shadow.
inline double areaInShadow(const std::vector<double>& shares)
{
    double sum = 0;
    for (const double share : shares)
        sum += (1 - share) * pixel * pixel;
    return sum;
}

/// Distance to a circle by the closed form of its sum, see docs/stylized-shadows.md.
inline double toCircle(double radius, double rho)
{
    const double difference = radius * radius - rho * rho;
    const double x = (radius * radius + rho * rho) / std::abs(difference);
    const double legendre = 0.5 * (5 * x * x * x - 3 * x);
    const double phi = 2 * std::numbers::pi * radius * legendre / std::pow(difference, 4);
    const double constant = std::sqrt(std::numbers::pi) * std::tgamma(3.5) / std::tgamma(4.0);
    return std::pow(phi / constant, -1.0 / 7);
}

} // namespace wedge::test::floors
