#pragma once

#include "host/render/emitters.h"
#include "host/render/environment_table.h"
#include "host/scene/scene.h"
#include "kernels/shared/light.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wedge::render {

/// As many lights have a term of direct light each; what the others send is one more term, whatever their number.
inline constexpr std::size_t mostOwnTerms = 16;
/// A panel is one of them if it has at least this part of all power of meshes that emit.
inline constexpr double leastPanelShare = 1.0 / 16.0;

/// A light that has a term of direct light of its own.
struct OwnLight {
    scene::AreaLight quad; ///< one of the scene's, or a panel; without styles, which may change without it
    float lift = 0; ///< metres, AreaLight::lift: of a panel, or of a quad that lies in a surface
    std::optional<std::uint32_t> number = {}; ///< among the scene's area lights; of a panel: none

    shared::AreaLight onDevice() const;
};

/// Which lights have a term of their own, and which share one: docs/emitters.md.
struct DirectLights {
    std::vector<OwnLight> own; ///< quads in the order of the scene, then panels in that of its triangles
    std::vector<std::uint32_t> sharedQuads; ///< numbers of the scene's area lights, ascending
    std::vector<std::size_t> panelTriangles; ///< of the panels that have a term of their own, ascending
    bool share = false; ///< whether there is anything for a term to share
    std::vector<float> lifts; ///< liftsOf() the scene's area lights

    /// Whether what they share is all that emits, and nothing else.
    bool shareEmitters() const { return sharedQuads.empty() && panelTriangles.empty(); }
};

/// A panel is a parallelogram of two triangles that emit evenly, do not move, and adjoin nothing else that emits: as
/// good a light as a quad of the scene file. Takes time in proportion to the scene's triangles.
DirectLights directLights(const scene::Scene& scene);

/// A scene's lights as kernels choose among them. Takes time in proportion to its triangles, and memory likewise where
/// anything emits: a renderer makes it once.
struct SceneLights {
    /// table: of what is beyond the scene, never null.
    SceneLights(const scene::Scene& scene, const DirectLights& direct, std::shared_ptr<const EnvironmentTable> table);

    EmitterList emitters; ///< what paths' vertices choose among
    EmitterList shared; ///< what the term that lights share does, where that is something else; else empty
    std::shared_ptr<const EnvironmentTable> beyond; ///< directions to what is beyond the scene
};

} // namespace wedge::render
