// wave_light.cl alone: the unshadowed shading of a wave's receivers, against means over the light in double.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/wave.h"
#include "tests/lamp.h"
#include "tests/pass_bench.h"
#include "tests/render_oracles.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::size_t receiverCount = 411; ///< not whole blocks
constexpr std::size_t planeSize = 432;
constexpr float untouched = -7;

struct ReceiverPoint {
    bool surface;
    glm::dvec3 position, normal, view;
    double specular, exponent;
    bool phong;
    double rise = -1; ///< at least 0: of microfacets
};

glm::dvec3 narrowed(glm::dvec3 v) { return glm::dvec3(glm::vec3(v)); }

/// As the kernel has it: packed.
void setView(ReceiverPoint& p, glm::dvec3 view)
{
    const auto packed = shared::unpackDirection(shared::packDirection(
        shared::vec3(static_cast<float>(view.x), static_cast<float>(view.y), static_cast<float>(view.z))));
    p.view = { packed.x, packed.y, packed.z };
}

/// At any distance from a light, from its own size on, facing it or not; lobes up to that exponent, most of them aimed
/// at the light.
ReceiverPoint randomReceiver(const scene::AreaLight& light, double sharpest, std::mt19937& random)
{
    ReceiverPoint p {};
    p.surface = random() % 7 != 0;
    const double distance = std::exp(uniform(random, std::log(0.7), std::log(12)));
    const glm::dvec3 away = glm::normalize(glm::dvec3(0, -0.5, 0) + unitVector(random));
    p.position = narrowed(glm::dvec3(light.centre) + distance * away);
    p.normal = narrowed(glm::normalize((random() % 3 == 0 ? 0.1 : 0.7) * -away + unitVector(random)));
    const glm::dvec3 aim = pointOf(light, uniform(random, -1, 1), uniform(random, -1, 1)) - p.position;
    const glm::dvec3 mirrored = glm::reflect(glm::normalize(-aim), p.normal);
    p.view = random() % 5 == 0 ? unitVector(random) : glm::normalize(mirrored + 0.1 * unitVector(random));
    p.specular = random() % 5 == 0 ? 0 : uniform(random, 0.1, 1);
    p.exponent = static_cast<float>(std::exp(uniform(random, 0, std::log(sharpest))));
    p.phong = random() % 2 == 0;
    setView(p, p.view);
    return p;
}

/// A mirror for the light's centre, far from it and at a low angle to both light and view.
ReceiverPoint grazingReceiver(const scene::AreaLight& light, double sharpest, std::mt19937& random)
{
    ReceiverPoint p = randomReceiver(light, sharpest, random);
    const glm::dvec3 away = p.position - glm::dvec3(light.centre);
    p.position = narrowed(glm::dvec3(light.centre) + uniform(random, 3, 8) * glm::normalize(away));
    const glm::dvec3 l = glm::normalize(glm::dvec3(light.centre) - p.position);
    const glm::dvec3 side = glm::normalize(glm::cross(l, unitVector(random)));
    const double elevation = uniform(random, 0.05, 0.4);
    p.normal = narrowed(std::sin(elevation) * l + std::cos(elevation) * side);
    setView(p, glm::normalize(glm::reflect(-l, p.normal) + 0.03 * unitVector(random)));
    return p;
}

/// The lobe in 1/sr; towards a light above the horizon.
double lobeOf(const ReceiverPoint& p, glm::dvec3 d)
{
    const glm::dvec3 l = glm::normalize(d), v = p.view, n = p.normal;
    const double m = p.exponent, pi = 3.14159265358979;
    if (!p.phong && p.rise >= 0) {
        // From below the horizon it is seen as from just above.
        const double below = std::max(WEDGE_LEAST_FACING - glm::dot(n, v), 0.0);
        const glm::dvec3 facing = glm::normalize(v + below * n), h = glm::normalize(facing + l);
        const double a = 4 / m, nh = glm::dot(n, h), nl = glm::dot(n, l), nv = glm::dot(n, facing);
        const auto root = [&](double c) { return std::sqrt(a + (1 - a) * c * c); };
        const double facets = a / (pi * std::pow((a - 1) * nh * nh + 1, 2));
        const double fresnel = 1 + p.rise * std::pow(1 - glm::dot(facing, h), 5);
        return 0.5 * facets * fresnel / (nl * root(nv) + nv * root(nl));
    }
    const double c =
        p.phong ? 2 * glm::dot(n, v) * glm::dot(n, l) - glm::dot(v, l) : glm::dot(n, glm::normalize(v + l));
    const double scale = p.phong ? (m + 2) / (2 * pi) : (m + 2) * (m + 4) / (8 * pi * (std::pow(2, -m / 2) + m));
    return c > 0 ? scale * std::pow(c, m) : 0;
}

