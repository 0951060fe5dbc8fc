// waves.cl alone: every pixel's samples are listed once, pixel by pixel, and those of terms are shared out evenly.
#include "host/render/waves.h"
#include "tests/wave_support.h"

#include <algorithm>
#include <map>
#include <set>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::uint32_t untouched = WaveBench::untouched;

/// Samples that pixels have and want: none, less than they have, a few, or many.
struct Counts {
    Planes<std::uint32_t> taken, wanted;

    Counts(const render::PlaneLayout& layout, unsigned seed)
        : taken(layout, 1, 0u)
        , wanted(layout, 1, 99u) // beyond the image stands what must not be taken
    {
        std::mt19937 random(seed);
        for (int y = 0; y < static_cast<int>(layout.height); ++y)
            for (int x = 0; x < static_cast<int>(layout.width); ++x) {
                taken.at(x, y) = static_cast<std::uint32_t>(random() % 5);
                const std::uint32_t more = random() % 9 == 0 ? 70 : static_cast<std::uint32_t>(random() % 6);
                wanted.at(x, y) = random() % 4 == 0 ? static_cast<std::uint32_t>(random() % 4) : taken.at(x, y) + more;
            }
    }
    /// New samples up to `last`.
    std::uint32_t added(int x, int y, std::uint32_t last) const
    {
        const std::uint32_t end = std::min(wanted.at(x, y), last);
        return end > taken.at(x, y) ? end - taken.at(x, y) : 0;
    }
};

struct Case {
    int width, height;
    image::Window window;
};
const std::vector<Case> cases = { { 1, 1, { 0, 0, 1, 1 } }, { 37, 1, { 0, 0, 37, 1 } }, { 3, 29, { 0, 0, 3, 29 } },
    { 45, 27, { 0, 0, 45, 27 } }, { 75, 35, { 0, 0, 75, 35 } }, { 64, 40, { 17, 5, 50, 30 } },
    { 64, 40, { 8, 8, 9, 40 } } };

/// The corner of the tile that is number `slot`.
std::pair<int, int> tileAt(const shared::FrameParams& p, std::uint32_t slot)
{
    const std::uint32_t strips = p.tileCount / WEDGE_STRIP_TILES, strip = slot / WEDGE_STRIP_TILES;
    const std::uint64_t distant = strip < strips ? std::uint64_t { strip } * p.tileStep % strips : strip;
    const auto tile = static_cast<int>(distant * WEDGE_STRIP_TILES + slot % WEDGE_STRIP_TILES);
    const auto across = static_cast<int>(p.tilesX);
    return { static_cast<int>(p.x0) + tile % across * 8, static_cast<int>(p.y0) + tile / across * 8 };
}

/// Packs tiles into waves of at most `capacity` receivers; at least one tile a wave.
struct Schedule {
    std::vector<shared::WaveParams> waves;
    std::vector<std::uint32_t> tileFirst;

    Schedule(const std::vector<std::uint32_t>& counts, std::uint32_t capacity, std::uint32_t last)
    {
        for (std::uint32_t tile = 0; tile < counts.size(); ++tile) {
            if (waves.empty() || waves.back().receivers + counts[tile] > capacity) {
                waves.emplace_back();
                waves.back().firstTile = tile;
                waves.back().lastSample = last;
            }
            tileFirst.push_back(waves.back().receivers);
            waves.back().receivers += counts[tile];
            ++waves.back().tiles;
        }
        for (shared::WaveParams& wave : waves)
            wave.planeSize = wave.receivers + 7;
    }
};

} // namespace

TEST_CASE("sharedSamples: all are shared, in order, as evenly as whole numbers go, and nothing overflows")
{
    std::mt19937 random(2);
    for (int k = 0; k < 3000; ++k) {
        const std::uint32_t count = 1 + static_cast<std::uint32_t>(random() % (k % 3 == 0 ? 65535 : 20));
        const std::uint32_t total = static_cast<std::uint32_t>(random() % (k % 2 == 0 ? 1u << 20 : 40));
        const auto index = static_cast<std::uint32_t>(random() % count);
        REQUIRE(shared::sharedSamples(0, count, total) == 0);
        REQUIRE(shared::sharedSamples(count, count, total) == total);
        REQUIRE(shared::sharedSamples(index, count, total)
            == std::uint64_t { index } * (total / count) + std::min(index, total % count));
        const std::uint32_t own =
            shared::sharedSamples(index + 1, count, total) - shared::sharedSamples(index, count, total);
        REQUIRE(own >= total / count);
        REQUIRE(own <= (total + count - 1) / count);
    }
}

