#include "effects/styled_shadows/styled_shadows.h"

#include "effects/styled_shadows/object_list.h"
#include "effects/styled_shadows/style_knobs.h"
#include "effects/styled_shadows/styled_lights.h"
#include "host/graph/lists.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cstdint>
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
using graph::writes;

namespace {

constexpr const char* edgesProgram = "light/shadow_edges.cl";
constexpr const char* distanceProgram = "light/shadow_distance.cl";
constexpr const char* stylesProgram = "light/shadow_styles.cl";

struct Matte { }; ///< WEDGE_MATTE_*
struct Edges { }; ///< pieces of shadows' edges, and boxes around them

/// Blocks of 16 pixels that are taken one after the other.
constexpr std::size_t blocksOfTile = 4;

/// Such blocks in a row of a window, which for that begins and ends at them.
std::size_t blocksAlong(const Window& window)
{
    constexpr int side = WEDGE_BLOCK_PIXELS;
    return static_cast<std::size_t>((window.x1 - window.x0 / side * side + side - 1) / side);
}

/// The passes of those of a light's styles that have the same casters.
class StyledShadow {
public:
    /// places: of the styles, among all of the light; weights: of all of these.
    StyledShadow(
        FrameBuilder& frame, ReceiverSet& at, const StyledLight& light, std::vector<std::size_t> places, float weights)
        : f_(frame)
        , at_(at)
        , light_(light)
        , places_(std::move(places))
        , weights_(weights)
        , casters_(!light.styles.front().casters.empty())
        , varies_(std::ranges::any_of(light.styles, variesByOccluder))
        , farthest_(varies_ ? farthestOccluder(frame.description, light.index) : 0.0f)
        , largest_(mostDistance(light.styles, farthest_))
    {
    }

    /// Declares them; adds to the radiance that pixels reflect.
    void declare(graph::Handle<Radiance>& radiance)
    {
        matte();
        if (largest_ > 0.0f) {
            distances();
        }
        shares();
        light(radiance);
        show();
    }

private:
    /// Of the scene's lights the one that this is.
    Arguments ofLight() const
    {
        return graph::together("light",
            { f_.ofScene("lights", "DeltaLight", &DeviceScene::deltaLights), value("lightIndex", light_.index),
                value("sceneDiameter", f_.scene != nullptr ? f_.scene->diameter : 0.0f) });
    }

    Arguments surfaces(graph::Reach reach = {}) const
    {
        const Surfaces& s = f_.surfaces;
        return graph::together("surfaces",
            { reads("position", s.position, reach), reads("normal", s.normal, reach),
                reads("objectId", s.objectId, reach), reads("pixelSize", s.pixelSize, reach) });
    }

