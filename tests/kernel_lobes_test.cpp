// What lobes would see beyond the scene if nothing were hidden, and what samples make of it, kernel by kernel.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"
#include "tests/environment_support.h"
#include "tests/filter_oracle.h"
#include "tests/pass_bench.h"

#include <algorithm>
#include <memory>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 40, height = 6;
const render::PlaneLayout layout(width, height);

/// Radiance that is smooth over the sphere.
glm::dvec3 radianceTowards(glm::dvec3 d) { return { 1.2 + d.x, 1.0 + 0.8 * d.y * d.z, std::exp(d.z - d.x) }; }

/// A map of it that is turned in the world.
render::EnvironmentPicture smoothMap()
{
    render::EnvironmentPicture p;
    p.width = 256;
    p.height = 128;
    p.up = glm::normalize(glm::vec3(0.2f, 1.0f, -0.3f));
    p.right = glm::normalize(glm::cross(p.up, glm::vec3(0, 0, 1)));
    p.back = glm::cross(p.right, p.up);
    const double pi = std::acos(-1.0);
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
            const double polar = pi * (y + 0.5) / p.height, turn = 2 * pi * ((x + 0.5) / p.width - 0.5);
            const glm::dvec3 c = radianceTowards(std::cos(polar) * glm::dvec3(p.up)
                + std::sin(polar) * (std::sin(turn) * glm::dvec3(p.right) - std::cos(turn) * glm::dvec3(p.back)));
            for (int channel = 0; channel < 3; ++channel)
                p.radiance.push_back(static_cast<float>(c[channel]));
        }
    return p;
}

/// What a lobe reflects of it, over the reflectance, by a fine quadrature around the mirrored view.
glm::dvec3 reflectedOf(shared::Gloss gloss, glm::dvec3 n, glm::dvec3 v)
{
    const shared::Lobe lobe = shared::lobeOf(gloss);
    const glm::dvec3 r = 2 * glm::dot(n, v) * n - v;
    const glm::dvec3 s = glm::normalize(
                         glm::cross(r, std::fabs(r.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))),
                     t = glm::cross(r, s);
    constexpr int rings = 400, spokes = 128;
    const double pi = std::acos(-1.0);
    glm::dvec3 sum(0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < spokes; ++j) {
            const double polar = pi * (i + 0.5) / rings, turn = 2 * pi * (j + 0.5) / spokes;
            const glm::dvec3 l = std::cos(polar) * r + std::sin(polar) * (std::cos(turn) * s + std::sin(turn) * t);
            const double cosine = glm::dot(n, l);
            if (cosine > 0)
                sum += double { shared::lobeValue(lobe, toVec3(n), toVec3(v), toVec3(l)) } * cosine * std::sin(polar)
                    * radianceTowards(l);
        }
    return sum * (pi / rings * 2 * pi / spokes);
}

/// Of a glossy floor under a map.
class LobeFrame : public DeclaredFrame {
public:
    LobeFrame(const device::Device& device, const std::shared_ptr<render::EnvironmentPicture>& picture)
        : DeclaredFrame(device, under(picture), sized(render::axisAligned(16), width, height))
    {
    }

private:
    static scene::Scene under(const std::shared_ptr<render::EnvironmentPicture>& picture)
    {
        SceneBuilder b = openFloor();
        b.scene.materials[0].specular = glm::vec3(0.3f);
        b.scene.materials[0].exponent = 100; // of wide lobes samples are what is filtered
        render::setEnvironment(b.scene, picture);
        return b.scene;
    }
};

/// What correctLobes() is handed; all that samples found is as expected until a test says otherwise.
struct Lobes {
    Planes<float> specular { layout, 3, 0.5f }, sums { layout, 4, 0.0f }, whole { layout, 1, 0.0f },
        unshadowed { layout, 3, 0.0f };
    Planes<std::uint32_t> taken { layout, 1, 16u }, objectId { layout, 1, 1u };