/// Means over the light.
struct Shading {
    double diffuse = 0, specular = 0;
    bool horizon = false; ///< a part of the light is below the receiver's
};
Shading overLight(const scene::AreaLight& light, const ReceiverPoint& p)
{
    constexpr int steps = 200;
    Shading out;
    double weights = 0;
    bool dark = false, lit = false;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const double a = 2 * (i + 0.5) / steps - 1, b = 2 * (k + 0.5) / steps - 1;
            const glm::dvec3 d = pointOf(light, a, b) - p.position;
            const double g = geometry(p.normal, d, lightNormal(light), light.twoSided), weight = profileAt(light, a, b);
            (g > 0 ? lit : dark) = true;
            weights += weight;
            out.diffuse += weight * g;
            out.specular += g > 0 ? weight * g * lobeOf(p, d) : 0.0;
        }
    out.diffuse /= weights;
    out.specular /= weights;
    out.horizon = lit && dark;
    return out;
}

/// Largest half extent of the light over the distance to its centre.
double extentOver(const scene::AreaLight& light, const ReceiverPoint& p)
{
    const double extent = std::max(glm::length(glm::dvec3(light.halfU)), glm::length(glm::dvec3(light.halfV)));
    return extent / glm::length(glm::dvec3(light.centre) - p.position);
}

/// Squared extent of the light over the squared width of the lobe, as seen.
double lobesAcross(const scene::AreaLight& light, const ReceiverPoint& p)
{
    const double near = extentOver(light, p);
    const glm::dvec3 half = p.view + glm::normalize(glm::dvec3(light.centre) - p.position);
    const double across = near * near * p.exponent / (p.phong ? 1 : glm::dot(half, half));
    if (p.phong || p.rise < 0)
        return across;
    // Aside of their peak microfacets fall off slower.
    const double sine = glm::length(glm::cross(glm::normalize(half), p.normal));
    const double aside = std::max(0.0, sine - std::sqrt(2 * near * near / glm::dot(half, half)));
    return across / (1 + p.exponent / 4 * aside * aside);
}

/// About the geometry term of a light that faces a receiver, 1/m^2: lamp()'s larger half extent is 0.6 m.
double unclipped(double extent) { return extent * extent / 0.36; }

/// What there is in the scene besides diffuse reflection, which programs hang on.
enum class Reflects { Nothing, Lobes, Microfacets };

/// Of a frame in waves under one light.
DeclaredFrame frameUnder(const device::Device& device, const scene::AreaLight& light, Reflects reflects)
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.camera({ 0, 2, 3 }, { 0, 0, 0 });
    b.scene.areaLights = { light };
    if (reflects != Reflects::Nothing)
        b.scene.materials[0].specular = glm::vec3(0.3f);
    if (reflects == Reflects::Microfacets)
        b.scene.materials[0].specularModel = scene::SpecularModel::Ggx;
    render::Settings settings = sized(render::axisAligned(16), 16, 16);
    settings.antialias = true;
    return { device, b.scene, settings };
}

