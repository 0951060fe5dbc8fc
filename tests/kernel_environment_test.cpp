// Directions of an environment's map: how often each is chosen, the densities that are told, what is seen there, and
// pre-computed ones.
#include "host/render/environment_table.h"
#include "tests/environment_support.h"
#include "tests/pass_bench.h"

#include <algorithm>
#include <array>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 16, height = 8;
constexpr std::uint32_t count = 1u << 18;

std::size_t indexOf(int x, int y) { return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x); }

/// Of all brightnesses, one texel far beyond the others, and black ones; turned in the world.
render::EnvironmentPicture picture()
{
    render::EnvironmentPicture p;
    p.width = width;
    p.height = height;
    std::mt19937 random(3);
    for (int i = 0; i < width * height; ++i)
        for (int c = 0; c < 3; ++c)
            p.radiance.push_back(i % 5 == 0 ? 0.0f : static_cast<float>(std::pow(10.0, uniform(random, -2, 1))));
    std::fill_n(p.radiance.begin() + 3 * (2 * width + 5), 3, 400.0f);
    p.up = glm::normalize(glm::vec3(0.2f, 1.0f, -0.3f));
    p.right = glm::normalize(glm::cross(p.up, glm::vec3(0, 0, 1)));
    p.back = glm::cross(p.right, p.up);
    return p;
}

struct Sample {
    glm::dvec3 direction, radiance;
    double pdf;
    glm::dvec3 seen;
    double seenPdf;
};

std::vector<Sample> samples(const device::Device& device, const render::EnvironmentTable& table)
{
    KernelBench bench(device, {}, kernelDir().empty() ? WEDGE_TEST_KERNELS : kernelDir());
    std::mt19937 random(7);
    std::vector<float> numbers(2 * std::size_t { count });
    for (float& u : numbers)
        u = static_cast<float>(random() >> 8) * (1.0f / 16777216.0f);
    const auto out = bench.filled(11 * std::size_t { count }, 0.0f);
    const auto map = bench.buffer(std::vector { table.map });
    const auto tableBuffer = bench.buffer(table.numbers), numberBuffer = bench.buffer(numbers);
    device::Kernel kernel = bench.library.kernel("environment_map.cl", "sampleDirections");
    kernel.setArgs(map, tableBuffer, numberBuffer, count, out);
    bench.queue.launch("directions", device::PassKind::Trace, kernel, count, 16);
    const std::vector<float> read = bench.read(out);
    std::vector<Sample> all;
    for (std::size_t i = 0; i < count; ++i) {
        const float* s = &read[11 * i];
        all.push_back({ { s[0], s[1], s[2] }, { s[3], s[4], s[5] }, s[6], { s[7], s[8], s[9] }, s[10] });
    }
    return all;
}

/// The texel that a direction lies in, and the direction's place in texels.
struct Texel {
    int x, y;
    double fx, fy;
};

Texel texelOf(const render::EnvironmentPicture& p, glm::dvec3 d)
{
    const double pi = std::acos(-1.0);
    const double x = glm::dot(glm::dvec3(p.right), d), y = glm::dot(glm::dvec3(p.up), d),
                 z = glm::dot(glm::dvec3(p.back), d);
    const double fx = (0.5 + std::atan2(x, -z) / (2 * pi)) * width,
                 fy = std::acos(std::clamp(y, -1.0, 1.0)) / pi * height;
    return { std::clamp(static_cast<int>(fx), 0, width - 1), std::clamp(static_cast<int>(fy), 0, height - 1), fx, fy };
}

/// Between four texels, columns around.
glm::dvec3 lookup(const render::EnvironmentPicture& p, Texel at)
{
    const double x = std::floor(at.fx - 0.5), y = std::floor(at.fy - 0.5);
    glm::dvec3 sum(0);
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner % 2, dy = corner / 2;
        const int column = (static_cast<int>(x) + dx + width) % width,
                  row = std::clamp(static_cast<int>(y) + dy, 0, height - 1);
        const double weight =
            (dx != 0 ? at.fx - 0.5 - x : 1 - (at.fx - 0.5 - x)) * (dy != 0 ? at.fy - 0.5 - y : 1 - (at.fy - 0.5 - y));
        for (int c = 0; c < 3; ++c)
            sum[c] += weight * p.radiance[3 * indexOf(column, row) + static_cast<std::size_t>(c)];
    }
    return sum;
}

