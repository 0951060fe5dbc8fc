#include "host/render/cutouts.h"

#include "host/error.h"
#include "host/render/flush_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace wedge::render {
namespace {

const scene::Material& materialOf(const scene::Scene& scene, std::size_t triangle)
{
    return scene.materials[scene.geometry.materialIds[triangle]];
}

constexpr std::size_t wordsOf(std::size_t bytes) { return (bytes + 3) / 4; }

/// A rectangle of barycentrics.
struct Rectangle {
    double low[2] = { 1, 1 }, high[2] = { 0, 0 };

    void add(const Rectangle& other)
    {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
    }
};

/// Around a cover, by the corners of its triangle, and within the triangle that it covers.
Rectangle around(const Cover& cover)
{
    Rectangle out;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &e = cover[i], &f = cover[(i + 1) % 3];
        const double determinant = static_cast<double>(e[0]) * f[1] - static_cast<double>(e[1]) * f[0];
        const double at[2] = { (static_cast<double>(e[1]) * f[2] - static_cast<double>(e[2]) * f[1]) / determinant,
            (static_cast<double>(e[2]) * f[0] - static_cast<double>(e[0]) * f[2]) / determinant };
        for (std::size_t axis = 0; axis < 2; ++axis) {
            // Edges that are nearly parallel: anywhere.
            const bool known = std::isfinite(at[axis]);
            out.low[axis] = std::min(out.low[axis], known ? std::max(at[axis] - 1e-6, 0.0) : 0.0);
            out.high[axis] = std::max(out.high[axis], known ? std::min(at[axis] + 1e-6, 1.0) : 1.0);
        }
    }
    return out;
}

/// A grid of `side` cells an axis over a rectangle.
class CoverGrid {
public:
    CoverGrid(const std::vector<Cover>& covers)
        : covers_(covers)
    {
        for (const Cover& cover : covers) {
            whole_.add(around(cover));
        }
        for (std::size_t axis = 0; axis < 2; ++axis) {
            low_[axis] = static_cast<float>(whole_.low[axis]);
        }
        // Some four a cell, where they are small and even, and not more than four times each.
        side_ =
            static_cast<std::uint32_t>(std::clamp(std::sqrt(static_cast<double>(covers.size()) / 4.0), 1.0, 1024.0));
        while (side_ > 1 && entries() > 4 * covers.size()) {
            side_ /= 2;
        }
    }

    /// In the layout of kernels/shared/cutout.h.
    std::vector<std::uint32_t> words() const
    {
        std::vector<std::uint32_t> counts(std::size_t { side_ } * side_ + 1, 0);
        for (const Cover& cover : covers_) {
            everyCell(cover, [&](std::size_t cell) { ++counts[cell + 1]; });
        }
        std::partial_sum(counts.begin(), counts.end(), counts.begin());
        std::vector<std::uint32_t> out { side_, bits(low_[0]), bits(low_[1]), bits(scale(0)), bits(scale(1)) };
        out.insert(out.end(), counts.begin(), counts.end());
        const std::size_t first = out.size();
        out.resize(first + WEDGE_COVER_WORDS * std::size_t { counts.back() });
        for (const Cover& cover : covers_) {
            everyCell(cover, [&](std::size_t cell) {
                std::memcpy(&out[first + WEDGE_COVER_WORDS * std::size_t { counts[cell]++ }], &cover, sizeof(cover));
            });
        }
        return out;
    }

private:
    static std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
    float scale(std::size_t axis) const
    {
        return static_cast<float>(side_ / std::max(whole_.high[axis] - whole_.low[axis], 1e-6));
    }
    /// A cell beside it, for the rounding of look-ups.
    template <class Visit>
    void everyCell(const Cover& cover, const Visit& visit) const
    {
        const Rectangle reached = around(cover);
        const auto cellOf = [&](std::size_t axis, double at, double more) {
            const double cell = std::floor((at - low_[axis]) * scale(axis) + more);
            return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
        };
        const std::size_t x0 = cellOf(0, reached.low[0], -0.01), x1 = cellOf(0, reached.high[0], 0.01);
        for (std::size_t y = cellOf(1, reached.low[1], -0.01); y <= cellOf(1, reached.high[1], 0.01); ++y) {
            for (std::size_t x = x0; x <= x1; ++x) {
                visit(y * side_ + x);
            }
        }
    }
    std::size_t entries() const
    {
        std::size_t sum = 0;
        for (const Cover& cover : covers_) {
            everyCell(cover, [&](std::size_t) { ++sum; });
        }
        return sum;
    }