/// What the kernel finds: diffuse, and where the program has it specular.
std::vector<float> unshadowed(const device::Device& device, const scene::AreaLight& light,
    const std::vector<ReceiverPoint>& points, std::size_t count, Reflects reflects = Reflects::Lobes)
{
    DeclaredFrame frame = frameUnder(device, light, reflects);
    PassBench pass(frame, "unshadowedReceivers");
    const std::size_t size = pass.elements("objectId");
    REQUIRE(size >= planeSize);
    const auto fill = [&](const char* name, const auto& value) {
        std::vector<float> out(3 * size, std::nanf(""));
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t r = 0; r < points.size(); ++r)
                out[c * size + r] = static_cast<float>(value(points[r], static_cast<int>(c)));
        pass.plane(name, out);
    };
    fill("position", [](const ReceiverPoint& p, int c) { return p.position[c]; });
    fill("normal", [](const ReceiverPoint& p, int c) { return p.normal[c]; });
    fill("specular", [](const ReceiverPoint& p, int) { return p.specular; });
    // One pixel's receivers, the first to the last.
    std::vector<std::uint32_t> objects(size, 0), views(size, 0), glosses(size, 0), samples(size, 0);
    std::iota(samples.begin(), samples.end(), 0u);
    for (std::size_t r = 0; r < points.size(); ++r) {
        objects[r] = points[r].surface ? 5 : 0;
        const glm::vec3 v(points[r].view);
        const bool microfacets = !points[r].phong && points[r].rise >= 0;
        shared::Gloss gloss = shared::makeGloss(static_cast<float>(points[r].exponent),
            points[r].phong   ? WEDGE_PHONG
                : microfacets ? WEDGE_MICROFACETS
                              : WEDGE_BLINN_PHONG);
        gloss.rise = microfacets ? static_cast<float>(points[r].rise) : 0.0f;
        glosses[r] = shared::packGloss(gloss);
        views[r] = shared::packDirection(shared::vec3(v.x, v.y, v.z));
    }
    pass.plane("objectId", objects);
    pass.plane("view", views);
    pass.plane("gloss", glosses);
    pass.plane("sampleOf", samples);
    pass.plane("pixelOf", std::vector<std::uint32_t>(size, 7));
    pass.plane("unshadowed", std::vector(2 * size, untouched));
    shared::FrameParams params {};
    params.tileCount = 1;
    shared::WaveParams wave {};
    wave.receivers = static_cast<std::uint32_t>(count);
    wave.planeSize = static_cast<std::uint32_t>(size);
    pass.value("frame", params);
    pass.value("wave", wave);
    pass.items((count + WEDGE_BLOCK_PIXELS - 1) / WEDGE_BLOCK_PIXELS);
    pass.run();
    const auto read = pass.read<float>("unshadowed");
    std::vector<float> out(2 * planeSize);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = read[i / planeSize * size + i % planeSize];
    return out;
}

/// Of its lobe, normalized.
double peakOf(const ReceiverPoint& p) { return (p.exponent + 2) * (p.phong ? 1 : 0.25) / (2 * 3.14159265358979); }

/// Rules that serve a receiver's lobe.
struct LobeRule {
    bool clipped, sampled, fine, medium;
};

LobeRule ruleOf(const scene::AreaLight& light, const ReceiverPoint& p, bool horizon)
{
    const double near = extentOver(light, p), across = lobesAcross(light, p);
    const bool steady = p.phong || glm::dot(p.view, glm::normalize(glm::dvec3(light.centre) - p.position)) > -0.875;
    const double profile = light.profile == scene::LightProfile::Gaussian ? light.cut * light.cut : 0;
    const bool clipped = horizon && steady && near < 0.5 && profile <= 9 && across + profile < 14;
    // About where the light is nearer than one of its half extents the fitted rule serves.
    const bool fitted = near > 0.4 || (horizon && !clipped);
    return { clipped, across > 40 || (fitted && across > 10), !fitted && !clipped && across > 14 && across < 40,
        !fitted && !clipped && across > 4 && across < 14 };
}

template <class Visit>
void everyLight(const Visit& visit)
{
    for (const scene::LightProfile profile : { scene::LightProfile::Gaussian, scene::LightProfile::Uniform })
        for (const bool twoSided : { false, true }) {
            CAPTURE(twoSided);
            CAPTURE((profile == scene::LightProfile::Gaussian));
            visit(lamp(profile, twoSided));
        }
}

} // namespace