double solidAngle(int y)
{
    const double pi = std::acos(-1.0);
    return 2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
}

/// Of a floor that a map lights.
DeclaredFrame frameUnder(const device::Device& device, const render::EnvironmentPicture& map, render::Settings settings)
{
    SceneBuilder b = openFloor();
    render::setEnvironment(b.scene, std::make_shared<render::EnvironmentPicture>(map));
    return { device, b.scene, settings };
}

/// Of plain Monte Carlo, with pre-computed samples.
DeclaredFrame precomputing(const device::Device& device, const render::EnvironmentPicture& map)
{
    render::Settings settings = sized(render::monteCarlo(1), 1, 1);
    settings.environment.sampling = render::EnvironmentSampling::Precomputed;
    return frameUnder(device, map, settings);
}

/// Its pre-computed samples with that seed, row by row.
std::vector<Sample> precomputed(DeclaredFrame& frame, std::uint32_t seed)
{
    PassBench pass(frame, "precomputeDirections");
    pass.value("seed", seed);
    pass.plane("samples", std::vector(pass.elements("samples"), -1.0f));
    pass.run();
    const auto read = pass.read<float>("samples");
    std::vector<Sample> all(read.size() / WEDGE_ENVIRONMENT_SAMPLE_FLOATS);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const float* s = &read[WEDGE_ENVIRONMENT_SAMPLE_FLOATS * i];
        all[i] = { { s[0], s[1], s[2] }, { s[3], s[4], s[5] }, s[6], {}, 0 };
    }
    return all;
}

/// What would light surfaces of half the reflectance, R G B of each normal, if nothing hid it: of receivers, which is
/// that of pixels.
std::vector<float> unshadowed(
    const device::Device& device, const render::EnvironmentPicture& map, const std::vector<glm::dvec3>& normals)
{
    render::Settings settings = sized(render::axisAligned(16), static_cast<int>(normals.size()), 1);
    DeclaredFrame ofPixels = frameUnder(device, map, settings);
    settings.antialias = true;
    DeclaredFrame ofWaves = frameUnder(device, map, settings);
    PassBench pixels(ofPixels, "environmentOfPixels"), receivers(ofWaves, "environmentOfReceivers");
    Planes<float> facing(ofPixels.layout, 3, 0.0f);
    const std::size_t size = receivers.elements("normal");
    std::vector<float> list(3 * size);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        facing.setVector(static_cast<int>(i), 0, normals[i]);
        for (std::size_t c = 0; c < 3; ++c)
            list[c * size + i] = static_cast<float>(normals[i][static_cast<int>(c)]);
    }
    pixels.plane("normal", facing);
    receivers.plane("normal", list);
    shared::FrameParams frame {};
    frame.tileCount = 1;
    shared::WaveParams wave {};
    wave.receivers = static_cast<std::uint32_t>(normals.size());
    wave.planeSize = static_cast<std::uint32_t>(size);
    receivers.value("frame", frame);
    receivers.value("wave", wave);
    receivers.items(normals.size() / WEDGE_BLOCK_PIXELS);
    for (PassBench* pass : { &pixels, &receivers }) {
        pass->plane("diffuse", std::vector(pass->read<float>("diffuse").size(), 0.5f));
        pass->plane("unshadowed", std::vector(pass->read<float>("unshadowed").size(), -1.0f));
        pass->run();
    }
    const auto image = pixels.pixels<float>("unshadowed");
    const auto read = receivers.read<float>("unshadowed");
    std::vector<float> out(3 * normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            out[c * normals.size() + i] = read[c * size + i];
            REQUIRE(image.at(static_cast<int>(i), 0, c) == read[c * size + i]);
        }
    return out;
}

