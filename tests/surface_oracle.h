// What accumulateSurfaces is to make of the points that pixels have seen, in double; planes in all bits or in few.
#pragma once

#include "tests/accumulate_support.h"

#include <algorithm>

namespace wedge::test {

/// How pixels keep what they see. In lean frames the first wave alone measures.
struct Keeping {
    bool lean;
    float oneVelocity;
    bool motion; ///< whether there is a plane of it
};

/// The planes after all rounds, unpacked.
struct SurfacesFound {
    Planes<std::uint32_t> object, rays, pathRays, taken, hits, gloss;
    Planes<float> position, normal, diffuse, specular, emission, emissionSquares, pixelSize, distance, confusion,
        motion, motionSpread;

    SurfacesFound(Accumulation& a, const SurfacePixels& p)
        : object(a.read(p.object))
        , rays(a.read(p.rays))
        , pathRays(a.read(p.pathRays))
        , taken(a.read(a.primaryTaken))
        , hits(a.read(a.hits))
        , gloss(a.read(p.gloss))
        , position(a.read(p.position))
        , normal(a.lean ? normalsOf(a.read(p.normal)) : a.read(p.normal))
        , diffuse(a.read(p.diffuse))
        , specular(a.read(p.specular))
        , emission(a.read(p.emission))
        , emissionSquares(a.read(p.emissionSquares))
        , pixelSize(a.lean ? numbersOf(a.read(p.pixelSize), 0) : a.read(p.pixelSize))
        , distance(a.read(p.distance))
        , confusion(a.lean ? numbersOf(a.read(p.confusion), 0) : a.read(p.confusion))
        , motion(a.read(p.motion))
        , motionSpread(a.read(p.motionSpread))
    {
        for (const Planes<float>* planes :
            { &position, &normal, &pixelSize, &diffuse, &emission, &emissionSquares, &distance, &confusion })
            checkElsewhere(a, *planes);
        if (!a.lean) {
            checkElsewhere(a, motion);
            checkElsewhere(a, motionSpread);
            return;
        }
        // Nothing but what it shares its plane with is beside these.
        checkElsewhere(a, numbersOf(motion, 0));
        checkElsewhere(a, numbersOf(motion, 1));
        const Planes<std::uint32_t> halves = hits;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                REQUIRE(shortOf(halves, x, y, 1) == 0);
                hits.at(x, y) = shortOf(halves, x, y, 0);
            }
    }
};

inline std::vector<SeenPoint> hitsOf(std::vector<SeenPoint> seen)
{
    std::erase_if(seen, [](const SeenPoint& p) { return p.object == 0; });
    return seen;
}

/// Least and largest radius; packed, the one nearest to 0, or 0 where there are both signs. Returns the latter.
inline double requireConfusion(const SurfacesFound& found, bool lean, const std::vector<SeenPoint>& seen, int x, int y)
{
    const shared::CameraParams camera = lens();
    double low = 1e30, high = -1e30;
    for (const SeenPoint& p : seen) {
        const double r = camera.apertureRadius / camera.pixelStep * (1 / p.depth - 1 / camera.focusDistance);
        low = std::min(low, r);
        high = std::max(high, r);
    }
    const double nearest = low > 0 ? low : high < 0 ? high : 0;
    if (!lean) {
        REQUIRE(nearTo(found.confusion.at(x, y), low));
        REQUIRE(nearTo(found.confusion.at(x, y, 1), high));
    } else {
        REQUIRE(nearTo(found.confusion.at(x, y), nearest, 1.0 / 256));
    }
    return nearest;
}

inline void requireMotion(const SurfacesFound& found, const std::vector<SeenPoint>& hit, bool oneWave, int x, int y)
{
    const Planes<float>& motion = found.motion;
    const glm::dvec2 moves = sumOf(hit, [](const SeenPoint& p) { return p.motion; }) / static_cast<double>(hit.size());
    REQUIRE(nearTo(motion.at(x, y), moves.x));
    REQUIRE(nearTo(motion.at(x, y, 1), moves.y));
    double spread = 0, apart = 0;
    for (const SeenPoint& p : hit) {
        spread = std::max(spread, glm::distance(p.motion, moves));
        for (const SeenPoint& q : hit)
            apart = std::max(apart, glm::distance(p.motion, q.motion));
    }
    if (oneWave)
        REQUIRE(nearTo(found.motionSpread.at(x, y), spread));
    // From a mean that itself moves while waves come in.
    REQUIRE(found.motionSpread.at(x, y) >= (hit.size() > 1 ? 0.1 * apart : 0.0) - 1e-5);
    REQUIRE(found.motionSpread.at(x, y) <= apart + 1e-5);
}

