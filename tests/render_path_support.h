// What tests of path tracing share: means over independent runs, and scenes with closed forms.
#pragma once

#include "tests/lobe_grid.h"
#include "tests/render_support.h"

#include <algorithm>
#include <span>

namespace wedge::test {

enum class Part { Beauty, Indirect };

/// Mean of each value of an image over runs of different seeds, and how sure it is.
struct Moments {
    std::vector<double> mean, variance; ///< variance: of the mean
    std::size_t size() const { return mean.size(); }
    double average() const
    {
        double sum = 0;
        for (const double m : mean)
            sum += m;
        return sum / static_cast<double>(size());
    }
};

inline Moments moments(render::Renderer& renderer, render::Settings settings, Part part, int runs)
{
    Moments out;
    std::vector<double> squares;
    for (int run = 0; run < runs; ++run) {
        settings.seed = static_cast<std::uint32_t>(1 + run);
        renderer.render(settings, {}, part != Part::Beauty);
        const std::vector<float> values =
            pixels(renderer, part == Part::Beauty ? "beauty" : "indirect", { 0, 0, settings.width, settings.height });
        REQUIRE(notFinite(values) == 0);
        out.mean.resize(values.size());
        squares.resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double before = out.mean[i], added = values[i] - before;
            out.mean[i] += added / (run + 1);
            squares[i] += added * (values[i] - out.mean[i]);
        }
    }
    for (const double s : squares)
        out.variance.push_back(s / (runs * (runs - 1.0)));
    return out;
}

/// How far two sets of values are apart, in standard deviations: of the sum over one channel of all pixels, the worst
/// of the three channels; and the root of the mean square, which is near 1 if pixels deviate as they vary.
struct Distance {
    double sum = 0, each = 0;
};

/// relative: uncertainty of a and b besides their variance, of rounding and quadrature.
inline Distance distance(const Moments& a, const Moments& b, double relative)
{
    REQUIRE(a.size() == b.size());
    Distance out;
    double squares = 0, expected = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double sum = 0, variance = 0, rounding = 0;
        for (std::size_t i = channel; i < a.size(); i += 3) {
            const double d = a.mean[i] - b.mean[i], v = a.variance[i] + b.variance[i];
            const double r = relative * std::fabs(b.mean[i]) + 1e-12;
            sum += d;
            variance += v;
            rounding += r;
            squares += d * d;
            expected += v + r * r;
        }
        out.sum = std::max(out.sum, std::fabs(sum) / std::sqrt(variance + rounding * rounding));
    }
    out.each = std::sqrt(squares / expected);
    return out;
}

/// The same for values that are known.
inline Moments exactly(std::vector<double> values)
{
    const std::size_t count = values.size();
    return { std::move(values), std::vector<double>(count) };
}

/// Checks that a agrees with b. The bounds hold for the means of 4 runs or more.
inline void checkAgreement(const Moments& a, const Moments& b, double relative = 1e-4)
{
    const Distance d = distance(a, b, relative);
    CAPTURE(a.average());
    CAPTURE(b.average());
    CHECK(d.sum < 4.5);
    CHECK(d.each < 1.6);
}

/// Every triangle with its own normal.
inline void flatten(scene::Scene& scene) { std::ranges::fill(scene.geometry.normals, 0.0f); }

inline std::uint32_t modelOf(const scene::Material& m)
{
    return m.specularModel == scene::SpecularModel::Phong ? WEDGE_PHONG : WEDGE_BLINN_PHONG;
}

/// Reflectance of a material without textures in 1/sr, straight from its definition.
inline glm::dvec3 reflectance(const scene::Material& m, glm::dvec3 n, glm::dvec3 view, glm::dvec3 light)
{
    const double c = m.specularModel == scene::SpecularModel::Phong
        ? 2 * glm::dot(n, view) * glm::dot(n, light) - glm::dot(view, light)
        : glm::dot(n, glm::normalize(view + light));
    const double lobe = shared::specularNormalization(m.exponent, modelOf(m)) * std::pow(std::max(0.0, c), m.exponent);
    return glm::dvec3(m.diffuse) / std::numbers::pi + glm::dvec3(m.specular) * lobe;
}

} // namespace wedge::test
