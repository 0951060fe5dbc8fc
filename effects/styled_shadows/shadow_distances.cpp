#include "effects/styled_shadows/shadow_distances.h"

#include "host/graph/lists.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

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

/// Blocks of 16 pixels that are taken one after the other.
constexpr std::size_t blocksOfTile = 4;

/// Such blocks in a row of a window, which for that begins and ends at them.
std::size_t blocksAlong(const Window& window)
{
    constexpr int side = WEDGE_BLOCK_PIXELS;
    return static_cast<std::size_t>((window.x1 - window.x0 / side * side + side - 1) / side);
}

Arguments surfacesOf(const FrameBuilder& f, graph::Reach reach = {})
{
    const Surfaces& s = f.surfaces;
    return graph::together("surfaces",
        { reads("position", s.position, reach), reads("normal", s.normal, reach), reads("objectId", s.objectId, reach),
            reads("pixelSize", s.pixelSize, reach) });
}

/// Of the whole image.
shared::AnalysisParams allPixels(const FrameBuilder& f)
{
    shared::AnalysisParams p = f.analysisParams();
    setRectangle(p, f.graph.image());
    return p;
}

graph::Argument orAbsent(const char* name, const graph::Handle<Metres>& plane)
{
    return plane.graph != 0 ? reads(name, plane) : graph::absent(name);
}

/// The pieces of the shadow's edge, and boxes around them.
Arguments edgesOf(FrameBuilder& f, const graph::Handle<Matte>& matte, const graph::Handle<Metres>& occluder)
{
    const auto tilesAlong = [](int pixels) {
        return std::max((static_cast<std::uint32_t>(pixels) + WEDGE_EDGE_TILE - 2) / WEDGE_EDGE_TILE, 1u);
    };
    const PlaneLayout& layout = f.layout;
    const std::uint32_t tiles =
        tilesAlong(static_cast<int>(layout.width)) * tilesAlong(static_cast<int>(layout.height));
    const std::uint32_t capacity = tiles * WEDGE_EDGE_TILE * WEDGE_EDGE_TILE;
    auto counts = f.graph.list<Count>("edges of tiles", graph::counts, tiles);
    const Arguments cells = joined({ value("p", allPixels(f)), graph::unlessEmpty("tiles", tiles) }, surfacesOf(f),
        Arguments { reads("matte", matte) });
    f.items("edges of shadows", PassKind::Analysis, { edgesProgram, "countEdges" }, tiles,
        joined(cells, Arguments { writes("counts", counts) }));
    const graph::ListPlaces places = graph::placeBlocks(f.graph, "edges of shadows", edgesProgram, counts, capacity);
    auto edges = f.graph.list<Edges>("edges of shadows", graph::floats, std::uint64_t { capacity } * WEDGE_EDGE_FLOATS);
    f.items("edges of shadows", PassKind::Analysis, { edgesProgram, "listEdges" }, tiles,
        joined(cells,
            Arguments { orAbsent("occluder", occluder), reads("first", places.first), value("capacity", capacity),
                writes("edges", edges) }));
    const std::uint32_t chunks = capacity / WEDGE_EDGE_CHUNK, room = (chunks + 15) / 16 * 16; // for vectors of them
    auto boxes = f.graph.list<Edges>("boxes around edges", graph::floats, std::uint64_t { room } * WEDGE_EDGE_BOX);
    Arguments listed { reads("edges", edges), reads("listed", places.listed), graph::unlessEmpty("most", capacity),
        value("room", room) };
    f.items("edges of shadows", PassKind::Analysis, { edgesProgram, "boundEdges" }, chunks,
        joined(listed, Arguments { writes("boxes", boxes) }));
    listed.push_back(reads("boxes", boxes));
    return listed;
}

