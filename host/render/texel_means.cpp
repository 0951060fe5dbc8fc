#include "host/render/texel_means.h"

#include "host/render/cutouts.h"
#include "host/render/luminance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wedge::render {
namespace {

/// Sums are of whole numbers, so that a difference of two is 0 where nothing is.
constexpr double wholes = 1 << 24;

std::array<double, 256> linearBytes()
{
    std::array<double, 256> out {};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double v = static_cast<double>(i) / 255.0;
        out[i] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return out;
}

/// A range of texels, the last one too, as one of blocks of a texture that is repeated.
struct Blocks {
    std::int64_t from, end; ///< from: within the first period
    std::int64_t texels;
};

/// low, high: in texels, of places that are looked up.
Blocks blocksOf(double low, double high, std::int64_t size, std::int64_t block, std::int64_t count)
{
    // Coordinates on the device are off by their rounding.
    const double rounding = 0.01 + 1e-6 * std::max(std::abs(low), std::abs(high));
    const double first = std::floor(low - 0.5 - rounding), last = std::floor(high + 0.5 + rounding);
    if (!(last - first + 1 < static_cast<double>(size))) {
        return { 0, count, size };
    }
    const double period = std::floor(first / static_cast<double>(size)) * static_cast<double>(size);
    const auto from = std::min(static_cast<std::int64_t>(first - period), size - 1),
               to = from + static_cast<std::int64_t>(last - first);
    const auto blockAt = [&](std::int64_t texel) { return texel / size * count + texel % size / block; };
    const auto texelsBelow = [&](std::int64_t b) { return b / count * size + std::min(b % count * block, size); };
    const std::int64_t begin = blockAt(from), end = blockAt(to) + 1;
    return { begin, end, texelsBelow(end) - texelsBelow(begin) };
}

} // namespace

template <typename Value>
void TexelMeans::sum(const Value& value)
{
    while (((width_ + blockX_ - 1) / blockX_) * ((height_ + blockY_ - 1) / blockY_)
        > static_cast<std::int64_t>(mostBlocks)) {
        (width_ / blockX_ > height_ / blockY_ ? blockX_ : blockY_) *= 2;
    }
    columns_ = (width_ + blockX_ - 1) / blockX_;
    rows_ = (height_ + blockY_ - 1) / blockY_;
    const auto stride = static_cast<std::size_t>(columns_) + 1;
    sums_.assign(stride * (static_cast<std::size_t>(rows_) + 1), 0);
    std::vector<std::uint64_t> row(stride);
    for (std::int64_t y = 0; y < height_; ++y) {
        const auto above = static_cast<std::size_t>(y / blockY_ + 1) * stride;
        if (y % blockY_ == 0) {
            std::ranges::fill(row, 0);
        }
        for (std::int64_t x = 0; x < width_; ++x) {
            const double v = value(
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)); // 0 to 1
            row[static_cast<std::size_t>(x / blockX_) + 1] += static_cast<std::uint64_t>(std::ceil(v * wholes));
        }
        if (y % blockY_ == blockY_ - 1 || y == height_ - 1) {
            std::uint64_t along = 0;
            for (std::size_t x = 1; x < stride; ++x) {
                along += row[x];
                sums_[above + x] = sums_[above - stride + x] + along;
            }
        }
    }
}

TexelMeans::TexelMeans(const scene::Texture& texture, glm::vec3 emission)
    : width_(texture.width)
    , height_(texture.height)
{
    static const std::array<double, 256> linear = linearBytes();
    const glm::dvec3 weights = luminanceWeights() * glm::max(glm::dvec3(emission), 0.0);
    const double most = weights.r + weights.g + weights.b;
    const glm::dvec3 share = most > 0 ? weights / most : glm::dvec3(0);
    unit_ = most / wholes;
    sum([&](std::size_t i) {
        const std::uint32_t rgba = texture.rgba[i];
        return share.r * linear[rgba & 255u] + share.g * linear[(rgba >> 8) & 255u]
            + share.b * linear[(rgba >> 16) & 255u];
    });
}

TexelMeans::TexelMeans(const scene::Texture& texture)
    : width_(texture.width)
    , height_(texture.height)
    , unit_(1.0 / wholes)
{
    sum([&](std::size_t i) { return opacityOf(texture, i) / 255.0; });
}

/// Sum of the blocks before a column and a row, of a texture that is there twice either way.
std::uint64_t TexelMeans::below(std::int64_t column, std::int64_t row) const
{
    const auto at = [&](std::int64_t x, std::int64_t y) {
        return sums_[static_cast<std::size_t>(y) * (static_cast<std::size_t>(columns_) + 1)
            + static_cast<std::size_t>(x)];
    };
    const bool again = column > columns_, above = row > rows_;
    const std::int64_t x = again ? column - columns_ : column, y = above ? row - rows_ : row;
    return at(x, y) + (again ? at(columns_, y) : 0) + (above ? at(x, rows_) : 0)
        + (again && above ? at(columns_, rows_) : 0);
}

double TexelMeans::texel(std::int64_t x, std::int64_t y) const
{
    return static_cast<double>(below(x + 1, y + 1) - below(x, y + 1) - below(x + 1, y) + below(x, y));
}

double TexelMeans::at(glm::dvec2 coordinates) const
{
    const glm::dvec2 within = coordinates - glm::floor(coordinates);
    const double x = within.x * static_cast<double>(width_) - 0.5, y = within.y * static_cast<double>(height_) - 0.5;
    const auto x0 = static_cast<std::int64_t>(std::floor(x)), y0 = static_cast<std::int64_t>(std::floor(y));
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const auto wrapped = [&](std::int64_t i, std::int64_t j) {
        return texel((i + width_) % width_ / blockX_, (j + height_) % height_ / blockY_);
    };
    const double lower = (1 - fx) * wrapped(x0, y0) + fx * wrapped(x0 + 1, y0),
                 upper = (1 - fx) * wrapped(x0, y0 + 1) + fx * wrapped(x0 + 1, y0 + 1);
    return unit_ * ((1 - fy) * lower + fy * upper);
}

double TexelMeans::mean(const TextureBox& box) const
{
    const Blocks x = blocksOf(box.low.x * static_cast<double>(width_), box.high.x * static_cast<double>(width_), width_,
                     blockX_, columns_),
                 y = blocksOf(box.low.y * static_cast<double>(height_), box.high.y * static_cast<double>(height_),
                     height_, blockY_, rows_);
    const std::uint64_t sum = below(x.end, y.end) - below(x.from, y.end) - below(x.end, y.from) + below(x.from, y.from);
    return unit_ * static_cast<double>(sum) / (static_cast<double>(x.texels) * static_cast<double>(y.texels));
}

} // namespace wedge::render
