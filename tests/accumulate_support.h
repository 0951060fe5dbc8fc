// Made-up receivers, waves of them, and the pixels that accumulate.cl adds them to.
#pragma once

#include "kernels/shared/camera.h"
#include "tests/packed_support.h"
#include "tests/wave_support.h"

#include <functional>
#include <limits>
#include <vector>

namespace wedge::test {

/// What one primary sample of a pixel sees.
struct SeenPoint {
    std::uint32_t object; ///< 0: nothing
    glm::dvec3 diffuse, specular, emission, position, normal;
    shared::Gloss gloss;
    double pixelSize, depth;
    glm::dvec2 motion;
    std::uint32_t rays, pathRays;
    double weight[2], visible[2]; ///< of a light's samples there: mean weight, diffuse and specular; visible fractions
    double unshadowed[2]; ///< what the weights estimate; specular -1 where that is not known
    double slopes[6]; ///< least and largest, 0 where no ray was occluded; sums of shadows' motions
    glm::dvec3 irradiance; ///< of a path's samples: mean
    double reflectors[3];
};

/// Which receivers there are: all sorts, only surfaces that are lit and not black, or some where more light arrives the
/// brighter they are.
enum class Receivers { All, LitSurfaces, Related };

/// Makes light go with the texture, in each channel another way; the weights are right in the mean.
inline void relate(SeenPoint* p, std::mt19937& random)
{
    p->irradiance = 3.0 * p->diffuse * glm::dvec3(1, 0.5, 2);
    p->visible[0] = p->diffuse.x > 0.5 ? 0.9 : 0.1;
    p->visible[1] = p->specular.z > 0.25 ? 0.1 : 0.8;
    p->unshadowed[0] = 0.2 + p->diffuse.y;
    p->unshadowed[1] = 2 - p->specular.x;
    for (int k = 0; k < 2; ++k)
        p->weight[k] = p->unshadowed[k] * uniform(random, 0.5, 1.5);
}

/// The same for a pixel and index at each call.
inline SeenPoint seenPoint(Receivers kind, int x, int y, std::uint32_t index)
{
    std::mt19937 random(static_cast<unsigned>(x) * 7919u + static_cast<unsigned>(y) * 104729u + index * 1299709u + 1u);
    random.discard(4);
    const auto vector = [&](double lo, double hi) {
        return glm::dvec3(uniform(random, lo, hi), uniform(random, lo, hi), uniform(random, lo, hi));
    };
    const bool all = kind == Receivers::All, related = kind == Receivers::Related;
    SeenPoint p {};
    p.object = kind != Receivers::LitSurfaces && random() % 5 == 0
        ? 0
        : 1 + static_cast<std::uint32_t>(random() % (x % 2 == 0 ? 2 : 1));
    p.diffuse = all && random() % 6 == 0 ? glm::dvec3(0) : vector(0.05, 0.9);
    p.specular = all && random() % 3 == 0 ? glm::dvec3(0) : vector(0, 0.5);
    p.emission = vector(0, 2);
    p.position = vector(-1, 1) + glm::dvec3(x, y, -5);
    p.normal = glm::normalize(glm::dvec3(0.1, 0.9, 0.2) + 0.05 * unitVector(random));
    const auto exponent = static_cast<float>(uniform(random, 1, 30));
    p.gloss = shared::makeGloss(exponent,
        p.specular == glm::dvec3(0) ? WEDGE_LAMBERT
            : index % 2 == 0        ? WEDGE_PHONG
                                    : WEDGE_BLINN_PHONG);
    p.pixelSize = uniform(random, 0.01, 0.1);
    p.depth = p.object == 0 && random() % 2 == 0 ? std::numeric_limits<double>::infinity() : uniform(random, 1, 9);
    p.motion = { uniform(random, -3, 3), uniform(random, -3, 3) };
    p.rays = static_cast<std::uint32_t>(random() % 20);
    p.pathRays = static_cast<std::uint32_t>(random() % 10);
    const bool lit = !all || random() % 4 != 0;
    for (int k = 0; k < 2; ++k) {
        p.weight[k] = lit ? uniform(random, 0.1, 2) : 0;
        p.visible[k] = random() % 4 == 0 ? 0 : uniform(random);
    }
    p.slopes[0] = random() % 3 == 0 ? 0 : uniform(random, 0.1, 2);
    p.slopes[1] = p.slopes[0] > 0 ? p.slopes[0] + uniform(random) : 0;
    p.irradiance = random() % 7 == 0 ? glm::dvec3(0) : vector(0, 3);
    p.reflectors[0] = random() % 3 == 0 ? 0 : uniform(random, 0.1, 2);
    p.reflectors[1] = p.reflectors[0] > 0 ? p.reflectors[0] + uniform(random) : 0;
    p.reflectors[2] = p.reflectors[0] > 0 ? uniform(random, 0.5, 5) : 0;
    for (auto& unshadowed : p.unshadowed)
        unshadowed = lit ? uniform(random, 0.1, 2) : 0;
    if (all && random() % 3 == 0)
        p.unshadowed[1] = -1;
    for (int k = 2; k < 6; ++k)
        p.slopes[k] = uniform(random);
    if (related)
        relate(&p, random);
    return p;
}

/// The pixels of an image while primary samples are added to them in waves.
class Accumulation {
public:
    static constexpr float elsewhere = -7.0f; ///< what planes hold beside the window

