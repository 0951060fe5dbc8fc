// temporal.cl alone: against the same on the host, in double.
#include "kernels/shared/temporal.h"
#include "tests/declared_kernel.h"

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr const char* file = "filter/temporal.cl";

shared::TemporalParams temporalParamsOf(const render::PlaneLayout& layout)
{
    shared::TemporalParams p = paramsOf<shared::TemporalParams>(layout);
    p.blocksX = (p.width + 3) / 4;
    p.blocksY = (p.height + 3) / 4;
    p.normalCosine = 0.9f;
    return p;
}

struct Camera {
    glm::dvec3 eye { 0, 0, 5 }, forward { 0, 0, -1 }, right { 0.02, 0, 0 }, down { 0, -0.02, 0 };

    glm::dvec3 through(const render::PlaneLayout& layout, double x, double y) const
    {
        return forward + right * (x - 0.5 * layout.width) + down * (y - 0.5 * layout.height);
    }
};

void setCamera(shared::TemporalParams& p, const Camera& c)
{
    p.eye = toVec3(c.eye);
    p.forward = toVec3(c.forward);
    p.right = toVec3(c.right);
    p.down = toVec3(c.down);
}

/// What a camera sees of the floor z = 0, on the right z = 0.5, object 1 or 2 by where, and of a disk before it, object
/// 3, which is turned.
struct Seen {
    Planes<float> position, normal, depth, noisy, light;
    Planes<std::uint32_t> object, facing;

    Seen(const render::PlaneLayout& layout, const Camera& camera, glm::dvec3 disk)
        : position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , depth(layout, 1, 0.0f)
        , noisy(layout, 1, 0.0f)
        , light(layout, 3, 0.0f)
        , object(layout, 1, 0u)
        , facing(layout, 1, 0u)
    {
        everyPixel(layout, [&](int x, int y) {
            const glm::dvec3 d = camera.through(layout, x + 0.5, y + 0.5), n = glm::normalize(glm::dvec3(0.3, 0, 1));
            const double step = (0.5 - camera.eye.z) / d.z;
            double t = camera.eye.x + step * d.x > 0.5 ? step : -camera.eye.z / d.z;
            std::uint32_t id = 0;
            glm::dvec3 facingTo(0, 0, 1);
            if (const double u = glm::dot(disk - camera.eye, n) / glm::dot(d, n);
                glm::length(camera.eye + u * d - disk) < 0.4) {
                t = u;
                id = 3;
                facingTo = n;
            }
            const glm::dvec3 at = camera.eye + t * d;
            if (id == 0 && std::abs(at.x) < 1.2) {
                id = at.y > 0.13 ? 1 : 2;
            }
            object.at(x, y) = id;
            if (id == 0) {
                return;
            }
            position.setVector(x, y, at);
            normal.setVector(x, y, facingTo);
            depth.at(x, y) = static_cast<float>(t);
            facing.at(x, y) = shared::packNormal(toVec3(facingTo));
            // Some pixels are far brighter than those beside them.
            light.setVector(
                x, y, { 1 + std::sin(9 * at.x), 2 + std::cos(7 * at.y), (x * 5 + y * 3) % 29 == 0 ? 8.0 : 1.5 });
            noisy.at(x, y) = static_cast<float>(1 + 0.25 * ((x * 7 + y * 5) % 4));
        });
    }
};

/// Colours as kernels keep them.
std::vector<float> packed(const render::PlaneLayout& layout, const Planes<float>& colours)
{
    std::vector<float> out(2 * layout.size, 0.0f);
    auto* high = reinterpret_cast<std::uint16_t*>(out.data() + layout.size);
    everyPixel(layout, [&](int x, int y) {
        const std::size_t i = colours.index(x, y);
        const shared::PackedColour c = shared::packColour(toVec3(colours.vector(x, y)));
        std::memcpy(&out[i], &c.low, sizeof(float));
        high[i] = static_cast<std::uint16_t>(c.high);
    });
    return out;
}

/// Where the disk was, against where it is.
const glm::dvec3 diskNow { 0.1, 0.2, 1.0 }, diskThen { -0.25, 0.05, 1.2 };

bool sees(const Seen& then, const Camera& camera, std::uint32_t id, glm::dvec3 at, glm::dvec3 n, int x, int y)
{
    const render::PlaneLayout& layout = then.depth.layout;
    if (x < 0 || y < 0 || x >= static_cast<int>(layout.width) || y >= static_cast<int>(layout.height)
        || then.object.at(x, y) != id) {
        return false;
    }
    const double t = then.depth.at(x, y);
    const glm::dvec3 off = camera.eye + t * camera.through(layout, x + 0.5, y + 0.5) - at;
    return std::abs(glm::dot(off, n)) <= t * glm::length(camera.right) && glm::dot(then.normal.vector(x, y), n) > 0.9;
}