    Lobes()
    {
        std::mt19937 random(5);
        everyPixel(layout, [&](int x, int y) {
            const glm::dvec3 light(uniform(random, 0.5, 2), uniform(random, 0.5, 2), uniform(random, 0.5, 2));
            unshadowed.setVector(x, y, 0.5 * light);
            whole.at(x, y) = static_cast<float>(luminanceOf(light));
            objectId.at(x, y) = x < width / 2 ? 1 : 2;
            find(x, y, 1, light);
        });
    }
    /// So much of what is expected is what samples would bring, all of it seen, in a colour of any brightness.
    void find(int x, int y, double ofExpected, glm::dvec3 colour)
    {
        const double all = taken.at(x, y) * ofExpected * whole.at(x, y);
        sums.setVector(x, y, all / luminanceOf(colour) * colour);
        sums.at(x, y, 3) = static_cast<float>(all);
    }
    /// Times the reflectance.
    glm::dvec3 light(int x, int y) const { return unshadowed.vector(x, y); }
    Planes<float> corrected(const device::Device& device) const
    {
        LobeFrame frame(device, even(sky));
        PassBench pass(frame, "correctLobes");
        pass.plane("specular", specular);
        pass.plane("sums", sums);
        pass.plane("taken", taken);
        pass.plane("objectId", objectId);
        pass.plane("whole", whole);
        pass.plane("unshadowed", unshadowed);
        pass.run();
        return pass.pixels<float>("unshadowed");
    }
};

} // namespace

TEST_CASE("lobesOfPixels is the integral of map, lobe and cosine, whatever the lobe")
{
    const auto picture = std::make_shared<render::EnvironmentPicture>(smoothMap());
    shared::FrameParams camera {};
    camera.eye = shared::vec3(0.3f, -0.2f, 4);
    Planes<float> position(layout, 3, 0.0f), normal(layout, 3, 0.0f), specular(layout, 3, 0.0f);
    Planes<std::uint32_t> gloss(layout, 1, 0u);
    Planes<double> expected(layout, 3, 0.0);
    std::mt19937 random(9);
    everyPixel(layout, [&](int x, int y) {
        const glm::dvec3 at(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        const glm::dvec3 v = glm::normalize(toGlm(camera.eye) - at);
        glm::dvec3 n = glm::normalize(v + 0.8 * unitVector(random));
        const shared::Gloss g = shared::makeGloss(
            static_cast<float>(std::pow(2.0, uniform(random, 4, 10))), x % 2 == 0 ? WEDGE_PHONG : WEDGE_BLINN_PHONG);
        position.setVector(x, y, at);
        normal.setVector(x, y, n);
        gloss.at(x, y) = shared::packGloss(g);
        if (x % 5 != 0)
            specular.setVector(x, y, { 0.6, 0.3, 0.1 });
        const glm::dvec3 all = reflectedOf(shared::unpackGloss(gloss.at(x, y)), n, v);
        for (std::size_t c = 0; c < 3; ++c)
            expected.at(x, y, c) = all[static_cast<int>(c)];
    });
    onEveryDevice([&](const device::Device& device) {
        LobeFrame frame(device, picture);
        PassBench pass(frame, "lobesOfPixels");
        pass.value("frame", camera);
        pass.value("rings", 8u);
        pass.plane("position", position);
        std::vector<float> normals = normal.values;
        normals.resize(pass.read<float>("normal").size());
        pass.plane("normal", normals);
        pass.plane("gloss", gloss);
        pass.plane("specular", specular);
        pass.run();
        const auto found = pass.pixels<float>("unshadowed"), brightness = pass.pixels<float>("whole");
        double worst = 0;
        everyPixel(layout, [&](int x, int y) {
            const glm::dvec3 k = specular.vector(x, y);
            const glm::dvec3 e(expected.at(x, y), expected.at(x, y, 1), expected.at(x, y, 2));
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::fabs(found.vector(x, y)[c] - k[c] * e[c]) / (0.6 * luminanceOf(e)));
            const double seen = luminanceOf(k) > 0 ? luminanceOf(e) : 0;
            REQUIRE(std::fabs(brightness.at(x, y) - seen) <= 0.01 * seen);
        });
        MESSAGE("off by up to ", worst);
        CHECK(worst < 0.01);
    });
}