/// Where sums up to an entry begin and end.
struct Stripe {
    double begin, end;
};

Stripe stripeOf(const float* upTo, int i) { return { i > 0 ? double { upTo[i - 1] } : 0.0, double { upTo[i] } }; }

/// The integral of radiance times the cosine to a normal, where that is positive, by pre-computed samples.
glm::dvec3 irradianceBy(const std::vector<Sample>& samples, glm::dvec3 normal)
{
    glm::dvec3 sum(0);
    for (const Sample& s : samples)
        sum += std::max(0.0, glm::dot(normal, s.direction)) / s.pdf * s.radiance;
    return sum / static_cast<double>(samples.size());
}

/// The same by quadrature over so many parts of each texel along both axes; the lookup goes from one to the next.
std::vector<glm::dvec3> irradiances(
    const render::EnvironmentPicture& p, const std::vector<glm::dvec3>& normals, int parts)
{
    std::vector<glm::dvec3> sums(normals.size(), glm::dvec3(0));
    const double pi = std::acos(-1.0);
    for (int y = 0; y < height * parts; ++y)
        for (int x = 0; x < width * parts; ++x) {
            const double fx = (x + 0.5) / parts, fy = (y + 0.5) / parts;
            const double polar = pi * fy / height, turn = 2 * pi * (fx / width - 0.5);
            const glm::dvec3 d = std::cos(polar) * glm::dvec3(p.up)
                + std::sin(polar) * (std::sin(turn) * glm::dvec3(p.right) - std::cos(turn) * glm::dvec3(p.back));
            const double weight = 2 * pi * pi / (height * width * parts * parts) * std::sin(polar);
            const glm::dvec3 radiance = lookup(p, { static_cast<int>(fx), static_cast<int>(fy), fx, fy });
            for (std::size_t i = 0; i < normals.size(); ++i)
                sums[i] += weight * std::max(0.0, glm::dot(normals[i], d)) * radiance;
        }
    return sums;
}

} // namespace

TEST_CASE("directions are chosen as often as their densities say, evenly within texels")
{
    const render::EnvironmentPicture p = picture();
    onEveryDevice([&](const device::Device& device) {
        const std::vector<Sample> all = samples(device, render::environmentTable(&p));
        std::array<std::size_t, std::size_t { width } * height> found {}, left {}, above {};
        std::array<double, std::size_t { width } * height> pdf {};
        std::size_t beside = 0;
        for (const Sample& s : all) {
            CHECK(glm::length(s.direction) == doctest::Approx(1).epsilon(1e-5));
            const Texel t = texelOf(p, s.direction);
            const auto i = indexOf(t.x, t.y);
            // Directions by a side of their texel may be rounded to the other side of it.
            const double nearest = std::min({ t.fx - t.x, t.x + 1 - t.fx, t.fy - t.y, t.y + 1 - t.fy });
            if (nearest < 1e-4) {
                ++beside;
                continue;
            }
            ++found[i];
            pdf[i] = s.pdf;
            const double middle =
                std::cos(std::acos(-1.0) * t.y / height) - 0.5 * solidAngle(t.y) * width / (2 * std::acos(-1.0));
            left[i] += t.fx - t.x < 0.5 ? 1 : 0;
            above[i] += glm::dot(glm::dvec3(p.up), s.direction) > middle ? 1 : 0;
            REQUIRE(s.seenPdf == doctest::Approx(s.pdf).epsilon(1e-6));
        }
        CHECK(beside < count / 1000);
        double square = 0, total = 0, halves = 0, cells = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const auto i = indexOf(x, y);
                const double expected = count * pdf[i] * solidAngle(y);
                total += expected / count;
                if (expected < 10)
                    continue;
                const auto n = static_cast<double>(found[i]);
                square += (n - expected) * (n - expected) / expected;
                halves += (2.0 * static_cast<double>(left[i]) - n) * (2.0 * static_cast<double>(left[i]) - n) / n;
                halves += (2.0 * static_cast<double>(above[i]) - n) * (2.0 * static_cast<double>(above[i]) - n) / n;
                ++cells;
            }
        CHECK(total == doctest::Approx(1).epsilon(1e-3)); // what was never chosen has next to nothing
        CHECK(cells > 100);
        // Chi-square: mean `cells`, standard deviation sqrt(2 cells).
        CHECK(square < cells + 5 * std::sqrt(2 * cells));
        CHECK(halves < 2 * cells + 5 * std::sqrt(4 * cells));
        // The bright texel's excess over the mean is most of all.
        CHECK(pdf[2 * width + 5] * solidAngle(2) > 0.4);
    });
}