/// How light changes around a pixel along (dx, dy): half of the first difference and the second one, where those beside
/// it see the surface, too.
struct Change {
    glm::dvec3 slope { 0 }, bend { 0 };
};

Change changeAt(const Seen& then, const Camera& camera, std::uint32_t id, glm::dvec3 at, glm::dvec3 n, glm::ivec2 tap,
    glm::ivec2 step)
{
    const glm::ivec2 before = tap - step, after = tap + step;
    if (!sees(then, camera, id, at, n, before.x, before.y) || !sees(then, camera, id, at, n, after.x, after.y)) {
        return {};
    }
    const glm::dvec3 a = then.light.vector(before.x, before.y), b = then.light.vector(after.x, after.y);
    return { 0.5 * (b - a), a + b - 2.0 * then.light.vector(tap.x, tap.y) };
}

/// The camera of the earlier frame.
Camera cameraThen()
{
    Camera then;
    then.eye = { 0.31, -0.07, 4.8 };
    return then;
}

/// What differFromFrame() fills.
struct DifferencePlanes { // NOLINT(bugprone-exception-escape): as Buffer
    device::Buffer<float> difference, noise, variations, share;
};

/// Of frames without indirect light.
void differFromFrame(KernelBench& bench, const shared::TemporalParams& p, const std::vector<float>& motions,
    const Seen& own, const Seen& earlier, const device::Buffer<float>& variation, const DifferencePlanes& out)
{
    const render::PlaneLayout& layout = own.depth.layout;
    const auto colours = [&](const char* name, const Seen& seen) {
        return plane(name, bench.buffer(packed(layout, seen.light)), render::packedColours);
    };
    const auto shorts = [](const char* name, const device::Buffer<float>& numbers) {
        return plane(name, numbers, render::shortFloats);
    };
    launchDeclared(bench, { file, "differFromFrame" }, layout, p,
        { plane("motions", bench.buffer(motions)), vectors("position", bench.buffer(own.position.values)),
            vectors("normal", bench.buffer(own.normal.values)), plane("object", bench.buffer(own.object.values)),
            colours("directLight", own), lacks("indirectLight", render::packedColours),
            shorts("noisy", bench.buffer(inShorts(own.noisy))), shorts("variation", variation),
            plane("earlierDepth", bench.buffer(earlier.depth.values)),
            plane("earlierFacing", bench.buffer(earlier.facing.values)),
            plane("earlierObject", bench.buffer(earlier.object.values)), colours("earlierDirect", earlier),
            lacks("earlierIndirect", render::packedColours),
            shorts("earlierNoisy", bench.buffer(inShorts(earlier.noisy))), shorts("earlierVariation", variation),
            vectors("difference", out.difference), plane("noise", out.noise), plane("variations", out.variations),
            plane("share", out.share) });
}

/// What differFromFrame() finds, of the disk that has moved.
struct Differences {
    Planes<float> light, seen, unfiltered, variations;
};

Differences differ(KernelBench& bench, std::uint32_t published, const Seen& own, const Seen& earlier)
{
    const render::PlaneLayout& layout = own.depth.layout;
    shared::TemporalParams p = temporalParamsOf(layout);
    setCamera(p, cameraThen());
    p.published = published;
    p.objects = 3;
    std::vector<float> motions(3 * WEDGE_TEMPORAL_MOTION, 0.0f);
    motions[12] = motions[WEDGE_TEMPORAL_MOTION + 12] = WEDGE_TEMPORAL_STILL;
    for (int k = 0; k < 3; ++k) {
        motions[2 * WEDGE_TEMPORAL_MOTION + 5 * k] = 1.0f;
        motions[2 * WEDGE_TEMPORAL_MOTION + 4 * k + 3] = static_cast<float>((diskThen - diskNow)[k]);
    }
    motions[2 * WEDGE_TEMPORAL_MOTION + 12] = WEDGE_TEMPORAL_MOVED;
    const auto difference = bench.filled(3 * layout.size, 7.0f);
    const auto noise = bench.filled(layout.size, 7.0f), variations = bench.filled(layout.size, 7.0f),
               share = bench.filled(layout.size, 7.0f);
    const auto variation = bench.buffer(inShorts(Planes<float>(layout, 1, 0.25f)));
    differFromFrame(bench, p, motions, own, earlier, variation, { difference, noise, variations, share });
    return { planesOf(layout, bench.read(difference)), planesOf(layout, bench.read(share)),
        planesOf(layout, bench.read(noise)), planesOf(layout, bench.read(variations)) };
}

