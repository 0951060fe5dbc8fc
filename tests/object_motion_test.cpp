// Where objects are found to have gone from one frame of a sequence to another.
#include "filters/temporal/object_motion.h"
#include "kernels/shared/temporal.h"

#include <doctest/doctest.h>

#include <glm/glm.hpp>

using namespace wedge;

TEST_CASE("temporal: objects are found again by their vertices, and those that deform are not")
{
    scene::Geometry then;
    const auto add = [&](const std::vector<glm::vec3>& corners) {
        then.objectNames.emplace_back("object");
        for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                then.indices.push_back(static_cast<std::uint32_t>(then.positions.size() / 3));
                const glm::vec3 v = corners[i + k];
                then.positions.insert(then.positions.end(), { v.x, v.y, v.z });
            }
            then.objectIds.push_back(static_cast<std::uint32_t>(then.objectNames.size()));
        }
    };
    add({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 1 } }); // moves
    add({ { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 }, { 6, 1, 0 } }); // flat, turns out of its plane
    add({ { 0, 5, 0 }, { 1, 5, 0 }, { 0, 6, 0 }, { 0, 5, 1 }, { 1, 6, 1 } }); // deforms
    add({ { 9, 9, 9 }, { 8, 9, 9 }, { 9, 8, 9 } }); // rests
    const filters::ObjectTracker tracker(then);
    scene::Geometry now = then;
    const auto moved = [](std::uint32_t id, glm::dvec3 v) {
        return id == 1 ? glm::dvec3(2 - v.y, v.x, 1.5 * v.z) : glm::dvec3(v.x, -v.z, v.y + 0.5);
    };
    for (std::size_t corner = 0; corner < now.indices.size(); ++corner) {
        const std::uint32_t id = now.objectIds[corner / 3];
        float* at = &now.positions[3 * std::size_t { now.indices[corner] }];
        const glm::dvec3 to = moved(id, { at[0], at[1], at[2] });
        for (int k = 0; id < 3 && k < 3; ++k) {
            at[k] = static_cast<float>(to[k]);
        }
    }
    now.positions[3 * std::size_t { then.indices[18] } + 1] += 0.3f;
    const filters::ObjectPlaces before = tracker.placesIn(then), after = tracker.placesIn(now);
    CHECK(filters::areStill(before, before));
    CHECK_FALSE(filters::areStill(before, after));
    const std::vector<float> motions = filters::motionsBetween(after, before);
    const auto kind = [&](std::size_t id) { return motions[(id - 1) * WEDGE_TEMPORAL_MOTION + 12]; };
    CHECK(kind(1) == WEDGE_TEMPORAL_MOVED);
    CHECK(kind(2) == WEDGE_TEMPORAL_MOVED);
    CHECK(kind(3) == WEDGE_TEMPORAL_UNKNOWN);
    CHECK(kind(4) == WEDGE_TEMPORAL_STILL);
    for (const std::uint32_t id : { 1u, 2u }) {
        const float* m = &motions[(id - 1) * WEDGE_TEMPORAL_MOTION];
        const glm::dvec3 was = id == 1 ? glm::dvec3(0.2, 0.3, 0.4) : glm::dvec3(5.3, 0.6, 0.0), is = moved(id, was);
        for (int row = 0; row < 3; ++row) {
            const double back = m[4 * row] * is.x + m[4 * row + 1] * is.y + m[4 * row + 2] * is.z + m[4 * row + 3];
            CHECK(back == doctest::Approx(was[row]).epsilon(1e-5));
        }
    }
}
