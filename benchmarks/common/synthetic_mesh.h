#pragma once

#include "host/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wedge::benchmark {

/// Triangles alone. Metres.
struct SyntheticMesh {
    std::vector<float> positions; ///< 3 a vertex
    std::vector<std::uint32_t> indices; ///< 3 a triangle
};

inline constexpr std::size_t leastSyntheticTriangles = 500;

/// A hilly field with boulders and trees, of exactly that many triangles, leastSyntheticTriangles or more: a quarter of
/// them ground, a quarter boulders, and leaves for the rest. More triangles are smaller ones of the same shapes, and
/// the leaves' area together stays the same, so that a ray meets as much at any count and what it costs shows how the
/// hierarchy grows. The same triangles come out for the same arguments on every machine whose libm agrees.
SyntheticMesh syntheticMesh(std::size_t triangles, std::uint32_t seed = 1);

/// The same as a scene: one matt material, a square area light overhead, and a camera that does not depend on the
/// count.
scene::Scene syntheticScene(std::size_t triangles, std::uint32_t seed = 1);

} // namespace wedge::benchmark