graph::Handle<Metres> zerosWithin(FrameBuilder& f, const graph::Handle<Matte>& matte,
    const graph::Handle<Metres>& distance, const graph::Argument& found)
{
    auto areas = f.graph.list<Edges>(
        "areas in shadow", graph::floats, std::uint64_t { WEDGE_AREA_STRIPES } * WEDGE_AREA_NUMBERS);
    shared::AnalysisParams p = f.analysisParams();
    setRectangle(p, f.graph.shown()); // what is beyond the image would have to be smoothed, too
    f.items("areas of shadows", PassKind::Analysis, { stylesProgram, "countAreas" }, WEDGE_AREA_STRIPES,
        { value("p", p), graph::unlessEmpty("stripes", WEDGE_AREA_STRIPES), found, reads("distance", distance),
            reads("matte", matte), reads("pixelSize", f.surfaces.pixelSize), writes("areas", areas) },
        true);
    auto sums = f.graph.list<Edges>("areas in shadow, together", graph::floats, WEDGE_AREA_NUMBERS);
    f.graph.add({ .name = "areas of shadows",
        .kind = PassKind::Analysis,
        .kernel = { stylesProgram, "sumAreas" },
        .arguments = { graph::unlessEmpty("numbers", WEDGE_AREA_NUMBERS),
            graph::unlessEmpty("stripes", WEDGE_AREA_STRIPES), reads("areas", areas), writes("sums", sums) },
        .domain = graph::Domain::Items,
        .count = [](const Launch&) { return std::size_t { WEDGE_AREA_NUMBERS }; },
        .mostItems = WEDGE_AREA_NUMBERS });
    auto zeros = f.graph.list<Metres>("edges of smoothed shadows", graph::floats, 2);
    f.items("areas of shadows", PassKind::Analysis, { stylesProgram, "keepArea" }, 1,
        { graph::unlessEmpty("items", 1), found, reads("sums", sums), writes("zeros", zeros) });
    return zeros;
}

} // namespace

ShadowDistances shadowDistances(FrameBuilder& f, const graph::Handle<Matte>& matte,
    const graph::Handle<Metres>& occluder, float farthest, const DistanceReach& reach)
{
    const Arguments facing =
        graph::together("surfaces", { reads("position", f.surfaces.position), reads("normal", f.surfaces.normal) });
    ShadowDistances out;
    out.distance = f.graph.plane<Metres>("distance to shadows' edges", graph::floats);
    f.zero(out.distance);
    if (occluder.graph != 0) {
        out.away = f.graph.plane<Metres>("what hides a light, around shadows", graph::floats);
        f.zero(out.away);
    }
    // All edges may be near all pixels: it can take seconds, and be stopped.
    f.graph.add({ .name = "distances to shadows' edges",
        .kind = PassKind::Analysis,
        .kernel = { distanceProgram, "shadowDistance" },
        .arguments = joined({ f.rectangle(f.analysisParams()) }, facing,
            Arguments { reads("matte", matte), orAbsent("occluder", occluder) },
            graph::together("edges",
                joined(edgesOf(f, matte, occluder), Arguments { value("published", f.settings.published ? 1u : 0u) })),
            Arguments { value("largest", reach.largest), value("meanWithin", reach.meanWithin),
                value("farthest", farthest), updates("distance", out.distance),
                occluder.graph != 0 ? updates("away", out.away) : graph::absent("away") }),
        .domain = graph::Domain::Tiles,
        .count =
            [](const Launch& launch) {
                const Window& w = launch.window;
                return blocksAlong(w) * static_cast<std::size_t>(w.height()) / blocksOfTile + 1;
            },
        .itemsOfTile = blocksOfTile,
        .stoppable = true });
    return out;
}

SmoothedDistance smoothedDistance(FrameBuilder& f, const graph::Handle<Matte>& matte,
    const graph::Handle<Metres>& distance, const Smoothing& smoothing)
{
    SmoothedDistance out;
    out.distance = f.graph.plane<Metres>("smoothed distances", graph::floats);
    f.blocks("blur of shadows' edges", PassKind::Filter, { distanceProgram, "smoothDistance" },
        joined({ f.frame() }, surfacesOf(f, graph::wholeImage),
            Arguments { reads("distance", distance, graph::wholeImage), smoothing.away, smoothing.deviation,
                value("largest", smoothing.largest), writes("smoothed", out.distance) }));
    if (smoothing.keepArea) {
        // The distance at which as much is in shadow as was: its class, and then itself within that.
        const graph::Handle<Metres> found = zerosWithin(f, matte, out.distance, graph::absent("found"));
        out.zeros = zerosWithin(f, matte, out.distance, reads("found", found));
    }
    return out;
}

} // namespace wedge::render