TEST_CASE("countReceivers: the new samples of each tile's pixels inside the window")
{
    onEveryDevice([](const device::Device& device) {
        for (const Case& c : cases)
            for (const std::uint32_t last : { 0u, 3u, 8u, 0xffffffffu }) {
                WaveBench bench(device, c.width, c.height, c.window);
                const Counts counts(bench.layout, 3);
                shared::WaveParams wave {};
                wave.lastSample = last;
                const std::vector<std::uint32_t> found = bench.tileCounts(counts.taken, counts.wanted, wave);
                std::uint64_t all = 0, expectedAll = 0;
                std::set<std::pair<int, int>> tiles;
                for (std::uint32_t slot = 0; slot < bench.params.tileCount; ++slot) {
                    const auto [x0, y0] = tileAt(bench.params, slot);
                    tiles.emplace(x0, y0);
                    std::uint32_t expected = 0;
                    for (int y = y0; y < std::min(y0 + 8, c.window.y1); ++y)
                        for (int x = x0; x < std::min(x0 + 8, c.window.x1); ++x)
                            expected += counts.added(x, y, last);
                    REQUIRE(found[slot] == expected);
                    all += found[slot];
                }
                bench.everyPixel([&](int x, int y) { expectedAll += counts.added(x, y, last); });
                CHECK(all == expectedAll);
                CHECK(tiles.size() == bench.params.tileCount); // and so each is taken once
            }
    });
}

TEST_CASE("limitTiles: a tile's new samples fit into a wave, and no pixel is cut more than another")
{
    onEveryDevice([](const device::Device& device) {
        WaveBench bench(device, 64, 40, { 0, 0, 64, 40 });
        for (const std::uint32_t capacity : { 64u, 100u, 300u, 1u << 17 }) {
            CAPTURE(capacity);
            Counts counts(bench.layout, 6);
            // In one tile all want the most that there is, in another one pixel does, in a third many do in vain.
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 24; ++x)
                    counts.wanted.at(x, y) = x < 8 || (x == 9 && y == 3) ? 16384u : counts.wanted.at(x, y) % 3;
            const auto wanted = bench.bench.buffer(counts.wanted.values);
            bench.launch("limitTiles", bench.params.tileCount,
                { value("capacity", capacity), plane("taken", bench.bench.buffer(counts.taken.values)),
                    plane("wanted", wanted) });
            const Planes<std::uint32_t> found = planesOf(bench.layout, bench.bench.read(wanted));
            int cut = 0, whole = 0;
            for (int y0 = 0; y0 < 40; y0 += 8)
                for (int x0 = 0; x0 < 64; x0 += 8) {
                    const auto sumOf = [&](std::uint32_t most) {
                        std::uint64_t sum = 0;
                        for (int k = 0; k < 64; ++k)
                            sum += std::min(counts.added(x0 + k % 8, y0 + k / 8, 1u << 30), most);
                        return sum;
                    };
                    std::uint32_t most = 1u << 30;
                    if (sumOf(most) > capacity)
                        for (most = 0; sumOf(most + 1) <= capacity;)
                            ++most;
                    (sumOf(1u << 30) > capacity ? cut : whole) += 1;
                    for (int k = 0; k < 64; ++k) {
                        const int x = x0 + k % 8, y = y0 + k / 8;
                        const std::uint32_t want = counts.wanted.at(x, y), has = counts.taken.at(x, y);
                        REQUIRE(found.at(x, y) == std::min(want, has + most));
                    }
                }
            CHECK(cut > 0);
            CHECK((whole > 0 || capacity < 1u << 17));
        }
    });
}