TEST_CASE("correctLobes: what agrees stays, what neighbours are off by together goes, and noise changes nothing")
{
    onEveryDevice([](const device::Device& device) {
        Lobes lobes;
        const auto scaled = [&](double ofOne, double ofTwo, double slack) {
            const Planes<float> found = lobes.corrected(device);
            double worst = 0;
            everyPixel(layout, [&](int x, int y) {
                const double factor = lobes.objectId.at(x, y) == 1 ? ofOne : ofTwo;
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::fabs(found.vector(x, y)[c] / lobes.light(x, y)[c] - factor));
            });
            CHECK(worst <= slack);
        };
        scaled(1, 1, 1e-4);
        // One object is brighter than expected, the other as expected.
        everyPixel(layout,
            [&](int x, int y) { lobes.find(x, y, lobes.objectId.at(x, y) == 1 ? 1.2 : 1.0, lobes.light(x, y)); });
        scaled(1.2, 1, 1e-3);
        std::mt19937 random(8);
        everyPixel(layout, [&](int x, int y) { lobes.find(x, y, uniform(random, 0.6, 1.4), lobes.light(x, y)); });
        scaled(1, 1, 0.02);
    });
}

TEST_CASE("correctLobes: colours become those of samples, the more is hidden, and black maps those of what is found")
{
    onEveryDevice([](const device::Device& device) {
        Lobes lobes;
        const glm::dvec3 red(1, 0.1, 0.1);
        // Columns: all is seen, half of it, and half by few samples; nobody saw; and directions that found nothing.
        everyPixel(layout, [&](int x, int y) {
            lobes.taken.at(x, y) = x % 5 == 2 ? 2 : x % 5 == 3 ? 0 : 4000;
            if (x % 5 == 4) {
                lobes.whole.at(x, y) = 1;
                lobes.find(x, y, 0.7, red);
                lobes.whole.at(x, y) = 0;
                lobes.unshadowed.setVector(x, y, glm::dvec3(0));
                return;
            }
            lobes.find(x, y, 1, red);
            if (x % 5 == 1 || x % 5 == 2)
                lobes.sums.setVector(x, y, 0.5 * lobes.sums.vector(x, y));
        });
        const Planes<float> found = lobes.corrected(device);
        everyPixel(layout, [&](int x, int y) {
            const glm::dvec3 before = lobes.light(x, y), after = found.vector(x, y);
            const glm::dvec3 coloured = 0.5 * lobes.whole.at(x, y) / luminanceOf(red) * red;
            const auto from = [&](glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) / glm::length(b); };
            switch (x % 5) {
            case 0:
            case 3:
                REQUIRE(from(after, before) < 1e-3);
                break;
            case 1:
                REQUIRE(from(after, coloured) < 0.02);
                break; // a share 0.25 / (0.25 + 1 / 2000)
            case 2:
                REQUIRE(from(after, 0.8 * before + 0.2 * coloured) < 0.02);
                break; // 0.25 / (0.25 + 1)
            default:
                REQUIRE(from(after, 0.5 * 0.7 / luminanceOf(red) * red) < 1e-4);
            }
        });
    });
}

