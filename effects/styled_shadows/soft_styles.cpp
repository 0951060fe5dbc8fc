#include "effects/styled_shadows/soft_styles.h"

#include "effects/styled_shadows/object_list.h"
#include "effects/styled_shadows/shadow_distances.h"
#include "effects/styled_shadows/style_knobs.h"
#include "effects/styled_shadows/styled_lights.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/shadow_levels.cl";

/// The level k of so many, 0 to 1: close to each other where hardly anything or nearly all is seen of a light, since
/// the tails of penumbras are long.
float levelOf(std::uint32_t k, std::uint32_t count)
{
    const double turn = (k + 0.5) / count * std::numbers::pi;
    return static_cast<float>(0.5 - 0.5 * std::cos(turn));
}

/// Metres that distances of a light's levels are told apart up to, beyond what styles ask for: penumbras are about as
/// wide as lights, and more than the distance between two levels has to be known.
float widthOf(const shared::AreaLight& light)
{
    return 8.0f * std::max(shared::vecLength(light.halfU), shared::vecLength(light.halfV));
}

/// Finds a shadow whose edge is where that much is seen of the light; where a half is, it is what is seen.
/// matte: to be filled in
void findLevel(FrameBuilder& f, const LightVisibility& seen, float level, graph::Argument matte,
    const std::function<bool(const graph::Run&)>& condition = {})
{
    f.pixels("levels of a shadow", PassKind::Analysis, { program, "levelMatte" },
        { f.rectangle(f.analysisParams()), reads("position", f.surfaces.position), reads("normal", f.surfaces.normal),
            reads("objectId", f.surfaces.objectId), value("light", seen.light), reads("value", seen.value),
            value("level", level), std::move(matte) },
        condition);
}

/// Those of a light's styles of one penumbra, whose level sets are the same, and by how much each changes what is seen.
class LevelStyles {
public:
    /// places: of these, among all of the light, at least one; reach: of distances, 0
    /// where no style moves edges; weights: the sum of those of all styles
    LevelStyles(FrameBuilder& frame, const LightVisibility& seen, std::vector<std::size_t> places,
        const DistanceReach& reach, float weights)
        : f_(frame)
        , seen_(seen)
        , places_(std::move(places))
        , penumbra_(style(0).penumbra)
        , reach_(reach)
        , weights_(weights)
        , changes_(places_.size())
    {
    }

    /// Adds to R, G and B of what is seen.
    void declare(graph::Handle<Value>& sum)
    {
        if (reach_.largest > 0.0f) {
            levels();
        }
        for (std::size_t i = 0; i < places_.size(); ++i) {
            addStyle(i, sum);
        }
    }

private:
    /// One of them as it was at the level before.
    struct Level {
        graph::Handle<Metres> distance;
        std::vector<SmoothedDistance> smoothed; ///< of each style
    };

    const scene::ShadowStyle& style(std::size_t of) const
    {
        return f_.description.areaLights[seen_.quad].styles.at(places_[of]);
    }

    template <class Number>
    graph::Argument knob(std::string name, std::size_t of, const Number& number) const
    {
        const auto style = [&scene = f_.description, quad = seen_.quad, place = places_[of] ]() -> const auto&
        {
            return scene.areaLights[quad].styles.at(place);
        };
        return knobValue(std::move(name), style, number);
    }

    void levels()
    {
        for (graph::Handle<Share>& change : changes_) {
            change = f_.graph.plane<Share>("change by levels", graph::floatPlanes(WEDGE_LEVEL_PLANES));
            f_.zero(change);
        }
        // Without a penumbra all levels are one.
        const std::uint32_t count = penumbra_ > 0.0f ? WEDGE_SHADOW_LEVELS : 1u;
        Level before;
        for (std::uint32_t k = 0; k < count; ++k) {
            Level level = levelAt(0.5f + penumbra_ * (levelOf(k, count) - 0.5f));
            if (k > 0 || count == 1) {
                for (std::size_t i = 0; i < places_.size(); ++i) {
                    addLevels(i, k, count, level, before);
                }
            }
            before = std::move(level);
        }
    }