TEST_CASE("receivers that hit nothing get no shading, and nothing is written beyond the wave's blocks")
{
    onEveryDevice([](const device::Device& device) {
        const scene::AreaLight light = lamp(scene::LightProfile::Uniform, true);
        std::mt19937 random(1);
        std::vector<ReceiverPoint> points;
        for (std::size_t r = 0; r < planeSize; ++r) {
            points.push_back(randomReceiver(light, 10, random));
            points.back().surface = r == 3;
        }
        for (const std::size_t count : { std::size_t { 1 }, std::size_t { 16 }, std::size_t { 37 } })
            for (const Reflects reflects : { Reflects::Nothing, Reflects::Lobes }) {
                const std::vector<float> found = unshadowed(device, light, points, count, reflects);
                const std::size_t written = (count + 15) / 16 * 16;
                for (std::size_t r = 0; r < planeSize; ++r) {
                    if (r >= written)
                        REQUIRE(found[r] == untouched);
                    else if (r != 3)
                        REQUIRE(found[r] == 0);
                    REQUIRE((reflects == Reflects::Lobes && r < written) == (found[planeSize + r] != untouched));
                }
            }
    });
}

TEST_CASE("diffuse: the mean geometry term over the light, near, far and partly below the horizon")
{
    onEveryDevice([](const device::Device& device) {
        unsigned seed = 10;
        const auto check = [&](const scene::AreaLight& light) {
            std::mt19937 random(++seed);
            std::vector<ReceiverPoint> points;
            while (points.size() < receiverCount)
                points.push_back(randomReceiver(light, 10, random));
            const std::vector<float> found = unshadowed(device, light, points, receiverCount, Reflects::Nothing);
            int lit = 0, horizons = 0, close = 0, far = 0;
            for (std::size_t r = 0; r < receiverCount; ++r) {
                const Shading expected = overLight(light, points[r]);
                if (!points[r].surface) {
                    REQUIRE(found[r] == 0);
                    continue;
                }
                const double near = extentOver(light, points[r]);
                // Of a horizon across the light the midpoints above have an error, too.
                const double tolerance = near > 1.0 / 3 ? 2e-3 : 5e-4;
                REQUIRE(std::fabs(found[r] - expected.diffuse)
                    <= tolerance * expected.diffuse + (expected.horizon ? 1e-4 * unclipped(near) : 0.0) + 1e-9);
                lit += expected.diffuse > 0 ? 1 : 0;
                horizons += expected.horizon ? 1 : 0;
                close += near > 0.5 ? 1 : 0;
                // Of few plain nodes over what is above the horizon, where these serve the light's profile.
                far += expected.horizon && near < 0.5 ? 1 : 0;
            }
            CHECK(lit > 150);
            CHECK(horizons > 30);
            CHECK(close > 40);
            CHECK(far > 20);
        };
        everyLight(check);
        // Profiles that fall off within a part of the light.
        for (const float cut : { 1.0f, 3.0f, 4.0f, 6.0f }) {
            CAPTURE(cut);
            scene::AreaLight light = lamp(scene::LightProfile::Gaussian, false);
            light.cut = cut;
            check(light);
        }
    });
}

TEST_CASE("receivers of a pixel that see one point share out the lobe's directions: their mean is the integral")
{
    // What stands still, and in focus, while something else moves.
    onEveryDevice([](const device::Device& device) {
        const scene::AreaLight light = lamp(scene::LightProfile::Gaussian, false);
        std::mt19937 random(5);
        for (int k = 0; k < 12; ++k) {
            ReceiverPoint p = randomReceiver(light, 1000, random);
            while (!p.surface || p.specular == 0 || lobesAcross(light, p) < 41 || overLight(light, p).horizon)
                p = randomReceiver(light, 1000, random);
            const std::vector<ReceiverPoint> same(receiverCount, p);
            const std::vector<float> found = unshadowed(device, light, same, receiverCount);
            double mean = 0;
            for (std::size_t r = 0; r < receiverCount; ++r)
                mean += found[planeSize + r] / receiverCount;
            const Shading expected = overLight(light, p);
            const double peak = peakOf(p);
            CAPTURE(p.exponent);
            CAPTURE(mean);
            CAPTURE(expected.specular);
            CHECK(std::fabs(mean - expected.specular) <= 0.003 * (expected.specular + 0.1 * peak * expected.diffuse));
        }
    });
}

