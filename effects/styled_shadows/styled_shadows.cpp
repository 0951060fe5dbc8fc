#include "effects/styled_shadows/styled_shadows.h"

#include "effects/styled_shadows/object_list.h"
#include "effects/styled_shadows/shadow_distances.h"
#include "effects/styled_shadows/soft_styles.h"
#include "effects/styled_shadows/style_knobs.h"
#include "effects/styled_shadows/styled_lights.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace wedge::render {

using device::PassKind;
using graph::Launch;
using graph::reads;
using graph::updates;
using graph::value;

namespace {

constexpr const char* edgesProgram = "light/shadow_edges.cl";
constexpr const char* stylesProgram = "light/shadow_styles.cl";

/// The passes of those of a light's styles that have the same casters.
class StyledShadow {
public:
    /// light: with those styles alone; group: them
    StyledShadow(FrameBuilder& frame, ReceiverSet& at, const StyledLight& light, const StyleGroup& group)
        : f_(frame)
        , at_(at)
        , light_(light)
        , group_(group)
        , casters_(!group.styles.front().casters.empty() || !group.apart.empty())
        , varies_(std::ranges::any_of(light.styles, variesByOccluder))
        , farthest_(varies_ ? farthestOccluder(frame.description, light.index) : 0.0f)
        , largest_(mostDistance(light.styles, farthest_))
    {
    }

    /// Declares them: what is left of the light.
    graph::Handle<Share>& declare()
    {
        matte();
        if (largest_ > 0.0f) {
            distances();
        }
        shares();
        show();
        return share_;
    }

    /// Adds to the radiance that pixels reflect.
    void light(const graph::Handle<Share>& share, graph::Handle<Radiance>& radiance)
    {
        f_.pixels("composite", PassKind::Composite, { stylesProgram, "styledLight" },
            joined({ f_.frame() }, ofLight(), at_.arguments(),
                graph::together(
                    "reflectances", { reads("diffuse", f_.surfaces.diffuse), reads("specular", f_.surfaces.specular) }),
                Arguments { reads("matte", matte_), reads("share", share), updates("lit", radiance) }));
    }

private:
    /// Of the scene's lights the one that this is.
    Arguments ofLight() const
    {
        return graph::together("light",
            { f_.ofScene("lights", "DeltaLight", &DeviceScene::deltaLights), value("lightIndex", light_.index),
                value("sceneDiameter", f_.scene != nullptr ? f_.scene->diameter : 0.0f) });
    }

    void matte()
    {
        matte_ = f_.graph.plane<Matte>("shadow's matte", graph::floats);
        f_.fill("unknown", matte_, WEDGE_MATTE_UNKNOWN);
        if (varies_) {
            occluder_ = f_.graph.plane<Metres>("what hides a light", graph::floats);
            f_.zero(occluder_);
        }
        Arguments passes = joined({ at_.frame() }, ofLight(), f_.hierarchy(), at_.arguments(),
            Arguments { updates("matte", matte_), varies_ ? updates("occluder", occluder_) : graph::absent("occluder"),
                value("farthest", farthest_), at_.tallyRays() });
        if (casters_) {
            others_ = f_.graph.plane<Matte>("matte of other shadows", graph::floats);
            f_.fill("unknown", others_, WEDGE_MATTE_UNKNOWN);
            passes = joined(passes, Arguments { f_.ofScene("objectIds", "uint", &DeviceScene::objectIds) },
                casterList(f_, group_), Arguments { updates("others", others_) });
        }
        at_.trace("shadows in a style", { edgesProgram, casters_ ? "shadowOfCasters" : "shadowMatte" },
            std::move(passes), [](const Launch&) { return 1.0; });
    }

    void distances()
    {
        const ShadowDistances found = shadowDistances(f_, matte_, occluder_, farthest_, DistanceReach::means(largest_));
        distance_ = found.distance;
        away_ = found.away;
    }

