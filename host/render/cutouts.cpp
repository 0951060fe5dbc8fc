#include "host/render/cutouts.h"

#include "host/error.h"

#include <algorithm>
#include <bit>
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

} // namespace

bool isCutout(const scene::Material& m) { return m.opacity < 1.0f || m.opacityTexture >= 0; }

bool hasCutouts(const scene::Scene& scene)
{
    return std::ranges::any_of(
        scene.geometry.materialIds, [&](std::uint32_t id) { return isCutout(scene.materials[id]); });
}

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
    if (!hasCutouts(scene)) {
        return {};
    }
    const scene::Geometry& g = scene.geometry;
    const std::size_t triangles = g.materialIds.size();
    std::size_t words = triangles, cutouts = 0;
    std::map<int, std::size_t> textures; // where each begins
    for (std::size_t t = 0; t < triangles; ++t) {
        const scene::Material& m = materialOf(scene, t);
        cutouts += isCutout(m) ? 1 : 0;
        if (m.opacityTexture >= 0) {
            textures.emplace(m.opacityTexture, 0);
        }
    }
    words += cutouts * WEDGE_CUTOUT_WORDS;
    for (auto& [texture, begin] : textures) {
        begin = words;
        words += wordsOf(scene.textures[static_cast<std::size_t>(texture)].rgba.size());
    }
    if (words > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("cut-outs are too large", fmt::format("{} words of triangles and opacity textures", words),
            "use smaller opacity textures");
    }
    std::vector<std::uint32_t> table(words, WEDGE_NO_CUTOUT);
    std::size_t next = triangles;
    for (std::size_t t = 0; t < triangles; ++t) {
        const scene::Material& m = materialOf(scene, t);
        if (!isCutout(m)) {
            continue;
        }
        shared::Cutout c {};
        c.opacity = m.opacity;
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
