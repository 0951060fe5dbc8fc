#pragma once

#include "host/render/environment_table.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// A part of the sphere that the choice of lights takes as one: a texel, several of a large map, or part of one of a
/// small map.
struct MapPlace {
    glm::dvec3 direction { 0 }; ///< unit; X to the map's right, Y up, Z back
    double solidAngle = 0; ///< sr
    glm::dvec3 irradiance { 0 }; ///< radiance times solid angle, R G B, W/m^2
    glm::dvec3 moment { 0 }; ///< directions by the luminance of that
};

/// A map's places, row by row from above. However the map is turned they are the same.
struct MapPlaces {
    int columns = 0, rows = 0;
    std::vector<MapPlace> all;
    glm::dmat3 axes { 1 }; ///< the map's right, up and back in the world
};

/// How many places a map of so many texels has: columns, rows. At least 64 and 32, about 512 and 256 at most.
struct PlaceGrid {
    int columns, rows;
    int timesAcross, timesDown; ///< parts of a texel along each axis
    int ofPlaceAcross, ofPlaceDown; ///< such parts, of a place
};
PlaceGrid placeGrid(int width, int height);

/// What each place of a picture has. Together they have all of its light, each texel that of its own solid angle.
MapPlaces mapPlaces(const EnvironmentPicture& picture);

/// A map in cells, each place in the one of whose `points` it is nearest; of several as near in the first.
struct MapCells {
    std::vector<std::uint32_t> points; ///< places, all different
    std::vector<std::uint32_t> cellOf; ///< of each place, by number in points
};

/// Structured importance sampling (Agarwal, Ramamoorthi, Belongie and Jensen, Structured Importance Sampling of
/// Environment Maps, SIGGRAPH 2003): the sphere is split at six levels, 0 to 5 times the standard deviation of the
/// luminance over it, into parts that hang together. The points are shared out among these, from the widest to those
/// within them, by L w^(1/4), L being the part's luminance (W/m^2) and w its solid angle, at most 0.01 sr: what is
/// smaller is seen or hidden as a whole. In each part they are spread as Hochbaum and Shmoys do: the next is the place
/// that is farthest from all before it. The same for the same picture. Throws UsageError for more points than places.
/// points: at least 1
MapCells mapCells(const MapPlaces& places, std::size_t points);

/// A directional light.
struct MapLight {
    glm::vec3 towards { 0, 1, 0 }; ///< unit, in the world
    glm::vec3 irradiance { 0 }; ///< of what faces it, R G B, W/m^2
};

/// One of each cell: from the middle of its light, weighted by luminance, or where that is nowhere from its point; all
/// of its light. Their irradiances add up to the map's.
std::vector<MapLight> mapLights(const MapPlaces& places, const MapCells& cells);

/// All of that.
std::vector<MapLight> mapLights(const EnvironmentPicture& picture, std::size_t lights);

/// Throws UsageError where a picture has fewer places than so many lights.
void requirePlaces(const EnvironmentPicture& picture, std::size_t lights);

} // namespace wedge::render