TEST_CASE("listReceivers: over all waves every new sample once, a pixel's together in one wave, and nothing else")
{
    onEveryDevice([](const device::Device& device) {
        for (const Case& c : cases)
            for (const std::uint32_t capacity : { 1u, 300u, 1u << 20 })
                for (const std::uint32_t last : { 5u, 0xffffffffu }) {
                    CAPTURE(capacity);
                    WaveBench bench(device, c.width, c.height, c.window);
                    const Counts counts(bench.layout, 4);
                    shared::WaveParams all {};
                    all.lastSample = last;
                    const Schedule schedule(bench.tileCounts(counts.taken, counts.wanted, all), capacity, last);
                    std::map<std::pair<int, int>, int> wavesOf;
                    for (const shared::WaveParams& wave : schedule.waves) {
                        const WaveLists l = bench.lists(counts.taken, counts.wanted, schedule.tileFirst, wave);
                        std::uint32_t at = 0;
                        for (std::uint32_t slot = 0; slot < wave.tiles * WEDGE_TILE_PIXELS; ++slot) {
                            // Pixels follow each other without gaps, those without samples too.
                            REQUIRE(l.firsts[slot] == at);
                            for (std::uint32_t j = 0; j < l.counts[slot]; ++j, ++at) {
                                const int x = l.x(at), y = l.y(at);
                                const auto [x0, y0] = tileAt(bench.params, wave.firstTile + slot / WEDGE_TILE_PIXELS);
                                REQUIRE((x >= x0 && x < std::min(x0 + 8, c.window.x1)));
                                REQUIRE((y >= y0 && y < std::min(y0 + 8, c.window.y1)));
                                REQUIRE(l.pixels[at] == l.pixels[l.firsts[slot]]);
                                REQUIRE(l.samples[at] == counts.taken.at(x, y) + j);
                                REQUIRE(l.shares[at] == (j | l.counts[slot] << 16));
                                if (j == 0) {
                                    REQUIRE(l.counts[slot] == counts.added(x, y, last));
                                    ++wavesOf[{ x, y }];
                                }
                            }
                        }
                        REQUIRE(at == wave.receivers);
                        for (std::size_t i = at; i < l.pixels.size(); ++i)
                            REQUIRE(
                                (l.pixels[i] == untouched && l.samples[i] == untouched && l.shares[i] == untouched));
                        REQUIRE(l.firsts.back() == untouched);
                        REQUIRE(l.counts.back() == untouched);
                    }
                    bench.everyPixel([&](int x, int y) {
                        const auto found = wavesOf.find({ x, y });
                        REQUIRE((found == wavesOf.end() ? 0 : found->second) == (counts.added(x, y, last) > 0 ? 1 : 0));
                    });
                }
    });
}

TEST_CASE("packets of 16 receivers, one each, are blocks of 4x4 pixels")
{
    onEveryDevice([](const device::Device& device) {
        WaveBench bench(device, 32, 24, { 0, 0, 32, 24 });
        const Planes<std::uint32_t> none(bench.layout, 1, 0u), one(bench.layout, 1, 1u);
        const WaveLists l = bench.oneWave(none, one);
        REQUIRE(l.wave.receivers == 32 * 24);
        for (std::size_t packet = 0; packet < l.wave.receivers; packet += 16)
            for (std::size_t i = packet; i < packet + 16; ++i) {
                REQUIRE(l.x(i) / 4 == l.x(packet) / 4);
                REQUIRE(l.y(i) / 4 == l.y(packet) / 4);
            }
    });
}