/// Where the earlier frame has a pixel's point: its place in the scene, and in pixels from the middle of the first.
struct Place {
    glm::dvec3 at;
    double x, y;
};

Place placeThen(const Seen& own, const Camera& then, int x, int y)
{
    const render::PlaneLayout& layout = own.depth.layout;
    const glm::dvec3 moved = own.object.at(x, y) == 3 ? diskThen - diskNow : glm::dvec3(0);
    const glm::dvec3 at = own.position.vector(x, y) + moved, d = at - then.eye;
    return { at, d.x / (then.right.x * -d.z) + 0.5 * layout.width - 0.5,
        d.y / (then.down.y * -d.z) + 0.5 * layout.height - 0.5 };
}

} // namespace

TEST_CASE("temporal: differences are those of the four pixels around where a point was that see its surface")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const render::PlaneLayout layout(83, 61);
        const Camera then = cameraThen();
        const Seen own(layout, Camera(), diskNow), earlier(layout, then, diskThen);
        const Differences found = differ(bench, 0, own, earlier);
        int other = 0, shown = 0, hidden = 0, bends = 0, bounded = 0;
        everyPixel(layout, [&](int x, int y) {
            const std::uint32_t id = own.object.at(x, y);
            const glm::dvec3 n = own.normal.vector(x, y);
            const auto [at, px, py] = placeThen(own, then, x, y);
            double weight = 0, nearest = 0, before = 0;
            glm::ivec2 nearby(0);
            glm::dvec3 sum(0);
            for (int tap = 0; id != 0 && tap < 4; ++tap) {
                const int tx = static_cast<int>(std::floor(px)) + tap % 2,
                          ty = static_cast<int>(std::floor(py)) + tap / 2;
                const double w = (1 - std::abs(px - tx)) * (1 - std::abs(py - ty));
                if (sees(earlier, then, id, at, n, tx, ty)) {
                    weight += w;
                    sum += w * earlier.light.vector(tx, ty);
                    before = w > nearest ? earlier.noisy.at(tx, ty) : before;
                    nearby = w > nearest ? glm::ivec2(tx, ty) : nearby;
                    nearest = std::max(nearest, w);
                }
            }
            const bool isSeen = weight > 0.5;
            if ((found.seen.at(x, y) == 1.0f) != isSeen) {
                ++other; // at the edge of what is decided
                return;
            }
            CHECK((found.seen.at(x, y) == 0.0f || found.seen.at(x, y) == 1.0f));
            shown += isSeen ? 1 : 0;
            hidden += !isSeen && id != 0 ? 1 : 0;
            glm::dvec3 expected(0);
            double moved = 0;
            if (isSeen) {
                const Change across = changeAt(earlier, then, id, at, n, nearby, { 1, 0 }),
                             down = changeAt(earlier, then, id, at, n, nearby, { 0, 1 });
                const double fx = px - std::floor(px), fy = py - std::floor(py), all = weight > 0.999 ? 0.5 : 0.0;
                const glm::dvec3 looked = sum / weight,
                                 curved = all * (fx * (1 - fx) * across.bend + fy * (1 - fy) * down.bend);
                expected = looked - glm::clamp(curved, -0.5 * looked, 0.5 * looked) - own.light.vector(x, y);
                moved = (nearby.x - px) * luminanceOf(across.slope) + (nearby.y - py) * luminanceOf(down.slope);
                bends += glm::length(curved) > 0.01 ? 1 : 0;
                bounded += glm::any(glm::greaterThan(glm::abs(curved), 0.5 * looked)) ? 1 : 0;
            }
            CHECK(glm::length(found.light.vector(x, y) - expected) < 2e-3); // of which rounding is 4e-4
            CHECK(found.variations.at(x, y) == (isSeen ? 0.5f : 0.0f));
            const double change = isSeen ? before - own.noisy.at(x, y) - moved : 0.0;
            if (std::abs(found.unfiltered.at(x, y) - change) > 1e-3) { // light is packed
                ++other; // two are equally near
            }
        });
        CHECK(shown > 1000);
        CHECK(hidden > 50);
        CHECK(bends > 50);
        CHECK(bounded > 5);
        CHECK(other < 20);
    });
}