TEST_CASE("specular: the mean of lobe times geometry term, of both models, by a rule or by directions of the lobe")
{
    onEveryDevice([](const device::Device& device) {
        unsigned seed = 20;
        everyLight([&](const scene::AreaLight& light) {
            for (const double sharpest : { 20.0, 1000.0 }) {
                CAPTURE(sharpest);
                std::mt19937 random(++seed);
                std::vector<ReceiverPoint> points;
                while (points.size() < receiverCount)
                    points.push_back(points.size() % 2 == 0 ? randomReceiver(light, sharpest, random)
                                                            : grazingReceiver(light, sharpest, random));
                const std::vector<float> found = unshadowed(device, light, points, receiverCount);
                int sharp = 0, bright = 0, few = 0, medium = 0, fine = 0;
                double error = 0, total = 0;
                for (std::size_t r = 0; r < receiverCount; ++r) {
                    const ReceiverPoint& p = points[r];
                    const double near = extentOver(light, p), across = lobesAcross(light, p);
                    if (!p.surface || p.specular == 0 || std::fabs(across - 40) < 0.01)
                        continue;
                    const float value = found[planeSize + r];
                    const Shading expected = overLight(light, p);
                    // Against a light all above the horizon and at the lobe's peak.
                    const double peak = peakOf(p);
                    const double scale = peak * (expected.horizon ? unclipped(near) : expected.diffuse);
                    REQUIRE(value >= 0);
                    // Directions of sharp lobes are but a few for each receiver, whose errors are their own.
                    const LobeRule rule = ruleOf(light, p, expected.horizon);
                    const double tolerance = rule.sampled ? 1.0 : 4e-3;
                    CAPTURE(across);
                    CAPTURE(near);
                    CAPTURE(expected.horizon);
                    CAPTURE(value);
                    CAPTURE(expected.specular);
                    CAPTURE(scale);
                    CHECK(std::fabs(value - expected.specular) <= tolerance * scale + 1e-9);
                    if (across > 40) {
                        ++sharp;
                        error += value - expected.specular;
                        total += expected.specular;
                    }
                    bright += expected.specular > 0.1 * scale ? 1 : 0;
                    few += near < 0.25 && across < 1.5 ? 1 : 0;
                    medium += rule.medium ? 1 : 0;
                    fine += rule.fine ? 1 : 0;
                }
                CHECK(bright > 90);
                CHECK(few > 50);
                CHECK((medium > 10 || sharpest < 1000));
                CHECK((fine > 5 || sharpest < 1000));
                CHECK((sharp > 15 || sharpest < 1000));
                CHECK((std::fabs(error) <= 0.03 * total || sharpest < 1000));
            }
        });
    });
}

