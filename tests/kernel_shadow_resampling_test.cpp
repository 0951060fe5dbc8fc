// shadow_resampling.cl alone: receivers of a coarse grid, and what they say of all pixels, against the host in double.
#include "tests/shadow_lights_support.h"

#include <algorithm>
#include <array>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

render::Settings scaled(int side)
{
    render::Settings s = settings(render::Shadows::Ratio);
    s.environment.shadows.blockSide = side;
    return s;
}

/// Planes of a coarse grid over width x height pixels.
struct Grid {
    explicit Grid(int ofSide)
        : side(ofSide)
        , columns((width + side - 1) / side)
        , rows((height + side - 1) / side)
        , layout(columns, rows)
    {
    }
    std::size_t index(int x, int y) const
    {
        return shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride);
    }
    int middle(int at, int size) const { return std::min(at * side + side / 2, size - 1); }

    int side, columns, rows;
    graph::PlaneLayout layout;
};

/// What the camera sees, at pixels and at those of the grid.
struct Seen {
    Seen(DeclaredFrame& frame)
        : primary(frame, "primary")
        , copy(frame, "coarseReceivers")
        , resample(frame, "resampleShadows")
    {
        primary.run();
        for (PassBench* bench : { &copy, &resample }) {
            for (const char* name : { "position", "normal", "origin", "diffuse", "specular" })
                if (bench->has(name))
                    bench->plane(name, primary.read<float>(name));
            for (const char* name : { "geometric", "objectId", "gloss" })
                if (bench->has(name))
                    bench->plane(name, primary.read<std::uint32_t>(name));
        }
        resample.plane("pixelSize", primary.read<float>("pixelSize"));
        copy.run();
        for (const char* name : { "coarsePosition", "coarseNormal" })
            resample.plane(name, copy.read<float>(name));
        resample.plane("coarseGloss", copy.read<std::uint32_t>("coarseGloss"));
    }
    PassBench primary, copy, resample;
};

std::array<double, 3> spline(double t)
{
    return { 0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t) };
}

} // namespace

TEST_CASE("coarseReceivers: those of the pixels in the middle, to the bit")
{
    onEveryDevice([](const device::Device& device) {
        for (const int side : { 2, 4, 32 }) {
            CAPTURE(side);
            DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), scaled(side));
            Seen seen(frame);
            const Grid grid(side);
            const std::uint32_t size = static_cast<std::uint32_t>(grid.layout.size);
            const auto object = seen.copy.pixels<std::uint32_t>("objectId");
            const auto coarse = seen.copy.read<std::uint32_t>("coarseObjectId");
            for (const auto& [full, few] : { std::pair("position", "coarsePosition"), { "origin", "coarseOrigin" },
                     { "normal", "coarseNormal" }, { "diffuse", "coarseDiffuse" }, { "specular", "coarseSpecular" } }) {
                const auto of = seen.copy.pixels<float>(full);
                const std::vector<float> got = seen.copy.read<float>(few);
                for (int y = 0; y < grid.rows; ++y)
                    for (int x = 0; x < grid.columns; ++x)
                        for (std::size_t c = 0; c < 3; ++c)
                            REQUIRE(got[c * size + grid.index(x, y)]
                                == of.at(grid.middle(x, width), grid.middle(y, height), c));
            }
            std::size_t hit = 0;
            for (int y = 0; y < grid.rows; ++y)
                for (int x = 0; x < grid.columns; ++x) {
                    REQUIRE(coarse[grid.index(x, y)] == object.at(grid.middle(x, width), grid.middle(y, height)));
                    hit += coarse[grid.index(x, y)] != 0 ? 1 : 0;
                }
            CHECK(hit > 0);
        }
    });
}