TEST_CASE("temporal: as published differences are those of the nearest pixel, where it sees the surface")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const render::PlaneLayout layout(83, 61);
        const Camera then = cameraThen();
        const Seen own(layout, Camera(), diskNow), earlier(layout, then, diskThen);
        const Differences found = differ(bench, 1, own, earlier);
        int other = 0, shown = 0, hidden = 0;
        everyPixel(layout, [&](int x, int y) {
            const std::uint32_t id = own.object.at(x, y);
            const Place place = placeThen(own, then, x, y);
            const int nearX = static_cast<int>(std::lround(place.x)), nearY = static_cast<int>(std::lround(place.y));
            const bool isSeen = id != 0 && sees(earlier, then, id, place.at, own.normal.vector(x, y), nearX, nearY);
            const glm::dvec3 expected =
                isSeen ? earlier.light.vector(nearX, nearY) - own.light.vector(x, y) : glm::dvec3(0);
            shown += isSeen ? 1 : 0;
            hidden += !isSeen && id != 0 ? 1 : 0;
            other += (found.seen.at(x, y) == 1.0f) != isSeen || glm::length(found.light.vector(x, y) - expected) > 2e-3;
        });
        CHECK(shown > 1000);
        CHECK(hidden > 50);
        CHECK(other < 20); // where two are equally near
    });
}

TEST_CASE("temporal: a still camera's pixels are looked up where they are, whatever they see")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const render::PlaneLayout layout(35, 18);
        const Camera camera;
        const Seen seen(layout, camera, diskNow);
        shared::TemporalParams p = temporalParamsOf(layout);
        setCamera(p, camera);
        p.cameraStill = p.objectsStill = 1;
        const auto difference = bench.filled(3 * layout.size, 7.0f), plane = bench.filled(layout.size, 7.0f),
                   noise = bench.filled(layout.size, 7.0f), share = bench.filled(layout.size, 0.0f);
        differFromFrame(
            bench, p, { 0.0f }, seen, seen, bench.filled(layout.size, 0.0f), { difference, noise, plane, share });
        const Planes<float> found = planesOf(layout, bench.read(difference)), all = planesOf(layout, bench.read(share));
        everyPixel(layout, [&](int x, int y) {
            CHECK(all.at(x, y) == 1.0f);
            CHECK(found.vector(x, y) == glm::dvec3(0));
        });
    });
}

