#pragma once

#include "bvh/bvh.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

/// Meshes that a builder or a traversal may stumble over, all seeded.
namespace wedge::test {

struct TestMesh {
    std::string name;
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;

    bvh::Mesh view() const { return { positions, indices }; }
    std::size_t triangles() const { return indices.size() / 3; }

    /// Adds a triangle with vertices of its own.
    void add(std::initializer_list<float> nineCoordinates)
    {
        for (std::uint32_t i = 0; i < 3; i++)
            indices.push_back(static_cast<std::uint32_t>(positions.size() / 3) + i);
        positions.insert(positions.end(), nineCoordinates);
    }
    void scale(float factor)
    {
        for (float& x : positions)
            x *= factor;
    }
};

/// Triangles of about the given size anywhere in the cube [-1, 1]^3.
inline TestMesh soup(std::size_t count, float size, unsigned seed = 1)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    TestMesh mesh { "soup", {}, {} };
    for (std::size_t i = 0; i < count; i++) {
        const float x = u(random), y = u(random), z = u(random);
        float v[9];
        for (float& c : v)
            c = size * u(random);
        mesh.add({ x + v[0], y + v[1], z + v[2], x + v[3], y + v[4], z + v[5], x + v[6], y + v[7], z + v[8] });
    }
    return mesh;
}

/// A wavy square of 2 n^2 triangles over [-1, 1]^2 that share vertices: no ray may pass between them.
inline TestMesh waves(std::uint32_t n)
{
    TestMesh mesh { "waves", {}, {} };
    for (std::uint32_t j = 0; j <= n; j++)
        for (std::uint32_t i = 0; i <= n; i++) {
            const float x = 2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f;
            const float z = 2.0f * static_cast<float>(j) / static_cast<float>(n) - 1.0f;
            mesh.positions.insert(mesh.positions.end(), { x, 0.1f * std::sin(7.0f * x) * std::cos(5.0f * z), z });
        }
    for (std::uint32_t j = 0; j < n; j++)
        for (std::uint32_t i = 0; i < n; i++) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), { a, b, c, b, d, c });
        }
    return mesh;
}

inline TestMesh duplicates(std::size_t count)
{
    TestMesh mesh { "duplicates", {}, {} };
    mesh.positions = { -1, -1, 0.5f, 1, -1, 0.5f, 0, 1, 0.5f };
    for (std::size_t i = 0; i < count; i++)
        mesh.indices.insert(mesh.indices.end(), { 0, 1, 2 });
    return mesh;
}

/// Points, segments and collinear triples among a few good triangles.
inline TestMesh degenerates()
{
    TestMesh mesh = soup(20, 0.5f);
    mesh.name = "degenerates";
    for (int i = 0; i < 20; i++) {
        const float x = 0.1f * static_cast<float>(i) - 1.0f;
        mesh.add({ x, x, x, x, x, x, x, x, x });
        mesh.add({ x, 0, 0, x, 1, 0, x, 1, 0 });
        mesh.add({ x, 0, 0, x, 1, 1, x, 0.5f, 0.5f });
        mesh.add({ x, 0.1f, 0.3f, x + 0.1f, 0.4f, 0.6f, x + 0.2f, 0.7f, 0.9f });
    }
    return mesh;
}

/// From 1e6 across to 1e-6.
inline TestMesh unevenSizes()
{
    TestMesh mesh = soup(400, 0.1f);
    mesh.name = "uneven sizes";
    mesh.add({ -1e6f, -2, -1e6f, 1e6f, -2, -1e6f, 0, -2, 1e6f });
    const TestMesh small = soup(400, 1e-6f, 3);
    const auto offset = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    mesh.positions.insert(mesh.positions.end(), small.positions.begin(), small.positions.end());
    for (const std::uint32_t index : small.indices)
        mesh.indices.push_back(index + offset);
    return mesh;
}

/// Each triangle four times as far out and four times as large as the last: planes at even distances part one a time.
inline TestMesh exponential()
{
    TestMesh mesh { "exponential", {}, {} };
    for (int i = 0; i < 60; i++)
        for (int copy = 0; copy < 20; copy++) {
            const float s = std::ldexp(1.0f, 2 * i - 60) * (1.0f + 0.01f * static_cast<float>(copy));
            mesh.add({ s, 0, 0, s, s, 0, s, 0, s });
        }
    return mesh;
}