TEST_CASE("what is seen lies between the four texels around, and the columns meet behind")
{
    const render::EnvironmentPicture p = picture();
    onEveryDevice([&](const device::Device& device) {
        for (const Sample& s : samples(device, render::environmentTable(&p))) {
            const glm::dvec3 expected = lookup(p, texelOf(p, s.direction));
            for (int c = 0; c < 3; ++c) {
                REQUIRE(std::abs(s.seen[c] - expected[c]) < 1e-3 * expected[c] + 5e-3);
                REQUIRE(std::abs(s.radiance[c] - expected[c]) < 1e-3 * expected[c] + 5e-3);
            }
        }
    });
}

TEST_CASE("unshadowed light is the irradiance by normal, over the largest")
{
    const render::EnvironmentPicture p = picture();
    constexpr std::size_t normals = 256;
    std::mt19937 random(11);
    std::vector<glm::dvec3> directions(normals);
    for (glm::dvec3& d : directions) {
        const double z = uniform(random, -1, 1), turn = uniform(random, 0, 6.2831853), r = std::sqrt(1 - z * z);
        d = { r * std::cos(turn), r * std::sin(turn), z };
    }
    const std::vector<glm::dvec3> expected = irradiances(p, directions, 4);
    glm::dvec3 most(0);
    for (const glm::dvec3& e : expected)
        most = glm::max(most, e);
    onEveryDevice([&](const device::Device& device) {
        const std::vector<float> all = unshadowed(device, p, directions);
        double off = 0;
        for (std::size_t i = 0; i < normals; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const int channel = static_cast<int>(c);
                const double share = std::max(expected[i][channel] / most[channel], 0.0625);
                // What harmonics of the second order leave out of a single direction's light is up to 9 % of its most.
                REQUIRE(std::abs(2 * all[c * normals + i] - share) < 0.1);
                off += std::abs(2 * all[c * normals + i] - share) / (3 * normals);
            }
        CHECK(off < 0.04);
        for (const float value : unshadowed(device, *even(glm::vec3(0.25f)), directions))
            REQUIRE(value == doctest::Approx(0.5).epsilon(0.01));
        for (const float value : unshadowed(device, *even(glm::vec3(0)), directions))
            REQUIRE(value == 0.5f);
    });
}

