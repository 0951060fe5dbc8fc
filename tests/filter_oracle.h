// Images for the gather of filter.cl, and the gather in double.
#pragma once

#include "kernels/shared/filter_params.h"
#include "tests/render_support.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

namespace wedge::test {

/// What the filters read.
struct FilterImage {
    shared::FilterParams params {};
    Planes<float> value, beta, position, normal, pixelSize, slopeWidth;
    Planes<std::uint32_t> objectId;
    std::optional<Planes<float>> betaOfColumns; ///< where widths along y are others than beta
    std::optional<Planes<float>>
        gradients; ///< of sheared filters: planes of each channel of value, two or `moments`; kernels have 16 bits
    std::size_t moments = 2; ///< 5: of filters that follow second derivatives, as WEDGE_GATHER_CURVED
    bool meanSquare = false; ///< pairs have the mean of both squared bandwidths, as WEDGE_GATHER_MEAN_SQUARE

    FilterImage(int width, int height, std::size_t channels)
        : FilterImage(render::PlaneLayout(width, height), channels)
    {
    }
    explicit FilterImage(const render::PlaneLayout& layout, std::size_t channels)
        : value(layout, channels, 0.0f)
        , beta(layout, 1, 0.0f)
        , position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , pixelSize(layout, 1, 1.0f)
        , slopeWidth(layout, 1, 1.0f)
        , objectId(layout, 1, 0u)
    {
    }
    const Planes<float>& widthsAlong(bool rows) const { return rows || !betaOfColumns ? beta : *betaOfColumns; }
    int width() const { return static_cast<int>(value.layout.width); }
    int height() const { return static_cast<int>(value.layout.height); }
};

struct FilterResult {
    Planes<float> value, effective;
};

enum class Shape {
    Flat, ///< a plane across the view, one object
    Tilted, ///< a plane at a slant
    Steps, ///< blocks of two depths, some of them objects of their own
    Rough, ///< positions, normals and objects at random
};

inline glm::dvec3 rayOf(const shared::FilterParams& p, int x, int y)
{
    return toGlm(p.forward) + (x + 0.5 - 0.5 * p.width) * toGlm(p.right) + (y + 0.5 - 0.5 * p.height) * toGlm(p.down);
}

/// A camera at 3 m above the floor looking down at a slant; values in [0, 1]; widths of no, few and many pixels.
inline FilterImage randomImage(int width, int height, Shape shape, unsigned seed, std::size_t channels = 1)
{
    FilterImage image(width, height, channels);
    std::mt19937 random(seed);
    shared::FilterParams& p = image.params;
    p.eye = shared::vec3(0.2f, 3, 0.1f);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0.15, -1, -0.1)),
                     right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, -1)));
    p.forward = toVec3(forward);
    p.right = toVec3(right * 0.0173);
    p.down = toVec3(-glm::cross(right, forward) * 0.0173);
    p.lightCentre = shared::vec3(0.7f, 4, -0.5f);
    p.lightNormal = toVec3(glm::normalize(glm::dvec3(0.1, -1, 0.2)));
    p.normalCosine = 0.9848f;
    p.cut = 3;
    p.oblique = p.narrower = p.surface = 1;
    p.most = std::numeric_limits<float>::infinity();
    p.maxRadius = WEDGE_MAX_RADIUS;
    p.width = p.x1 = static_cast<std::uint32_t>(width);
    p.height = p.y1 = static_cast<std::uint32_t>(height);
    p.stride = image.value.layout.stride;
    p.planeSize = static_cast<std::uint32_t>(image.value.layout.size);
    const float widths[] = { 0, -1, 1e-6f, 0.02f, 0.06f, 0.11f, 0.25f, 1e4f };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool raised = shape == Shape::Steps && ((x / 9) + (y / 7)) % 3 == 0;
            const glm::dvec3 up =
                shape == Shape::Tilted ? glm::normalize(glm::dvec3(0.5, 1, -0.3)) : glm::dvec3(0, 1, 0);
            const glm::dvec3 ray = rayOf(p, x, y), eye = toGlm(p.eye);
            const double t = ((raised ? 0.3 : 0.0) - glm::dot(up, eye)) / glm::dot(up, ray);
            glm::dvec3 at = eye + t * ray, n = up;
            std::uint32_t object = 1 + (raised && x % 2 == 0 ? 1u : 0u);
            if (shape == Shape::Rough) {
                at += 0.1 * unitVector(random);
                n = glm::normalize(n + 0.12 * unitVector(random));
                object = static_cast<std::uint32_t>(random() % 4);
            }
            image.position.setVector(x, y, at);
            image.normal.setVector(x, y, n);
            const double z = glm::dot(at - eye, toGlm(p.forward)), facing = std::fabs(glm::dot(n, at - eye));
            image.pixelSize.at(x, y) = static_cast<float>(0.0173 * std::sqrt(z * z * z / facing));
            image.objectId.at(x, y) = object;
            image.beta.at(x, y) = shape == Shape::Flat ? widths[3 + random() % 3] : widths[random() % 8];
            for (std::size_t c = 0; c < channels; ++c)
                image.value.at(x, y, c) = static_cast<float>(uniform(random));
        }
    return image;
}

