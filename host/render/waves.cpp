#include "host/render/waves.h"

#include "host/graph/execution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wedge::render {

using device::PassKind;
using graph::Launch;
using graph::made;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr std::uint32_t receiversOfTile = WEDGE_TILE_PIXELS;

/// Tiles of the whole image: no rectangle of its pixels has more.
std::size_t mostTiles(const PlaneLayout& layout)
{
    const std::size_t across = (layout.width + WEDGE_TILE - 1) / WEDGE_TILE;
    return across * ((layout.height + WEDGE_TILE - 1) / WEDGE_TILE);
}

std::uint32_t tilesOf(std::uint32_t receivers) { return (receivers + receiversOfTile - 1) / receiversOfTile; }

} // namespace

std::uint32_t roomOfWaves(const PlaneLayout& layout, double most)
{
    const double all = std::ceil(most) * WEDGE_TILE_PIXELS * static_cast<double>(mostTiles(layout));
    return static_cast<std::uint32_t>(std::min<double>(WaveSchedule::capacity, all));
}

WaveSchedule::WaveSchedule(
    const std::vector<std::uint32_t>& counts, const shared::WaveParams& settings, std::uint32_t room)
    : first(counts.size())
{
    const std::uint32_t tilesOfWave = room / WEDGE_TILE_PIXELS;
    for (std::uint32_t tile = 0; tile < counts.size(); ++tile) {
        if (counts[tile] > room) { // memory is at stake
            throw std::logic_error(fmt::format("a tile has {} receivers, and waves room for {}", counts[tile], room));
        }
        const bool fits =
            !waves.empty() && waves.back().tiles < tilesOfWave && waves.back().receivers + counts[tile] <= room;
        if (!fits) {
            waves.push_back(settings);
            waves.back().firstTile = tile;
        }
        first[tile] = waves.back().receivers;
        waves.back().receivers += counts[tile];
        ++waves.back().tiles;
    }
    std::erase_if(waves, [](const shared::WaveParams& wave) { return wave.receivers == 0; });
}

const shared::WaveParams& Waves::State::wave(const Run& run) const
{
    return run.rehearsal() ? settings : waves.at(run.iteration());
}

Waves::Waves(FrameBuilder& frame, const shared::WaveParams& settings, const shared::CameraParams& camera,
    PrimaryCounts& counts, Sampling sampling)
    : f_(frame)
    , settings_(settings)
    , camera_(camera)
    , counts_(counts)
    , sampling_(std::move(sampling))
    , room_(roomOfWaves(frame.layout, sampling_.most))
    , state_(std::make_shared<State>())
{
    // Passes over blocks may read a little more.
    settings_.planeSize = room_ + device::partAlignment / sizeof(float);
    state_->settings = settings_;
}

std::size_t Waves::tilesOfWave() const
{
    return std::min<std::size_t>(mostTiles(f_.layout), room_ / WEDGE_TILE_PIXELS);
}

std::function<std::size_t(Run&)> Waves::counter() const
{
    return [state = state_](Run&) { return state->waves.size(); };
}

graph::Argument Waves::pixelParams() const { return f_.frame(); }

graph::Argument Waves::frame() const
{
    return made("frame",
        [state = state_, &scene = f_.description, layout = f_.layout, seed = frameSeed(f_.settings)](
            const Launch& launch) {
            const shared::WaveParams& wave = state->wave(launch.run);
            shared::FrameParams p = frameParams(scene, layout, launch.window, seed);
            p.planeSize = wave.planeSize;
            p.receivers = wave.receivers;
            p.tileCount = tilesOf(wave.receivers);
            return p;
        });
}

graph::Argument Waves::params() const
{
    return made("wave", [state = state_](const Launch& launch) { return state->wave(launch.run); });
}

Arguments Waves::arguments() const
{
    return graph::together(
        "receivers", joined(f_.readBy(ReadBy::Samplers, r_), Arguments { reads("pixelOf", r_.pixelOf) }));
}

std::vector<graph::Argument> Waves::pixelLists(graph::Argument taken) const
{
    return graph::together("pixels of the wave",
        { reads("pixelFirst", r_.pixelFirst), reads("pixelCount", r_.pixelCount), std::move(taken) });
}

void Waves::tiles(std::string name, graph::KernelName kernel, std::vector<graph::Argument> arguments, bool rays)
{
    const auto count = [state = state_, room = room_](const Launch& launch) -> std::size_t {
        return launch.run.rehearsal() ? tilesOf(room) : tilesOf(state->wave(launch.run).receivers);
    };
    const double shares = static_cast<double>(sampling_.rounds) * (1.0 + static_cast<double>(sampling_.terms));
    const double units = rays ? sampling_.workUnits / shares : 0.0;
    f_.graph.add({ .name = std::move(name),
        .kind = PassKind::Trace,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Tiles,
        .count = count,
        .itemsOfTile = WEDGE_TILE_PIXELS / f_.packetSize,
        .workUnits =
            [state = state_, units](
                const Launch&) { return units / static_cast<double>(std::max<std::size_t>(1, state->waves.size())); },
        .everywhere = sampling_.everywhere });
}

void Waves::list(
    std::string name, graph::KernelName kernel, std::uint32_t across, std::vector<graph::Argument> arguments)
{
    f_.graph.add({ .name = std::move(name),
        .kind = PassKind::Trace,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Items,
        .count = [state = state_, across](const Launch& launch) -> std::size_t {
            return (state->wave(launch.run).receivers + across - 1) / across;
        },
        .mostItems = room_ / across,
        .everywhere = sampling_.everywhere });
}

