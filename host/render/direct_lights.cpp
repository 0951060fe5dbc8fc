#include "host/render/direct_lights.h"

#include "host/render/cutouts.h"
#include "host/render/device_scene.h"
#include "host/render/flush_lights.h"
#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace wedge::render {
namespace {

/// Two triangles that may be a panel.
struct Candidate {
    std::array<glm::dvec3, 4> corners; ///< around it
    std::uint32_t material = 0;
    double power = 0; ///< W/sr of one side
    std::vector<std::size_t> triangles; ///< both, then what lies in their place
    bool alone = true; ///< nothing that emits touches it
};

/// How far points at the corners may be off by rounding: as kernels reckon (trace/surface.h).
double roundingOf(const std::array<glm::dvec3, 4>& corners)
{
    double far = 0;
    for (const glm::dvec3& c : corners) {
        far = std::max(far, std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
    }
    return 64.0 * far * static_cast<double>(std::numeric_limits<float>::epsilon());
}

std::array<glm::dvec3, 4> cornersOfPair(const scene::Geometry& g, std::size_t triangle, std::uint32_t pair)
{
    const auto first = [&](std::size_t k) { return cornerOf(g, triangle, k); };
    // The triangles are a, b, c and a, c, d; or a, b, d and b, c, d.
    return pair == WEDGE_PAIR_FIRST
        ? std::array<glm::dvec3, 4> { first(0), first(1), first(2), cornerOf(g, triangle + 1, 2) }
        : std::array<glm::dvec3, 4> { first(0), first(1), cornerOf(g, triangle + 1, 1), first(2) };
}

/// To what the corners' rounding allows, which must be far below the sides.
bool isParallelogram(const std::array<glm::dvec3, 4>& c)
{
    const double rounding = roundingOf(c), side = std::min(glm::length(c[1] - c[0]), glm::length(c[3] - c[0]));
    if (rounding > 1e-2 * side) {
        return false;
    }
    return glm::length(c[0] + c[2] - c[1] - c[3]) <= rounding / 16.0
        && glm::length(glm::cross(c[1] - c[0], c[3] - c[0])) > 0;
}

/// Pairs of at least `least` W/sr, of a material that emits evenly.
std::vector<Candidate> candidates(const scene::Scene& scene, double least)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<Candidate> out;
    for (std::size_t t = 0; t + 1 < g.materialIds.size(); ++t) {
        const std::uint32_t material = g.materialIds[t];
        const double power = plainPower(scene, t);
        if (!(power > 0) || 2.5 * power < least || scene.materials[material].emissionTexture >= 0
            || isCutout(scene.materials[material]) || g.materialIds[t + 1] != material || triangleMoves(g, t)
            || triangleMoves(g, t + 1)) {
            continue;
        }
        const std::uint32_t pair = pairAt(g, t);
        const double both = power + plainPower(scene, t + 1);
        if (pair == WEDGE_PAIR_NONE || both < least) {
            continue;
        }
        const std::array<glm::dvec3, 4> corners = cornersOfPair(g, t, pair);
        if (isParallelogram(corners)) {
            out.push_back({ corners, material, both, { t, t + 1 } });
            ++t;
        }
    }
    return out;
}

/// What else emits at a candidate's corners: faces that are there twice belong to it; others make it part of a larger
/// mesh.
void meet(const scene::Scene& scene, std::size_t triangle, Candidate& candidate)
{
    const double near = roundingOf(candidate.corners);
    std::size_t touching = 0, same = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 corner = cornerOf(scene.geometry, triangle, k);
        const auto isThere = [&](const glm::dvec3& c) { return glm::length(c - corner) <= near; };
        touching += std::ranges::any_of(candidate.corners, isThere) ? 1 : 0;
        same += std::ranges::count(candidate.corners, corner) > 0 ? 1 : 0;
    }
    if (same == 3 && scene.geometry.materialIds[triangle] == candidate.material
        && !triangleMoves(scene.geometry, triangle)) {
        candidate.triangles.push_back(triangle);
    } else if (touching > 0) {
        candidate.alone = false;
    }
}

