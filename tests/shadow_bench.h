// Passes of frames whose lights' shadows have a style, up to the edges of shadows, and these by the host in double.
#pragma once

#include "bvh/host_traverse.h"
#include "kernels/shared/styled_shadows.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <numbers>

namespace wedge::test::shadows {

inline constexpr int width = 93, height = 71;
inline constexpr float inflation = 0.05f, softness = 0.1f, abstraction = 0.06f;
inline const glm::dvec3 sunward(-0.36, 0.8, -0.48), irradiance(1, 2, 3);

/// The small scene, glossy, under one sun whose shadows have a style.
inline scene::Scene underSun(float alpha = abstraction)
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.3f };
    scene.materials[0].exponent = 12;
    scene::ShadowStyle style;
    style.inflation = inflation;
    style.softness = softness;
    style.abstraction = alpha;
    style.brightness = glm::vec3(0.1f, 0.2f, 0.3f);
    scene.directionalLights.push_back({ -glm::vec3(sunward), glm::vec3(irradiance), "sun", { style } });
    return scene;
}

/// The frame's passes up to the edges of its shadow, run one after the other.
struct Traced {
    explicit Traced(const device::Device& device, float alpha = abstraction)
        : frame(device, underSun(alpha), sized(render::monteCarlo(1), width, height))
        , primary(frame, "primary")
        , matte(frame, "shadowMatte")
    {
        primary.run();
        for (const char* name : { "position", "normal", "origin" })
            matte.plane(name, primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            matte.plane(name, primary.read<std::uint32_t>(name));
        matte.plane("matte", std::vector<float>(frame.layout.size, WEDGE_MATTE_UNKNOWN));
        matte.run();
    }
    /// What a pass reads of surfaces, and of the light if it reads that.
    void give(PassBench& pass) const
    {
        for (const char* name : { "position", "normal", "pixelSize" })
            if (pass.has(name))
                pass.plane(name, primary.read<float>(name));
        if (pass.has("objectId"))
            pass.plane("objectId", primary.read<std::uint32_t>("objectId"));
        if (pass.has("matte"))
            pass.plane("matte", matte.read<float>("matte"));
    }

    DeclaredFrame frame;
    PassBench primary, matte;
};

/// What of a scene the tests look at: planes of pixels.
struct Seen {
    explicit Seen(const Traced& traced)
        : position(traced.primary.pixels<float>("position"))
        , normal(traced.primary.pixels<float>("normal"))
        , size(traced.primary.pixels<float>("pixelSize"))
        , matte(traced.matte.pixels<float>("matte"))
        , object(traced.primary.pixels<std::uint32_t>("objectId"))
    {
    }
    Planes<float> position, normal, size, matte;
    Planes<std::uint32_t> object;
};

struct Piece {
    glm::dvec3 middle, normal;
    double length;
};

inline bool onOneSurface(const Seen& s, glm::ivec2 a, glm::ivec2 b)
{
    const glm::dvec3 n = s.normal.vector(a.x, a.y), m = s.normal.vector(b.x, b.y);
    const glm::dvec3 d = s.position.vector(b.x, b.y) - s.position.vector(a.x, a.y);
    const double off = std::max(s.size.at(a.x, a.y), s.size.at(b.x, b.y));
    return s.object.at(a.x, a.y) == s.object.at(b.x, b.y) && glm::dot(n, m) > std::numbers::sqrt2 / 2
        && std::abs(glm::dot(n, d)) <= off && std::abs(glm::dot(m, d)) <= off;
}

/// Of the cell whose first corner is that pixel, by the table of marching squares.
inline std::vector<Piece> piecesOf(const Seen& s, int x, int y)
{
    const glm::ivec2 corners[] = { { x, y }, { x + 1, y }, { x + 1, y + 1 }, { x, y + 1 } };
    int code = 0;
    glm::dvec3 sum(0);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 at = corners[k], next = corners[(k + 1) % 4];
        const float v = s.matte.at(at.x, at.y);
        if (v < 0 || !onOneSurface(s, at, next))
            return {};
        code |= v > 0.5f ? 1 << k : 0;
        sum += s.normal.vector(at.x, at.y);
    }
    // Bits: lit corners. Sides that pieces join, -1: none.
    const int table[16][4] = { { -1, -1, -1, -1 }, { 3, 0, -1, -1 }, { 0, 1, -1, -1 }, { 3, 1, -1, -1 },
        { 1, 2, -1, -1 }, { 3, 0, 1, 2 }, { 0, 2, -1, -1 }, { 3, 2, -1, -1 }, { 2, 3, -1, -1 }, { 2, 0, -1, -1 },
        { 0, 1, 2, 3 }, { 1, 2, -1, -1 }, { 1, 3, -1, -1 }, { 0, 1, -1, -1 }, { 0, 3, -1, -1 }, { -1, -1, -1, -1 } };
    const auto middle = [&](int side) {
        const glm::ivec2 a = corners[side], b = corners[(side + 1) % 4];
        return 0.5 * (s.position.vector(a.x, a.y) + s.position.vector(b.x, b.y));
    };
    std::vector<Piece> out;
    for (int k = 0; k < 4 && table[code][k] >= 0; k += 2) {
        const glm::dvec3 a = middle(table[code][k]), b = middle(table[code][k + 1]);
        out.push_back({ 0.5 * (a + b), glm::normalize(sum), glm::length(b - a) });
    }
    return out;
}

/// All, tile by tile.
inline std::vector<std::vector<Piece>> piecesOfTiles(const Seen& s)
{
    constexpr int side = WEDGE_EDGE_TILE;
    std::vector<std::vector<Piece>> out;
    for (int y0 = 0; y0 < height - 1; y0 += side)
        for (int x0 = 0; x0 < width - 1; x0 += side) {
            out.emplace_back();
            for (int y = y0; y < std::min(y0 + side, height - 1); ++y)
                for (int x = x0; x < std::min(x0 + side, width - 1); ++x)
                    for (const Piece& piece : piecesOf(s, x, y))
                        out.back().push_back(piece);
        }
    return out;
}

/// As the device has them.
inline std::vector<float> listOf(const std::vector<Piece>& pieces, std::size_t room)
{
    std::vector<float> out;
    out.reserve(room);
    for (const Piece& p : pieces)
        for (const double v : { p.middle.x, p.middle.y, p.middle.z, p.normal.x, p.normal.y, p.normal.z, p.length, 0.0 })
            out.push_back(static_cast<float>(v));
    out.resize(room);
    return out;
}

inline std::vector<Piece> joinedPieces(const std::vector<std::vector<Piece>>& tiles)
{
    std::vector<Piece> out;
    for (const std::vector<Piece>& tile : tiles)
        out.insert(out.end(), tile.begin(), tile.end());
    return out;
}

/// The power mean of the distances to the pieces that count, metres.

} // namespace wedge::test::shadows
