// Lists of receivers as waves.cl makes them, for tests of what works on waves.
#pragma once

#include "kernels/shared/wave.h"
#include "tests/declared_kernel.h"

#include <vector>

namespace wedge::test {

/// A wave's lists on the device and as read back.
struct WaveLists { // NOLINT(bugprone-exception-escape): as Buffer
    shared::WaveParams wave;
    device::Buffer<std::uint32_t> pixelOf, sampleOf, shareOf, pixelFirst, pixelCount;
    std::vector<std::uint32_t> pixels, samples, shares, firsts, counts;

    int x(std::size_t receiver) const { return static_cast<int>(pixels[receiver] & 0xffffu); }
    int y(std::size_t receiver) const { return static_cast<int>(pixels[receiver] >> 16); }
};

/// The pixels of a window of an image, and waves of what they want.
class WaveBench {
public:
    static constexpr std::uint32_t untouched = 0xdddddddd;

    WaveBench(
        const device::Device& device, int width, int height, image::Window pixelWindow, const Defines& defines = {})
        : bench(device, defines)
        , layout(width, height)
        , window(pixelWindow)
        , params(render::frameParams(scene::Scene(), layout, window, 7))
    {
    }

    /// Receivers of each tile, as countReceivers counts them.
    std::vector<std::uint32_t> tileCounts(
        const Planes<std::uint32_t>& taken, const Planes<std::uint32_t>& wanted, const shared::WaveParams& wave)
    {
        const auto out = bench.filled(params.tileCount, untouched);
        launch("countReceivers", params.tileCount,
            { value("wave", wave), plane("taken", bench.buffer(taken.values)),
                plane("wanted", bench.buffer(wanted.values)), plane("tileReceivers", out) });
        return bench.read(out);
    }

    /// The lists of one wave, in buffers longer than it by a few elements.
    WaveLists lists(const Planes<std::uint32_t>& taken, const Planes<std::uint32_t>& wanted,
        const std::vector<std::uint32_t>& tileFirst, const shared::WaveParams& wave)
    {
        const std::size_t receivers = wave.planeSize, pixels = std::size_t { wave.tiles } * WEDGE_TILE_PIXELS + 5;
        WaveLists out { wave, bench.filled(receivers, untouched), bench.filled(receivers, untouched),
            bench.filled(receivers, untouched), bench.filled(pixels, untouched), bench.filled(pixels, untouched), {},
            {}, {}, {}, {} };
        launch("listReceivers", wave.tiles,
            { value("wave", wave), plane("taken", bench.buffer(taken.values)),
                plane("wanted", bench.buffer(wanted.values)), plane("tileFirst", bench.buffer(tileFirst)),
                plane("pixelOf", out.pixelOf), plane("sampleOf", out.sampleOf), plane("shareOf", out.shareOf),
                plane("pixelFirst", out.pixelFirst), plane("pixelCount", out.pixelCount) });
        out.pixels = bench.read(out.pixelOf);
        out.samples = bench.read(out.sampleOf);
        out.shares = bench.read(out.shareOf);
        out.firsts = bench.read(out.pixelFirst);
        out.counts = bench.read(out.pixelCount);
        return out;
    }

    /// All tiles in one wave.
    WaveLists oneWave(const Planes<std::uint32_t>& taken, const Planes<std::uint32_t>& wanted)
    {
        shared::WaveParams wave {};
        wave.tiles = params.tileCount;
        wave.lastSample = 0xffffffffu;
        std::vector<std::uint32_t> first;
        for (const std::uint32_t count : tileCounts(taken, wanted, wave)) {
            first.push_back(wave.receivers);
            wave.receivers += count;
        }
        wave.planeSize = wave.receivers + 5;
        return lists(taken, wanted, first, wave);
    }

    /// Launches a kernel of waves.cl over that many items. It is handed the frame, too.
    void launch(const std::string& kernel, std::size_t items, std::vector<Handed> handed)
    {
        handed.insert(handed.begin(), value("frame", params));
        launchDeclared(bench, { "waves/waves.cl", kernel }, items, handed);
    }

    template <class Visit>
    void everyPixel(const Visit& visit) const
    {
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                visit(x, y);
    }

    KernelBench bench;
    render::PlaneLayout layout;
    image::Window window;
    shared::FrameParams params;
};

} // namespace wedge::test
