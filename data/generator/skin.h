#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "data/generator/obj_writer.h"

namespace wedge::generator {

/// A closed line of points around an axis, counter-clockwise seen from the axis' tip. All points may be one.
using Ring = std::vector<glm::dvec3>;

/// The skin over rings of equally many points, each joined with the next, with smooth normals from the points around:
/// 2 sides (rings - 1) triangles, less `sides` at an end whose ring is one point. It looks away from the axis where
/// rings follow each other along the axis, and towards it where they go back.
void skin(ObjWriter& mesh, const std::vector<Ring>& rings);

/// The centripetal Catmull-Rom curve through the control points, of which no two neighbours coincide: it neither
/// loops nor overshoots where they are unevenly spaced. `steps` points a stretch and the last one; before the first
/// and after the last it goes on to `before` and `after`.
template <class Point>
std::vector<Point> curveThrough(const std::vector<Point>& control, const Point& before, const Point& after, int steps)
{
    const auto knots = [](const Point& from, const Point& to) { return std::sqrt(glm::length(to - from)); };
    std::vector<Point> curve;
    for (std::size_t k = 0; k + 1 < control.size(); ++k) {
        const Point &b = control[k], &c = control[k + 1];
        const Point& a = k == 0 ? before : control[k - 1];
        const Point& d = k + 2 == control.size() ? after : control[k + 2];
        const double ab = knots(a, b), bc = knots(b, c), cd = knots(c, d);
        const Point start = bc * ((b - a) / ab - (c - a) / (ab + bc)) + c - b;
        const Point end = bc * ((d - c) / cd - (d - b) / (bc + cd)) + c - b;
        for (int i = 0; i < steps; ++i) {
            const double t = static_cast<double>(i) / steps;
            curve.push_back(b + t * start + t * t * (3.0 * (c - b) - 2.0 * start - end)
                + t * t * t * (2.0 * (b - c) + start + end));
        }
    }
    curve.push_back(control.back());
    return curve;
}

/// The curve that goes on straight at both ends.
template <class Point>
std::vector<Point> curveThrough(const std::vector<Point>& control, int steps)
{
    const std::size_t n = control.size();
    return curveThrough(control, 2.0 * control[0] - control[1], 2.0 * control[n - 1] - control[n - 2], steps);
}

/// A place on a line: the directions along it, up from it and to its left (along x up), all of unit length.
struct Frame {
    glm::dvec3 at, along, up, left;
};

/// The place on a line that goes `along`; `up` is as near to `upward` as can be, which is not parallel to `along`.
Frame frameAt(const glm::dvec3& at, const glm::dvec3& along, const glm::dvec3& upward);

/// A frame at each point of a line: `upward` at its start, and from there carried along without a twist.
std::vector<Frame> framesOn(const std::vector<glm::dvec3>& line, const glm::dvec3& upward);

/// A ring around a line: radius(angle) away from it, at angles in radians from `up` over `left`.
Ring ringAround(const Frame& frame, int sides, const std::function<double(double)>& radius);
Ring ringAround(const Frame& frame, int sides, double radius);

/// Rings around the y axis for a profile of points (radius, height, 0) that starts and ends on the axis: a smooth
/// curve through them, `steps` a stretch. Its outside is to the right of the way the profile goes.
std::vector<Ring> turned(const std::vector<glm::dvec3>& profile, int steps, int sides);

/// The rings after an affine map.
std::vector<Ring> placed(std::vector<Ring> rings, const glm::dmat4& map);

} // namespace wedge::generator
