// Graphs whose planes are of several scales, on devices.
#include "graph_lab.h"

#include "kernels/shared/frame.h"

#include <algorithm>
#include <cmath>

using namespace wedge;
using namespace wedge::graph;
using test::Lab;
using test::usableDevices;

namespace {

struct Brightness { };

int sideOf(Scale scale) { return static_cast<int>(scale); }

/// A pass of a kernel over pixels of a scale, which makes a plane of it from one of another.
void resampled(Graph& graph, const std::string& kernel, const Handle<Brightness>& in, Scale from,
    Handle<Brightness>& out, Scale to, Reach reach = {})
{
    graph.add({ .name = kernel,
        .kernel = { .file = "graph_scales.cl", .name = kernel },
        .arguments = { graph.grid("to", to), graph.grid("from", from), reads("in", in, reach), writes("out", out) },
        .domain = Domain::Pixels,
        .scale = to });
}

constexpr int blurReach = 2;

/// Down to a scale by way of another.
struct Way {
    Scale between, to;
};

Handle<Brightness> pattern(Graph& graph)
{
    auto out = graph.plane<Brightness>("pattern", floats);
    graph.add({ .name = "pattern",
        .kernel = { .file = "graph_scales.cl", .name = "pattern" },
        .arguments = { graph.grid("to", Scale::Full), writes("out", out) },
        .domain = Domain::Pixels });
    return out;
}

/// Down that way, blurred there, and up again.
Handle<Brightness> throughScales(Graph& graph, const Handle<Brightness>& full, const Way& way)
{
    auto first = graph.plane<Brightness>("first", floats, way.between),
         coarse = graph.plane<Brightness>("coarse", floats, way.to);
    auto soft = graph.plane<Brightness>("soft", floats, way.to), out = graph.plane<Brightness>("out", floats);
    resampled(graph, "coarser", full, Scale::Full, first, way.between);
    resampled(graph, "coarser", first, way.between, coarse, way.to);
    const auto reach = [all = graph.image(way.to)](const Launch& launch) {
        CHECK(all.contains(launch.window)); // rounded to blocks, and not beyond
        return std::uint32_t { blurReach };
    };
    graph.add({ .name = "blurred",
        .kernel = { .file = "graph_scales.cl", .name = "blurred" },
        .arguments = { graph.grid("to", way.to), made("reach", reach), reads("in", coarse, around(blurReach)),
            writes("out", soft) },
        .domain = Domain::Blocks,
        .scale = way.to });
    resampled(graph, "finer", soft, way.to, out, Scale::Full, around(1));
    return out;
}

/// Pixels of a plane without its padding.
struct Picture {
    int width, height;
    std::vector<double> pixels =
        std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));

    double& at(int x, int y)
    {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    template <class F>
    static Picture of(int width, int height, const F& f)
    {
        Picture out { width, height };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                out.at(x, y) = f(x, y);
            }
        }
        return out;
    }
    /// Mean of those pixels of the rectangle that there are.
    double mean(int x0, int y0, int x1, int y1)
    {
        double sum = 0.0;
        int count = 0;
        for (int y = std::max(0, y0); y < std::min(height, y1); ++y) {
            for (int x = std::max(0, x0); x < std::min(width, x1); ++x) {
                sum += at(x, y);
                ++count;
            }
        }
        return sum / count;
    }
    double between(double u, double v)
    {
        const double x = std::clamp(u, 0.0, width - 1.0), y = std::clamp(v, 0.0, height - 1.0);
        const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
        const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
        return std::lerp(std::lerp(at(x0, y0), at(x1, y0), x - x0), std::lerp(at(x0, y1), at(x1, y1), x - x0), y - y0);
    }
};

Picture coarser(Picture from, int side)
{
    return Picture::of((from.width + side - 1) / side, (from.height + side - 1) / side,
        [&](int x, int y) { return from.mean(side * x, side * y, side * (x + 1), side * (y + 1)); });
}

struct Size {
    int width, height;
};

