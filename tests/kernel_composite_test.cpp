// composite.cl alone: terms to radiance, against integrals over the light in double.
#include "host/render/device_scene.h"
#include "kernels/shared/bsdf.h"
#include "kernels/shared/path.h"
#include "tests/lamp.h"
#include "tests/pass_bench.h"
#include "tests/render_oracles.h"
#include "tests/render_support.h"

#include <array>
#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Receivers scattered around a light at y = 2, with made-up terms.
struct Receivers {
    Planes<float> position, normal, diffuse, specular, value, noisy, parts; ///< parts: numbers that 16 bits hold
    Planes<std::uint32_t> gloss, objectId, taken;

    Receivers(int width, int height, unsigned seed)
        : Receivers(render::PlaneLayout(width, height))
    {
        std::mt19937 random(seed);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                objectId.at(x, y) = random() % 6 == 0 && width > 1 ? 0 : 1;
                position.setVector(x, y, { uniform(random, -3, 3), uniform(random, -1, 1.5), uniform(random, -3, 3) });
                normal.setVector(x, y, glm::normalize(glm::dvec3(0, 0.7, 0) + unitVector(random)));
                diffuse.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
                specular.setVector(x, y,
                    random() % 4 == 0 ? glm::dvec3(0) : glm::dvec3(uniform(random), uniform(random), uniform(random)));
                gloss.at(x, y) = shared::packGloss(shared::makeGloss(
                    static_cast<float>(uniform(random, 1, 20)), random() % 2 == 0 ? WEDGE_PHONG : WEDGE_BLINN_PHONG));
                for (std::size_t c = 0; c < 2; ++c) {
                    value.at(x, y, c) = static_cast<float>(uniform(random));
                    noisy.at(x, y, c) = static_cast<float>(uniform(random));
                    parts.at(x, y, c) = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random))));
                }
                taken.at(x, y) = objectId.at(x, y) != 0 ? 9 + static_cast<std::uint32_t>(random() % 90) : 0;
            }
    }
    explicit Receivers(const render::PlaneLayout& layout)
        : position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , diffuse(layout, 3, 0.0f)
        , specular(layout, 3, 0.0f)
        , value(layout, 2, 0.0f)
        , noisy(layout, 2, 0.0f)
        , parts(layout, 2, 0.0f)
        , gloss(layout, 1, 0u)
        , objectId(layout, 1, 0u)
        , taken(layout, 1, 0u)
    {
    }
    const render::PlaneLayout& layout() const { return position.layout; }
    template <class Visit>
    void everyPixel(const Visit& visit) const
    {
        for (int y = 0; y < static_cast<int>(layout().height); ++y)
            for (int x = 0; x < static_cast<int>(layout().width); ++x)
                visit(x, y);
    }
};

/// What a term of reflected luminance `shown` adds to the deviation: its part's difference, times sqrt(h / (n - h)), h
/// the samples of the part, half of n, or, where they are fewer than 18, 4 of the first pass.
double deviationOf(double mean, double ofPart, std::uint32_t n, double shown)
{
    const std::uint32_t h = n >= 18 ? n / 2 : 4;
    return n > h ? shown * (ofPart - mean) * std::sqrt(static_cast<double>(h) / (n - h)) : 0.0;
}

double shownLuminance(const Planes<float>& reflectance, int x, int y, shared::Vec3 power)
{
    const glm::dvec3 k = reflectance.vector(x, y);
    return 0.2126 * k.x * power.x + 0.7152 * k.y * power.y + 0.0722 * k.z * power.z;
}