    Accumulation(const device::Device& device, int width, int height, image::Window window, Receivers receivers,
        const Defines& defines = {})
        : waves(device, width, height, window, defines)
        , taken(waves.layout, 1, 0u)
        , wanted(waves.layout, 1, 0u)
        , primaryTaken(waves.bench.buffer(taken.values))
        , hits(waves.bench.filled(waves.layout.size, 0u))
        , lists(waves.oneWave(taken, taken))
        , kind(receivers)
        , objectId(waves.bench.filled(1, 0u))
    {
    }

    /// The next wave: pixels get samples up to those numbers.
    void begin(const std::function<std::uint32_t(int, int)>& upTo)
    {
        waves.everyPixel([&](int x, int y) { wanted.at(x, y) = upTo(x, y); });
        lists = waves.oneWave(taken, wanted);
        lists.wave.published = published;
        lists.wave.oneVelocity = oneVelocity;
        points.clear();
        for (std::size_t r = 0; r < lists.wave.receivers; ++r)
            points.push_back(seenPoint(kind, lists.x(r), lists.y(r), lists.samples[r]));
        objectId = receiverBuffer<std::uint32_t>(1, [](const SeenPoint& p, std::size_t) { return p.object; });
    }
    /// In frames of one image the first wave alone measures.
    void end()
    {
        measures = measures && !once();
        waves.everyPixel([&](int x, int y) { taken.at(x, y) = std::max(taken.at(x, y), wanted.at(x, y)); });
    }

    /// Planes of the wave with value(point, plane) in each receiver.
    template <class T, class Value>
    device::Buffer<T> receiverBuffer(std::size_t planes, const Value& value)
    {
        std::vector<T> out(planes * lists.wave.planeSize);
        for (std::size_t plane = 0; plane < planes; ++plane)
            for (std::size_t r = 0; r < points.size(); ++r)
                out[plane * lists.wave.planeSize + r] = static_cast<T>(value(points[r], plane));
        return waves.bench.buffer(out);
    }
    template <class Value>
    device::Buffer<float> vectors(const Value& value)
    {
        return receiverBuffer<float>(
            3, [&](const SeenPoint& p, std::size_t c) { return value(p)[static_cast<int>(c)]; });
    }

    device::Buffer<std::uint32_t> glosses()
    {
        return receiverBuffer<std::uint32_t>(
            1, [](const SeenPoint& p, std::size_t) { return shared::packGloss(p.gloss); });
    }

    /// Samples that a receiver has of a term whose pixels go from `before` to `after`.
    std::uint32_t shareOf(std::size_t r, const Planes<std::uint32_t>& before, const Planes<std::uint32_t>& after) const
    {
        const std::uint64_t index = lists.shares[r] & 0xffffu, count = lists.shares[r] >> 16;
        const std::uint64_t all = after.at(lists.x(r), lists.y(r)) - before.at(lists.x(r), lists.y(r));
        // All get the same, and the first ones one of those that are left each.
        return static_cast<std::uint32_t>(all / count + (index < all % count ? 1 : 0));
    }

    /// Planes of sums over the samples that receivers have of a term whose pixels go from `before` to `after`.
    template <class Value>
    device::Buffer<float> sums(
        std::size_t planes, const Planes<std::uint32_t>& before, const Planes<std::uint32_t>& after, const Value& mean)
    {
        std::vector<float> out(planes * lists.wave.planeSize);
        for (std::size_t r = 0; r < points.size(); ++r) {
            const double own = shareOf(r, before, after);
            for (std::size_t plane = 0; plane < planes; ++plane)
                out[plane * lists.wave.planeSize + r] = static_cast<float>(own * mean(points[r], plane));
        }
        return waves.bench.buffer(out);
    }

