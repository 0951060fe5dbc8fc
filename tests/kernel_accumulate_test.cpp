// accumulate.cl alone, area lights: what pixels hold after whatever waves of receivers, of which each has samples or
// not.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "tests/accumulate_oracle.h"

#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

shared::AreaLight lamp()
{
    shared::AreaLight light {};
    light.power = shared::vec3(3, 2, 1);
    return light;
}
const glm::dvec3 power(3, 2, 1);

struct LightCase {
    bool exact, specular;
    TermCount count;
};

/// Reflected radiance at those weights, diffuse and specular.
glm::dvec3 reflected(const SeenPoint& p, const LightCase& how, double diffuse, double specular)
{
    if (p.object == 0)
        return glm::dvec3(0);
    return power * (p.diffuse * (diffuse / std::numbers::pi) + (how.specular ? p.specular * specular : glm::dvec3(0)));
}

/// The mean weight over receivers with samples, each as much as it reflects.
double meanWeight(const std::vector<TermSample>& wave, int k)
{
    double weights = 0, reflectances = 0;
    for (const TermSample& s : wave)
        if (s.point.object != 0 && s.samples > 0) {
            const double own = luminanceOf(k == 0 ? s.point.diffuse : s.point.specular);
            weights += own * s.point.weight[k];
            reflectances += own;
        }
    return reflectances > 0 ? weights / reflectances : 0;
}

/// What a pixel's receivers add of a light that is not as published.
void lightSamples(std::vector<TermSample>& wave, const LightCase& how)
{
    const bool anySampled =
        std::ranges::any_of(wave, [](const TermSample& s) { return s.point.object != 0 && s.samples > 0; });
    const double diffuse = meanWeight(wave, 0), specular = meanWeight(wave, 1);
    for (TermSample& s : wave) {
        const SeenPoint& p = s.point;
        if (p.object == 0)
            continue;
        const double none = s.samples > 0 ? 1 : 0;
        const bool exactLobe = how.exact && p.unshadowed[1] >= 0;
        const double d = how.exact ? p.unshadowed[0] : none > 0 ? p.weight[0] : diffuse;
        const double g = exactLobe ? p.unshadowed[1] : none > 0 ? p.weight[1] : specular;
        s.known = none > 0 || anySampled || (how.exact && (!how.specular || exactLobe));
        s.texture = reflected(p, how, d, g);
        s.weights = none * s.samples * reflected(p, how, p.weight[0], p.weight[1]);
        const glm::dvec3 seen = reflected(p, how, p.weight[0] * p.visible[0], p.weight[1] * p.visible[1]);
        const glm::dvec3 sampled = reflected(p, how, p.weight[0], p.weight[1]);
        for (int c = 0; c < 3; ++c)
            s.irradiance[c] = sampled[c] > 0 ? seen[c] / sampled[c] : 0;
        s.plain = luminanceOf(sampled) > 0 ? luminanceOf(seen) / luminanceOf(sampled) : 0;
        s.radiance = how.exact ? s.texture * s.plain : seen;
    }
}

Defines definesOf(bool specular, bool motion = false)
{
    Defines out;
    if (specular)
        out.push_back({ "WEDGE_SPECULAR", "1" });
    if (motion)
        out.push_back({ "WEDGE_MOTION", "1" });
    return out;
}

void addWave(Accumulation& a, TermPixels& term, const LightCase& how, bool motion)
{
    term.light = true;
    term.begin(a);
    term.expectExtremes(
        a, [](const SeenPoint& p) { return p.slopes; }, motion ? 6 : 2);
    term.expect(a, [&](std::vector<TermSample>& wave) { lightSamples(wave, how); });
    accumulateLight(a, term, lamp(), how.exact, how.specular);
}

TermPixels accumulated(Accumulation& a, const Rounds& rounds, const LightCase& how, bool motion)
{
    TermPixels term(a, how.count);
    term.moves = motion;
    SurfacePixels surfaces(a);
    for (const auto& upTo : rounds) {
        a.begin(upTo);
        addWave(a, term, how, motion);
        accumulateSurfaces(a, surfaces);
    }
    return term;
}

} // namespace

TEST_CASE(
    "lights: the means over receivers, each with samples, few with some, or a wave without any; lean and in steps, "
    "too")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool exact : { false, true })
            for (const bool specular : { false, true })
                for (const TermCount count : { more, oneEach, fewer, skipping })
                    for (const Rounds& rounds : { oneRound, threeRounds }) {
                        // Without a second round it skips none.
                        if (rounds.size() == 1 && count == skipping)
                            continue;
                        for (const char* kept : { "all", "lean", "steps" }) {
                            CAPTURE(exact);
                            CAPTURE(specular);
                            CAPTURE(rounds.size());
                            CAPTURE(nameOf(count));
                            CAPTURE(kept);
                            const bool motion = count == fewer;
                            Accumulation a(device, width, height, window, Receivers::All, definesOf(specular, motion));
                            a.lean = kept != std::string_view("all");
                            a.steps = kept == std::string_view("steps");
                            const TermPixels term = accumulated(a, rounds, { exact, specular, count }, motion);
                            term.check(a);
                            if (a.once() && motion)
                                term.checkShadows(a);
                        }
                    }
    });
}

