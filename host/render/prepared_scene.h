#pragma once

#include "host/render/direct_lights.h"
#include "host/render/environment_table.h"
#include "host/scene/scene.h"
#include "host/scene/sequence.h"

#include <functional>
#include <memory>

namespace wedge::render {

/// What the materials of a scene's triangles are like, and what moves. What lies unused in a mesh's library does not
/// count: lobes cost more than all else of a shadow ray.
struct SceneTraits {
    bool specular = false; ///< some reflect specularly, and are no mirrors
    /// All lobes of those are so narrow that what they see is known well by directions alone (kernels/light/
    /// unshadowed_environment.h): not wide ones, those that a texture may make wide, and GGX, whose tails reach far.
    bool narrowLobes = false;
    bool mirrors = false; ///< some are mirrors or glass
    bool microfacets = false; ///< some are of GGX
    bool normalMaps = false; ///< some have a normal map or heights: programs are then built with WEDGE_NORMAL_MAPS
    float touchingGlass = 0; ///< touchingDistance() where hasTouchingGlass(), else 0
    bool moves = false; ///< scene::geometryMoves()
};

SceneTraits traitsOf(const scene::Scene& scene);

/// A scene, and what everybody asks of it: found once, when it is made and where it is changed.
class PreparedScene : public scene::Scene {
public:
    /// Takes time in proportion to its triangles.
    explicit PreparedScene(scene::Scene scene);

    const DirectLights& directLights() const { return direct_; }
    /// Made when first asked for, which is after the hierarchy, and has taken memory in proportion to what emits.
    const SceneLights& lights() const;
    const EmitterList& ofSharedTerm() const { return direct_.shareEmitters() ? lights().emitters : lights().shared; }
    const SceneTraits& traits() const { return traits_; }
    /// The picture around it; null without.
    const std::shared_ptr<const EnvironmentPicture>& picture() const { return picture_; }

    /// Lets `alter` change it in the parts that `change` names, and in its camera.
    void change(const scene::Change& change, const std::function<void(scene::Scene&)>& alter);

private:
    std::shared_ptr<const EnvironmentPicture> picture_;
    DirectLights direct_;
    /// Copies have these in common; null: not yet asked for.
    mutable std::shared_ptr<const SceneLights> lights_;
    mutable std::shared_ptr<const EnvironmentTable> beyond_; ///< of the picture, which no change alters
    SceneTraits traits_;
};

} // namespace wedge::render