    const std::vector<Cover>& covers_;
    Rectangle whole_;
    float low_[2] {};
    std::uint32_t side_ = 1;
};

/// One byte a texel.
void storeOpacities(const scene::Texture& texture, std::uint32_t* words)
{
    auto* bytes = reinterpret_cast<std::uint8_t*>(words);
    for (std::size_t i = 0; i < texture.rgba.size(); ++i) {
        bytes[i] = opacityOf(texture, i);
    }
}

/// The opacity texture of a triangle, whose bytes begin at that word of the table, and where the triangle lies in it.
void setTexture(const scene::Scene& scene, std::size_t triangle, std::size_t begin, shared::Cutout& c)
{
    const scene::Geometry& g = scene.geometry;
    const int number = materialOf(scene, triangle).opacityTexture;
    const scene::Texture& texture = scene.textures[static_cast<std::size_t>(number)];
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t vertex = g.indices[3 * triangle + k];
        c.u[k] = g.texcoords[2 * vertex];
        c.v[k] = g.texcoords[2 * vertex + 1];
    }
    c.alphas = static_cast<std::uint32_t>(begin);
    c.width = static_cast<std::uint32_t>(texture.width);
    c.height = static_cast<std::uint32_t>(texture.height);
}

} // namespace

bool isCutout(const scene::Material& m) { return m.opacity < 1.0f || m.opacityTexture >= 0; }

std::uint8_t opacityOf(const scene::Texture& texture, std::size_t texel)
{
    const std::uint32_t rgba = texture.rgba[texel];
    // Rec.709 weights in 16 bits; they add up to 1, so that white is 255.
    const std::uint32_t luminance =
        13933u * (rgba & 255u) + 46871u * ((rgba >> 8) & 255u) + 4732u * ((rgba >> 16) & 255u);
    return static_cast<std::uint8_t>(texture.hasAlpha ? rgba >> 24 : (luminance + 32768u) >> 16);
}

std::vector<std::uint32_t> cutoutTable(const scene::Scene& scene)
{
    const std::size_t triangles = scene.geometry.materialIds.size();
    std::map<std::size_t, std::vector<std::uint32_t>> grids;
    for (const auto& [triangle, covers] : coversOf(scene)) {
        grids.emplace(triangle, CoverGrid(covers).words());
    }
    std::size_t words = triangles, cutouts = 0;
    std::map<int, std::size_t> textures; // where each begins
    for (std::size_t t = 0; t < triangles; ++t) {
        const scene::Material& m = materialOf(scene, t);
        cutouts += isCutout(m) || grids.contains(t) ? 1 : 0;
        if (m.opacityTexture >= 0) {
            textures.emplace(m.opacityTexture, 0);
        }
    }
    if (cutouts == 0) {
        return {};
    }
    words += cutouts * WEDGE_CUTOUT_WORDS;
    for (auto& [texture, begin] : textures) {
        begin = words;
        words += wordsOf(scene.textures[static_cast<std::size_t>(texture)].rgba.size());
    }
    std::size_t nextGrid = words;
    for (const auto& [triangle, grid] : grids) {
        words += grid.size();
    }
    if (words > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("cut-outs are too large",
            fmt::format("{} words of triangles, opacity textures, and lamps in surfaces", words),
            "use smaller opacity textures, and move lamps of many triangles a millimetre off");
    }
    std::vector<std::uint32_t> table(words, WEDGE_NO_CUTOUT);
    std::size_t next = triangles;
    for (std::size_t t = 0; t < triangles; ++t) {
        const scene::Material& m = materialOf(scene, t);
        const auto grid = grids.find(t);
        if (!isCutout(m) && grid == grids.end()) {
            continue;
        }
        shared::Cutout c {};
        c.opacity = m.opacity;
        if (grid != grids.end()) {
            c.covers = static_cast<std::uint32_t>(nextGrid);
            std::ranges::copy(grid->second, table.begin() + static_cast<std::ptrdiff_t>(nextGrid));
            nextGrid += grid->second.size();
            grids.erase(grid); // which may be large
        }
        if (m.opacityTexture >= 0) {
            setTexture(scene, t, textures[m.opacityTexture], c);
        }
        static_assert(sizeof(c) == WEDGE_CUTOUT_WORDS * sizeof(std::uint32_t));
        std::memcpy(&table[next], &c, sizeof(c));
        table[t] = static_cast<std::uint32_t>(next);
        next += WEDGE_CUTOUT_WORDS;
    }
    for (const auto& [texture, begin] : textures) {
        storeOpacities(scene.textures[static_cast<std::size_t>(texture)], &table[begin]);
    }
    return table;
}

} // namespace wedge::render