TEST_CASE("pre-computed samples lie one in each cell, evenly in it, and tell what the map has there")
{
    const render::EnvironmentPicture p = picture();
    const render::EnvironmentTable table = render::environmentTable(&p);
    const float* rows = table.numbers.data() + 3 * width * height;
    const float* columns = rows + height;
    onEveryDevice([&](const device::Device& device) {
        constexpr int cells = WEDGE_ENVIRONMENT_CELLS, seeds = 8, parts = 4;
        std::array<std::size_t, std::size_t { parts } * parts> found {};
        std::size_t beside = 0, counted = 0;
        DeclaredFrame frame = precomputing(device, p);
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            const std::vector<Sample> all = precomputed(frame, seed);
            REQUIRE(all.size() == 4096);
            for (std::size_t i = 0; i < all.size(); ++i) {
                const Sample& s = all[i];
                const Texel t = texelOf(p, s.direction);
                const glm::dvec3 expected = lookup(p, t);
                for (int c = 0; c < 3; ++c)
                    REQUIRE(std::abs(s.radiance[c] - expected[c]) < 1e-3 * expected[c] + 5e-3);
                if (std::min({ t.fx - t.x, t.x + 1 - t.fx, t.fy - t.y, t.y + 1 - t.fy }) < 1e-4) {
                    ++beside; // may be rounded to the other side
                    continue;
                }
                const Stripe row = stripeOf(rows, t.y), column = stripeOf(columns + indexOf(0, t.y), t.x);
                const double pdf = (row.end - row.begin) * (column.end - column.begin) / solidAngle(t.y);
                REQUIRE(s.pdf == doctest::Approx(pdf).epsilon(1e-4));
                // The numbers that the direction was made of, in cells. Within rows cosines are even.
                const double pi = std::acos(-1.0), cosine = glm::dot(glm::dvec3(p.up), s.direction);
                const double top = std::cos(pi * t.y / height), bottom = std::cos(pi * (t.y + 1) / height);
                const double u = cells * (column.begin + (column.end - column.begin) * (t.fx - t.x));
                const double v = cells * (row.begin + (row.end - row.begin) * (cosine - top) / (bottom - top));
                const std::size_t cellX = i % cells, cellY = i / cells;
                const auto x = static_cast<double>(cellX), y = static_cast<double>(cellY);
                REQUIRE(std::abs(u - x - 0.5) < 0.5 + 1e-3);
                REQUIRE(std::abs(v - y - 0.5) < 0.5 + 1e-3);
                ++found[static_cast<std::size_t>(std::clamp(parts * (u - x), 0.0, parts - 0.5))
                    + parts * static_cast<std::size_t>(std::clamp(parts * (v - y), 0.0, parts - 0.5))];
                ++counted;
            }
        }
        CHECK(beside < seeds * 4096 / 1000);
        double square = 0;
        const double expected = static_cast<double>(counted) / (parts * parts);
        for (const std::size_t n : found)
            square += (static_cast<double>(n) - expected) * (static_cast<double>(n) - expected) / expected;
        CHECK(square < 15 + 5 * std::sqrt(30.0)); // chi-square of 15 degrees of freedom
    });
}

TEST_CASE("pre-computed samples light as their map does, in the mean over seeds")
{
    std::vector<glm::dvec3> normals { { 0, 1, 0 }, { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } };
    normals.push_back(glm::normalize(glm::dvec3(-1, 0.5, -0.7)));
    onEveryDevice([&](const device::Device& device) {
        DeclaredFrame underGrey = precomputing(device, *even(glm::vec3(0.25f), width, height));
        // All that a sample of an even map brings is the same; what is left is where directions are.
        const std::vector<Sample> flat = precomputed(underGrey, 0);
        double whole = 0;
        for (const Sample& s : flat)
            whole += s.radiance.y / s.pdf / 4096;
        CHECK(whole == doctest::Approx(std::acos(-1.0)).epsilon(1e-5)); // 4 pi / 4
        for (const glm::dvec3& n : normals)
            CHECK(irradianceBy(flat, n).y == doctest::Approx(std::acos(-1.0) / 4).epsilon(0.002));

        const render::EnvironmentPicture p = picture();
        DeclaredFrame frame = precomputing(device, p);
        const std::vector<glm::dvec3> expected = irradiances(p, normals, 32);
        constexpr std::uint32_t seeds = 32;
        std::vector<double> sums(normals.size()), squares(normals.size());
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            const std::vector<Sample> all = precomputed(frame, seed);
            for (std::size_t i = 0; i < normals.size(); ++i) {
                const double off = irradianceBy(all, normals[i]).y - expected[i].y;
                sums[i] += off / seeds;
                squares[i] += off * off / seeds;
            }
        }
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const double deviation = std::sqrt((squares[i] - sums[i] * sums[i]) / (seeds - 1));
            CHECK(deviation > 0); // no two seeds have the same samples
            CHECK(std::abs(sums[i]) < 4 * deviation + 1e-4 * expected[i].y);
        }
    });
}
