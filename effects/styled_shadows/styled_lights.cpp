#include "effects/styled_shadows/styled_lights.h"

#include "effects/styled_shadows/style_knobs.h"
#include "host/error.h"
#include "host/render/distributed_samples.h"

#include <algorithm>
#include <cctype>
#include <string_view>

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

/// Names of all lights with a style as layers are named, of those without one "".
std::vector<std::string> plainNames(const scene::Scene& scene)
{
    std::vector<std::string> out;
    const auto add = [&](const auto& lights) {
        for (const auto& light : lights) {
            if (!light.styles.empty()) {
                out.push_back(plainName(light.name));
            }
        }
    };
    add(scene.pointLights);
    add(scene.directionalLights);
    add(scene.areaLights);
    return out;
}

constexpr std::string_view quadPrefix = "quad";

/// What a light is called that has this name: by it, where no other of `all` has it and it is none that lights
/// without a name are given; else as given.
std::string nameAmong(const std::vector<std::string>& all, const std::string& name, const std::string& given)
{
    const auto isNumber = [](std::string_view text) {
        return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0;
    };
    const std::string_view rest = std::string_view(name).substr(name.starts_with(quadPrefix) ? quadPrefix.size() : 0);
    const bool own = !name.empty() && std::ranges::count(all, name) == 1 && !isNumber(name) && !isNumber(rest);
    return own ? name : given;
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
    const std::vector<std::string> all = plainNames(scene);
    std::uint32_t index = 0;
    const auto add = [&](const auto& lights) {
        for (const auto& light : lights) {
            if (!light.styles.empty()) {
                const std::string number = fmt::format("{}", index + 1);
                out.push_back({ index, nameAmong(all, plainName(light.name), number),
                    light.name.empty() ? number : light.name, light.styles });
            }
            ++index;
        }
    };
    add(scene.pointLights);
    add(scene.directionalLights);
    return out;
}

std::string layerNameOf(const scene::Scene& scene, std::uint32_t quad)
{
    const std::string name = plainName(scene.areaLights.at(quad).name);
    return nameAmong(plainNames(scene), name, fmt::format("{}{}", quadPrefix, quad + 1));
}

bool movesEdges(const Settings& settings, const scene::Scene& scene)
{
    if (settings.integrator != Integrator::Path || !settings.styles) {
        return false;
    }
    const auto hard = [&](const StyledLight& light) {
        const bool varies = std::ranges::any_of(light.styles, variesByOccluder);
        return mostDistance(light.styles, varies ? farthestOccluder(scene, light.index) : 0.0f) > 0.0f;
    };
    const auto soft = [](const scene::AreaLight& light) { return mostDistance(light.styles, 0.0f) > 0.0f; };
    return std::ranges::any_of(styledLights(settings, scene), hard) || std::ranges::any_of(scene.areaLights, soft);
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

bool isStyled(const scene::AreaLight& light) { return !light.styles.empty(); }

/// In messages.
std::string nameOf(const scene::AreaLight& light)
{
    return fmt::format("style of light '{}'", light.name.empty() ? "quad" : light.name);
}

/// Throws where soft shadows are to be drawn in a style, and frames do not filter what is seen of each such light.
void requireSoftStylable(const Settings& settings, const PreparedScene& scene)
{
    const DirectLights& lights = scene.directLights();
    for (const std::uint32_t number : lights.sharedQuads) {
        if (isStyled(scene.areaLights[number])) {
            throw UsageError(fmt::format("only the {} strongest area lights have styles", mostOwnTerms),
                nameOf(scene.areaLights[number]), "leave it out, or add --no-style");
        }
    }
    const auto light = std::ranges::find_if(scene.areaLights, isStyled);
    if (settings.method != Method::AxisAligned || settings.filtering == Filtering::None
        || settings.shading == Shading::Inside) {
        throw UsageError("styles of soft shadows are drawn of filtered shadows alone", nameOf(*light),
            "choose --method aaf, without --filter none or --falloff inside, or add --no-style");
    }
}

} // namespace

void requireStylable(const Settings& settings, const PreparedScene& scene)
{
    const std::vector<StyledLight> lights = styledLights(settings, scene);
    const bool soft = settings.styles && std::ranges::any_of(scene.areaLights, isStyled);
    if (settings.integrator != Integrator::Path || (lights.empty() && !soft)) {
        return;
    }
    if (isDistributed(settings, scene)) {
        const auto styled = std::ranges::find_if(scene.areaLights, isStyled);
        throw UsageError("styles of shadows are of frames through a pinhole where nothing moves, neither antialiased "
                         "nor progressive",
            lights.empty() ? nameOf(*styled) : fmt::format("style of light {}", lights.front().called),
            "add --no-style, or leave out --antialias, --progressive, the lens and what moves");
    }
    if (soft) {
        requireSoftStylable(settings, scene);
    }
}

} // namespace wedge::render