TEST_CASE("highlights of lights cut by the horizon: as good as their rule, whatever the profile")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [profile, cut] : { std::pair(scene::LightProfile::Uniform, 2.0f),
                 { scene::LightProfile::Gaussian, 2.0f }, { scene::LightProfile::Gaussian, 3.0f } }) {
            scene::AreaLight light = lamp(profile, true);
            light.cut = cut;
            std::mt19937 random(31);
            std::vector<ReceiverPoint> points;
            constexpr std::size_t different = 80;
            while (points.size() < different) {
                ReceiverPoint p = randomReceiver(light, 20, random);
                const double across = lobesAcross(light, p);
                if (!p.surface || p.specular == 0 || !(across > 0))
                    continue;
                p.exponent = static_cast<float>(p.exponent * uniform(random, 4.0, 13.9) / across);
                const Shading expected = overLight(light, p);
                if (p.exponent >= 1 && extentOver(light, p) < 0.45 && expected.horizon
                    && expected.specular > 0.05 * peakOf(p) * unclipped(extentOver(light, p)))
                    points.push_back(p);
            }
            points.resize(receiverCount, points.back());
            const std::vector<float> found = unshadowed(device, light, points, receiverCount);
            int ruled = 0;
            for (std::size_t r = 0; r < different; ++r) {
                const ReceiverPoint& p = points[r];
                const double near = extentOver(light, p), across = lobesAcross(light, p);
                const Shading expected = overLight(light, p);
                if (ruleOf(light, p, true).sampled)
                    continue;
                ++ruled;
                CAPTURE(light.cut);
                CAPTURE(near);
                CAPTURE(across);
                CAPTURE(p.phong);
                CAPTURE(found[planeSize + r] / expected.specular);
                CHECK(std::fabs(found[planeSize + r] - expected.specular) <= 1.5e-3 * expected.specular);
            }
            CHECK(ruled > 30);
        }
    });
}

TEST_CASE("specular: the mean of a microfacet lobe times geometry term, by a rule or by directions of the lobe")
{
    onEveryDevice([](const device::Device& device) {
        unsigned seed = 40;
        everyLight([&](const scene::AreaLight& light) {
            std::mt19937 random(++seed);
            std::vector<ReceiverPoint> points;
            while (points.size() < receiverCount) {
                points.push_back(
                    points.size() % 2 == 0 ? randomReceiver(light, 20, random) : grazingReceiver(light, 20, random));
                // The exponents of roughnesses from 0.2 to 1; some beside Phong's.
                ReceiverPoint& p = points.back();
                p.phong = points.size() % 9 == 0;
                p.exponent = p.phong ? p.exponent : 4 / std::pow(uniform(random, 0.2, 1), 4);
                p.rise = p.phong ? 0 : uniform(random, 0, 20);
            }
            const std::vector<float> found = unshadowed(device, light, points, receiverCount, Reflects::Microfacets);
            int sharp = 0, bright = 0;
            double error = 0, squares = 0, total = 0, worst = 0;
            for (std::size_t r = 0; r < receiverCount; ++r) {
                const ReceiverPoint& p = points[r];
                if (!p.surface || p.specular == 0)
                    continue;
                const float value = found[planeSize + r];
                const Shading expected = overLight(light, p);
                const double near = extentOver(light, p), across = lobesAcross(light, p);
                const double scale = peakOf(p) * (expected.horizon ? unclipped(near) : expected.diffuse);
                const LobeRule rule = ruleOf(light, p, expected.horizon);
                const bool ahead = glm::dot(p.normal, p.view) > 0.02; // the rule above is not of lifted views
                CAPTURE(across);
                CAPTURE(near);
                CAPTURE(p.exponent);
                CAPTURE(p.rise);
                CAPTURE(expected.horizon);
                CAPTURE(scale);
                REQUIRE(value >= 0);
                const bool sampled = rule.sampled || std::fabs(across - 40) < 0.1 || std::fabs(across - 10) < 0.1;
                if (ahead && sampled) {
                    ++sharp;
                    error += value - expected.specular;
                    squares += (value - expected.specular) * (value - expected.specular);
                    total += expected.specular;
                } else if (ahead) {
                    worst = std::max(worst, std::fabs(value - expected.specular) / (expected.specular + 0.02 * scale));
                    CHECK(std::fabs(value - expected.specular) <= 4e-3 * (expected.specular + 0.02 * scale) + 1e-9);
                }
                bright += ahead && !sampled && expected.specular > 0.1 * scale ? 1 : 0;
            }
            MESSAGE("largest error of a rule: " << worst);
            CHECK(bright > 60);
            CHECK(sharp > 15);
            // Directions of lobes are random: 3 standard deviations of the sum, and that is of what there is.
            CHECK(std::fabs(error) <= 3 * std::sqrt(squares) + 1e-3 * total);
            CHECK(std::sqrt(squares) <= 0.1 * total);
        });
    });
}