/// The host's throughScales(), in double precision.
Picture oracle(Size size, const Way& way)
{
    const Picture full =
        Picture::of(size.width, size.height, [](int x, int y) { return (x * 7 + y * 13) % 32 + 0.125 * x; });
    Picture coarse = coarser(coarser(full, sideOf(way.between)), sideOf(way.to) / sideOf(way.between));
    Picture soft = Picture::of(coarse.width, coarse.height,
        [&](int x, int y) { return coarse.mean(x - blurReach, y - blurReach, x + blurReach + 1, y + blurReach + 1); });
    const double side = sideOf(way.to);
    return Picture::of(size.width, size.height,
        [&](int x, int y) { return soft.between((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5); });
}

/// The plane that throughScales() makes where that window of it is wanted, among memory full of not-a-numbers.
std::vector<float> rendered(Lab& lab, Size size, const Way& way, const Window& wanted)
{
    Graph graph(size.width, size.height, PlaneLayout(size.width, size.height).size);
    const auto out = throughScales(graph, pattern(graph), way);
    graph.want(out, wanted);
    const Plan plan(graph, device::partAlignment, slabRulesOf(lab.device.info()));
    Execution execution(plan, lab.memory, lab.kernels, lab.queue);
    CHECK(execution.run(nullptr, true));
    return execution.output<float>(out).downloadAll(lab.queue);
}

/// Crops have the bits of the whole image, which are near the host's, and nothing is made for them beyond.
void requireCrops(Lab& lab, Size size, const Way& way, const std::vector<Window>& crops)
{
    const PlaneLayout layout(size.width, size.height);
    const auto at = [&](const std::vector<float>& plane, int x, int y) {
        return plane[shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride)];
    };
    const std::vector<float> whole = rendered(lab, size, way, { 0, 0, size.width, size.height });
    Picture expected = oracle(size, way);
    for (const Window& crop : crops) {
        CAPTURE(crop.x0);
        CAPTURE(crop.y0);
        const std::vector<float> part = rendered(lab, size, way, crop);
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x) {
                REQUIRE(at(part, x, y) == at(whole, x, y)); // a not-a-number is no number's equal
                REQUIRE(at(part, x, y) == doctest::Approx(expected.at(x, y)).epsilon(1e-5));
            }
        }
        CHECK((crop.x0 == 0 || std::isnan(at(part, crop.x0 - 1, crop.y0)))); // nobody asked for it
    }
}

} // namespace

TEST_CASE("a crop through coarser planes has the bits of the whole image, which is the host's")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        for (const Way& way : { Way { Scale::Half, Scale::Half }, Way { Scale::Quarter, Scale::Quarter },
                 Way { Scale::Half, Scale::Quarter }, Way { Scale::Quarter, Scale::ThirtySecond } }) {
            CAPTURE(sideOf(way.between));
            CAPTURE(sideOf(way.to));
            requireCrops(lab, { 37, 23 }, way,
                { { 0, 0, 37, 23 }, { 11, 7, 14, 9 }, { 0, 0, 5, 4 }, { 30, 18, 37, 23 }, { 36, 0, 37, 23 },
                    { 15, 3, 17, 4 } });
            requireCrops(lab, { 64, 32 }, way, { { 30, 9, 33, 32 }, { 63, 31, 64, 32 } });
            requireCrops(lab, { 5, 3 }, way, { { 4, 1, 5, 3 } });
            requireCrops(lab, { 1, 1 }, way, { { 0, 0, 1, 1 } });
        }
    }
}

TEST_CASE("a coarser plane outlives the frame that made it")
{
    const device::Device device = usableDevices().front();
    Lab lab(device);
    const PlaneLayout full(37, 23), half(19, 12);
    device::Buffer<float> kept(device, static_cast<std::size_t>(half.size), "kept");
    for (const bool making : { true, false }) {
        Graph graph(37, 23, full.size);
        auto coarse = graph.imported<Brightness>("coarse", floats, kept.cl(), Scale::Half);
        if (making) {
            resampled(graph, "coarser", pattern(graph), Scale::Full, coarse, Scale::Half);
            graph.want(coarse, graph.image(Scale::Half));
        }
        auto fine = graph.plane<Brightness>("fine", floats);
        resampled(graph, "finer", coarse, Scale::Half, fine, Scale::Full, around(1));
        graph.want(fine, graph.image());
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        CHECK(plan.passes.size() == (making ? 3 : 1));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK(execution.run(nullptr, true));
        const std::vector<float> found = execution.output<float>(fine).downloadAll(lab.queue);
        CHECK(found[shared::pixelIndex(0, 0, full.stride)] == doctest::Approx((0.0 + 7.125 + 13.0 + 20.125) / 4));
    }
}