/// The same without a light: distances are plain ones.
inline FilterImage withoutLight(FilterImage image)
{
    image.params.oblique = 0;
    image.params.lightCentre = image.params.lightNormal = shared::vec3(0, 0, 0);
    return image;
}

/// The picture seen in a mirror: the pixels change places, and the camera's axis turns round.
inline FilterImage mirrored(const FilterImage& image, bool vertical)
{
    FilterImage out = image;
    shared::Vec3& axis = vertical ? out.params.down : out.params.right;
    axis = shared::vecScale(axis, -1.0f);
    const int width = image.width(), height = image.height();
    const auto turn = [&](auto& to, const auto& from, std::size_t planes) {
        for (std::size_t plane = 0; plane < planes; ++plane)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    to.at(vertical ? x : width - 1 - x, vertical ? height - 1 - y : y, plane) = from.at(x, y, plane);
    };
    turn(out.value, image.value, 1);
    turn(out.beta, image.beta, 1);
    turn(out.position, image.position, 3);
    turn(out.normal, image.normal, 3);
    turn(out.pixelSize, image.pixelSize, 1);
    turn(out.objectId, image.objectId, 1);
    return out;
}

/// The same scene in other units.
inline FilterImage scaled(const FilterImage& image, float factor)
{
    FilterImage out = image;
    for (float& x : out.position.values)
        x *= factor;
    for (float& s : out.pixelSize.values)
        s *= factor;
    for (float& b : out.beta.values)
        b *= b > 0 ? factor : 1.0f;
    out.params.eye = shared::vecScale(out.params.eye, factor);
    out.params.lightCentre = shared::vecScale(out.params.lightCentre, factor);
    return out;
}

/// Filtered values and effective counts in double. uncertain: pixels where a rounding decides what is gathered, here
/// or in the pass before.
struct OracleResult {
    int width = 0, channels = 1;
    std::vector<double> values, counts;
    std::vector<bool> doubtful;
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
    double value(int x, int y, int c) const
    {
        return values[index(x, y) * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
    }
    double effective(int x, int y) const { return counts[index(x, y)]; }
    bool uncertain(int x, int y) const { return doubtful[index(x, y)]; }
};

/// The gather's geometry as its definition has it, for one pixel.
class GatherGeometry {
public:
    GatherGeometry(const FilterImage& image, int x, int y)
        : image_(image)
        , position_(image.position.vector(x, y))
        , slant_(toGlm(image.params.lightNormal))
    {
        const shared::FilterParams& p = image.params;
        if (p.oblique != 0) {
            const glm::dvec3 l = glm::normalize(toGlm(p.lightCentre) - position_);
            const double cosine = glm::dot(l, toGlm(p.lightNormal));
            slant_ = l / std::copysign(std::max(std::fabs(cosine), 0.05), cosine);
        }
    }

    /// Squared distance across the light's rays (methods: e = D - l (D.n)/(l.n), or along the normal).
    double squared(glm::dvec3 d) const
    {
        const glm::dvec3 e = offset(d);
        return glm::dot(e, e);
    }
    glm::dvec3 offset(glm::dvec3 d) const { return d - slant_ * glm::dot(d, toGlm(image_.params.lightNormal)); }

    /// What a neighbour counts for the surface that it sees: 0 off the pixel's own. *doubt: a rounding may decide.
    double surface(int x, int y, int qx, int qy, bool* doubt) const
    {
        if (image_.params.surface == 0)
            return 1.0;
        const glm::dvec3 d = image_.position.vector(qx, qy) - position_;
        const double rise = std::fabs(glm::dot(image_.normal.vector(x, y), d)) / std::max(glm::length(d), 1e-30);
        *doubt = *doubt || std::fabs(rise - 0.3) < 1e-4;
        return rise > 0.3 ? 0.0 : std::min(std::pow(image_.pixelSize.at(qx, qy) / image_.pixelSize.at(x, y), 2.0), 4.0);
    }

