#include "benchmarks/rays/compare.h"

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace wedge::benchmark {
namespace {

using glm::dvec2;
using glm::dvec3;
using shared::Hit;

constexpr double agreeingT = 1e-4; ///< relative
constexpr double roundingUlps = 64; ///< what a handful of float operations may add up to
constexpr double ulp = 1.0 / (1 << 24);

/// One triangle and one ray, exactly.
struct ExactTest {
    bool inside = false; ///< the line passes through the triangle, edges included
    double t = 0; ///< of the plane
    double edge = 0; ///< distance of the line from the nearest edge, metres
    double scale = 0; ///< largest length involved: what floats round relative to, metres
    double cosine = 0; ///< between ray and normal, not negative
    double length = 0; ///< of the direction
    double edgeUlps() const { return edge / (scale * ulp); }
    /// What rounding may do to t.
    double slackT() const { return roundingUlps * scale * ulp / std::max(1e-12, cosine * length); }
};

dvec3 toDouble(const shared::Vec3& v) { return { v.x, v.y, v.z }; }

/// Distance of the origin from the segment ab.
double distanceToSegment(const dvec2& a, const dvec2& b)
{
    const dvec2 ab = b - a;
    const double squared = glm::dot(ab, ab);
    const double s = squared > 0 ? std::clamp(-glm::dot(a, ab) / squared, 0.0, 1.0) : 0.0;
    return glm::length(a + s * ab);
}

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

ExactTest test(const bvh::Mesh& mesh, std::uint32_t triangle, const bvh::Ray& ray)
{
    ExactTest out;
    const dvec3 origin = toDouble(ray.origin), direction = toDouble(ray.direction);
    out.length = glm::length(direction);
    const dvec3 along = direction / out.length;
    const dvec3 helper = std::fabs(along.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 x = glm::normalize(glm::cross(helper, along)), y = glm::cross(along, x);
    dvec3 corner[3];
    dvec2 seen[3]; // as the ray sees it, itself at 0
    for (std::size_t i = 0; i < 3; ++i) {
        const float* p = mesh.positions.data() + 3 * std::size_t { mesh.indices[3 * std::size_t { triangle } + i] };
        corner[i] = dvec3(p[0], p[1], p[2]);
        const dvec3 relative = corner[i] - origin;
        seen[i] = { glm::dot(relative, x), glm::dot(relative, y) };
        for (int axis = 0; axis < 3; ++axis)
            out.scale =
                std::max({ out.scale, std::fabs(corner[i][axis]), std::fabs(origin[axis]), std::fabs(relative[axis]) });
    }
    const double u = cross(seen[1], seen[2]), v = cross(seen[2], seen[0]), w = cross(seen[0], seen[1]);
    out.inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    out.edge = std::min({ distanceToSegment(seen[0], seen[1]), distanceToSegment(seen[1], seen[2]),
        distanceToSegment(seen[2], seen[0]) });
    const dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double facing = glm::dot(normal, along), size = glm::length(normal);
    out.t = glm::dot(normal, corner[0] - origin) / (facing * out.length);
    out.cosine = size > 0 ? std::fabs(facing) / size : 0;
    return out;
}

bool withinRay(const ExactTest& exact, const bvh::Ray& ray) { return exact.t > ray.tMin && exact.t < ray.tMax; }

Disagreement judge(const bvh::Mesh& mesh, const bvh::Ray& ray, const Hit& ours, const Hit& theirs)
{
    Disagreement out;
    out.ours = ours;
    out.theirs = theirs;
    const bool weHit = ours.triangle != WEDGE_NO_TRIANGLE, theyHit = theirs.triangle != WEDGE_NO_TRIANGLE;
    out.kind = "unexplained";
    if (!weHit && !theyHit) {
        out.right = "both";
        return out;
    }
    // The nearer one is in question: if it is there, whoever did not see it is wrong.
    const bool oursNearer = weHit && (!theyHit || ours.t <= theirs.t);
    const ExactTest near = test(mesh, oursNearer ? ours.triangle : theirs.triangle, ray);
    out.edgeUlps = near.edgeUlps();
    out.trueT = near.t;
    const bool there = near.inside && withinRay(near, ray);
    out.right = there == oursNearer ? "ours" : "embree";
    if (weHit && theyHit) {
        const ExactTest far = test(mesh, oursNearer ? theirs.triangle : ours.triangle, ray);
        const bool close = std::fabs(near.t - far.t) <= near.slackT() + far.slackT();
        if (ours.triangle == theirs.triangle) {
            out.kind = std::fabs(double { ours.t } - theirs.t) <= near.slackT() ? "rounded t" : "unexplained";
            out.right = std::fabs(ours.t - near.t) <= std::fabs(theirs.t - near.t) ? "ours" : "embree";
            return out;
        }
        if (close) {
            out.kind = "tie";
            out.right = "both";
            return out;
        }
    }
    if (near.edgeUlps() <= roundingUlps)
        out.kind = "edge";
    else if (near.inside && std::min(std::fabs(near.t - ray.tMin), std::fabs(near.t - ray.tMax)) <= near.slackT())
        out.kind = "end";
    return out;
}

bool agree(const Hit& a, const Hit& b)
{
    if (a.triangle != b.triangle)
        return false;
    return a.triangle == WEDGE_NO_TRIANGLE || std::fabs(a.t - b.t) <= agreeingT * std::fabs(b.t);
}

} // namespace

const std::vector<std::string>& disagreementKinds()
{
    static const std::vector<std::string> kinds = { "tie", "edge", "end", "rounded t", "unexplained" };
    return kinds;
}

std::size_t Comparison::count(const std::string& kind) const
{
    return static_cast<std::size_t>(std::ranges::count(disagreements, kind, &Disagreement::kind));
}

std::size_t Comparison::right(const std::string& side) const
{
    return static_cast<std::size_t>(std::ranges::count(disagreements, side, &Disagreement::right));
}

Comparison compareHits(
    const bvh::Mesh& mesh, const RaySet& set, const std::vector<Hit>& ours, const std::vector<Hit>& theirs)
{
    Comparison out { set.live, {} };
    for (std::size_t i = 0; i < set.rays.size(); ++i)
        if (isLive(set.rays[i]) && !agree(ours[i], theirs[i])) {
            out.disagreements.push_back(judge(mesh, set.rays[i], ours[i], theirs[i]));
            out.disagreements.back().ray = i;
        }
    return out;
}

Comparison compareOccluded(const bvh::Mesh& mesh, const RaySet& set, const std::vector<std::uint32_t>& ours,
    const std::vector<std::uint32_t>& theirs, const std::function<Hit(const bvh::Ray&)>& ourNearest,
    const std::function<Hit(const bvh::Ray&)>& theirNearest)
{
    Comparison out { set.live, {} };
    const Hit none { 0, 0, 0, WEDGE_NO_TRIANGLE };
    for (std::size_t i = 0; i < set.rays.size(); ++i)
        if (isLive(set.rays[i]) && ours[i] != theirs[i]) {
            const bvh::Ray& ray = set.rays[i];
            const Hit a = ours[i] != 0 ? ourNearest(ray) : none, b = theirs[i] != 0 ? theirNearest(ray) : none;
            out.disagreements.push_back(judge(mesh, ray, a, b));
            out.disagreements.back().ray = i;
        }
    return out;
}

} // namespace wedge::benchmark