TEST_CASE("temporal: blocks are weighed by Student's t of differences and by their squares")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const render::PlaneLayout layout(70, 45);
        std::mt19937 random(5);
        std::normal_distribution<float> gauss;
        Planes<float> noise(layout, 1, 0.0f), variations(layout, 1, 0.0f), share(layout, 1, 0.0f),
            difference(layout, 3, 0.0f);
        everyPixel(layout, [&](int x, int y) {
            share.at(x, y) = random() % 5 == 0 ? 0.0f : 1.0f;
            // On the left noise, then a faint change of all, then one that is bright here and dark there.
            const float change = x < 24 ? 0.0f : x < 48 ? 0.4f : (x + y) % 2 == 0 ? 4.0f : -4.0f;
            noise.at(x, y) = share.at(x, y) * (change + gauss(random));
            variations.at(x, y) = share.at(x, y);
            difference.setVector(x, y, glm::dvec3(share.at(x, y)) * glm::dvec3(1, 2, 3));
        });
        const shared::TemporalParams p = temporalParamsOf(layout);
        const std::uint32_t blocks = p.blocksX * p.blocksY;
        const auto sums = bench.filled(4 * std::size_t { blocks }, 7.0f), weights = bench.filled(blocks, 7.0f);
        const auto run = [&](const char* kernel, std::vector<Handed> handed) {
            handed.insert(handed.begin(), { value("p", p), value("blocks", blocks) });
            launchDeclared(bench, { file, kernel }, blocks, handed);
        };
        run("sumBlocks",
            { plane("noise", bench.buffer(noise.values)), plane("variations", bench.buffer(variations.values)),
                plane("share", bench.buffer(share.values)), plane("sums", sums, graph::floatPlanes(4)) });
        run("weighBlocks", { plane("sums", sums, graph::floatPlanes(4)), plane("weights", weights) });
        const std::vector<float> found = bench.read(weights);
        std::vector<double> expected(blocks);
        struct Sum {
            double count = 0, sum = 0, squares = 0, noise = 0;
            double t() const
            {
                const double mean = count > 0 ? sum / count : 0;
                return count < 2 ? 0 : std::abs(mean) / std::sqrt((squares - sum * mean) / ((count - 1) * count));
            }
        };
        const auto sumOver = [&](int bx, int by, int reach) {
            Sum s;
            everyPixel(layout, [&](int x, int y) {
                if (std::abs(x / 4 - bx) <= reach && std::abs(y / 4 - by) <= reach) {
                    s.count += share.at(x, y);
                    s.sum += noise.at(x, y);
                    s.squares += std::pow(noise.at(x, y), 2);
                    s.noise += variations.at(x, y);
                }
            });
            return s;
        };
        const auto fall = [](double x, double from, double to) {
            const double o = std::clamp((x - from) / (to - from), 0.0, 1.0);
            return 1 - o * o * (3 - 2 * o);
        };
        double left = 0, middle = 0, right = 0;
        for (std::uint32_t b = 0; b < blocks; ++b) {
            const int bx = static_cast<int>(b % p.blocksX), by = static_cast<int>(b / p.blocksX);
            double ratio = 0;
            for (int y = std::max(0, by - 1); y <= std::min(by + 1, static_cast<int>(p.blocksY) - 1); ++y) {
                for (int x = std::max(0, bx - 1); x <= std::min(bx + 1, static_cast<int>(p.blocksX) - 1); ++x) {
                    const Sum one = sumOver(x, y, 0);
                    ratio = std::max(ratio, one.squares / one.noise);
                }
            }
            const double t = std::max(sumOver(bx, by, 0).t(), sumOver(bx, by, 2).t());
            expected[b] = fall(t, 3, 4) * fall(ratio, 4, 8);
            CHECK(found[b] == doctest::Approx(expected[b]).epsilon(1e-3));
            (bx < 4 ? left : bx >= 8 && bx < 10 ? middle : bx > 12 ? right : left) += bx < 4 || bx > 7 ? found[b] : 0;
        }
        CHECK(left > 40);
        CHECK(middle < 6);
        CHECK(right < 1e-6);
        // And what is made of them.
        const auto sum = bench.filled(3 * layout.size, 0.0f), counts = bench.filled(layout.size, 0.0f);
        const auto add = [&](const shared::TemporalParams& how, const Handed& weighed, const auto& to,
                             const auto& seen) {
            launchDeclared(bench, { file, "addFrame" }, layout, how,
                { vectors("difference", bench.buffer(difference.values)), plane("share", bench.buffer(share.values)),
                    weighed, vectors("sum", to), plane("counts", seen) });
        };
        add(p, plane("weights", weights), sum, counts);
        // As published it counts whatever has changed.
        const auto unweighed = bench.filled(3 * layout.size, 0.0f);
        add(p, lacks("weights"), unweighed, bench.filled(layout.size, 0.0f));
        CHECK(bench.read(unweighed) == difference.values);
        Planes<float> direct(layout, 3, 1.0f), beauty(layout, 3, 2.0f), diffuse(layout, 3, 0.49f);
        const auto directOut = bench.buffer(direct.values), beautyOut = bench.buffer(beauty.values);
        launchDeclared(bench, { file, "finishTemporal" }, layout, p,
            { vectors("diffuse", bench.buffer(diffuse.values)),
                vectors("specular", bench.filled(3 * layout.size, 0.0f)), vectors("sum", sum), plane("counts", counts),
                vectors("direct", directOut), lacks("indirect", graph::vectors), vectors("beauty", beautyOut) });
        const Planes<float> made = planesOf(layout, bench.read(beautyOut)),
                            madeDirect = planesOf(layout, bench.read(directOut));
        everyPixel(layout, [&](int x, int y) {
            const double bx = std::clamp((x + 0.5) / 4 - 0.5, 0.0, p.blocksX - 1.0),
                         by = std::clamp((y + 0.5) / 4 - 0.5, 0.0, p.blocksY - 1.0);
            const auto at = [&](double u, double v) {
                const auto column = std::min(static_cast<std::uint32_t>(u), p.blocksX - 1),
                           row = std::min(static_cast<std::uint32_t>(v), p.blocksY - 1);
                return expected[row * p.blocksX + column];
            };
            const double fx = bx - std::floor(bx), fy = by - std::floor(by);
            const double w = (1 - fy) * ((1 - fx) * at(bx, by) + fx * at(bx + 1, by))
                + fy * ((1 - fx) * at(bx, by + 1) + fx * at(bx + 1, by + 1));
            // Of two frames, where both see the surface; k = 0.5.
            const double more = share.at(x, y) * 0.5 * w / 2;
            CHECK(glm::length(made.vector(x, y) - glm::dvec3(2) - more * glm::dvec3(1, 2, 3)) < 3e-3);
            CHECK(glm::length(madeDirect.vector(x, y) - glm::dvec3(1) - more * glm::dvec3(1, 2, 3)) < 3e-3);
        });
    });
}