std::vector<Candidate> panels(const scene::Scene& scene)
{
    const std::size_t count = scene.geometry.materialIds.size();
    double total = 0;
    bool foundAlone = false;
    for (std::size_t t = 0; t < count; ++t) {
        total += plainPower(scene, t);
        foundAlone |= isFoundAlone(scene, t);
    }
    // What directions alone find needs a term that follows them.
    if (!(total > 0) || foundAlone) {
        return {};
    }
    std::vector<Candidate> found = candidates(scene, leastPanelShare * total);
    for (std::size_t t = 0; !found.empty() && t < count; ++t) {
        if (!(plainPower(scene, t) > 0)) {
            continue;
        }
        for (Candidate& c : found) {
            if (t != c.triangles[0] && t != c.triangles[1]) {
                meet(scene, t, c);
            }
        }
    }
    // Faces there twice may be two candidates: the first is the panel, with both.
    for (std::size_t i = 0; i < found.size(); ++i) {
        std::ranges::sort(found[i].triangles);
        for (std::size_t k = 0; k < i; ++k) {
            found[i].alone = found[i].alone && !(found[k].alone && found[k].triangles == found[i].triangles);
        }
    }
    std::erase_if(found, [](const Candidate& c) { return !c.alone; });
    return found;
}

OwnLight lightOf(const scene::Scene& scene, const Candidate& panel)
{
    const auto& c = panel.corners;
    OwnLight out;
    out.quad.centre = glm::vec3(0.25 * (c[0] + c[1] + c[2] + c[3]));
    out.quad.halfU = glm::vec3(0.5 * (c[1] - c[0]));
    out.quad.halfV = glm::vec3(0.5 * (c[3] - c[0]));
    out.quad.radiance = scene.materials[panel.material].emission;
    out.quad.profile = scene::LightProfile::Uniform;
    out.quad.twoSided = true;
    out.quad.visible = false; // the surface is
    out.lift = static_cast<float>(roundingOf(c));
    return out;
}

double powerOf(const scene::AreaLight& quad)
{
    const shared::AreaLight light = deviceLight(quad);
    return shared::luminance(light.power) * (light.twoSided != 0 ? 2.0 : 1.0);
}

} // namespace

shared::AreaLight OwnLight::onDevice() const
{
    shared::AreaLight light = deviceLight(quad);
    light.lift = lift;
    return light;
}

DirectLights directLights(const scene::Scene& scene)
{
    struct Ranked {
        std::size_t number;
        double power;
    };
    const std::vector<Candidate> found = panels(scene);
    const std::size_t quads = scene.areaLights.size();
    std::vector<Ranked> ranked;
    for (std::size_t i = 0; i < quads; ++i) {
        ranked.push_back({ i, powerOf(scene.areaLights[i]) });
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        ranked.push_back({ quads + i, 2.0 * found[i].power });
    }
    std::ranges::stable_sort(ranked, std::greater<> {}, &Ranked::power);
    std::ranges::sort(ranked.begin(),
        ranked.begin() + static_cast<std::ptrdiff_t>(std::min(ranked.size(), mostOwnTerms)), {}, &Ranked::number);
    DirectLights out;
    out.lifts = liftsOf(scene.areaLights, scene.geometry);
    for (std::size_t i = 0; i < ranked.size(); ++i) {
        const std::size_t number = ranked[i].number;
        if (i >= mostOwnTerms) {
            if (number < quads && ranked[i].power > 0) {
                out.sharedQuads.push_back(static_cast<std::uint32_t>(number));
            }
        } else if (number < quads) {
            out.own.push_back({ scene.areaLights[number], out.lifts[number], static_cast<std::uint32_t>(number) });
            out.own.back().quad.styles.clear();
        } else {
            const Candidate& panel = found[number - quads];
            out.own.push_back(lightOf(scene, panel));
            out.panelTriangles.insert(out.panelTriangles.end(), panel.triangles.begin(), panel.triangles.end());
        }
    }
    std::ranges::sort(out.sharedQuads);
    std::ranges::sort(out.panelTriangles);
    out.share = !out.sharedQuads.empty();
    for (std::size_t t = 0; !out.share && t < scene.geometry.materialIds.size(); ++t) {
        out.share = plainPower(scene, t) > 0 && !std::ranges::binary_search(out.panelTriangles, t);
    }
    return out;
}

SceneLights::SceneLights(
    const scene::Scene& scene, const DirectLights& direct, std::shared_ptr<const EnvironmentTable> table)
    : emitters(emitterList(scene))
    , beyond(std::move(table))
{
    if (direct.share && !direct.shareEmitters()) {
        shared = emitterList(scene, direct.panelTriangles, direct.sharedQuads);
    }
}

} // namespace wedge::render