/// What waves keep of motions in one plane: the mean, infinite once one of a wave's is too far from the mean so far.
enum class OneMotion { One, Several, Uncertain };
inline OneMotion requireOneMotion(const Accumulation& a, const SurfacesFound& found, const Rounds& rounds, int x, int y)
{
    const double x0 = shared::unpackShort(shortOf(found.motion, x, y, 0)),
                 y0 = shared::unpackShort(shortOf(found.motion, x, y, 1));
    const std::vector<SeenPoint> seen = a.seen(x, y);
    glm::dvec2 mean(0);
    double hits = 0;
    std::size_t k = 0;
    for (const auto& upTo : rounds) {
        std::vector<SeenPoint> wave(seen.begin() + static_cast<std::ptrdiff_t>(k), seen.begin() + upTo(x, y));
        wave = hitsOf(wave);
        k = upTo(x, y);
        if (wave.empty())
            continue;
        const double n = static_cast<double>(wave.size());
        mean = (mean * hits + sumOf(wave, [](const SeenPoint& p) { return p.motion; })) / (hits + n);
        hits += n;
        double spread = 0;
        for (const SeenPoint& p : wave)
            spread = std::max(spread, glm::distance(p.motion, mean));
        const double allowed = a.oneVelocity * glm::length(mean);
        // A single motion is its own mean, but for rounding.
        if (std::fabs(spread - allowed) < 1e-4)
            return OneMotion::Uncertain;
        if (spread > allowed) {
            REQUIRE(x0 == std::numeric_limits<double>::infinity());
            REQUIRE(y0 == 0);
            return OneMotion::Several;
        }
        mean = { rounded(mean.x), rounded(mean.y) };
    }
    REQUIRE(std::fabs(x0 - mean.x) <= unitOf(mean.x));
    REQUIRE(std::fabs(y0 - mean.y) <= unitOf(mean.y));
    return OneMotion::One;
}

/// What the waves that measure have seen of a pixel: of all, or packed of the first one.
inline void requireMeasured(const SurfacesFound& found, bool lean, const std::vector<SeenPoint>& seen, int x, int y)
{
    // What is seen to emit may have no surface, like a light.
    REQUIRE(nearTo(found.emissionSquares.at(x, y), sumOf(seen, [](const SeenPoint& p) {
        return std::pow(luminanceOf(p.emission), 2);
    }) / std::max<double>(1, static_cast<double>(seen.size()))));
    const std::vector<SeenPoint> hit = hitsOf(seen);
    const double h = std::max<double>(1, static_cast<double>(hit.size())), tolerance = lean ? 1.0 / 256 : 2e-5;
    REQUIRE(
        nearTo(found.pixelSize.at(x, y), sumOf(hit, [](const SeenPoint& p) { return p.pixelSize; }) / h, tolerance));
}

/// Kind and mean exponent of the lobes that the first round with a lobe has seen.
inline void requireGloss(
    const SurfacesFound& found, bool lean, const std::vector<SeenPoint>& seen, const Rounds& rounds, int x, int y)
{
    double sum = 0, lobes = 0;
    std::uint32_t kind = WEDGE_LAMBERT, first = 0;
    for (const auto& upTo : rounds) {
        for (const std::uint32_t last = upTo(x, y); first < last; ++first) {
            const SeenPoint& p = seen[first];
            if (p.object == 0 || p.gloss.kind == WEDGE_LAMBERT)
                continue;
            kind = kind == WEDGE_LAMBERT ? p.gloss.kind : kind;
            // Blinn-Phong's exponent is four times Phong's of the same width.
            sum += p.gloss.exponent * (p.gloss.kind == kind ? 1 : kind == WEDGE_PHONG ? 0.25 : 4);
            ++lobes;
        }
        if (lobes > 0)
            break;
    }
    const shared::Gloss gloss =
        lean ? shared::unpackGlossShort(shortOf(found.gloss, x, y, 0)) : shared::unpackGloss(found.gloss.at(x, y));
    REQUIRE(gloss.kind == kind);
    REQUIRE((lobes == 0 || nearTo(gloss.exponent, sum / lobes, lean ? 1.0 / 500 : 2e-5)));
}