    /// What planes hold beside the window. In fewer bits what is beside it in one layout is in it in the other.
    float beside() const { return lean ? 0.0f : elsewhere; }

    /// A pixel's planes: 0 in the window.
    device::Buffer<float> pixelBuffer(std::size_t planes)
    {
        Planes<float> out(waves.layout, planes, beside());
        for (std::size_t plane = 0; plane < planes; ++plane)
            waves.everyPixel([&](int x, int y) { out.at(x, y, plane) = 0; });
        return waves.bench.buffer(out.values);
    }
    template <class T>
    Planes<T> read(const device::Buffer<T>& buffer)
    {
        return planesOf(waves.layout, waves.bench.read(buffer));
    }

    /// Launches a kernel of accumulate.cl over the wave's pixels. It is handed the frame, the wave and its lists, too.
    template <class... Lists>
    void launch(const std::string& kernel, const Lists&... more)
    {
        std::vector<Handed> handed { value("frame", waves.params), value("wave", lists.wave),
            plane("pixelFirst", lists.pixelFirst), plane("pixelCount", lists.pixelCount),
            plane("taken", primaryTaken) };
        (handed.insert(handed.end(), more.begin(), more.end()), ...);
        launchDeclared(waves.bench, { "waves/accumulate.cl", kernel },
            std::size_t { lists.wave.tiles } * WEDGE_TILE_PIXELS, handed);
    }
    /// As frames keep a number, normals and colours of so many bits.
    graph::Format number() const { return lean ? render::shortFloats : graph::floats; }
    graph::Format hitCounts() const { return lean ? render::shortCounts : graph::counts; }
    static graph::Format colour(std::uint32_t bits)
    {
        return bits == plainBits ? graph::vectors
            : bits == colourBits ? render::packedColours
                                 : render::packedFractions;
    }

    /// All points that a pixel has seen.
    std::vector<SeenPoint> seen(int x, int y) const
    {
        std::vector<SeenPoint> out;
        for (std::uint32_t k = 0; k < taken.at(x, y); ++k)
            out.push_back(seenPoint(kind, x, y, k));
        return out;
    }

    WaveBench waves;
    Planes<std::uint32_t> taken, wanted; ///< primary samples before and after the wave
    device::Buffer<std::uint32_t> primaryTaken, hits; ///< as accumulateSurfaces keeps them
    WaveLists lists;
    Receivers kind;

