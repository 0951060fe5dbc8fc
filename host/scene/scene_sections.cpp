#include "host/scene/scene_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "host/scene/mesh_keys.h"
#include "host/scene/rounding.h"
#include "host/scene/sections.h"
#include "host/scene/single_precision.h"
#include "host/scene/style_section.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

/// Of a light's half edge its middle may be off by so much.
constexpr double lightOff = 0.02;

/// Where a light's keys, [[light.key]], put it at a time: as a mesh's do.
class LightPose {
public:
    LightPose(TableReader& table, double time)
        : moves_(table.has("key"))
        , table_(table)
        , pose_(MeshKeys(table).at(time))
    {
    }

    FileVector point(const FileVector& p) const
    {
        const FileVector moved { moves_ ? glm::dvec3(pose_.exact * glm::dvec4(p.exact, 1.0)) : p.exact,
            moves_ ? glm::dvec3(pose_.single * glm::dvec4(p.single, 1.0)) : p.single };
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(moved.exact[axis]) <= maxCoordinate))
                table_.fail("key", "puts a light at a coordinate beyond 1e12", fmt::format("{:g}", moved.exact[axis]),
                    "scale the scene down");
        }
        return moved;
    }
    glm::dvec3 vector(const glm::dvec3& v) const { return moves_ ? glm::dmat3(pose_.single) * v : v; }
    bool mirrors() const { return glm::determinant(glm::dmat3(pose_.single)) < 0.0; }

private:
    bool moves_;
    TableReader& table_;
    Transform pose_;
};

glm::vec3 settled(const FileVector& p) { return glm::vec3(isPrecise(p.single, p.exact) ? p.single : p.exact); }

/// The point under a key.
FileVector readPlace(TableReader& table, const std::string& key)
{
    const glm::dvec3 exact = table.require(key, table.point(key));
    return { exact, inSingle(exact) };
}

/// A quad is a corner and two edges, or a centre and two half edges. Returns the centre; the light gets the edges.
FileVector readQuadShape(TableReader& table, AreaLight& light)
{
    if (table.has("corner")) {
        const FileVector corner = readPlace(table, "corner");
        const glm::dvec3 u = readPlace(table, "edge1").exact, v = readPlace(table, "edge2").exact;
        light.halfU = 0.5f * glm::vec3(u);
        light.halfV = 0.5f * glm::vec3(v);
        return { corner.exact + 0.5 * (u + v), glm::dvec3(glm::vec3(corner.single) + light.halfU + light.halfV) };
    }
    if (table.has("centre")) {
        light.halfU = glm::vec3(readPlace(table, "half_u").exact);
        light.halfV = glm::vec3(readPlace(table, "half_v").exact);
        return readPlace(table, "centre");
    }
    table.failHere("has no shape", "quad", "give corner, edge1 and edge2, or centre, half_u and half_v");
}

void readQuad(TableReader& table, const LightPose& pose, Scene& scene, Warnings& warnings)
{
    AreaLight light;
    light.name = table.text("name").value_or("");
    const FileVector centre = readQuadShape(table, light);
    light.radiance = table.require("radiance", table.colour("radiance"));
    if (table.choice("profile", { "gaussian", "uniform" }).value_or("gaussian") == "uniform")
        light.profile = LightProfile::Uniform;
    light.cut = static_cast<float>(table.number("cut").value_or(double { light.cut }));
    if (table.boolean("flip").value_or(false))
        std::swap(light.halfU, light.halfV);
    const FileVector placed = pose.point(centre);
    light.centre = settled(placed);
    light.halfU = glm::vec3(pose.vector(light.halfU));
    light.halfV = glm::vec3(pose.vector(light.halfV));
    if (pose.mirrors())
        std::swap(light.halfU, light.halfV); // so that it emits to the side that is mirrored, too
    light.twoSided = table.boolean("two_sided").value_or(light.twoSided);
    light.visible = table.boolean("visible").value_or(light.visible);
    light.styles = readStyles(table, ShadowKind::Soft, scene.shutterOpen);
    checkAreaLight(light, table.where("type"), warnings);
    const float side = std::min(glm::length(light.halfU), glm::length(light.halfV));
    warnOfRounding(placed.exact, lightOff * double { side }, table.where("type"), "light's middle", warnings);
    scene.areaLights.push_back(light);
}

void readPoint(TableReader& table, const LightPose& pose, Scene& scene)
{
    PointLight light;
    light.position = settled(pose.point(readPlace(table, "position")));
    light.intensity = table.require("intensity", table.colour("intensity"));
    light.name = table.text("name").value_or("");
    light.styles = readStyles(table, ShadowKind::Hard, scene.shutterOpen);
    scene.pointLights.push_back(light);
}