    /// How far away what hides the light is, for a style that goes by it: at a pixel, or around its shadow.
    graph::Argument away(const scene::ShadowStyle& style) const
    {
        return variesByOccluder(style) ? reads("away", distance_.graph != 0 ? away_ : occluder_)
                                       : graph::absent("away");
    }

    template <class Number>
    graph::Argument knob(std::string name, std::size_t style, const Number& number) const
    {
        const auto found =
            [&scene = f_.description, light = light_.index, place = group_.places[style] ]() -> const auto&
        {
            return styleOf(scene, light, place);
        };
        return knobValue(std::move(name), found, number);
    }

    /// What all styles leave of the light.
    void shares()
    {
        share_ = f_.graph.plane<Share>("share of a light", graph::vectors);
        f_.zero(share_);
        float weights = 0.0f;
        for (const scene::ShadowStyle& style : light_.styles) {
            weights += style.weight;
        }
        for (std::size_t i = 0; i < light_.styles.size(); ++i) {
            addStyle(i, light_.styles[i].weight / weights);
        }
    }

    SmoothedDistance smoothed(std::size_t of)
    {
        const scene::ShadowStyle& style = light_.styles[of];
        if (!(mostOf(abstractionOf(style), farthest_) > 0.0f)) {
            return { distance_, {} };
        }
        return smoothedDistance(
            f_, matte_, distance_, { away(style), knob("deviation", of, abstractionOf), largest_, style.keepArea });
    }

    void addStyle(std::size_t style, float weight)
    {
        // Without an edge to be moved the matte itself says what is lit.
        const bool asIs = distance_.graph == 0;
        const auto left = [](int channel) {
            return [channel](const scene::ShadowStyle& s) { return brightnessOf(s, channel); };
        };
        const SmoothedDistance of = asIs ? SmoothedDistance() : smoothed(style);
        Arguments passes = joined(
            { f_.rectangle(f_.analysisParams()), asIs ? reads("distance", matte_) : reads("distance", of.distance),
                of.zeros.graph != 0 ? reads("zeros", of.zeros) : graph::absent("zeros"), away(light_.styles[style]),
                casters_ ? reads("others", others_) : graph::absent("others") },
            graph::together("style",
                { value("offset", asIs ? 0.5f : 0.0f), knob("inflation", style, inflationOf),
                    knob("softness", style, softnessOf), knob("red", style, left(0)), knob("green", style, left(1)),
                    knob("blue", style, left(2)), value("weight", weight) }),
            Arguments { updates("share", share_) });
        if (light_.styles[style].receivers.empty()) {
            passes.push_back(graph::absent("receivers", graph::counts));
        } else {
            passes = joined(passes, objectList(f_, "receivers", light_.styles[style].receivers),
                Arguments { reads("matte", matte_), reads("objectId", f_.surfaces.objectId) });
        }
        f_.pixels("styles of shadows", PassKind::Composite, { stylesProgram, "addStyle" }, std::move(passes));
    }

    void show()
    {
        if (f_.layers == nullptr) {
            return;
        }
        f_.layers->add({ "shadowMatte", "." + light_.name, matte_, Where::OnSurfaces });
        if (distance_.graph != 0) {
            f_.layers->add({ "shadowDistance", "." + light_.name, distance_, Where::OnSurfaces });
        }
    }

