#pragma once

#include "host/render/prepared_scene.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wedge::render {

/// A light whose hard shadow is drawn in a style.
struct StyledLight {
    std::uint32_t index = 0; ///< among DeviceScene::deltaLights: point lights first, then directional ones
    std::string
        name; ///< of its layers: its own, as far as it is letters and digits, where no other has it; or a number
    std::string called; ///< in messages: by its own name, or a number
    std::span<const scene::ShadowStyle> styles; ///< the scene's, at least one
};

/// The style of one of them as it is now; changes in the scene show.
const scene::ShadowStyle& styleOf(const scene::Scene& scene, std::uint32_t light, std::size_t style);

/// Lights whose shadows frames of these settings draw in a style; refers to the scene.
std::vector<StyledLight> styledLights(const Settings& settings, const scene::Scene& scene);

/// What the layers of an area light with a style are called after: as StyledLight::name, but "quad" and its number
/// among area lights, from 1, where that is a number.
std::string layerNameOf(const scene::Scene& scene, std::uint32_t quad);

/// Whether frames of these settings move, soften or smooth the edge of any shadow, now or at a style's key.
bool movesEdges(const Settings& settings, const scene::Scene& scene);

/// Those of a light's styles that have the same casters.
struct StyleGroup {
    std::string name; ///< of its layers: the light's, of the second and later ones with a number
    std::vector<scene::ShadowStyle> styles;
    std::vector<std::size_t> places; ///< of these, among all of the light
    std::vector<std::string> apart; ///< casters of the light's other groups
    bool restApart = false; ///< one of these has all that none names
};

/// In the order of the first style of each.
std::vector<StyleGroup> groupsOf(const StyledLight& light);

/// Throws UsageError where shadows are to be drawn in a style and frames of these settings cannot: pixels have several
/// receivers; or of soft ones, they are not filtered each by itself.
void requireStylable(const Settings& settings, const PreparedScene& scene);

} // namespace wedge::render