/// Integral over the light of radiance 1 times profile, geometry term and, in the specular case, the lobe.
struct Integral {
    double value = 0;
    bool horizon = false; ///< part of the light does not light the receiver
};
template <class Lobe>
Integral overLight(const scene::AreaLight& light, glm::dvec3 at, glm::dvec3 n, const Lobe& lobe)
{
    constexpr int steps = 200;
    Integral out;
    bool dark = false, lit = false;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const double a = 2 * (i + 0.5) / steps - 1, b = 2 * (k + 0.5) / steps - 1;
            const glm::dvec3 d = pointOf(light, a, b) - at;
            const double g = geometry(n, d, lightNormal(light), light.twoSided);
            (g > 0 ? lit : dark) = true;
            out.value += g > 0 ? profileAt(light, a, b) * g * lobe(d) : 0.0;
        }
    out.value *= lightArea(light) / (steps * steps);
    out.horizon = lit && dark;
    return out;
}

shared::Vec3 narrowed(glm::dvec3 v)
{
    return shared::vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

/// A frame of one light and nothing else that is sampled, or of paths, on surfaces that reflect specularly or not.
class CompositeFrame : public DeclaredFrame {
public:
    CompositeFrame(
        const device::Device& device, const render::PlaneLayout& size, const scene::AreaLight& light, bool specular)
        : DeclaredFrame(device, lit(light, specular),
            sized(render::axisAligned(16), static_cast<int>(size.width), static_cast<int>(size.height)))
    {
    }

private:
    static scene::Scene lit(const scene::AreaLight& light, bool specular)
    {
        scene::Scene out = smallScene();
        out.areaLights = { light };
        out.materials[0].specular = glm::vec3(specular ? 0.3f : 0.0f);
        return out;
    }
};

/// A pass that adds a light's term to sums that are there.
PassBench lightPass(
    CompositeFrame& frame, const std::string& kernel, const Receivers& in, std::uint32_t shading, float directBefore)
{
    PassBench pass(frame, kernel);
    pass.value("params", shared::SampleParams { shading, 0, 0, 9, WEDGE_LIGHTS_SAMPLED, 0, {} });
    pass.plane("position", in.position);
    pass.plane("normal", in.normal);
    pass.plane("objectId", in.objectId);
    pass.plane("taken", in.taken);
    for (const auto& [name, planes] : { std::pair("value", &in.value), { "noisy", &in.noisy }, { "parts", &in.parts } })
        pass.plane(name,
            std::vector(planes->values.begin(),
                planes->values.begin() + static_cast<std::ptrdiff_t>(pass.read<float>(name).size())));
    const std::size_t size = in.layout().size;
    pass.plane("direct", std::vector<float>(3 * size, directBefore));
    pass.plane("directNoisy", std::vector<float>(3 * size, 0.25f));
    pass.plane("deviation", std::vector<float>(size, 0.125f));
    return pass;
}

} // namespace

TEST_CASE("addDiffuse: value times unshadowed shading times reflectance, in each way of shading")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [width, height] : { std::pair(1, 1), { 37, 5 } })
            for (const bool twoSided : { false, true })
                for (const std::uint32_t shading :
                    { WEDGE_SHADING_SEPARATE, WEDGE_SHADING_INSIDE, WEDGE_SHADING_RATIO }) {
                    const scene::AreaLight light =
                        lamp(twoSided ? scene::LightProfile::Uniform : scene::LightProfile::Gaussian, twoSided);
                    const shared::AreaLight made = render::deviceLight(light);
                    const Receivers in(width, height, 3);
                    CompositeFrame frame(device, in.layout(), light, false);
                    PassBench pass = lightPass(frame, "addDiffuse", in, shading, 0.5f);
                    pass.plane("diffuse", in.diffuse);
                    pass.run();
                    const auto found = pass.pixels<float>("direct"), foundNoisy = pass.pixels<float>("directNoisy"),
                               foundDeviation = pass.pixels<float>("deviation");
                    CAPTURE(shading);
                    CAPTURE(twoSided);
                    in.everyPixel([&](int x, int y) {
                        const bool surface = in.objectId.at(x, y) != 0;
                        const glm::dvec3 at = in.position.vector(x, y), n = in.normal.vector(x, y);
                        const Integral integral = overLight(light, at, n, [](glm::dvec3) { return 1.0; });
                        double shade = made.power.y;
                        double tolerance = 1e-4;
                        if (shading == WEDGE_SHADING_SEPARATE) {
                            shade *= geometry(n, glm::dvec3(light.centre) - at, lightNormal(light), twoSided);
                        } else if (shading == WEDGE_SHADING_RATIO) {
                            shade = 4 * integral.value;
                            tolerance = 2e-3;
                        }
                        const double reflected = surface ? shade * in.diffuse.at(x, y, 1) / 3.14159265358979 : 0.0;
                        const double slack = tolerance * (reflected + (integral.horizon ? 0.3 : 1e-3));
                        REQUIRE(std::fabs(found.at(x, y, 1) - 0.5 - in.value.at(x, y) * reflected) <= slack);
                        REQUIRE(std::fabs(foundNoisy.at(x, y, 1) - 0.25 - in.noisy.at(x, y) * reflected) <= slack);
                        const double shown = surface
                            ? shade / made.power.y / 3.14159265358979 * shownLuminance(in.diffuse, x, y, made.power)
                            : 0.0;
                        const double off = deviationOf(in.noisy.at(x, y), in.parts.at(x, y), in.taken.at(x, y), shown);
                        REQUIRE(std::fabs(foundDeviation.at(x, y) - 0.125 - off)
                            <= tolerance * (shown + (integral.horizon ? 0.3 : 1e-3)) + std::fabs(0.125 + off) / 256);
                    });
                }
    });
}