TEST_CASE(
    "lights: with a sample a receiver texture times value is the radiance, and plain means miss the covariance (5.10)")
{
    onEveryDevice([](const device::Device& device) {
        for (const Receivers kind : { Receivers::All, Receivers::LitSurfaces })
            for (const Rounds& rounds : { oneRound, threeRounds }) {
                Accumulation a(device, width, height, window, kind, definesOf(true));
                const LightCase how { false, true, oneEach };
                const TermPixels term = accumulated(a, rounds, how, false);
                const auto texture = a.read(term.texture), value = a.read(term.value), plain = a.read(term.plain);
                double largest = 0;
                a.waves.everyPixel([&](int x, int y) {
                    const std::vector<SeenPoint> seen = a.seen(x, y);
                    const double n = std::max<double>(1, static_cast<double>(seen.size()));
                    const auto li = [&](const SeenPoint& p) {
                        return reflected(p, how, p.weight[0] * p.visible[0], p.weight[1] * p.visible[1]);
                    };
                    const glm::dvec3 radiance = sumOf(seen, li) / n;
                    for (int c = 0; c < 3; ++c)
                        REQUIRE(nearTo(texture.vector(x, y)[c] * value.vector(x, y)[c], radiance[c], 1e-4));
                    if (kind == Receivers::All || a.taken.at(x, y) == 0)
                        return;
                    // L - k E is the mean of (k_i - k)(E_i - E).
                    const auto ki = [&](const SeenPoint& p) {
                        return luminanceOf(reflected(p, how, p.weight[0], p.weight[1]));
                    };
                    const auto ei = [&](const SeenPoint& p) { return luminanceOf(li(p)) / ki(p); };
                    const double meanK = sumOf(seen, ki) / n, meanE = sumOf(seen, ei) / n;
                    const double covariance =
                        sumOf(seen, [&](const SeenPoint& p) { return (ki(p) - meanK) * (ei(p) - meanE); }) / n;
                    const double error = luminanceOf(radiance) - luminanceOf(texture.vector(x, y)) * plain.at(x, y);
                    REQUIRE(std::fabs(error - covariance) < 1e-5);
                    largest = std::max(largest, std::fabs(covariance));
                });
                CHECK((largest > 0.05 || kind == Receivers::All));
            }
    });
}

TEST_CASE(
    "lights as published: plain means of the form factor's visible part, and of the lobe towards the light's centre")
{
    onEveryDevice([](const device::Device& device) {
        for (const TermCount count : { more, fewer })
            for (const Rounds& rounds : { oneRound, threeRounds }) {
                Accumulation a(device, width, height, window, Receivers::All, definesOf(true));
                a.published = 1;
                shared::AreaLight light {};
                light.power = shared::vec3(300, 200, 100);
                light.centre = shared::vec3(12, 22, -3);
                light.normal = shared::vec3(0, -1, 0);
                const glm::dvec3 centre(12, 22, -3);
                // The form factor (5.14), and the reflection towards the light's centre (5.20).
                const auto irradiance = [&](const SeenPoint& p) {
                    const glm::dvec3 d = centre - p.position;
                    const double squared = glm::dot(d, d);
                    return p.weight[0] * p.visible[0] * std::max(0.0, glm::dot(p.normal, d)) * std::max(0.0, d.y)
                        / (squared * squared);
                };
                const auto texture = [&](const SeenPoint& p) {
                    const auto narrow = [](glm::dvec3 v) { return shared::vec3(float(v.x), float(v.y), float(v.z)); };
                    const shared::Vec3 view = shared::unpackDirection(shared::packDirection(viewOf(p)));
                    const double lobe = shared::specularLobe(narrow(p.normal), view,
                        narrow(glm::normalize(centre - p.position)), p.gloss.exponent, p.gloss.kind);
                    return glm::dvec3(300, 200, 100) * (p.diffuse / std::numbers::pi + p.specular * lobe);
                };
                TermPixels term(a, count);
                term.light = true;
                SurfacePixels surfaces(a);
                for (const auto& upTo : rounds) {
                    a.begin(upTo);
                    term.begin(a);
                    term.expect(a, [&](std::vector<TermSample>& wave) {
                        for (TermSample& s : wave)
                            if (s.point.object != 0) {
                                s.texture = texture(s.point);
                                s.plain = irradiance(s.point);
                                s.irradiance = glm::dvec3(s.plain);
                                s.radiance = s.texture * s.plain;
                                s.weights = glm::dvec3(1);
                            }
                    });
                    accumulateLight(a, term, light, false, true);
                    accumulateSurfaces(a, surfaces);
                }
                const auto value = a.read(term.value), plain = a.read(term.plain), k = a.read(term.texture),
                           own = a.read(term.radiance);
                double largest = 0;
                a.waves.everyPixel([&](int x, int y) {
                    const TermMeans& m = term.means[term.after.index(x, y)];
                    REQUIRE(nearTo(value.vector(x, y), m.value, 1e-4));
                    REQUIRE(nearTo(plain.at(x, y), m.plain, 1e-4));
                    REQUIRE(nearTo(k.vector(x, y), m.texture, 1e-4));
                    REQUIRE(nearTo(own.vector(x, y), m.radiance, 1e-4));
                    largest = std::max(largest, m.radiance.x);
                });
                CHECK(largest > 0.05);
            }
    });
}