    /// Pixels along image step `step` that `reach` metres on the tangent plane take, not rounded.
    double pixels(int x, int y, shared::Vec3 step, double reach) const
    {
        const glm::dvec3 fromEye = position_ - toGlm(image_.params.eye), n = image_.normal.vector(x, y);
        const double z = glm::dot(fromEye, toGlm(image_.params.forward)), facing = glm::dot(n, fromEye);
        const double bounded = std::copysign(std::max(std::fabs(facing), 0.05 * glm::length(fromEye)), facing);
        const glm::dvec3 moved = z * toGlm(step) - fromEye * (z * glm::dot(n, toGlm(step)) / bounded);
        return reach / std::max(std::sqrt(squared(moved)), 1e-20);
    }

private:
    const FilterImage& image_;
    glm::dvec3 position_, slant_;
};

/// What a pixel of a line counts for, d pixels from the one that gathers.
struct LineTap {
    int x, y;
    double d, weight;
    glm::dvec3 offset; ///< metres
};

/// What the values of each tap are multiplied by: weights over their sum or, fitted, the coefficients of a straight
/// line's value at 0, by least squares with 0.3 pixels^2 in the denominator of the slope.
inline std::vector<double> lineCoefficients(const std::vector<LineTap>& taps, bool fitted)
{
    double weights = 0, middle = 0, spread = 0;
    for (const LineTap& tap : taps) {
        weights += tap.weight;
        middle += tap.weight * tap.d;
    }
    middle /= weights;
    for (const LineTap& tap : taps)
        spread += tap.weight * (tap.d - middle) * (tap.d - middle);
    std::vector<double> out;
    out.reserve(taps.size());
    for (const LineTap& tap : taps)
        out.push_back(
            tap.weight * (1 / weights - (fitted ? middle * (tap.d - middle) / (spread + 0.3 * weights) : 0.0)));
    return out;
}

/// The standard deviation of a pair's kernel. there: the neighbour's own, 0 where it has none.
inline double pairWidth(const FilterImage& image, double beta, double there)
{
    if (!(there > 0))
        return beta;
    if (image.meanSquare) // of both bandwidths, 1 / (2 beta)
        return std::sqrt(2 / (1 / (beta * beta) + 1 / (there * there)));
    return image.params.narrower != 0 ? std::min(beta, there) : beta;
}

/// What a neighbour counts as: its value, as seen from where it is gathered to. Its moments are channels of `in` after
/// the values, and as seen from there, too.
inline double seenThere(
    const FilterImage& image, const OracleResult& in, const LineTap& tap, double slopeWidth, std::size_t c)
{
    const std::size_t values = image.value.values.size() / image.value.layout.size;
    const double own = in.value(tap.x, tap.y, static_cast<int>(c));
    if (!image.gradients)
        return own;
    const std::size_t first = c < values ? values + image.moments * c : c - (c - values) % image.moments;
    const auto moment = [&](std::size_t k) { return in.value(tap.x, tap.y, static_cast<int>(first + k)); };
    const double u = glm::dot(tap.offset, toGlm(image.params.shearU)) / slopeWidth,
                 v = glm::dot(tap.offset, toGlm(image.params.shearV)) / slopeWidth;
    if (image.moments == 2)
        return c < values ? own - u * moment(0) - v * moment(1) : own;
    // The polynomial b.z + z.C z, whose slope elsewhere is b + 2 C z.
    if (c < values)
        return own + u * moment(0) + v * moment(1) + u * u * moment(2) + 2 * u * v * moment(3) + v * v * moment(4);
    const std::size_t k = c - first;
    return k < 2 ? own + 2 * (u * moment(2 + k) + v * moment(3 + k)) : own;
}

/// One pass. in: values (channels a pixel) and counts of the pass before, with its doubts.
inline OracleResult gatherLine(const FilterImage& image, const OracleResult& in, int dx, int dy)
{
    const shared::FilterParams& p = image.params;
    const int width = image.width(), height = image.height();
    const Planes<float>& betas = image.widthsAlong(dx != 0);
    OracleResult out = in;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double beta = betas.at(x, y);
            if (!(beta > 0) || image.objectId.at(x, y) == 0)
                continue;
            const GatherGeometry geometry(image, x, y);
            const double widest = image.meanSquare ? std::sqrt(2.0) * beta : beta;
            const double exactRadius = geometry.pixels(x, y, dx != 0 ? p.right : p.down, p.cut * widest);
            const int radius =
                static_cast<int>(std::clamp(std::ceil(exactRadius), 1.0, static_cast<double>(p.maxRadius)));
            bool doubt = false;
            std::vector<LineTap> taps;
            for (int k = -radius - 1; k <= radius + 1; ++k) {
                const int qx = x + k * dx, qy = y + k * dy;
                if (qx < 0 || qy < 0 || qx >= width || qy >= height)
                    continue;
                const double there = betas.at(qx, qy);
                const double facing = glm::dot(image.normal.vector(x, y), image.normal.vector(qx, qy));
                if (k != 0 && (image.objectId.at(qx, qy) != image.objectId.at(x, y) || !(there >= 0)))
                    continue;
                const double squared = geometry.squared(image.position.vector(qx, qy) - image.position.vector(x, y));
                const double pair = pairWidth(image, beta, k != 0 ? there : 0.0);
                const double reach = image.meanSquare ? pair : beta, limit = p.cut * p.cut * reach * reach;
                const bool nearRadius = std::fabs(exactRadius - std::round(exactRadius)) < 1e-3 * exactRadius;
                if (k != 0 && (std::fabs(squared / limit - 1) < 1e-3 || std::fabs(facing - p.normalCosine) < 1e-5))
                    doubt = true;
                if (k != 0 && (facing < p.normalCosine || squared > limit))
                    continue;
                const double seen = k == 0 ? 1.0 : geometry.surface(x, y, qx, qy, &doubt);
                if (seen == 0)
                    continue;
                doubt |= (nearRadius && std::abs(k) >= radius && radius < static_cast<int>(p.maxRadius))
                    || in.uncertain(qx, qy);
                if (std::abs(k) > radius)
                    continue;
                const double w = k == 0 ? 1.0 : seen * std::exp(-0.5 * squared / (pair * pair));
                taps.push_back({ qx, qy, static_cast<double>(k), w,
                    geometry.offset(image.position.vector(qx, qy) - image.position.vector(x, y)) });
            }
            const std::size_t i = out.index(x, y);
            const auto channels = static_cast<std::size_t>(in.channels);
            const auto sumOf = [&](bool fitted, std::size_t c) {
                const std::vector<double> coefficients = lineCoefficients(taps, fitted);
                double sum = 0;
                for (std::size_t t = 0; t < taps.size(); ++t)
                    sum += coefficients[t]
                        * seenThere(image, in, taps[t], std::max<double>(beta, image.slopeWidth.at(x, y)), c);
                return sum;
            };
            for (std::size_t c = 0; c < channels; ++c) {
                // A line is believed up to a fifth of the mean off it, and less and less up to two fifths.
                const double mean = sumOf(false, c), off = c < p.fitted ? sumOf(true, c) - mean : 0.0;
                const double trust = std::clamp(2 - 5 * std::fabs(off) / std::max(std::fabs(mean), 1e-30), 0.0, 1.0);
                const double line = mean + trust * off;
                out.values[i * channels + c] =
                    c < p.fitted ? std::clamp(line, 0.0, std::max<double>(mean, p.most)) : mean;
            }
            double squares = 0;
            for (const double coefficient : lineCoefficients(taps, p.fitted != 0))
                squares += coefficient * coefficient;
            out.counts[i] = in.counts[i] / squares;
            out.doubtful[i] = out.doubtful[i] || doubt;
        }
    return out;
}

