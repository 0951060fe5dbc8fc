#include "data/generator/skin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wedge::generator {
namespace {

bool isPoint(const Ring& ring)
{
    return std::all_of(ring.begin(), ring.end(), [&](const glm::dvec3& p) { return glm::length(p - ring[0]) < 1e-9; });
}

/// Twice the area that a ring spans, seen from a point in its middle.
glm::dvec3 spanned(const Ring& ring, const glm::dvec3& middle)
{
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i)
        sum += glm::cross(ring[i] - middle, ring[(i + 1) % ring.size()] - middle);
    return sum;
}

std::vector<std::size_t> vertices(ObjWriter& mesh, const std::vector<Ring>& rings, std::size_t k)
{
    const Ring& ring = rings[k];
    const Ring& before = rings[k == 0 ? 0 : k - 1];
    const Ring& after = rings[std::min(k + 1, rings.size() - 1)];
    const std::size_t sides = ring.size();
    if (isPoint(ring)) {
        const glm::dvec3 out = k == 0 ? -spanned(after, ring[0]) : spanned(before, ring[0]);
        return std::vector<std::size_t>(sides, mesh.vertex(ring[0], glm::normalize(out)));
    }
    std::vector<std::size_t> made;
    for (std::size_t i = 0; i < sides; ++i) {
        const glm::dvec3 around = ring[(i + 1) % sides] - ring[(i + sides - 1) % sides];
        made.push_back(mesh.vertex(ring[i], glm::normalize(glm::cross(around, after[i] - before[i]))));
    }
    return made;
}

} // namespace

void skin(ObjWriter& mesh, const std::vector<Ring>& rings)
{
    const std::size_t sides = rings[0].size();
    std::vector<std::size_t> previous, made;
    for (std::size_t k = 0; k < rings.size(); ++k) {
        made = vertices(mesh, rings, k);
        for (std::size_t i = 0; k > 0 && i < sides; ++i) {
            const std::size_t next = (i + 1) % sides;
            if (previous[i] == previous[next])
                mesh.triangle(previous[i], made[next], made[i]);
            else if (made[i] == made[next])
                mesh.triangle(previous[i], previous[next], made[i]);
            else
                mesh.quad(previous[i], previous[next], made[next], made[i]);
        }
        previous = made;
    }
}

Frame frameAt(const glm::dvec3& at, const glm::dvec3& along, const glm::dvec3& upward)
{
    Frame frame;
    frame.at = at;
    frame.along = glm::normalize(along);
    frame.up = glm::normalize(upward - frame.along * glm::dot(upward, frame.along));
    frame.left = glm::cross(frame.along, frame.up);
    return frame;
}

std::vector<Frame> framesOn(const std::vector<glm::dvec3>& line, const glm::dvec3& upward)
{
    std::vector<Frame> frames;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const glm::dvec3 along = line[std::min(k + 1, line.size() - 1)] - line[k == 0 ? 0 : k - 1];
        frames.push_back(frameAt(line[k], along, k == 0 ? upward : frames.back().up));
    }
    return frames;
}

Ring ringAround(const Frame& frame, int sides, const std::function<double(double)>& radius)
{
    Ring ring;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        ring.push_back(frame.at + radius(angle) * (std::cos(angle) * frame.up + std::sin(angle) * frame.left));
    }
    return ring;
}

Ring ringAround(const Frame& frame, int sides, double radius)
{
    return ringAround(frame, sides, [=](double) { return radius; });
}

std::vector<Ring> turned(const std::vector<glm::dvec3>& profile, int steps, int sides)
{
    // Mirrored at the axis, so that the surface is level there.
    const glm::dvec3 mirror(-1, 1, 1);
    const std::vector<glm::dvec3> curve =
        curveThrough(profile, mirror * profile[1], mirror * profile[profile.size() - 2], steps);
    std::vector<Ring> rings;
    for (const glm::dvec3& p : curve)
        rings.push_back(ringAround(frameAt({ 0, p.y, 0 }, { 0, 1, 0 }, { 0, 0, 1 }), sides, p.x));
    return rings;
}

std::vector<Ring> placed(std::vector<Ring> rings, const glm::dmat4& map)
{
    for (Ring& ring : rings) {
        for (glm::dvec3& p : ring)
            p = glm::dvec3(map * glm::dvec4(p, 1.0));
    }
    return rings;
}

} // namespace wedge::generator
