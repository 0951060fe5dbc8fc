#include "benchmarks/rendering_filters/shadow_outline.h"

#include "kernels/shared/pixel_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace wedge::benchmark {
namespace {

constexpr double facing = std::numbers::sqrt2 / 2; ///< cosine of 45 degrees
/// Of the mean to the power of 8 of distances to a straight edge: sqrt(pi) Gamma(7/2) / Gamma(4).
const double straightEdge = std::sqrt(std::numbers::pi) * std::tgamma(3.5) / std::tgamma(4.0);

std::size_t planesOf(const std::vector<float>& values, const graph::PlaneLayout& layout)
{
    return values.size() / layout.size;
}

} // namespace

ShadowOutline::ShadowOutline(render::Renderer& renderer, const std::string& light)
    : layout_(renderer.frame().layout)
    , normals_(0)
{
    const auto planes = [&](const std::string& name) {
        return renderer.frame().planes(name).downloadAll(renderer.queue());
    };
    position_ = planes("position");
    normal_ = planes("normal");
    normals_ = (planesOf(normal_, layout_) - 3) * layout_.size; // behind those of maps
    pixelSize_ = planes("pixelSize");
    matte_ = planes("shadowMatte" + light);
    distance_ = planes("shadowDistance" + light);
    object_ = renderer.frame().counts("objectId").downloadAll(renderer.queue());
    // Edges beyond the image have a say, but nobody sees what becomes of pixels there.
    const std::uint32_t margin = layout_.margin;
    for (std::uint32_t y = 0; y < layout_.height; ++y) {
        for (std::uint32_t x = 0; x < layout_.width; ++x) {
            const std::size_t i = shared::pixelIndex(x, y, layout_.stride);
            const bool shown = std::min(x, y) >= margin && x + margin < layout_.width && y + margin < layout_.height;
            if (shown && matte_[i] >= 0.0f) {
                pixels_.push_back(i);
            }
            if (x + 1 < layout_.width && y + 1 < layout_.height) {
                addPieces(i);
            }
        }
    }
}

glm::dvec3 ShadowOutline::vectorAt(const std::vector<float>& planes, std::size_t first, std::size_t pixel) const
{
    return { planes[first + pixel], planes[first + layout_.size + pixel], planes[first + 2 * layout_.size + pixel] };
}

bool ShadowOutline::onOneSurface(std::size_t a, std::size_t b) const
{
    const glm::dvec3 n = vectorAt(normal_, normals_, a), m = vectorAt(normal_, normals_, b);
    const glm::dvec3 d = vectorAt(position_, 0, b) - vectorAt(position_, 0, a);
    const double off = double { std::max(pixelSize_[a], pixelSize_[b]) };
    return object_[a] == object_[b] && glm::dot(n, m) > facing && std::abs(glm::dot(n, d)) <= off
        && std::abs(glm::dot(m, d)) <= off;
}

void ShadowOutline::addPieces(std::size_t corner)
{
    const std::array<std::size_t, 4> corners { corner, corner + 1, corner + layout_.stride + 1,
        corner + layout_.stride };
    std::vector<std::size_t> sides;
    glm::dvec3 normal(0.0);
    for (std::size_t k = 0; k < 4; ++k) {
        const float here = matte_[corners[k]], next = matte_[corners[(k + 1) % 4]];
        if (here < 0.0f) {
            return;
        }
        if (here != next) {
            sides.push_back(k);
        }
        normal += vectorAt(normal_, normals_, corners[k]);
    }
    for (std::size_t k = 0; k < 4 && !sides.empty(); ++k) {
        if (!onOneSurface(corners[k], corners[(k + 1) % 4])) {
            return;
        }
    }
    if (sides.size() == 4 && matte_[corners[1]] < 0.5f) {
        std::rotate(sides.begin(), sides.end() - 1, sides.end()); // around the lit corners
    }
    const auto middle = [&](std::size_t side) {
        return 0.5 * (vectorAt(position_, 0, corners[side]) + vectorAt(position_, 0, corners[(side + 1) % 4]));
    };
    for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
        const glm::dvec3 a = middle(sides[k]), b = middle(sides[k + 1]);
        pieces_.push_back({ 0.5 * (a + b), glm::normalize(normal), glm::length(b - a) });
    }
}

double ShadowOutline::share(const Piece& piece, const glm::dvec3& at, const glm::dvec3& normal) const
{
    const glm::dvec3 d = piece.middle - at;
    const double square = std::max(glm::dot(d, d), 1e-18), fourth = square * square;
    return glm::dot(piece.normal, normal) > facing ? piece.length / (fourth * fourth) : 0.0;
}

double ShadowOutline::distanceOf(double sum, std::size_t pixel) const
{
    const double distance =
        sum > 0.0 ? std::pow(sum / straightEdge, -1.0 / 7.0) : std::numeric_limits<double>::infinity();
    return matte_[pixel] > 0.5f ? distance : -distance;
}

double ShadowOutline::byAll(std::size_t pixel) const
{
    const glm::dvec3 at = vectorAt(position_, 0, pixel), normal = vectorAt(normal_, normals_, pixel);
    double sum = 0.0;
    for (const Piece& piece : pieces_) {
        sum += share(piece, at, normal);
    }
    return distanceOf(sum, pixel);
}

double ShadowOutline::bySome(std::size_t pixel, int count, std::mt19937_64& random) const
{
    const glm::dvec3 at = vectorAt(position_, 0, pixel), normal = vectorAt(normal_, normals_, pixel);
    double sum = 0.0;
    for (int k = 0; k < count && !pieces_.empty(); ++k) {
        sum += share(pieces_[random() % pieces_.size()], at, normal);
    }
    return distanceOf(sum * static_cast<double>(pieces_.size()) / count, pixel);
}

} // namespace wedge::benchmark
