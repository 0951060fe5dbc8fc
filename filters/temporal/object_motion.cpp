#include "filters/temporal/object_motion.h"

#include "host/hash.h"
#include "kernels/shared/temporal.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace wedge::filters {
namespace {

/// An area or a volume that is less than this part of what the longest edge would make counts as none.
constexpr double leastPart = 1e-6;
/// How far vertices may be from where the map takes them, of the longest edge and of the coordinates.
constexpr double rigidity = 1e-4, rounding = 1e-6;

glm::dvec3 vertexOf(const std::vector<float>& positions, std::uint32_t vertex)
{
    const std::size_t at = std::size_t { 3 } * vertex;
    return { positions[at], positions[at + 1], positions[at + 2] };
}

/// Halfway through the shutter's time.
glm::dvec3 middle(const scene::Geometry& geometry, std::uint32_t vertex)
{
    const glm::dvec3 open = vertexOf(geometry.positions, vertex);
    return geometry.positionsAtClose.empty() ? open : 0.5 * (open + vertexOf(geometry.positionsAtClose, vertex));
}

void addToHash(Hash& hash, const std::vector<float>& positions, std::uint32_t vertex)
{
    for (std::size_t k = 0; k < 3; ++k) {
        hash.add(std::bit_cast<std::uint32_t>(positions[std::size_t { 3 } * vertex + k]));
    }
}

/// The one of the members that `value` is largest of.
template <class Value>
std::uint32_t farthest(const std::vector<std::uint32_t>& vertices, const Value& value)
{
    return *std::ranges::max_element(vertices, {}, value);
}

} // namespace

ObjectTracker::ObjectTracker(const scene::Geometry& reference)
    : objects_(reference.objectNames.size())
{
    std::vector<std::vector<std::uint32_t>> vertices(objects_.size());
    for (std::size_t corner = 0; corner < reference.indices.size(); ++corner) {
        vertices[reference.objectIds[corner / 3] - 1].push_back(reference.indices[corner]);
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        std::vector<std::uint32_t>& own = vertices[i];
        std::ranges::sort(own);
        own.erase(std::unique(own.begin(), own.end()), own.end());
        Object& object = objects_[i];
        object.first = members_.size();
        for (const std::uint32_t vertex : own) {
            members_.push_back({ vertex, glm::vec3(0.0f) });
        }
        object.end = members_.size();
        chooseCorners(object, reference);
        const glm::dmat3 inverse = object.spans ? glm::inverse(axesOf(object, reference)) : glm::dmat3(0.0);
        const glm::dvec3 origin = own.empty() ? glm::dvec3(0.0) : middle(reference, object.corners[0]);
        for (std::size_t m = object.first; m < object.end; ++m) {
            members_[m].coordinates = inverse * (middle(reference, members_[m].vertex) - origin);
        }
    }
}

void ObjectTracker::chooseCorners(Object& object, const scene::Geometry& geometry) const
{
    std::vector<std::uint32_t> own;
    for (std::size_t m = object.first; m < object.end; ++m) {
        own.push_back(members_[m].vertex);
    }
    if (own.empty()) {
        return;
    }
    object.corners[0] = own.front();
    const auto edge = [&](std::uint32_t v) { return middle(geometry, v) - middle(geometry, object.corners[0]); };
    object.corners[1] = farthest(own, [&](std::uint32_t v) { return glm::length(edge(v)); });
    const glm::dvec3 first = edge(object.corners[1]);
    const double size = glm::length(first);
    object.corners[2] = farthest(own, [&](std::uint32_t v) { return glm::length(glm::cross(first, edge(v))); });
    const glm::dvec3 across = glm::cross(first, edge(object.corners[2]));
    object.spans = glm::length(across) > leastPart * size * size;
    object.corners[3] = farthest(own, [&](std::uint32_t v) { return std::abs(glm::dot(across, edge(v))); });
    object.flat = std::abs(glm::dot(across, edge(object.corners[3]))) <= leastPart * size * glm::length(across);
}

glm::dmat3 ObjectTracker::axesOf(const Object& object, const scene::Geometry& geometry) const
{
    const glm::dvec3 origin = middle(geometry, object.corners[0]);
    const glm::dvec3 u = middle(geometry, object.corners[1]) - origin, v = middle(geometry, object.corners[2]) - origin;
    const glm::dvec3 across = glm::cross(u, v);
    // As long as the first one, so that the axes are of one magnitude.
    const glm::dvec3 w =
        object.flat ? across * (glm::length(u) / glm::length(across)) : middle(geometry, object.corners[3]) - origin;
    return { u, v, w };
}

ObjectPlaces ObjectTracker::placesIn(const scene::Geometry& geometry) const
{
    ObjectPlaces places;
    places.objects.resize(objects_.size());
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const Object& object = objects_[i];
        ObjectPlaces::Place& place = places.objects[i];
        Hash shape;
        for (std::size_t m = object.first; m < object.end; ++m) {
            addToHash(shape, geometry.positions, members_[m].vertex);
            if (!geometry.positionsAtClose.empty()) {
                addToHash(shape, geometry.positionsAtClose, members_[m].vertex);
            }
        }
        place.shape = shape.value();
        if (!object.spans) {
            continue;
        }
        place.axes = axesOf(object, geometry);
        place.origin = middle(geometry, object.corners[0]);
        const double size = glm::length(place.axes[0]), determinant = std::abs(glm::determinant(place.axes));
        const double near = rigidity * size + rounding * glm::length(place.origin);
        const auto follows = [&](const Member& member) {
            const glm::dvec3 expected = place.origin + place.axes * glm::dvec3(member.coordinates);
            return glm::length(expected - middle(geometry, member.vertex)) <= near;
        };
        const auto begin = members_.begin();
        place.rigid = determinant > leastPart * leastPart * size * size * size
            && std::all_of(begin + static_cast<std::ptrdiff_t>(object.first),
                begin + static_cast<std::ptrdiff_t>(object.end), follows);
    }
    return places;
}

std::vector<float> motionsBetween(const ObjectPlaces& from, const ObjectPlaces& to)
{
    std::vector<float> out(from.objects.size() * WEDGE_TEMPORAL_MOTION, 0.0f);
    for (std::size_t i = 0; i < from.objects.size(); ++i) {
        const ObjectPlaces::Place &a = from.objects[i], &b = to.objects[i];
        float* motion = &out[i * WEDGE_TEMPORAL_MOTION];
        motion[12] = a.shape == b.shape ? WEDGE_TEMPORAL_STILL
            : a.rigid && b.rigid        ? WEDGE_TEMPORAL_MOVED
                                        : WEDGE_TEMPORAL_UNKNOWN;
        if (motion[12] != WEDGE_TEMPORAL_MOVED) {
            continue;
        }
        const glm::dmat3 map = b.axes * glm::inverse(a.axes);
        const glm::dvec3 shift = b.origin - map * a.origin;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                motion[4 * row + column] = static_cast<float>(map[column][row]);
            }
            motion[4 * row + 3] = static_cast<float>(shift[row]);
        }
    }
    return out;
}

bool areStill(const ObjectPlaces& from, const ObjectPlaces& to)
{
    return std::ranges::equal(from.objects, to.objects, {}, &ObjectPlaces::Place::shape, &ObjectPlaces::Place::shape);
}

} // namespace wedge::filters
