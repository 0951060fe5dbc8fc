#pragma once

#include "host/scene/scene.h"
#include "kernels/shared/emitter.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wedge::render {

/// Triangles that emit, and area lights, as kernels choose among them (kernels/light/emitters.h): in proportion to
/// their power, of triangles area times the luminance of what they emit, and where on them by their texture.
struct EmitterList {
    /// Mostly in the order of where they are, then the parts of those that are meshes; empty without any.
    std::vector<shared::Emitter> list;
    std::uint32_t count = 0; ///< of the list without parts
    /// Of each triangle of the scene: the probability that a number chooses it, or WEDGE_PICK_ELSEWHERE, or
    /// WEDGE_PICK_TABLE, and behind them what that stands for; empty where no material in use emits.
    std::vector<float> picks;
    std::vector<float> quadPicks; ///< of each area light of the scene, likewise; empty where the list is
    double power = 0; ///< W/sr, of both sides, as lights' are counted
    glm::vec3 low { 0 }, high { 0 }; ///< the box that they are in, metres
    float directedWithin = 0; ///< PathParams::directedWithin
    bool trees = false; ///< there are meshes in the list: programs are then built with WEDGE_EMITTER_TREES
    bool tables = false; ///< some have a table: WEDGE_EMITTER_TABLES
};

/// Whether a triangle has a material that emits, but is not chosen: it is too weak or too strong for numbers, or has no
/// area when the shutter opens and has some later. Only reflected directions find it.
bool isFoundAlone(const scene::Scene& scene, std::size_t triangle);

/// elsewhere: triangles that are part of another term, ascending. quads: area lights among the list, ascending.
EmitterList emitterList(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere = {}, std::span<const std::uint32_t> quads = {});

/// Corner k of a triangle when the shutter opens.
glm::dvec3 cornerOf(const scene::Geometry& g, std::size_t triangle, std::size_t k);

/// Whether a vertex is elsewhere when the shutter closes.
bool movesAt(const scene::Geometry& g, std::size_t vertex);

/// Whether a corner of a triangle is.
bool triangleMoves(const scene::Geometry& g, std::size_t triangle);

/// Whether a triangle's material emits, textures apart.
bool mayEmit(const scene::Scene& scene, std::size_t triangle);

/// Area of a triangle when the shutter opens, m^2.
double areaOf(const scene::Geometry& g, std::size_t triangle);

/// Area, m^2, times the luminance of radiance, W/(sr m^2): 0 of what has no area, or more than numbers can hold.
double powerOf(double area, glm::vec3 radiance);

/// A triangle's power for one side, W/sr, from its material's emission without its texture: 0 if it is no light, having
/// no area, emitting nothing, or more than numbers can hold.
double plainPower(const scene::Scene& scene, std::size_t triangle);

/// WEDGE_PAIR_* of a triangle and the next one as the halves of a quadrilateral.
std::uint32_t pairAt(const scene::Geometry& g, std::size_t triangle);

} // namespace wedge::render