TEST_CASE("addSpecular: the second term times the lobe's unshadowed shading times reflectance")
{
    onEveryDevice([](const device::Device& device) {
        const scene::AreaLight light = lamp(scene::LightProfile::Gaussian, false);
        const shared::AreaLight made = render::deviceLight(light);
        Receivers in(33, 6, 4);
        std::mt19937 random(5);
        in.everyPixel([&](int x, int y) {
            // About the mirror direction, so that there is a highlight to speak of.
            const glm::dvec3 at = in.position.vector(x, y), eye(0.5, 1, 6);
            in.normal.setVector(x, y,
                glm::normalize(glm::normalize(eye - at) + glm::normalize(glm::dvec3(light.centre) - at)
                    + 0.4 * unitVector(random)));
        });
        CompositeFrame frame(device, in.layout(), light, true);
        shared::FrameParams seen {};
        seen.eye = shared::vec3(0.5f, 1, 6);
        for (const std::uint32_t shading : { WEDGE_SHADING_SEPARATE, WEDGE_SHADING_INSIDE, WEDGE_SHADING_RATIO }) {
            PassBench pass = lightPass(frame, "addSpecular", in, shading, 0.5f);
            pass.value("frame", seen);
            pass.value("directions", 256u);
            pass.plane("gloss", in.gloss);
            pass.plane("specular", in.specular);
            pass.run();
            const auto found = pass.pixels<float>("direct"), foundNoisy = pass.pixels<float>("directNoisy"),
                       foundDeviation = pass.pixels<float>("deviation");
            CAPTURE(shading);
            unsigned bright = 0;
            in.everyPixel([&](int x, int y) {
                const glm::dvec3 at = in.position.vector(x, y), n = in.normal.vector(x, y);
                const glm::dvec3 view = glm::normalize(glm::dvec3(0.5, 1, 6) - at);
                const shared::Gloss gloss = shared::unpackGloss(in.gloss.at(x, y));
                const auto lobe = [&](glm::dvec3 d) {
                    return static_cast<double>(shared::specularLobe(
                        narrowed(n), narrowed(view), narrowed(glm::normalize(d)), gloss.exponent, gloss.kind));
                };
                double shade = made.power.z, slack = 1e-4;
                if (shading == WEDGE_SHADING_SEPARATE) {
                    const glm::dvec3 d = glm::dvec3(light.centre) - at;
                    const double g = geometry(n, d, lightNormal(light), false);
                    shade *= g > 0 ? g * lobe(d) : 0.0;
                } else if (shading == WEDGE_SHADING_RATIO) {
                    const Integral integral = overLight(light, at, n, lobe);
                    shade = 3 * integral.value;
                    slack = 4e-3;
                }
                const double reflected = in.objectId.at(x, y) != 0 ? shade * in.specular.at(x, y, 2) : 0.0;
                bright += reflected > 0.01 ? 1 : 0;
                REQUIRE(
                    std::fabs(found.at(x, y, 2) - 0.5 - in.value.at(x, y, 1) * reflected) <= slack * (reflected + 0.3));
                REQUIRE(std::fabs(foundNoisy.at(x, y, 2) - 0.25 - in.noisy.at(x, y, 1) * reflected)
                    <= slack * (reflected + 0.3));
                const double shown = in.objectId.at(x, y) != 0
                    ? shade / made.power.z * shownLuminance(in.specular, x, y, made.power)
                    : 0.0;
                const double off = deviationOf(in.noisy.at(x, y, 1), in.parts.at(x, y, 1), in.taken.at(x, y), shown);
                REQUIRE(std::fabs(foundDeviation.at(x, y) - 0.125 - off)
                    <= slack * (shown + 0.3) + std::fabs(0.125 + off) / 256);
            });
            CHECK(bright > 30);
        }
    });
}

