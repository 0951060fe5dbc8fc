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

/// Of frames without a margin: the tests' loops go over the image.
inline render::Settings settings()
{
    render::Settings s = sized(render::monteCarlo(1), width, height);
    s.styleMargin = 0;
    return s;
}

/// The frame's passes up to the edges of its shadow, run one after the other.
struct Traced {
    explicit Traced(const device::Device& device, float alpha = abstraction)
        : Traced(device, underSun(alpha))
    {
    }
    Traced(const device::Device& device, const scene::Scene& scene)
        : frame(device, scene, settings())
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
        if (pass.has("occluder"))
            pass.plane("occluder", matte.read<float>("occluder"));
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
        , occluder(traced.matte.pixels<float>(traced.matte.has("occluder") ? "occluder" : "matte"))
        , object(traced.primary.pixels<std::uint32_t>("objectId"))
    {
    }
    Planes<float> position, normal, size, matte;
    Planes<float> occluder; ///< metres to what hides the light, where knobs go by that
    Planes<std::uint32_t> object;
};

struct Piece {
    glm::dvec3 middle, normal;
    double length;
    double away; ///< mean over its corners in shadow
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
    double away = 0, hidden = 0;
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 at = corners[k], next = corners[(k + 1) % 4];
        const float v = s.matte.at(at.x, at.y);
        if (v < 0 || !onOneSurface(s, at, next))
            return {};
        code |= v > 0.5f ? 1 << k : 0;
        sum += s.normal.vector(at.x, at.y);
        away += v > 0.5f ? 0 : double { s.occluder.at(at.x, at.y) };
        hidden += v > 0.5f ? 0 : 1;
    }
    // Bits: lit corners. Sides that pieces join, -1: none.
    const int table[16][4] = { { -1, -1, -1, -1 }, { 3, 0, -1, -1 }, { 0, 1, -1, -1 }, { 3, 1, -1, -1 },
        { 1, 2, -1, -1 }, { 3, 0, 1, 2 }, { 0, 2, -1, -1 }, { 3, 2, -1, -1 }, { 2, 3, -1, -1 }, { 2, 0, -1, -1 },
        { 0, 1, 2, 3 }, { 1, 2, -1, -1 }, { 1, 3, -1, -1 }, { 0, 1, -1, -1 }, { 0, 3, -1, -1 }, { -1, -1, -1, -1 } };
    const auto crossing = [&](int side) {
        const glm::ivec2 a = corners[side], b = corners[(side + 1) % 4];
        const double here = s.matte.at(a.x, a.y), next = s.matte.at(b.x, b.y);
        return glm::mix(s.position.vector(a.x, a.y), s.position.vector(b.x, b.y), (0.5 - here) / (next - here));
    };
    std::vector<Piece> out;
    for (int k = 0; k < 4 && table[code][k] >= 0; k += 2) {
        const glm::dvec3 a = crossing(table[code][k]), b = crossing(table[code][k + 1]);
        out.push_back({ 0.5 * (a + b), glm::normalize(sum), glm::length(b - a), away / hidden });
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

/// As the device has them. by: whether knobs go by what hides the light.
inline std::vector<float> listOf(const std::vector<Piece>& pieces, std::size_t room, bool by = false)
{
    std::vector<float> out;
    out.reserve(room);
    for (const Piece& p : pieces)
        for (const double v :
            { p.middle.x, p.middle.y, p.middle.z, p.normal.x, p.normal.y, p.normal.z, p.length, by ? p.away : 0.0 })
            out.push_back(static_cast<float>(v));
    out.resize(room);
    return out;
}

/// The pass that finds distances to these pieces of edge, with boxes around them as the device makes them. by: as of
/// listOf()
inline PassBench distancesTo(Traced& traced, const std::vector<Piece>& pieces, bool by = false)
{
    PassBench bound(traced.frame, "boundEdges"), bench(traced.frame, "shadowDistance");
    traced.give(bench);
    const std::vector<float> edges = listOf(pieces, bench.elements("edges"), by);
    const std::vector<std::uint32_t> listed { static_cast<std::uint32_t>(pieces.size()), 0 };
    for (PassBench* pass : { &bound, &bench }) {
        pass->plane("edges", edges);
        pass->plane("listed", listed);
    }
    bound.run();
    bench.plane("boxes", bound.read<float>("boxes"));
    return bench;
}

inline std::vector<Piece> joinedPieces(const std::vector<std::vector<Piece>>& tiles)
{
    std::vector<Piece> out;
    for (const std::vector<Piece>& tile : tiles)
        out.insert(out.end(), tile.begin(), tile.end());
    return out;
}

/// The power mean of the distances to the pieces that count, metres.
inline double distanceTo(const std::vector<Piece>& pieces, glm::dvec3 at, glm::dvec3 n, double largest)
{
    const auto faces = [&](const Piece& piece) { return glm::dot(piece.normal, n) > std::numbers::sqrt2 / 2; };
    double nearest = 2 * largest;
    for (const Piece& piece : pieces)
        nearest = faces(piece) ? std::min(nearest, glm::length(piece.middle - at)) : nearest;
    if (nearest == 2 * largest)
        return largest;
    double sum = 0;
    for (const Piece& piece : pieces) {
        const double r = glm::length(piece.middle - at);
        sum += faces(piece) && r <= 3 * std::min(nearest, largest) ? piece.length * std::pow(r, -8) : 0;
    }
    const double constant = std::sqrt(std::numbers::pi) * std::tgamma(3.5) / std::tgamma(4.0);
    return std::min(std::pow(sum / constant, -1.0 / 7), largest);
}

/// Signed distances that stand for those of a shadow: 0 where the matte is unknown.
inline std::vector<float> someDistances(const Seen& s)
{
    std::vector<float> out(s.matte.values.size(), 0.0f);
    everyPixel(s.matte.layout, [&](int x, int y) {
        const float v = s.matte.at(x, y);
        const auto wave = static_cast<float>(0.2 + 0.15 * std::sin(0.2 * x) * std::cos(0.3 * y));
        out[s.matte.index(x, y)] = v < 0 ? 0.0f : v > 0.5f ? wave : -wave;
    });
    return out;
}

/// Whole pixels that three deviations span along both axes.
inline glm::ivec2 pixelsAlong(const Seen& s, const shared::FrameParams& frame, glm::ivec2 at, double alpha)
{
    const glm::dvec3 n = s.normal.vector(at.x, at.y), forward = toGlm(frame.forward);
    const double depth = glm::dot(s.position.vector(at.x, at.y) - toGlm(frame.eye), forward), reach = 3 * alpha;
    const double away = glm::dot(n, forward);
    const double least = std::max(depth - reach * std::sqrt(1 - away * away), 0.2 * depth);
    glm::ivec2 out;
    for (const int axis : { 0, 1 }) {
        const glm::dvec3 step = toGlm(axis == 0 ? frame.right : frame.down);
        const double along = glm::dot(n, glm::normalize(step));
        const double side = std::min(1.25 * std::sqrt(std::max(1 - along * along, 0.0)), 1.0);
        out[axis] = static_cast<int>(std::min(reach * side / (glm::length(step) * least), double { width }));
    }
    return out;
}

/// What the blur makes of a pixel.
inline double blurred(const Seen& s, const Planes<float>& before, glm::ivec2 at, glm::ivec2 span, double alpha)
{
    const glm::dvec3 here = s.position.vector(at.x, at.y), n = s.normal.vector(at.x, at.y);
    glm::ivec2 stride(1);
    for (const int axis : { 0, 1 })
        while (span[axis] > stride[axis] * WEDGE_STYLE_TAPS)
            stride[axis] *= 2;
    const glm::ivec2 taps = span / stride;
    double sum = 0, weights = 0;
    for (int v = -taps.y; v <= taps.y; ++v)
        for (int u = -taps.x; u <= taps.x; ++u) {
            const int x = at.x + u * stride.x, y = at.y + v * stride.y;
            if (x < 0 || y < 0 || x >= width || y >= height || s.object.at(x, y) != s.object.at(at.x, at.y)
                || before.at(x, y) == 0 || glm::dot(n, s.normal.vector(x, y)) <= std::numbers::sqrt2 / 2)
                continue;
            const double r = glm::length(s.position.vector(x, y) - here), side = s.size.at(x, y);
            const double w = r <= 3 * alpha ? side * side * std::exp(-0.5 * r * r / (alpha * alpha)) : 0;
            sum += w * before.at(x, y);
            weights += w;
        }
    return sum / weights;
}

} // namespace wedge::test::shadows