    Level levelAt(float level)
    {
        auto matte = f_.graph.plane<Matte>("matte of a level", graph::floats);
        findLevel(f_, seen_, level, writes("matte", matte));
        Level out;
        out.distance = shadowDistances(f_, matte, {}, 0.0f, reach_).distance;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            out.smoothed.push_back(mostOf(abstractionOf(style(i)), 0.0f) > 0.0f
                    ? smoothedDistance(f_, matte, out.distance,
                        { graph::absent("away"), knob("deviation", i, abstractionOf),
                            mostDistance({ &style(i), 1 }, 0.0f), style(i).keepArea })
                    : SmoothedDistance { out.distance, {} });
        }
        return out;
    }

    /// Adds what is seen between a level and the one before; of one level, of no graph, of all of the light.
    void addLevels(std::size_t of, std::uint32_t k, std::uint32_t count, const Level& level, const Level& before)
    {
        const auto zeros = [](const char* name, const SmoothedDistance& distance) {
            return distance.zeros.graph != 0 ? reads(name, distance.zeros) : graph::absent(name);
        };
        const auto metres = [](shared::StyleKnob (*which)(const scene::ShadowStyle&)) {
            return [which](const scene::ShadowStyle& s) { return which(s).base; };
        };
        const bool one = count == 1;
        const float at = levelOf(k, count), from = one ? at : levelOf(k - 1, count);
        const SmoothedDistance& now = level.smoothed[of];
        const SmoothedDistance previous = one ? SmoothedDistance() : before.smoothed[of];
        f_.pixels("styles of shadows", PassKind::Composite, { program, "addLevel" },
            joined({ f_.rectangle(f_.analysisParams()), reads("distance", level.distance),
                       reads("smoothed", now.distance), zeros("zeros", now) },
                Arguments { one ? graph::absent("previous") : reads("previous", before.distance),
                    one ? graph::absent("previousSmoothed") : reads("previousSmoothed", previous.distance),
                    zeros("previousZeros", previous) },
                graph::together("style",
                    { knob("inflation", of, metres(inflationOf)), knob("softness", of, metres(softnessOf)),
                        value("both", at - from), value("beforeThem", k <= 1 ? from : 0.0f),
                        value("afterThem", k + 1 == count ? 1.0f - at : 0.0f),
                        value("end", one ? 0.0f : levelOf(0, count) / (levelOf(1, count) - levelOf(0, count))),
                        value("pairs", static_cast<float>(one ? 1 : count - 1)) }),
                Arguments { updates("change", changes_[of]) }));
    }

    void addStyle(std::size_t of, graph::Handle<Value>& sum)
    {
        const graph::Handle<Share>& change = changes_[of];
        const auto left = [](int channel) {
            return [channel](const scene::ShadowStyle& s) { return brightnessOf(s, channel).base; };
        };
        const auto softness = [](const scene::ShadowStyle& s) { return softnessOf(s).base; };
        Arguments arguments =
            joined({ f_.rectangle(f_.analysisParams()), value("light", seen_.light), reads("value", seen_.value),
                       change.graph != 0 ? reads("change", change)
                                         : graph::absent("change", graph::floatPlanes(WEDGE_LEVEL_PLANES)),
                       reads("pixelSize", f_.surfaces.pixelSize) },
                places(f_.surfaces),
                graph::together("style",
                    { value("channels", f_.specular() ? 2u : 1u), value("penumbra", penumbra_),
                        knob("softness", of, softness), value("largest", reach_.largest), knob("red", of, left(0)),
                        knob("green", of, left(1)), knob("blue", of, left(2)),
                        value("weight", style(of).weight / weights_) }));
        if (style(of).receivers.empty()) {
            arguments.push_back(graph::absent("receivers", graph::counts));
        } else {
            arguments = joined(arguments, objectList(f_, "receivers", style(of).receivers));
        }
        arguments.push_back(updates("seen", sum));
        f_.pixels("styles of shadows", PassKind::Composite, { program, "softStyle" }, std::move(arguments));
    }

    FrameBuilder& f_;
    const LightVisibility& seen_;
    std::vector<std::size_t> places_;
    float penumbra_;
    DistanceReach reach_;
    float weights_;
    std::vector<graph::Handle<Share>> changes_; ///< of what is seen, by each style; of no graph: by none
};

/// How far distances are found, the same for all styles of a light, so that what one of them draws does not go by the
/// penumbras of others; both 0 where none of them moves edges.
DistanceReach reachOf(const LightVisibility& seen, const std::vector<scene::ShadowStyle>& styles)
{
    const float most = mostDistance(styles, 0.0f); // with headroom; half of it is where styles are done
    return { most > 0.0f ? most + widthOf(seen.light) : 0.0f, 0.5f * most };
}

} // namespace

graph::Handle<Value> softStyles(FrameBuilder& f, const LightVisibility& seen)
{
    const std::vector<scene::ShadowStyle>& styles = f.description.areaLights[seen.quad].styles;
    auto sum = f.graph.plane<Value>("change by styles", graph::floatPlanes(f.specular() ? 6 : 3));
    f.zero(sum);
    std::map<float, std::vector<std::size_t>> places; // by penumbras
    float weights = 0.0f;
    for (std::size_t i = 0; i < styles.size(); ++i) {
        places[styles[i].penumbra].push_back(i);
        weights += styles[i].weight;
    }
    const DistanceReach reach = reachOf(seen, styles);
    for (auto& [penumbra, alike] : places) {
        LevelStyles(f, seen, std::move(alike), reach, weights).declare(sum);
    }
    return sum;
}

void showSoftShadow(FrameBuilder& f, const LightVisibility& seen, const std::function<bool(const graph::Run&)>& known)
{
    const std::string name = fmt::format(".{}", layerNameOf(f.description, seen.quad));
    auto matte = f.graph.plane<Matte>("matte of a soft shadow", graph::floats);
    f.fill("unknown", matte, WEDGE_MATTE_UNKNOWN);
    findLevel(f, seen, 0.5f, updates("matte", matte), known);
    f.layers->add({ "shadowMatte", name, matte, Where::OnSurfaces });
    const DistanceReach reach = reachOf(seen, f.description.areaLights[seen.quad].styles);
    if (reach.largest > 0.0f) {
        f.layers->add(
            { "shadowDistance", name, shadowDistances(f, matte, {}, 0.0f, reach).distance, Where::OnSurfaces });
    }
}

} // namespace wedge::render