TEST_CASE("shareSamples: a term's new samples follow each other over the pixel's receivers, and sums start at 0")
{
    onEveryDevice([](const device::Device& device) {
        for (const Case& c : cases) {
            WaveBench bench(device, c.width, c.height, c.window);
            const Counts counts(bench.layout, 5), term(bench.layout, 6);
            WaveLists l = bench.oneWave(counts.taken, counts.wanted);
            l.wave.lastSample = 60;
            constexpr std::uint32_t sumPlanes = 3, extremePlanes = 2;
            const std::size_t size = l.wave.planeSize;
            const auto first = bench.bench.filled(size, untouched), last = bench.bench.filled(size, untouched);
            const auto sums = bench.bench.filled(4 * size, -7.0f), extremes = bench.bench.filled(3 * size, -7.0f);
            bench.launch("shareSamples", l.wave.receivers,
                { value("wave", l.wave), plane("pixelOf", l.pixelOf), plane("shareOf", l.shareOf),
                    plane("taken", bench.bench.buffer(term.taken.values)),
                    plane("wanted", bench.bench.buffer(term.wanted.values)), value("sumPlanes", sumPlanes),
                    value("extremePlanes", extremePlanes), plane("first", first), plane("last", last),
                    plane("sums", sums), plane("extremes", extremes) });
            const std::vector<std::uint32_t> from = bench.bench.read(first), to = bench.bench.read(last);
            std::uint32_t uneven = 0, none = 0;
            for (std::uint32_t slot = 0; slot < l.wave.tiles * WEDGE_TILE_PIXELS; ++slot) {
                if (l.counts[slot] == 0)
                    continue;
                const std::uint32_t begin = l.firsts[slot], end = begin + l.counts[slot];
                const int x = l.x(begin), y = l.y(begin);
                const std::uint32_t total = term.added(x, y, 60);
                std::uint32_t at = term.taken.at(x, y);
                for (std::uint32_t i = begin; i < end; ++i) {
                    REQUIRE(from[i] == at);
                    REQUIRE(to[i] >= from[i]);
                    // Within one of an even share.
                    REQUIRE(std::fabs(to[i] - from[i] - static_cast<double>(total) / l.counts[slot]) < 1);
                    at = to[i];
                }
                REQUIRE(at == term.taken.at(x, y) + total);
                uneven += total % l.counts[slot] != 0 ? 1 : 0;
                none += total < l.counts[slot] ? 1 : 0;
            }
            const std::vector<float> sum = bench.bench.read(sums), extreme = bench.bench.read(extremes);
            for (std::size_t i = 0; i < sum.size(); ++i)
                REQUIRE(sum[i] == (i / size < sumPlanes && i % size < l.wave.receivers ? 0.0f : -7.0f));
            for (std::size_t i = 0; i < extreme.size(); ++i)
                REQUIRE(extreme[i] == (i / size < extremePlanes && i % size < l.wave.receivers ? 0.0f : -7.0f));
            if (c.width == 45) {
                CHECK(uneven > 100);
                CHECK(none > 100);
            }
        }
    });
}

TEST_CASE("the host's schedule: waves of whole tiles in order, none too large, and of all samples")
{
    onEveryDevice([](const device::Device& device) {
        constexpr int width = 301, height = 203;
        const render::PlaneLayout layout(width, height);
        const Counts counts(layout, 8);
        for (const image::Window& window : { image::Window { 0, 0, width, height }, { 40, 3, 60, 50 } })
            for (const std::uint32_t last : { 0u, 4u, 0xffffffffu }) {
                WaveBench bench(device, width, height, window);
                shared::WaveParams settings {};
                settings.lastSample = last;
                settings.sampler = WEDGE_SAMPLER_STRATIFIED;
                settings.published = 1;
                const std::vector<shared::WaveParams> found =
                    render::WaveSchedule(bench.tileCounts(counts.taken, counts.wanted, settings), settings).waves;
                std::uint64_t receivers = 0, expected = 0;
                std::uint32_t tile = 0;
                for (const shared::WaveParams& wave : found) {
                    REQUIRE(wave.firstTile >= tile); // tiles without samples may be left out
                    tile = wave.firstTile + wave.tiles;
                    REQUIRE(wave.receivers > 0);
                    REQUIRE(wave.receivers <= render::WaveSchedule::capacity);
                    REQUIRE(wave.tiles * WEDGE_TILE_PIXELS <= render::WaveSchedule::capacity);
                    REQUIRE(wave.lastSample == last);
                    REQUIRE(wave.sampler == settings.sampler);
                    REQUIRE(wave.published == settings.published);
                    receivers += wave.receivers;
                }
                REQUIRE(tile <= bench.params.tileCount);
                for (int y = window.y0; y < window.y1; ++y)
                    for (int x = window.x0; x < window.x1; ++x)
                        expected += counts.added(x, y, last);
                CHECK(receivers == expected);
                // As few as there can be, but for tiles that do not fit in what is left.
                CHECK(found.size() <= expected / (render::WaveSchedule::capacity - 64 * 70) + 1);
                CHECK((last == 0) == found.empty());
            }
    });
}