TEST_CASE("addLobeSamples adds means of what is seen, and what their parts say of the noise")
{
    onEveryDevice([](const device::Device& device) {
        LobeFrame frame(device, even(sky));
        PassBench pass(frame, "addLobeSamples");
        Planes<float> specular(layout, 3, 0.0f), sums(layout, 4, 0.0f), noisy(layout, 3, 0.0f),
            deviation(layout, 1, 0.0f), parts(layout, 3, 0.0f);
        Planes<std::uint32_t> taken(layout, 1, 0u);
        std::mt19937 random(2);
        everyPixel(layout, [&](int x, int y) {
            const auto any = [&] { return static_cast<float>(uniform(random, 0.1, 1)); };
            taken.at(x, y) = x % 7 == 0 ? 0 : 4 + static_cast<std::uint32_t>(random() % 30);
            specular.setVector(x, y, { any(), any(), any() });
            noisy.setVector(x, y, { any(), any(), any() });
            for (std::size_t plane = 0; plane < 4; ++plane)
                sums.at(x, y, plane) = static_cast<float>(taken.at(x, y)) * any();
            deviation.at(x, y) = shared::unpackShort(shared::packShort(any()));
            parts.setVector(x, y, { any(), any(), 0 });
        });
        constexpr std::uint32_t firstPass = 4;
        pass.value("firstPass", firstPass);
        pass.plane("specular", specular);
        pass.plane("sums", sums);
        pass.plane("parts", parts);
        pass.plane("taken", taken);
        pass.plane("noisy", noisy);
        pass.plane("deviation", deviation);
        const auto part = pass.pixels<float>("parts"); // in 48 bits
        pass.run();
        const auto found = pass.pixels<float>("noisy"), off = pass.pixels<float>("deviation");
        everyPixel(layout, [&](int x, int y) {
            const double n = taken.at(x, y);
            const glm::dvec3 k = specular.vector(x, y), mean = n > 0 ? sums.vector(x, y) / n : glm::dvec3(0);
            REQUIRE(glm::length(found.vector(x, y) - (noisy.vector(x, y) + k * mean)) < 1e-5);
            const double h = n >= 2 * firstPass ? std::floor(n / 2) : firstPass / 2.0;
            const double more =
                n > h ? luminanceOf(k) * (part.at(x, y) - luminanceOf(mean)) * std::sqrt(h / (n - h)) : 0;
            const double expected = deviation.at(x, y) + more;
            REQUIRE(std::fabs(off.at(x, y) - expected) <= 0.005 * std::fabs(expected) + 1e-4);
        });
    });
}

TEST_CASE(
    "lightMeans: what is seen over what is weighed, or by the sample; of lobes without samples the diffuse part's")
{
    onEveryDevice([](const device::Device& device) {
        for (const std::uint32_t channels : { 1u, 2u })
            for (const std::uint32_t shading : { WEDGE_SHADING_SEPARATE, WEDGE_SHADING_INSIDE, WEDGE_SHADING_RATIO }) {
                scene::Scene scene = smallScene();
                scene.materials[0].specular = glm::vec3(channels == 2 ? 0.3f : 0.0f);
                DeclaredFrame frame(device, scene, sized(render::axisAligned(16), width, height));
                Planes<float> sums(layout, 2 * channels, 0.0f);
                Planes<std::uint32_t> taken(layout, 1, 0u);
                std::mt19937 random(6);
                everyPixel(layout, [&](int x, int y) {
                    taken.at(x, y) = static_cast<std::uint32_t>(random() % 9);
                    for (std::size_t c = 0; c < channels && taken.at(x, y) > 0; ++c)
                        if (c == 0 || x % 3 != 0) { // else no sample reached the lobe
                            sums.at(x, y, 2 * c) = static_cast<float>(uniform(random, 1, 9));
                            sums.at(x, y, 2 * c + 1) = sums.at(x, y, 2 * c) * static_cast<float>(uniform(random));
                        }
                });
                shared::SampleParams params {};
                params.shading = shading;
                PassBench pass(frame, "lightMeans");
                pass.value("params", params);
                pass.plane("sums", sums);
                pass.plane("taken", taken);
                pass.run();
                const auto found = pass.pixels<float>("value");
                everyPixel(layout, [&](int x, int y) {
                    for (std::size_t c = 0; c < channels; ++c) {
                        const bool inside = shading == WEDGE_SHADING_INSIDE;
                        const std::size_t from = c == 1 && x % 3 == 0 && !inside ? 0 : c;
                        const double all = sums.at(x, y, 2 * from), seen = sums.at(x, y, 2 * from + 1),
                                     over = inside ? taken.at(x, y) : all;
                        const double expected = over > 0 ? seen / over : 0;
                        REQUIRE(std::fabs(found.at(x, y, c) - expected) <= 1e-6 * expected);
                    }
                });
            }
    });
}
