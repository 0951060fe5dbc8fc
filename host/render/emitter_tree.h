#pragma once

#include "kernels/shared/emitter.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// A part of a mesh that emits.
struct EmitterPart {
    std::size_t number; ///< breaks ties
    std::uint32_t part; ///< as kernels know it: WEDGE_PART_*
    double power;
    glm::dvec3 at; ///< its middle
    float pick = 0; ///< out: the probability that it is chosen
};

/// Divides a mesh into halves again and again, so that the two numbers of a sample choose a part of it as they choose a
/// point of a square: points that are stratified over the square are so over the mesh. Appends to `list` what kernels
/// descend, and returns the entry of the mesh (WEDGE_PAIR_MESH).
/// axes: at right angles to each other. pick: the probability that the mesh is chosen.
shared::Emitter addMesh(std::vector<shared::Emitter>& list, std::span<EmitterPart> parts,
    const std::array<glm::dvec3, 3>& axes, float pick);

} // namespace wedge::render