    FrameBuilder& f_;
    ReceiverSet& at_;
    const StyledLight& light_;
    const StyleGroup& group_;
    const bool casters_; ///< some things alone throw such shadows
    const bool varies_; ///< some style goes by how far away what hides the light is
    const float farthest_; ///< metres, that it is
    const float largest_; ///< metres, of distances that are told apart
    graph::Handle<Matte> matte_;
    graph::Handle<Matte> others_; ///< of what is no caster; of no graph where all things are
    graph::Handle<Metres> occluder_, away_; ///< of no graph where nothing goes by them
    graph::Handle<Metres> distance_; ///< of no graph where no style moves or softens edges
    graph::Handle<Share> share_;
};

void sample(FrameBuilder& f, ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    for (const StyledLight& light : styledLights(f.settings, f.description)) {
        const std::vector<StyleGroup> groups = groupsOf(light);
        graph::Handle<Share> left;
        for (const StyleGroup& group : groups) {
            StyledLight part = light;
            part.name = group.name;
            part.styles = group.styles;
            StyledShadow shadow(f, at, part, group);
            graph::Handle<Share>& share = shadow.declare();
            if (left.graph == 0) {
                left = share;
            } else {
                f.pixels("styles of shadows", PassKind::Composite, { stylesProgram, "timesShare" },
                    { f.rectangle(f.analysisParams()), reads("other", share), updates("share", left) });
            }
            if (&group == &groups.back()) {
                shadow.light(left, radiance);
            }
        }
    }
}

class StyledShadows : public Effect {
public:
    std::string name() const override { return "styled shadows"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        requireStylable(settings, scene);
        const std::vector<StyledLight> lights = styledLights(settings, scene);
        if (settings.integrator != Integrator::Path || lights.empty()) {
            return std::nullopt;
        }
        std::size_t shadows = 0; // rays a pixel
        for (const StyledLight& light : lights) {
            shadows += groupsOf(light).size();
        }
        const bool changes = std::ranges::any_of(lights, [](const StyledLight& light) {
            return std::ranges::any_of(light.styles, [](const auto& style) { return !style.keys.empty(); });
        });
        return Unfiltered {
            .name = "styled shadows", .workUnits = static_cast<double>(shadows), .changes = changes, .sample = sample
        };
    }

    /// Where some style moves edges those beyond the border have a say: how far in pixels nobody knows before there are
    /// rays, so it is as far as there may be.
    int margin(const Settings& settings, const PreparedScene& scene) const override
    {
        if (!movesEdges(settings, scene)) {
            return 0;
        }
        const auto [shorter, longer] = std::minmax(settings.width, settings.height);
        const float wanted =
            std::min(settings.styleMargin * static_cast<float>(longer), 0.5f * static_cast<float>(shorter));
        // Whole blocks, so that vectors of pixels are those of a frame without.
        constexpr int block = WEDGE_BLOCK_PIXELS;
        return static_cast<int>(wanted / block + 0.5f) * block;
    }

    bool changesVisibility(const Settings& settings, const scene::AreaLight& light) const override
    {
        return settings.styles && !light.styles.empty();
    }
    graph::Handle<Value> changeVisibility(FrameBuilder& frame, const LightVisibility& seen) const override
    {
        return softStyles(frame, seen);
    }
    void showVisibility(FrameBuilder& frame, const LightVisibility& seen,
        const std::function<bool(const graph::Run&)>& known) const override
    {
        showSoftShadow(frame, seen, known);
    }

    std::vector<LayerInfo> layers(const Settings& settings, const PreparedScene* scene) const override
    {
        const bool styled = scene != nullptr && settings.integrator == Integrator::Path
            && (!styledLights(settings, *scene).empty()
                || std::ranges::any_of(
                    scene->areaLights, [&](const scene::AreaLight& l) { return changesVisibility(settings, l); }));
        const std::string absence = styled ? "" : "no light's shadows have a style";
        return { { "shadowMatte", { "Y" },
                     "of each light whose shadows have a style, shadowMatte.NAME: how much of it is seen, from 0 in "
                     "shadow to 1, -1 where a surface faces away",
                     absence },
            { "shadowDistance", { "Z" },
                "of the same, shadowDistance.NAME: metres to the shadow's edge, of a soft one where half of the light "
                "is seen; below 0 in shadow, 0 where unknown",
                absence, 0.0f } };
    }
};

} // namespace

std::unique_ptr<const Effect> styledShadows() { return std::make_unique<StyledShadows>(); }

} // namespace wedge::render