/// Sizes that fall by a factor of two from one cluster to the next over 120 octaves: every plane at even distances
/// parts off the largest alone.
inline TestMesh deep()
{
    TestMesh mesh { "deep", {}, {} };
    for (int i = 0; i < 119; i++)
        for (int copy = 0; copy < 70; copy++) {
            const float s = std::ldexp(1.0f, i - 60);
            mesh.add({ s, 0, 0, s, s * 0.01f, 0, s, 0, s * 0.01f });
        }
    return mesh;
}

inline TestMesh thin()
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    TestMesh mesh { "thin", {}, {} };
    for (int i = 0; i < 300; i++) {
        const float x = u(random), y = u(random), z = u(random), dx = u(random), dy = u(random), dz = u(random);
        mesh.add({ x, y, z, x + 1e-4f, y, z - 1e-4f, x + 3 * dx, y + 3 * dy, z + 3 * dz });
    }
    return mesh;
}

/// Long thin triangles at all angles among three times as many small ones: their boxes are mostly empty, which is what
/// spatial splits are for.
inline TestMesh needles(std::size_t count)
{
    TestMesh mesh = soup(3 * count, 0.02f);
    mesh.name = "needles";
    std::mt19937 random(11);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    for (std::size_t i = 0; i < count; i++) {
        const float x = u(random), y = u(random), z = u(random);
        const float dx = 0.5f * u(random), dy = 0.5f * u(random), dz = 0.5f * u(random);
        mesh.add({ x - dx, y - dy, z - dz, x + dx, y + dy, z + dz, x + dx + 0.003f, y + dy - 0.002f, z + dz + 0.001f });
    }
    return mesh;
}

/// Small dense clusters among large triangles: no plane near the top parts them well.
inline TestMesh clusters()
{
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    TestMesh mesh { "clusters", {}, {} };
    for (unsigned cluster = 0; cluster < 60; cluster++) {
        const TestMesh part = soup(100, 0.3f, cluster + 1);
        const float at[3] = { u(random), u(random), u(random) }, size = 0.02f + 0.05f * std::fabs(u(random));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
        for (std::size_t i = 0; i < part.positions.size(); i++)
            mesh.positions.push_back(at[i % 3] + size * part.positions[i]);
        for (const std::uint32_t index : part.indices)
            mesh.indices.push_back(first + index);
    }
    for (int i = 0; i < 100; i++) {
        const float x = u(random), y = u(random), z = u(random), dx = u(random), dy = u(random), dz = u(random);
        mesh.add({ x, y, z, x + dx, y, z + dz, x, y + dy, z });
    }
    return mesh;
}

/// A quarter of the triangles have a vertex that is NaN, infinite or out of range.
inline TestMesh invalidVertices()
{
    TestMesh mesh = soup(400, 0.2f);
    mesh.name = "invalid vertices";
    constexpr float inf = std::numeric_limits<float>::infinity();
    const float bad[] = { std::numeric_limits<float>::quiet_NaN(), inf, -inf, 3e38f };
    for (std::size_t i = 0; i < 100; i++)
        mesh.positions[36 * i + i % 9] = bad[i % 4];
    return mesh;
}

inline TestMesh scaled(TestMesh mesh, float factor, const std::string& name)
{
    mesh.scale(factor);
    mesh.name = name;
    return mesh;
}

inline TestMesh flat()
{
    TestMesh mesh = soup(500, 0.1f);
    mesh.name = "flat";
    for (std::size_t i = 1; i < mesh.positions.size(); i += 3)
        mesh.positions[i] = 0.0f;
    return mesh;
}

/// All of the above, at sizes where testing every triangle against every ray is quick.
inline std::vector<TestMesh> nastyMeshes()
{
    TestMesh one { "one triangle", {}, {} };
    one.add({ -1, -1, 0, 1, -1, 0, 0, 1, 0 });
    return { TestMesh { "empty", {}, {} }, one, soup(1000, 0.2f), waves(24), duplicates(700), degenerates(),
        unevenSizes(), exponential(), thin(), needles(100), invalidVertices(), flat(),
        scaled(soup(300, 0.3f), 1e-20f, "tiny"), scaled(soup(300, 0.3f), 7e17f, "huge"),
        scaled(waves(9), 1e-3f, "small") };
}

} // namespace wedge::test
