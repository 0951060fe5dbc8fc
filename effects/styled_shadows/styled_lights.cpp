#include "effects/styled_shadows/styled_lights.h"

#include "host/error.h"
#include "host/render/distributed_samples.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace wedge::render {
namespace {

/// Characters of a light's name in those of layers, which files cut where they are long.
constexpr std::size_t longestName = 64;

/// As layers are named.
std::string plainName(const std::string& name)
{
    std::string out;
    out.reserve(longestName);
    for (const char c : name.substr(0, longestName)) {
        out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    }
    return out;
}

/// Gives lights without a name of their own, or with one that begins as a number, their number among all point and
/// directional lights.
void number(std::vector<StyledLight>& lights)
{
    const std::vector<StyledLight> before = lights;
    const auto own = [&](const StyledLight& light) {
        return !light.name.empty() && std::ranges::count(before, light.name, &StyledLight::name) == 1
            && std::isdigit(static_cast<unsigned char>(light.name.front())) == 0;
    };
    for (StyledLight& light : lights) {
        light.name = own(light) ? light.name : fmt::format("{}", light.index + 1);
    }
}

} // namespace

const scene::ShadowStyle& styleOf(const scene::Scene& scene, std::uint32_t light, std::size_t style)
{
    const std::size_t points = scene.pointLights.size();
    return light < points ? scene.pointLights[light].styles.at(style)
                          : scene.directionalLights.at(light - points).styles.at(style);
}

std::vector<StyledLight> styledLights(const Settings& settings, const scene::Scene& scene)
{
    std::vector<StyledLight> out;
    if (!settings.styles) {
        return out;
    }
    std::uint32_t index = 0;
    const auto add = [&](const auto& lights) {
        for (const auto& light : lights) {
            if (!light.styles.empty()) {
                const std::string called = light.name.empty() ? fmt::format("{}", index + 1) : light.name;
                out.push_back({ index, plainName(light.name), called, light.styles });
            }
            ++index;
        }
    };
    add(scene.pointLights);
    add(scene.directionalLights);
    number(out);
    return out;
}

std::vector<StyleGroup> groupsOf(const StyledLight& light)
{
    std::vector<StyleGroup> groups;
    for (std::size_t i = 0; i < light.styles.size(); ++i) {
        const auto same = [&](const StyleGroup& group) {
            return group.styles.front().casters == light.styles[i].casters;
        };
        const auto known = std::ranges::find_if(groups, same);
        StyleGroup& group = known == groups.end() ? groups.emplace_back() : *known;
        group.styles.push_back(light.styles[i]);
        group.places.push_back(i);
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        groups[i].name = i == 0 ? light.name : fmt::format("{}.{}", light.name, i + 1);
        for (std::size_t k = 0; k < groups.size(); ++k) {
            const std::vector<std::string>& casters = groups[k].styles.front().casters;
            groups[i].apart.insert(groups[i].apart.end(), casters.begin(), k == i ? casters.begin() : casters.end());
            groups[i].restApart = groups[i].restApart || (k != i && casters.empty());
        }
    }
    return groups;
}

namespace {

/// Throws where soft shadows are to be drawn in a style, and frames do not filter what is seen of each such light.
void requireSoftStylable(const Settings& settings, const PreparedScene& scene)
{
    const DirectLights& lights = scene.directLights();
    const auto styled = [](const scene::AreaLight& light) { return !light.styles.empty(); };
    const auto name = [](const scene::AreaLight& light) {
        return fmt::format("style of light '{}'", light.name.empty() ? "quad" : light.name);
    };
    for (const std::uint32_t number : lights.sharedQuads) {
        if (styled(scene.areaLights[number])) {
            throw UsageError(fmt::format("only the {} strongest area lights have styles", mostOwnTerms),
                name(scene.areaLights[number]), "leave it out, or add --no-style");
        }
    }
    const auto light = std::ranges::find_if(scene.areaLights, styled);
    if (settings.method != Method::AxisAligned || settings.filtering == Filtering::None
        || settings.shading == Shading::Inside) {
        throw UsageError("styles of soft shadows are drawn of filtered shadows alone", name(*light),
            "choose --method aaf, without --filter none or --falloff inside, or add --no-style");
    }
}

} // namespace

void requireStylable(const Settings& settings, const PreparedScene& scene)
{
    const std::vector<StyledLight> lights = styledLights(settings, scene);
    const bool soft = settings.styles
        && std::ranges::any_of(scene.areaLights, [](const scene::AreaLight& light) { return !light.styles.empty(); });
    if (settings.integrator != Integrator::Path || (lights.empty() && !soft)) {
        return;
    }
    if (isDistributed(settings, scene)) {
        throw UsageError("styles of shadows are of frames through a pinhole where nothing moves, neither antialiased "
                         "nor progressive",
            lights.empty() ? "style of a quad" : fmt::format("style of light {}", lights.front().called),
            "add --no-style, or leave out --antialias, --progressive, the lens and what moves");
    }
    if (soft) {
        requireSoftStylable(settings, scene);
    }
}

} // namespace wedge::render