    std::uint32_t published = 0; ///< as of WaveParams
    bool lean = false; ///< in fewer bits, as frames of one image have it; set it before there are planes
    bool steps = false; ///< likewise, as frames that go on with it have it
    bool once() const { return lean && !steps; }
    bool measures = true; ///< the wave to come
    bool moves = true; ///< there are planes of motions
    float oneVelocity = 0.1f;
    std::vector<SeenPoint> points; ///< of the wave's receivers
    device::Buffer<std::uint32_t> objectId;
};

/// The image and the window of it that the tests fill.
constexpr int width = 29, height = 19;
const image::Window window { 3, 2, 28, 17 };
/// How many samples pixel (x, y) has after each of its rounds.
using Rounds = std::vector<std::function<std::uint32_t(int, int)>>;
inline std::uint32_t total(int x, int y) { return static_cast<std::uint32_t>((x * 5 + y * 3) % 10); }
inline const Rounds oneRound = { total };
inline const Rounds threeRounds = { [](int x, int y) { return total(x, y) / 3; },
    [](int x, int y) { return total(x, y) * 2 / 3; }, total };
/// The planes that accumulateSurfaces fills.
struct SurfacePixels {
    device::Buffer<std::uint32_t> object, rays, pathRays, gloss;
    device::Buffer<float> position, normal, diffuse, specular, emission, emissionSquares, pixelSize, distance,
        confusion, motion, motionSpread;
    explicit SurfacePixels(Accumulation& a)
        : object(a.waves.bench.filled(a.waves.layout.size, 0u))
        , rays(a.waves.bench.filled(a.waves.layout.size, 0u))
        , pathRays(a.waves.bench.filled(a.waves.layout.size, 0u))
        , gloss(a.waves.bench.filled(a.waves.layout.size, 0u))
        , position(a.pixelBuffer(3))
        , normal(a.pixelBuffer(3))
        , diffuse(a.pixelBuffer(3))
        , specular(a.pixelBuffer(3))
        , emission(a.pixelBuffer(3))
        , emissionSquares(a.pixelBuffer(1))
        , pixelSize(a.pixelBuffer(1))
        , distance(a.pixelBuffer(1))
        , confusion(a.pixelBuffer(2))
        , motion(a.pixelBuffer(2))
        , motionSpread(a.pixelBuffer(1))
    {
    }
};

inline shared::CameraParams lens()
{
    shared::CameraParams c {};
    c.apertureRadius = 0.05f;
    c.focusDistance = 4;
    c.pixelStep = 0.01f;
    return c;
}

inline void accumulateSurfaces(Accumulation& a, SurfacePixels& out, const shared::CameraParams& camera = lens())
{
    const auto single = [&](const auto& value) {
        return a.receiverBuffer<float>(1, [&](const SeenPoint& p, std::size_t) { return value(p); });
    };
    const bool layers = !a.lean, spread = a.moves && !a.lean;
    a.launch("accumulateSurfaces",
        std::vector { value("camera", camera), value("raysOfImage", layers ? 1u : 0u), plane("objectId", a.objectId),
            vectors("position", a.vectors([](const SeenPoint& p) { return p.position; })),
            vectors("normal", a.vectors([](const SeenPoint& p) { return p.normal; })), plane("gloss", a.glosses()),
            vectors("diffuse", a.vectors([](const SeenPoint& p) { return p.diffuse; })),
            vectors("specular", a.vectors([](const SeenPoint& p) { return p.specular; })),
            vectors("emission", a.vectors([](const SeenPoint& p) { return p.emission; })),
            plane("pixelSize", single([](const SeenPoint& p) { return p.pixelSize; })),
            plane("depth", single([](const SeenPoint& p) { return p.depth; })),
            plane("motion",
                a.receiverBuffer<float>(
                    2, [](const SeenPoint& p, std::size_t axis) { return p.motion[static_cast<int>(axis)]; }),
                graph::pairs),
            plane("rays", a.receiverBuffer<std::uint32_t>(1, [](const SeenPoint& p, std::size_t) { return p.rays; })),
            plane("pathRays",
                a.receiverBuffer<std::uint32_t>(1, [](const SeenPoint& p, std::size_t) { return p.pathRays; })) },
        group("kept",
            { plane("hits", a.hits, a.hitCounts()), plane("objectId", out.object), vectors("position", out.position),
                plane("normal", out.normal, a.lean ? render::packedNormals : graph::vectors),
                onlyIf(a.measures, plane("gloss", out.gloss, a.lean ? render::shortGloss : render::wholeGloss)),
                onlyIf(layers, vectors("diffuse", out.diffuse)), onlyIf(layers, vectors("specular", out.specular)),
                vectors("emission", out.emission), onlyIf(a.measures, plane("emissionSquares", out.emissionSquares)),
                onlyIf(a.measures, plane("pixelSize", out.pixelSize, a.number())),
                onlyIf(layers, plane("distance", out.distance)),
                plane("confusion", out.confusion, a.lean ? render::shortRanges : graph::pairs),
                onlyIf(a.moves, plane("motion", out.motion, a.lean ? render::shortPairs : graph::pairs)),
                onlyIf(spread, plane("motionSpread", out.motionSpread)), plane("rays", out.rays),
                plane("pathRays", out.pathRays) }));
    a.end();
}

/// Sums over receivers.
template <class Value>
auto sumOf(const std::vector<SeenPoint>& points, const Value& value)
{
    decltype(value(points[0])) sum {};
    for (const SeenPoint& p : points)
        sum += value(p);
    return sum;
}

/// Beside the window nothing was written.
inline void checkElsewhere(const Accumulation& a, const Planes<float>& plane)
{
    for (int x = 0; x < width; ++x)
        REQUIRE(plane.at(x, window.y1) == a.beside());
    for (int y = 0; y < height; ++y)
        REQUIRE(plane.at(window.x0 - 1, y) == a.beside());
    REQUIRE(a.waves.window.x1 == window.x1);
}

/// Whether each of three planes is near to a vector.
inline bool nearTo(glm::dvec3 found, glm::dvec3 expected, double relative = 2e-5)
{
    return glm::length(found - expected) <= relative * glm::length(expected) + 1e-6;
}
inline bool nearTo(double found, double expected, double relative = 2e-5)
{
    return std::fabs(found - expected) <= relative * std::fabs(expected) + 1e-6;
}

} // namespace wedge::test
