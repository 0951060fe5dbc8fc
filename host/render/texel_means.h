#pragma once

#include "host/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// A rectangle of texture coordinates; low and high are numbers.
struct TextureBox {
    glm::dvec2 low { 0 }, high { 0 };
};

/// What a texture brings over parts of it, for probabilities: 0 where nothing can be seen there, and never where
/// something can. Takes eight bytes for each texel of at most `mostBlocks`; larger textures are kept as means of
/// blocks of texels.
class TexelMeans {
public:
    static constexpr std::size_t mostBlocks = std::size_t { 1 } << 22;

    /// Of what a material emits by that texture: luminance, W/(sr m^2).
    TexelMeans(const scene::Texture& texture, glm::vec3 emission);
    /// Of opacities, 0 to 1.
    explicit TexelMeans(const scene::Texture& texture);

    /// In texels.
    glm::dvec2 size() const { return { static_cast<double>(width_), static_cast<double>(height_) }; }
    /// Whether at() knows each texel.
    bool isExact() const { return blockX_ == 1 && blockY_ == 1; }
    /// As look-ups show it: between texels' middles, repeated.
    double at(glm::dvec2 coordinates) const;
    /// The mean over the texels that look-ups within the box may see.
    double mean(const TextureBox& box) const;

private:
    template <typename Value>
    void sum(const Value& value); // of a texel, 0 to 1
    double texel(std::int64_t x, std::int64_t y) const;
    std::uint64_t below(std::int64_t column, std::int64_t row) const;

    std::int64_t width_, height_; ///< texels
    std::int64_t blockX_ = 1, blockY_ = 1; ///< texels of a block
    std::int64_t columns_ = 0, rows_ = 0; ///< blocks
    double unit_ = 1; ///< what one of `sums_` stands for
    std::vector<std::uint64_t> sums_; ///< of the texels of all blocks left of a column and below a row
};

} // namespace wedge::render