void readDirectional(TableReader& table, const LightPose& pose, Scene& scene)
{
    DirectionalLight light;
    const glm::dvec3 direction = inSingle(table.require("direction", table.vector("direction")));
    if (!(glm::length(direction) > 0.0))
        table.fail("direction", "is zero", "[0, 0, 0]", "give the way the light travels");
    light.direction = glm::vec3(glm::normalize(pose.vector(direction)));
    light.irradiance = table.require("irradiance", table.colour("irradiance"));
    light.name = table.text("name").value_or("");
    light.styles = readStyles(table, ShadowKind::Hard, scene.shutterOpen);
    scene.directionalLights.push_back(light);
}

/// Which integrator, and the keys that go with one of the two.
void readIntegratorType(TableReader& table, Settings& s)
{
    s.integrator = table.choice("type", { "path", "ao" });
    s.lightSampling = table.choice("light_sampling", { "both", "lights", "directions" });
    const auto bounces = table.integer("bounces", 0, maxBounces);
    const auto distance = table.number("ao_distance", leastAmbientDistance, mostAmbientDistance);
    const bool ambient = s.integrator == "ao";
    if (ambient && bounces)
        table.fail("bounces", "has no effect with type ao, which follows no paths", fmt::format("{}", *bounces),
            "leave it out or choose type path");
    if (ambient && s.lightSampling)
        table.fail("light_sampling", "has no effect with type ao, which knows no lights",
            fmt::format("'{}'", *s.lightSampling), "leave it out or choose type path");
    if (!ambient && distance)
        table.fail("ao_distance", "has no effect with type path", fmt::format("{:g}", *distance),
            "leave it out or choose type ao");
    if (bounces)
        s.bounces = static_cast<int>(*bounces);
    if (distance)
        s.ambientDistance = static_cast<float>(*distance);
}

} // namespace

void readImage(TableReader& root, Scene& scene)
{
    auto table = root.table("image");
    if (!table)
        return;
    Settings& s = scene.settings;
    s.width = static_cast<int>(table->integer("width", 1, maxImageSide).value_or(s.width));
    s.height = static_cast<int>(table->integer("height", 1, maxImageSide).value_or(s.height));
    table->finish();
}

void readIntegrator(TableReader& root, Scene& scene)
{
    auto table = root.table("integrator");
    if (!table)
        return;
    const auto count = [&](const char* key) -> std::optional<int> {
        const auto value = table->integer(key, 1, maxSamples);
        return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
    };
    Settings& s = scene.settings;
    s.method = table->choice("method", { "mc", "aaf", "maaf" });
    s.spp = count("spp");
    s.maxSpp = count("max_spp");
    if (s.spp && s.maxSpp && *s.maxSpp < *s.spp)
        table->fail("max_spp", "is below spp", fmt::format("{} and {}", *s.maxSpp, *s.spp), "raise it or lower spp");
    if (const auto mu = table->number("mu", leastMu, mostMu))
        s.mu = static_cast<float>(*mu);
    readIntegratorType(*table, s);
    s.antialias = table->boolean("antialias").value_or(false);
    s.pixelFilter = table->choice("pixel_filter", { "box", "gaussian", "blackman-harris" });
    s.seed =
        static_cast<std::uint32_t>(table->integer("seed", 0, std::numeric_limits<std::uint32_t>::max()).value_or(0));
    table->finish();
}

void readSequence(TableReader& root, Scene& scene)
{
    auto table = root.table("sequence");
    if (!table)
        return;
    scene.framesPerUnit = table->require("fps", table->number("fps", leastFps, mostFps));
    table->finish();
}

void readBackground(TableReader& root, Scene& scene)
{
    auto table = root.table("background");
    if (!table)
        return;
    scene.background = table->require("radiance", table->colour("radiance"));
    table->finish();
}

void readLights(TableReader& root, Scene& scene, Warnings& warnings)
{
    for (TableReader& table : root.tables("light")) {
        const std::string type = table.require("type", table.choice("type", { "quad", "point", "directional" }));
        const LightPose pose(table, scene.shutterOpen);
        if (type == "quad")
            readQuad(table, pose, scene, warnings);
        else if (type == "point")
            readPoint(table, pose, scene);
        else
            readDirectional(table, pose, scene);
        table.finish();
    }
}

void readExtensions(TableReader& root, Scene& scene, Warnings& warnings)
{
    for (const Section& section : sections()) {
        if (section.list) {
            std::vector<std::any> all;
            for (TableReader& table : root.tables(section.key)) {
                all.push_back(section.read(table, warnings));
                table.finish();
            }
            if (!all.empty()) {
                scene.extensions[section.key] = std::move(all);
            }
        } else if (auto table = root.table(section.key)) {
            scene.extensions[section.key] = section.read(*table, warnings);
            table->finish();
        }
    }
}

std::vector<AreaLight> lightsOfExtensions(const Scene& scene)
{
    std::vector<AreaLight> out;
    for (const Section& section : sections()) {
        if (const auto found = scene.extensions.find(section.key);
            found != scene.extensions.end() && section.areaLights) {
            const std::vector<AreaLight> more = section.areaLights(found->second, sceneBounds(scene));
            out.insert(out.end(), more.begin(), more.end());
        }
    }
    return out;
}

} // namespace wedge::scene