void Waves::pixels(std::string kernel, std::vector<graph::Argument> arguments)
{
    f_.graph.add({ .name = "accumulate",
        .kind = PassKind::Trace,
        .kernel = { "waves/accumulate.cl", std::move(kernel) },
        .arguments = std::move(arguments),
        .domain = graph::Domain::Items,
        .count = [state = state_](const Launch& launch) -> std::size_t {
            return std::size_t { state->wave(launch.run).tiles } * WEDGE_TILE_PIXELS;
        },
        .mostItems = tilesOfWave() * WEDGE_TILE_PIXELS,
        .everywhere = sampling_.everywhere });
}

void Waves::schedule()
{
    const std::size_t most = mostTiles(f_.layout);
    auto counts = f_.graph.list<Listed>("receivers of tiles", graph::counts, most);
    tileFirst_ = f_.graph.list<Listed>("first receivers of tiles", graph::counts, most);
    const auto tiles = [&scene = f_.description, layout = f_.layout](const Launch& launch) -> std::size_t {
        return frameParams(scene, layout, launch.window, 0).tileCount;
    };
    // What all waves of the round have alike.
    const auto round = [settings = settings_, last = sampling_.last](const Run& run, std::size_t outward) {
        shared::WaveParams wave = settings;
        wave.lastSample = last(run.iteration(outward));
        return wave;
    };
    f_.graph.add({ .name = "lists",
        .kind = PassKind::Trace,
        .kernel = { "waves/waves.cl", "countReceivers" },
        .arguments = { pixelParams(), made("wave", [round](const Launch& launch) { return round(launch.run, 0); }),
            reads("taken", counts_.taken), reads("wanted", counts_.wanted), writes("tileReceivers", counts) },
        .domain = graph::Domain::Items,
        .count = tiles,
        .mostItems = most,
        .everywhere = sampling_.everywhere });
    const auto plan = [state = state_, room = room_, round, tiles, counts, first = tileFirst_](Run& run) {
        if (run.rehearsal()) {
            return;
        }
        std::vector<std::uint32_t> receivers(tiles({ run, run.window() }));
        run.buffer<std::uint32_t>(counts).download(run.queue(), receivers);
        WaveSchedule schedule(receivers, round(run, 0), room);
        run.buffer<std::uint32_t>(first).upload(run.queue(), schedule.first);
        state->waves = std::move(schedule.waves);
    };
    f_.graph.add({ .name = "waves",
        .kind = PassKind::Trace,
        .arguments = { reads("tileReceivers", counts), writes("tileFirst", tileFirst_) },
        .domain = graph::Domain::Host,
        .step = plan,
        .everywhere = sampling_.everywhere });
}

void Waves::traceReceivers(bool lit)
{
    r_.pixelOf = list<Listed>("pixels", graph::counts);
    r_.sampleOf = list<Listed>("samples", graph::counts);
    r_.shareOf = list<Listed>("shares", graph::counts);
    r_.pixelFirst = list<Listed>("firsts of pixels", graph::counts);
    r_.pixelCount = list<Listed>("counts of pixels", graph::counts);
    f_.graph.add({ .name = "lists",
        .kind = PassKind::Trace,
        .kernel = { "waves/waves.cl", "listReceivers" },
        .arguments = { pixelParams(), params(), reads("taken", counts_.taken), reads("wanted", counts_.wanted),
            reads("tileFirst", tileFirst_), writes("pixelOf", r_.pixelOf), writes("sampleOf", r_.sampleOf),
            writes("shareOf", r_.shareOf), writes("pixelFirst", r_.pixelFirst), writes("pixelCount", r_.pixelCount) },
        .domain = graph::Domain::Items,
        .count = [state = state_](const Launch& launch) -> std::size_t { return state->wave(launch.run).tiles; },
        .mostItems = tilesOfWave(),
        .everywhere = sampling_.everywhere });
    f_.eachFound(r_,
        [this]<class Quantity>(const char* name, graph::Handle<Quantity>& plane, const graph::Format& format, ReadBy) {
            plane = list<Quantity>(name, format);
        });
    const auto traced = made("frame",
        [state = state_, &scene = f_.description, layout = f_.layout, seed = frameSeed(f_.settings)](
            const Launch& launch) {
            shared::FrameParams p = frameParams(scene, layout, launch.window, seed);
            p.tileCount = tilesOf(state->wave(launch.run).receivers);
            return p;
        });
    tiles("primary rays", { "waves/wave_primary.cl", "wavePrimary" },
        joined({ traced, value("camera", camera_), params() }, f_.met(lit),
            Arguments { reads("pixelOf", r_.pixelOf), reads("sampleOf", r_.sampleOf), reads("wanted", counts_.wanted),
                sampling_.seenLights ? reads("known", *sampling_.seenLights) : graph::absent("known", packedColours) },
            f_.found(r_, writes)));
}

std::uint32_t waveSampler(const Settings& settings)
{
    const bool counts = settings.method == Method::AxisAligned;
    return static_cast<std::uint32_t>(counts || settings.progressive ? Sampler::Sobol : settings.sampler);
}

void limitTiles(FrameBuilder& frame, PrimaryCounts& counts, std::uint32_t room)
{
    const auto tiles = static_cast<std::size_t>(frame.wholeFrame().tileCount);
    frame.graph.add({ .name = "counts",
        .kind = PassKind::Analysis,
        .kernel = { "waves/waves.cl", "limitTiles" },
        .arguments = { frame.frame(), value("capacity", room), reads("taken", counts.taken),
            updates("wanted", counts.wanted) },
        .domain = graph::Domain::Items,
        .count = [tiles](const Launch&) { return tiles; },
        .mostItems = tiles,
        .everywhere = true });
}

} // namespace wedge::render