TEST_CASE("resampleShadows: weights add up to 1, and are those of spline, normals and planes")
{
    onEveryDevice([](const device::Device& device) {
        for (const int side : { 2, 4 }) {
            CAPTURE(side);
            DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), scaled(side));
            Seen seen(frame);
            const Grid grid(side);
            const std::size_t size = grid.layout.size;
            PassBench& bench = seen.resample;
            std::mt19937 random(7);
            std::vector<float> sums = someNumbers(random, 6 * size, 0, 3);
            std::fill_n(sums.begin() + static_cast<std::ptrdiff_t>(size), size, 0.75f); // one plane is even
            std::vector<std::uint32_t> coarseTaken(size, 0);
            const auto coarseObject = seen.copy.read<std::uint32_t>("coarseObjectId");
            for (std::size_t i = 0; i < size; ++i)
                coarseTaken[i] = coarseObject[i] != 0 ? count : 0;
            bench.plane("coarseMattSums", sums);
            bench.plane("coarseLobeSums", someNumbers(random, 12 * size, 0, 3));
            bench.plane("coarseTaken", coarseTaken);
            bench.plane("coarseRays", std::vector<std::uint32_t>(size, 5));
            bench.run();
            const auto matt = bench.pixels<float>("mattSums");
            const auto taken = bench.pixels<std::uint32_t>("taken"), rays = bench.pixels<std::uint32_t>("rays");
            const auto object = bench.pixels<std::uint32_t>("objectId"), gloss = bench.pixels<std::uint32_t>("gloss");
            const auto position = bench.pixels<float>("position"), normal = bench.pixels<float>("normal");
            const auto pixelSize = bench.pixels<float>("pixelSize");
            const std::vector<float> there = seen.copy.read<float>("coarsePosition"),
                                     facing = seen.copy.read<float>("coarseNormal");
            const auto coarseGloss = seen.copy.read<std::uint32_t>("coarseGloss");
            const auto vectorAt = [&](const std::vector<float>& planes, std::size_t i) {
                return glm::dvec3(planes[i], planes[size + i], planes[2 * size + i]);
            };
            std::size_t made = 0, alone = 0, traced = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                traced += rays.at(x, y);
                REQUIRE(
                    rays.at(x, y) == (x == grid.middle(x / side, width) && y == grid.middle(y / side, height) ? 5 : 0));
                if (object.at(x, y) == 0) {
                    REQUIRE(taken.at(x, y) == 0);
                    return;
                }
                const auto across = spline((x - grid.middle(x / side, width)) / double(side)),
                           down = spline((y - grid.middle(y / side, height)) / double(side));
                const glm::dvec3 at = position.vector(x, y), n = normal.vector(x, y);
                double sum = 0, value = 0;
                bool close = false; // to where planes or gloss part
                for (int k = 0; k < 9; ++k) {
                    const int cx = x / side + k % 3 - 1, cy = y / side + k / 3 - 1;
                    if (cx < 0 || cy < 0 || cx >= grid.columns || cy >= grid.rows)
                        continue;
                    const std::size_t i = grid.index(cx, cy);
                    if (coarseTaken[i] == 0 || coarseGloss[i] != gloss.at(x, y))
                        continue;
                    const glm::dvec3 m = vectorAt(facing, i), d = vectorAt(there, i) - at;
                    const double off = std::max(std::abs(glm::dot(n, d)), std::abs(glm::dot(m, d)));
                    const double most = 0.5 * side * pixelSize.at(x, y);
                    close |= std::abs(off - most) < 1e-4 * most;
                    if (off > most)
                        continue;
                    const double weight = across[static_cast<std::size_t>(k % 3)]
                        * down[static_cast<std::size_t>(k / 3)] * std::max(glm::dot(n, m), 0.0);
                    sum += weight;
                    value += weight * sums[i];
                }
                if (close || std::abs(sum - 0.1) < 1e-4)
                    return;
                REQUIRE(taken.at(x, y) == (sum >= 0.1 ? count : 0));
                if (sum >= 0.1) {
                    ++made;
                    REQUIRE(matt.at(x, y, 0) == doctest::Approx(value / sum).epsilon(1e-4));
                    REQUIRE(matt.at(x, y, 1) == doctest::Approx(0.75).epsilon(1e-6));
                } else {
                    ++alone;
                    REQUIRE(matt.at(x, y, 1) == 0);
                }
            });
            CHECK(made > 600);
            CHECK(alone > 0);
            CHECK(traced == 5 * static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
        }
    });
}
