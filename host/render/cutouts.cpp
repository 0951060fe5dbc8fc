#include "host/render/cutouts.h"

#include "host/error.h"
#include "host/render/flush_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <fmt/format.h>

namespace wedge::render {
namespace {

const scene::Material& materialOf(const scene::Scene& scene, std::size_t triangle)
{
    return scene.materials[scene.geometry.materialIds[triangle]];
}

constexpr std::size_t wordsOf(std::size_t bytes) { return (bytes + 3) / 4; }

/// Cells of a grid of `side` an axis that a cover may reach, by the corners of its triangle.
struct Cells {
    std::uint32_t x0, y0, x1, y1;

    Cells(const Cover& cover, std::uint32_t side)
    {
        double low[2] = { 1, 1 }, high[2] = { 0, 0 };
        for (std::size_t i = 0; i < 3; ++i) {
            const auto &e = cover[i], &f = cover[(i + 1) % 3];
            const double determinant = static_cast<double>(e[0]) * f[1] - static_cast<double>(e[1]) * f[0];
            const double at[2] = { (static_cast<double>(e[1]) * f[2] - static_cast<double>(e[2]) * f[1]) / determinant,
                (static_cast<double>(e[2]) * f[0] - static_cast<double>(e[0]) * f[2]) / determinant };
            for (std::size_t axis = 0; axis < 2; ++axis) {
                // Edges that are nearly parallel: anywhere.
                low[axis] = std::isfinite(at[axis]) ? std::min(low[axis], at[axis]) : 0;
                high[axis] = std::isfinite(at[axis]) ? std::max(high[axis], at[axis]) : 1;
            }
        }
        const auto cellOf = [&](double at, double more) {
            return static_cast<std::uint32_t>(
                std::clamp(std::floor(at * side + more), 0.0, static_cast<double>(side - 1)));
        };
        x0 = cellOf(low[0], -0.01);
        y0 = cellOf(low[1], -0.01);
        x1 = cellOf(high[0], 0.01);
        y1 = cellOf(high[1], 0.01);
    }
    std::size_t count() const { return std::size_t { x1 - x0 + 1 } * (y1 - y0 + 1); }
};

/// The covers of one triangle, in the layout of kernels/shared/cutout.h.
std::vector<std::uint32_t> coverGrid(const std::vector<Cover>& covers)
{
    // Some four a cell, where they are small and even, and not more than 16 times each.
    auto side = static_cast<std::uint32_t>(std::clamp(std::sqrt(static_cast<double>(covers.size()) / 4.0), 1.0, 256.0));
    const auto entries = [&] {
        std::size_t sum = 0;
        for (const Cover& cover : covers) {
            sum += Cells(cover, side).count();
        }
        return sum;
    };
    while (side > 1 && entries() > 16 * covers.size()) {
        side /= 2;
    }
    std::vector<std::vector<std::uint32_t>> cells(std::size_t { side } * side);
    for (std::size_t i = 0; i < covers.size(); ++i) {
        const Cells reached(covers[i], side);
        for (std::uint32_t y = reached.y0; y <= reached.y1; ++y) {
            for (std::uint32_t x = reached.x0; x <= reached.x1; ++x) {
                cells[std::size_t { y } * side + x].push_back(static_cast<std::uint32_t>(i));
            }
        }
    }
    std::vector<std::uint32_t> out { side, 0 };
    for (const auto& cell : cells) {
        out.push_back(out.back() + static_cast<std::uint32_t>(cell.size()));
    }
    for (const auto& cell : cells) {
        for (const std::uint32_t i : cell) {
            for (const auto& edge : covers[i]) {
                for (const float x : edge) {
                    out.push_back(std::bit_cast<std::uint32_t>(x));
                }
            }
        }
    }
    return out;
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
    const scene::Geometry& g = scene.geometry;
    const std::size_t triangles = g.materialIds.size();
    std::map<std::size_t, std::vector<std::uint32_t>> grids;
    for (const auto& [triangle, covers] : coversOf(scene)) {
        grids.emplace(triangle, coverGrid(covers));
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
        throw Error("cut-outs are too large", fmt::format("{} words of triangles and opacity textures", words),
            "use smaller opacity textures");
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
        }
        if (m.opacityTexture >= 0) {
            const scene::Texture& texture = scene.textures[static_cast<std::size_t>(m.opacityTexture)];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t vertex = g.indices[3 * t + k];
                c.u[k] = g.texcoords[2 * vertex];
                c.v[k] = g.texcoords[2 * vertex + 1];
            }
            c.alphas = static_cast<std::uint32_t>(textures[m.opacityTexture]);
            c.width = static_cast<std::uint32_t>(texture.width);
            c.height = static_cast<std::uint32_t>(texture.height);
        }
        static_assert(sizeof(c) == WEDGE_CUTOUT_WORDS * sizeof(std::uint32_t));
        std::memcpy(&table[next], &c, sizeof(c));
        table[t] = static_cast<std::uint32_t>(next);
        next += WEDGE_CUTOUT_WORDS;
    }
    for (const auto& [texture, begin] : textures) {
        const scene::Texture& of = scene.textures[static_cast<std::size_t>(texture)];
        auto* bytes = reinterpret_cast<std::uint8_t*>(&table[begin]);
        for (std::size_t i = 0; i < of.rgba.size(); ++i) {
            bytes[i] = opacityOf(of, i);
        }
    }
    return table;
}

} // namespace wedge::render
