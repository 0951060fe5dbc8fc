#pragma once

#include "host/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::filters {

/// Where the objects of a scene are at one time: of each, an affine frame that moves with it.
struct ObjectPlaces {
    struct Place {
        glm::dmat3 axes { 0.0 }; ///< metres; columns
        glm::dvec3 origin { 0.0 };
        bool rigid = false; ///< an affine map takes the object from its reference to here, and the axes span space
        std::uint64_t shape = 0; ///< of all its vertices: equal where nothing of it moved
    };
    std::vector<Place> objects; ///< of object id i at [i - 1]
};

/// Finds where objects are by four of their vertices, which the others are held against: what deforms has no place.
class ObjectTracker {
public:
    /// reference: geometry that all others have the topology of. Of what moves while the shutter is open the middle
    /// counts.
    explicit ObjectTracker(const scene::Geometry& reference);

    ObjectPlaces placesIn(const scene::Geometry& geometry) const;

private:
    struct Member {
        std::uint32_t vertex;
        glm::vec3 coordinates; ///< in the reference's axes
    };
    struct Object {
        std::uint32_t corners[4] = {}; ///< vertices
        bool flat = false; ///< the third axis is across both others
        bool spans = false; ///< it has an area
        std::size_t first = 0, end = 0; ///< of members_
    };

    glm::dmat3 axesOf(const Object& object, const scene::Geometry& geometry) const;
    void chooseCorners(Object& object, const scene::Geometry& geometry) const;

    std::vector<Object> objects_;
    std::vector<Member> members_;
};

/// An object's way from one time to another, as kernels take it: WEDGE_TEMPORAL_MOTION floats.
std::vector<float> motionsBetween(const ObjectPlaces& from, const ObjectPlaces& to);

/// Whether no object has moved.
bool areStill(const ObjectPlaces& from, const ObjectPlaces& to);

} // namespace wedge::filters