TEST_CASE("addSpecular: a mirror shows the light's own radiance, where it shows the light")
{
    onEveryDevice([](const device::Device& device) {
        for (const scene::LightProfile profile : { scene::LightProfile::Uniform, scene::LightProfile::Gaussian }) {
            const scene::AreaLight light = lamp(profile, false);
            Receivers in(64, 6, 4);
            std::mt19937 random(11);
            const glm::dvec3 eye(0.5, 1, 6);
            std::vector<double> shown;
            in.everyPixel([&](int x, int y) {
                // Each mirrors the eye's ray to a point of the light's plane, most of them on the light.
                const double a = uniform(random, -1.5, 1.5), b = uniform(random, -1.5, 1.5);
                const glm::dvec3 at = in.position.vector(x, y), l = glm::normalize(pointOf(light, a, b) - at);
                in.normal.setVector(x, y, glm::normalize(glm::normalize(eye - at) + l));
                in.specular.setVector(x, y, { 1, 1, 1 });
                in.objectId.at(x, y) = 1;
                const bool faces = glm::dot(l, lightNormal(light)) < -0.1;
                const bool edge = std::fabs(std::fabs(a) - 1) < 0.15 || std::fabs(std::fabs(b) - 1) < 0.15;
                const bool hit = faces && std::fabs(a) < 1 && std::fabs(b) < 1;
                shown.push_back(edge || (!faces && glm::dot(l, lightNormal(light)) < 0.1) ? -1
                        : hit                                                             ? profileAt(light, a, b)
                                                                                          : 0);
            });
            CompositeFrame frame(device, in.layout(), light, true);
            shared::FrameParams seen {};
            seen.eye = shared::vec3(0.5f, 1, 6);
            std::ranges::fill(in.gloss.values, shared::packGloss(shared::makeGloss(1e6f, WEDGE_PHONG)));
            for (Planes<float>* all : { &in.value, &in.noisy, &in.parts })
                std::ranges::fill(all->values, 1.0f);
            PassBench pass = lightPass(frame, "addSpecular", in, WEDGE_SHADING_RATIO, 0.0f);
            pass.value("frame", seen);
            pass.value("directions", 256u);
            pass.plane("gloss", in.gloss);
            pass.plane("specular", in.specular);
            pass.run();
            const auto found = pass.pixels<float>("direct");
            std::size_t next = 0;
            int lit = 0;
            in.everyPixel([&](int x, int y) {
                const double expected = shown[next++];
                if (expected < 0)
                    return;
                // A lobe of exponent m reflects (m + 2) / (m + 1) of what arrives, times the cosine.
                const glm::dvec3 at = in.position.vector(x, y);
                const double cosine = glm::dot(in.normal.vector(x, y), glm::normalize(eye - at));
                const double reflected = expected * light.radiance.y * cosine;
                REQUIRE(std::fabs(found.at(x, y, 1) - reflected) <= 0.02 * light.radiance.y * cosine);
                lit += expected > 0.1 ? 1 : 0;
            });
            CHECK(lit > 60);
        }
    });
}

