#pragma once

#include "host/render/emitter_texture.h"
#include "host/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// Faces that emit, or an area light.
struct EmitterEntry {
    double power;
    std::size_t number; ///< the first triangle, or the light
    std::uint32_t pair; ///< WEDGE_PAIR_*
    glm::dvec3 at { 0 }; ///< its middle
    std::size_t texture = none; ///< which of EmitterGroups::textures it has

    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::size_t triangles() const { return pair == WEDGE_PAIR_QUAD ? 0 : pair == WEDGE_PAIR_NONE ? 1 : 2; }
};

/// All that emits of an object, or an area light.
struct EmitterGroup {
    double power = 0; ///< W/sr of one side
    double extent = 0; ///< metres: shared::Emitter::extent
    std::vector<EmitterEntry> entries;
    glm::vec3 at { 0 }; ///< the middle of its light
};

/// A triangle that lies in the place of another one.
struct EmitterTwin {
    std::size_t triangle, first;
};

struct EmitterGroups {
    std::vector<EmitterGroup> groups; ///< along a Morton curve: numbers that are stratified over them are so in space
    std::vector<EmittedOverSquare> textures;
    std::vector<EmitterTwin> twins;
    double power = 0; ///< of all
};

/// What numbers choose among. elsewhere: triangles that are part of another term, ascending. quads: area lights of it.
EmitterGroups emitterGroups(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere, std::span<const std::uint32_t> quads);

} // namespace wedge::render