    /// Of the whole image.
    shared::AnalysisParams image() const
    {
        shared::AnalysisParams p = f_.analysisParams();
        setRectangle(p, f_.graph.image());
        return p;
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
                objectList(f_, "casters", light_.styles.front().casters), Arguments { updates("others", others_) });
        }
        at_.trace("shadows in a style", { edgesProgram, casters_ ? "shadowOfCasters" : "shadowMatte" },
            std::move(passes), [](const Launch&) { return 1.0; });
    }

    /// The pieces of the shadow's edge, and boxes around them.
    Arguments edges() const
    {
        const auto tilesAlong = [](int pixels) {
            return std::max((static_cast<std::uint32_t>(pixels) + WEDGE_EDGE_TILE - 2) / WEDGE_EDGE_TILE, 1u);
        };
        const PlaneLayout& layout = f_.layout;
        const std::uint32_t tiles =
            tilesAlong(static_cast<int>(layout.width)) * tilesAlong(static_cast<int>(layout.height));
        const std::uint32_t capacity = tiles * WEDGE_EDGE_TILE * WEDGE_EDGE_TILE;
        auto counts = f_.graph.list<Count>("edges of tiles", graph::counts, tiles);
        const Arguments cells = joined({ value("p", image()), graph::unlessEmpty("tiles", tiles) }, surfaces(),
            Arguments { reads("matte", matte_) });
        f_.items("edges of shadows", PassKind::Analysis, { edgesProgram, "countEdges" }, tiles,
            joined(cells, Arguments { writes("counts", counts) }));
        const graph::ListPlaces places =
            graph::placeBlocks(f_.graph, "edges of shadows", edgesProgram, counts, capacity);
        auto edges =
            f_.graph.list<Edges>("edges of shadows", graph::floats, std::uint64_t { capacity } * WEDGE_EDGE_FLOATS);
        f_.items("edges of shadows", PassKind::Analysis, { edgesProgram, "listEdges" }, tiles,
            joined(cells,
                Arguments {
                    occluder(), reads("first", places.first), value("capacity", capacity), writes("edges", edges) }));
        const std::uint32_t chunks = capacity / WEDGE_EDGE_CHUNK, room = (chunks + 15) / 16 * 16; // for vectors of them
        auto boxes = f_.graph.list<Edges>("boxes around edges", graph::floats, std::uint64_t { room } * WEDGE_EDGE_BOX);
        Arguments listed { reads("edges", edges), reads("listed", places.listed), graph::unlessEmpty("most", capacity),
            value("room", room) };
        f_.items("edges of shadows", PassKind::Analysis, { edgesProgram, "boundEdges" }, chunks,
            joined(listed, Arguments { writes("boxes", boxes) }));
        listed.push_back(reads("boxes", boxes));
        return listed;
    }

    void distances()
    {
        const Arguments facing = graph::together(
            "surfaces", { reads("position", f_.surfaces.position), reads("normal", f_.surfaces.normal) });
        distance_ = f_.graph.plane<Metres>("distance to shadows' edges", graph::floats);
        f_.zero(distance_);
        if (varies_) {
            away_ = f_.graph.plane<Metres>("what hides a light, around shadows", graph::floats);
            f_.zero(away_);
        }
        // All edges may be near all pixels: it can take seconds, and be stopped.
        f_.graph.add({ .name = "distances to shadows' edges",
            .kind = PassKind::Analysis,
            .kernel = { distanceProgram, "shadowDistance" },
            .arguments =
                joined({ f_.rectangle(f_.analysisParams()) }, facing, Arguments { reads("matte", matte_), occluder() },
                    graph::together(
                        "edges", joined(edges(), Arguments { value("published", f_.settings.published ? 1u : 0u) })),
                    Arguments { value("largest", largest_), value("farthest", farthest_),
                        updates("distance", distance_), varies_ ? updates("away", away_) : graph::absent("away") }),
            .domain = graph::Domain::Tiles,
            .count =
                [](const Launch& launch) {
                    const Window& w = launch.window;
                    return blocksAlong(w) * static_cast<std::size_t>(w.height()) / blocksOfTile + 1;
                },
            .itemsOfTile = blocksOfTile,
            .stoppable = true });
    }

    graph::Argument occluder() const { return varies_ ? reads("occluder", occluder_) : graph::absent("occluder"); }
    /// How far away what hides the light is, for a style that goes by it: at a pixel, or around its shadow.
    graph::Argument away(const scene::ShadowStyle& style) const
    {
        return variesByOccluder(style) ? reads("away", distance_.graph != 0 ? away_ : occluder_)
                                       : graph::absent("away");
    }

    /// A number of one of the light's styles: of one with keys the same pass finds another one later.
    template <class Number>
    graph::Argument knob(std::string name, std::size_t style, const Number& number) const
    {
        const auto now = [&scene = f_.description, light = light_.index, place = places_[style], number] {
            return number(styleOf(scene, light, place));
        };
        return light_.styles[style].keys.empty() ? value(std::move(name), now())
                                                 : graph::changing(std::move(name), now);
    }

    /// What all styles leave of the light.
    void shares()
    {
        share_ = f_.graph.plane<Share>("share of a light", graph::vectors);
        f_.zero(share_);
        for (std::size_t i = 0; i < light_.styles.size(); ++i) {
            addStyle(i, light_.styles[i].weight / weights_);
        }
    }

    /// What a style goes by, and where in it the shadow's edge is.
    struct Smoothed {
        graph::Handle<Metres> distance;
        graph::Handle<Metres> zeros; ///< the first of its numbers; of no graph: none but 0
    };

    Smoothed smoothed(std::size_t of)
    {
        const scene::ShadowStyle& style = light_.styles[of];
        Smoothed out { distance_, {} };
        if (!(mostOf(abstractionOf(style), farthest_) > 0.0f)) {
            return out;
        }
        out.distance = f_.graph.plane<Metres>("smoothed distances", graph::floats);
        f_.blocks("blur of shadows' edges", PassKind::Filter, { distanceProgram, "smoothDistance" },
            joined({ f_.frame() }, surfaces(graph::wholeImage),
                Arguments { reads("distance", distance_, graph::wholeImage), away(style),
                    knob("deviation", of, abstractionOf), value("largest", largest_),
                    writes("smoothed", out.distance) }));
        if (style.keepArea) {
            out.zeros = zerosOf(out.distance);
        }
        return out;
    }

    /// The distance at which as much is in shadow as was: its class, and then itself within that.
    graph::Handle<Metres> zerosOf(const graph::Handle<Metres>& distance)
    {
        const graph::Handle<Metres> found = zerosWithin(distance, graph::absent("found"));
        return zerosWithin(distance, reads("found", found));
    }

    graph::Handle<Metres> zerosWithin(const graph::Handle<Metres>& distance, const graph::Argument& found)
    {
        auto areas = f_.graph.list<Edges>(
            "areas in shadow", graph::floats, std::uint64_t { WEDGE_AREA_STRIPES } * WEDGE_AREA_NUMBERS);
        f_.items("areas of shadows", PassKind::Analysis, { stylesProgram, "countAreas" }, WEDGE_AREA_STRIPES,
            { value("p", image()), graph::unlessEmpty("stripes", WEDGE_AREA_STRIPES), found,
                reads("distance", distance), reads("matte", matte_), reads("pixelSize", f_.surfaces.pixelSize),
                writes("areas", areas) });
        auto sums = f_.graph.list<Edges>("areas in shadow, together", graph::floats, WEDGE_AREA_NUMBERS);
        f_.graph.add({ .name = "areas of shadows",
            .kind = PassKind::Analysis,
            .kernel = { stylesProgram, "sumAreas" },
            .arguments = { graph::unlessEmpty("numbers", WEDGE_AREA_NUMBERS),
                graph::unlessEmpty("stripes", WEDGE_AREA_STRIPES), reads("areas", areas), writes("sums", sums) },
            .domain = graph::Domain::Items,
            .count = [](const Launch&) { return std::size_t { WEDGE_AREA_NUMBERS }; },
            .mostItems = WEDGE_AREA_NUMBERS });
        auto zeros = f_.graph.list<Metres>("edges of smoothed shadows", graph::floats, 2);
        f_.items("areas of shadows", PassKind::Analysis, { stylesProgram, "keepArea" }, 1,
            { graph::unlessEmpty("items", 1), found, reads("sums", sums), writes("zeros", zeros) });
        return zeros;
    }

    void addStyle(std::size_t style, float weight)
    {
        // Without an edge to be moved the matte itself says what is lit.
        const bool asIs = distance_.graph == 0;
        const auto left = [](int channel) {
            return [channel](const scene::ShadowStyle& s) { return brightnessOf(s, channel); };
        };
        const Smoothed of = asIs ? Smoothed() : smoothed(style);
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

    void light(graph::Handle<Radiance>& radiance)
    {
        f_.pixels("composite", PassKind::Composite, { stylesProgram, "styledLight" },
            joined({ f_.frame() }, ofLight(), at_.arguments(),
                graph::together(
                    "reflectances", { reads("diffuse", f_.surfaces.diffuse), reads("specular", f_.surfaces.specular) }),
                Arguments { reads("matte", matte_), reads("share", share_), updates("lit", radiance) }));
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
    const std::vector<std::size_t> places_; ///< of the styles, among all of the light
    const float weights_; ///< of all of those
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
        float weights = 0.0f;
        for (const scene::ShadowStyle& style : light.styles) {
            weights += style.weight;
        }
        for (const StyleGroup& group : groupsOf(light)) {
            StyledLight part = light;
            part.name = group.name;
            part.styles = group.styles;
            StyledShadow(f, at, part, group.places, weights).declare(radiance);
        }
    }
}

class StyledShadows : public Effect {
public:
    std::string name() const override { return "styled shadows"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        const std::vector<StyledLight> lights = styledLights(settings, scene);
        if (settings.integrator != Integrator::Path || lights.empty()) {
            return std::nullopt;
        }
        requireStylable(settings, scene);
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

    std::vector<LayerInfo> layers(const Settings& settings, const PreparedScene* scene) const override
    {
        const bool styled = scene != nullptr && !styledLights(settings, *scene).empty();
        const std::string absence = styled ? "" : "no light's shadows have a style";
        return { { "shadowMatte", { "Y" },
                     "of each light whose shadows have a style, shadowMatte.NAME: 1 where it is seen, 0 in shadow, -1 "
                     "where a surface faces away",
                     absence },
            { "shadowDistance", { "Z" },
                "of the same, shadowDistance.NAME: metres to the shadow's edge, below 0 in shadow, 0 where unknown",
                absence, 0.0f } };
    }
};

} // namespace

std::unique_ptr<const Effect> styledShadows() { return std::make_unique<StyledShadows>(); }

} // namespace wedge::render