TEST_CASE("addPathSamples, addIndirect: terms times reflectance add up; ambient is what is open, "
          "on white")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [width, height] : { std::pair(1, 1), { 37, 5 } }) {
            Receivers in(width, height, 8);
            const Receivers other(width, height, 9);
            Planes<float> value(in.layout(), 4, 0.0f), noisy(in.layout(), 4, 0.0f), deviations(in.layout(), 1, 0.0f);
            in.everyPixel([&](int x, int y) {
                for (std::size_t c = 0; c < 3; ++c) {
                    // What was never sampled holds anything.
                    const bool sampled = in.taken.at(x, y) > 0;
                    value.at(x, y, c) = sampled ? other.diffuse.at(x, y, c) : std::nanf("");
                    noisy.at(x, y, c) = sampled ? other.specular.at(x, y, c) : std::nanf("");
                    value.at(x, y, 3) = sampled ? other.diffuse.at(x, y, 2) : std::nanf("");
                    deviations.at(x, y) = sampled ? other.specular.at(x, y, 1) - 0.5f : std::nanf("");
                }
            });
            render::Settings settings = sized(render::axisAligned(16), width, height);
            settings.bounces = 1;
            DeclaredFrame frame(device, smallScene(), settings);
            PassBench samples(frame, "addPathSamples"), filtered(frame, "addIndirect");
            const std::size_t size = in.layout().size;
            samples.plane("indirectNoisy", std::vector<float>(3 * size, 0.25f));
            samples.plane("deviation", std::vector<float>(size, 0.125f));
            filtered.plane("indirect", std::vector<float>(3 * size, 0.5f));
            filtered.plane("variance", std::vector<float>(size, 0.25f));
            const auto add = [&](std::uint32_t component, const Planes<float>& reflectance) {
                for (PassBench* pass : { &samples, &filtered }) {
                    pass->value("component", component);
                    pass->plane("reflectance", reflectance);
                    pass->plane("taken", in.taken);
                }
                samples.plane("value", noisy);
                samples.plane("deviations", deviations);
                samples.run();
                REQUIRE(filtered.own<std::uint32_t>("varies") == 1);
                filtered.plane("value", value);
                filtered.run();
            };
            // After each term, what the terms so far multiply value by, and add.
            const auto check = [&](const auto& expected, unsigned terms) {
                const auto found = filtered.pixels<float>("indirect"),
                           foundNoisy = samples.pixels<float>("indirectNoisy"),
                           foundDeviation = samples.pixels<float>("deviation"),
                           foundVariance = filtered.pixels<float>("variance");
                in.everyPixel([&](int x, int y) {
                    // What is open falls by as much as what is occluded rises: the deviation of a term in k has no
                    // sign.
                    double off = 0.125, varies = 0.25, largest = 0.125;
                    for (unsigned term = 0; term < terms && in.taken.at(x, y) > 0; ++term) {
                        double k = term > 1 ? 1 : 0;
                        for (std::size_t c = 0; c < 3 && term < 2; ++c)
                            k += std::array { 0.2126, 0.7152, 0.0722 }[c]
                                * (term == 0 ? in.diffuse : in.specular).at(x, y, c);
                        off += k * deviations.at(x, y);
                        varies += k * k * value.at(x, y, 3);
                        largest = std::max(largest, std::fabs(off));
                    }
                    // In 16 bits each sum is rounded.
                    REQUIRE(std::fabs(foundDeviation.at(x, y) - off) <= terms * largest / 256);
                    REQUIRE(std::fabs(foundVariance.at(x, y) - varies) <= terms * varies / 256);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const bool has = in.taken.at(x, y) > 0;
                        const double sum = has ? expected(x, y, c, value.at(x, y, c)) : 0.0;
                        const double sumNoisy = has ? expected(x, y, c, noisy.at(x, y, c)) : 0.0;
                        REQUIRE(std::fabs(found.at(x, y, c) - 0.5 - sum) < 1e-6);
                        REQUIRE(std::fabs(foundNoisy.at(x, y, c) - 0.25 - sumNoisy) < 1e-6);
                    }
                });
            };
            add(WEDGE_COMPONENT_DIFFUSE, in.diffuse);
            check([&](int x, int y, std::size_t c, double v) { return in.diffuse.at(x, y, c) * v; }, 1);
            add(WEDGE_COMPONENT_GLOSSY, in.specular);
            const auto both = [&](int x, int y, std::size_t c, double v) {
                return (in.diffuse.at(x, y, c) + in.specular.at(x, y, c)) * v;
            };
            check(both, 2);
            add(WEDGE_COMPONENT_AMBIENT, in.diffuse);
            check([&](int x, int y, std::size_t c, double v) { return both(x, y, c, v) + 1 - v; }, 3);
        }
    });
}

