#pragma once

#include "kernels/shared/environment.h"

#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// A small bright source that was taken out of a picture: the rectangle of its direction, extent and energy.
struct Sun {
    glm::vec3 towards { 0, 1, 0 }; ///< unit, in the world
    glm::vec3 halfU { 0 },
        halfV { 0 }; ///< half extents at distance 1, across each other and `towards`; halfU is longer
    glm::vec3 radiance { 0 }; ///< W/(sr m^2), mean over the rectangle
    double share = 0; ///< of the luminance over all directions, what it has
};

/// A picture of what is beyond the scene, of the whole sphere: columns are angles around `up`, rows such from there.
struct EnvironmentPicture {
    int width = 1, height = 1; ///< texels
    std::vector<float> radiance; ///< R G B of each, rows from above, W/(sr m^2); finite, at least 0
    /// Unit, in the world: what 3/4 of the width shows in the middle of the height, the upper edge, and both ends of
    /// the width there.
    glm::vec3 right { 1, 0, 0 }, up { 0, 1, 0 }, back { 0, 0, 1 };
    bool seen = true; ///< by the camera
    std::vector<Sun> suns; ///< what was taken out of it, which area lights stand for; brightest first
    std::vector<float> shown; ///< as radiance, with the suns, as the camera sees it; empty without suns
};

/// The picture as kernels look it up and choose among its directions (kernels/light/environment_map.h).
struct EnvironmentTable {
    shared::EnvironmentMap map {}; ///< of no texels without a picture
    std::vector<float> numbers; ///< empty likewise
    double irradiance = 0; ///< luminance, over all directions, W/m^2
    /// The largest irradiance that any normal has by the harmonics, R G B, W/m^2; 0 of channels without light.
    glm::dvec3 mostIrradiance { 0 };
};

/// Directions are chosen by how far they are brighter than the mean, for reflected directions find the rest as well
/// (Karlik et al., MIS Compensation, 2019), and at least by a part of their brightness. picture: null: there is none.
EnvironmentTable environmentTable(const EnvironmentPicture* picture);

} // namespace wedge::render