inline OracleResult oracleRows(const FilterImage& image)
{
    OracleResult in;
    in.width = image.width();
    in.channels = static_cast<int>(image.value.values.size() / image.value.layout.size);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < in.channels; ++c)
                in.values.push_back(image.value.at(x, y, static_cast<std::size_t>(c)));
            for (std::size_t k = 0; image.gradients && k < image.moments * static_cast<std::size_t>(in.channels); ++k)
                in.values.push_back(image.gradients->at(x, y, k));
            in.counts.push_back(1);
            in.doubtful.push_back(false);
        }
    in.channels *= image.gradients ? 1 + static_cast<int>(image.moments) : 1;
    return gatherLine(image, in, 1, 0);
}

inline OracleResult oracleColumns(const FilterImage& image, const OracleResult& rows)
{
    return gatherLine(image, rows, 0, 1);
}

/// The reference that the two passes stand for: one gather over all pixels within maxRadius, in row order.
inline std::vector<double> oracleSquare(const FilterImage& image)
{
    const shared::FilterParams& p = image.params;
    std::vector<double> out;
    const int radius = static_cast<int>(p.maxRadius);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const GatherGeometry geometry(image, x, y);
            double weights = 0, sum = 0;
            for (int qy = std::max(0, y - radius); qy < std::min(image.height(), y + radius + 1); ++qy)
                for (int qx = std::max(0, x - radius); qx < std::min(image.width(), x + radius + 1); ++qx) {
                    const double beta = image.beta.at(x, y), there = image.beta.at(qx, qy);
                    const double facing = glm::dot(image.normal.vector(x, y), image.normal.vector(qx, qy));
                    const double squared =
                        geometry.squared(image.position.vector(qx, qy) - image.position.vector(x, y));
                    if (image.objectId.at(qx, qy) != image.objectId.at(x, y) || facing < p.normalCosine
                        || squared > p.cut * p.cut * beta * beta)
                        continue;
                    const double width = p.narrower != 0 ? std::min(beta, there) : beta;
                    bool unused = false;
                    const double w =
                        geometry.surface(x, y, qx, qy, &unused) * std::exp(-0.5 * squared / (width * width));
                    weights += w;
                    sum += w * image.value.at(qx, qy);
                }
            out.push_back(sum / weights);
        }
    return out;
}

} // namespace wedge::test