TEST_CASE("addReflected: what is below and reflection on surfaces, fallen back as shares say, what is below elsewhere")
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    onEveryDevice([&](const device::Device& device) {
        for (const auto& of : { std::pair(render::monteCarlo(4), true), { render::axisAligned(16), false },
                 { render::axisAligned(16), true } }) {
            const bool fallsBack = of.first.method == render::Method::AxisAligned, layers = of.second;
            DeclaredFrame frame(device, smallScene(), sized(of.first, 37, 5), layers);
            PassBench bench(frame, "addReflected");
            REQUIRE(bench.has("shares") == fallsBack);
            REQUIRE(bench.has("reflected") == (fallsBack && layers)); // what layers show
            std::mt19937 random(6);
            const std::size_t size = frame.layout.size;
            bench.plane("below", someNumbers(random, 3 * size, 0, 2));
            bench.plane("light", someNumbers(random, 3 * size, 0, 2));
            std::vector<std::uint32_t> objects(size);
            for (std::uint32_t& id : objects)
                id = static_cast<std::uint32_t>(random() % 3);
            bench.plane("objectId", objects);
            if (fallsBack) {
                auto shares = someNumbers(random, 2 * size, -1, 1), noisy = someNumbers(random, 3 * size, 0, 2);
                for (std::size_t i = 0; i < size; ++i) {
                    shares[i] = std::max(shares[i], 0.0f);
                    shares[size + i] *= i % 3 == 0 ? 0.0f : 1.0f;
                    for (std::size_t c = 0; shares[i] == 0 && c < 3; ++c)
                        noisy[c * size + i] = nan; // nobody looks at it
                }
                bench.plane("shares", shares);
                bench.plane("noisy", noisy);
            }
            bench.run();
            const auto plane = [&](const char* name) { return bench.pixels<float>(name); };
            const auto below = plane("below"), light = plane("light"), sum = plane("sum");
            const auto shares = fallsBack ? plane("shares") : Planes<float>(frame.layout, 2, 0.0f);
            const auto noisy = fallsBack ? plane("noisy") : light;
            const auto reflected = layers && fallsBack ? plane("reflected") : light;
            const auto ids = bench.pixels<std::uint32_t>("objectId");
            everyPixel(frame.layout, [&](int x, int y) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const double scaled = light.at(x, y, c) * (1.0 + shares.at(x, y, 1));
                    const double own = shares.at(x, y, 0);
                    const double shown = own > 0 ? scaled + own * (noisy.at(x, y, c) - scaled) : scaled;
                    REQUIRE(std::fabs(sum.at(x, y, c) - below.at(x, y, c) - (ids.at(x, y) != 0 ? shown : 0.0)) < 1e-6);
                    if (layers && fallsBack)
                        REQUIRE(std::fabs(reflected.at(x, y, c) - shown) < 1e-6);
                    if (own == 0 && shares.at(x, y, 1) == 0)
                        REQUIRE(sum.at(x, y, c) == below.at(x, y, c) + (ids.at(x, y) != 0 ? light.at(x, y, c) : 0.0f));
                }
            });
        }
    });
}