/// What layers show: lean frames leave it as it was.
inline void requireLayers(const Accumulation& a, const SurfacesFound& found, int x, int y)
{
    const std::vector<SeenPoint> seen = a.seen(x, y), hit = hitsOf(seen);
    const double n = std::max<double>(1, static_cast<double>(seen.size())), h = static_cast<double>(hit.size());
    if (a.lean) {
        REQUIRE(found.diffuse.vector(x, y) == glm::dvec3(0));
        REQUIRE(found.specular.vector(x, y) == glm::dvec3(0));
        REQUIRE(found.distance.at(x, y) == 0);
        return;
    }
    REQUIRE(found.rays.at(x, y) == sumOf(seen, [](const SeenPoint& p) { return p.rays; }));
    REQUIRE(found.pathRays.at(x, y) == sumOf(seen, [](const SeenPoint& p) { return p.pathRays; }));
    REQUIRE(nearTo(found.diffuse.vector(x, y), sumOf(hit, [](const SeenPoint& p) { return p.diffuse; }) / n));
    REQUIRE(nearTo(found.specular.vector(x, y), sumOf(hit, [](const SeenPoint& p) { return p.specular; }) / n));
    const float distance = found.distance.at(x, y);
    if (!hit.empty()) {
        const shared::Vec3 eye = a.waves.params.eye;
        const glm::dvec3 mean = sumOf(hit, [](const SeenPoint& p) { return p.position; }) / h;
        REQUIRE(nearTo(distance, glm::distance(mean, glm::dvec3(eye.x, eye.y, eye.z))));
    } else if (!seen.empty()) {
        // As far as one of them went.
        REQUIRE(std::ranges::any_of(seen, [&](const SeenPoint& p) { return static_cast<float>(p.depth) == distance; }));
    }
}

/// Where a pixel's hits are and what they are.
inline void requirePlace(
    const Accumulation& a, const SurfacesFound& found, const std::vector<SeenPoint>& hit, bool oneWave, int x, int y)
{
    const double h = static_cast<double>(hit.size());
    REQUIRE(nearTo(found.position.vector(x, y), sumOf(hit, [](const SeenPoint& p) { return p.position; }) / h));
    // A unit vector is added to as if it were the sum: of much the same normals that makes little.
    const glm::dvec3 facing = glm::normalize(sumOf(hit, [](const SeenPoint& p) { return p.normal; }));
    const double packing = a.lean ? 0.5 * std::sqrt(3.0) / WEDGE_NORMAL_UNITS : 0;
    REQUIRE(glm::length(found.normal.vector(x, y) - facing) < (oneWave ? 1e-5 + packing : 1e-3 + 2 * packing));
}

/// The sum over a plane's elements: lean frames count rays for the wave's pixels.
inline std::uint32_t totalOf(const Planes<std::uint32_t>& plane)
{
    std::uint32_t out = 0;
    for (const std::uint32_t value : plane.values)
        out += value;
    return out;
}

/// What the pixels were like: all sorts are to be among them.
struct SurfaceKinds {
    int mixed = 0, missed = 0, motions[3] = {}, sharp = 0, nearer = 0, farther = 0;
};

/// Holds all pixels after those rounds against the points that they have seen.
inline SurfaceKinds requireSurfaces(
    Accumulation& a, const SurfacesFound& found, const Rounds& rounds, const Keeping& keeping)
{
    SurfaceKinds kinds;
    std::uint32_t rays = 0, pathRays = 0;
    a.waves.everyPixel([&](int x, int y) {
        CAPTURE(x);
        CAPTURE(y);
        const std::vector<SeenPoint> seen = a.seen(x, y), hit = hitsOf(seen);
        REQUIRE(found.taken.at(x, y) == seen.size());
        REQUIRE(found.hits.at(x, y) == hit.size());
        rays += sumOf(seen, [](const SeenPoint& p) { return p.rays; });
        pathRays += sumOf(seen, [](const SeenPoint& p) { return p.pathRays; });
        std::uint32_t expected = hit.empty() ? 0 : hit[0].object;
        for (const SeenPoint& p : hit)
            expected = p.object == hit[0].object ? expected : 0xffffffffu;
        REQUIRE(found.object.at(x, y) == expected);
        kinds.mixed += expected == 0xffffffffu ? 1 : 0;
        REQUIRE(nearTo(found.emission.vector(x, y), sumOf(seen, [](const SeenPoint& p) {
            return p.emission;
        }) / std::max<double>(1, static_cast<double>(seen.size()))));
        std::vector<SeenPoint> measured = seen;
        if (a.lean)
            measured.resize(rounds[0](x, y));
        requireMeasured(found, a.lean, measured, x, y);
        requireGloss(found, a.lean, seen, a.lean ? Rounds { rounds[0] } : rounds, x, y);
        requireLayers(a, found, x, y);
        if (seen.empty())
            return;
        const double nearest = requireConfusion(found, a.lean, seen, x, y);
        ++(nearest == 0 ? kinds.sharp : nearest > 0 ? kinds.nearer : kinds.farther);
        if (hit.empty()) {
            ++kinds.missed;
            return;
        }
        requirePlace(a, found, hit, rounds.size() == 1, x, y);
        if (!a.lean)
            requireMotion(found, hit, rounds.size() == 1, x, y);
        else if (keeping.motion)
            ++kinds.motions[static_cast<int>(requireOneMotion(a, found, rounds, x, y))];
        else
            REQUIRE(wordOf(found.motion.at(x, y)) == 0);
    });
    REQUIRE(totalOf(found.rays) == rays);
    REQUIRE(totalOf(found.pathRays) == pathRays);
    return kinds;
}

} // namespace wedge::test
