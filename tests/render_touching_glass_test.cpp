// Bodies of glass that touch, overlap and lie in one another, against Fresnel's terms with all that is reflected
// between the faces, and against one body in their place.
#include "kernels/shared/mirror.h"
#include "tests/glass_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

const glm::vec3 above(0.8f, 0.5f, 0.2f), below(0.1f, 0.4f, 1.0f);

/// Above and below of one radiance each.
void addTwoSkies(scene::Scene& scene)
{
    std::vector<glm::vec3> rows(64, above);
    std::fill(rows.begin() + 32, rows.end(), below);
    addSky(scene, rows);
}

/// What layers of these refractive indices, from above, air not among them, reflect of unpolarized light in air at that
/// angle; each polarization by itself. What is left they transmit.
double reflectedBy(const std::vector<double>& layers, double angle)
{
    std::vector<double> n { 1 };
    n.insert(n.end(), layers.begin(), layers.end());
    n.push_back(1);
    // Paths mix polarizations at each face.
    double reflect = 0, back = 0, through = 1;
    for (std::size_t i = 0; i + 1 < n.size(); ++i) {
        const double sine = std::sin(angle) / n[i];
        if (sine >= 1)
            return 1;
        float cosine = 0;
        const double f = n[i] == n[i + 1] ? 0.0
                                          : shared::dielectricFresnel(static_cast<float>(std::sqrt(1 - sine * sine)),
                                              static_cast<float>(n[i + 1] / n[i]), &cosine);
        // Of the layers so far, from above and from below, with one more face below them.
        const double series = 1 / (1 - back * f);
        reflect += through * f * series * through;
        back = f + (1 - f) * back * series * (1 - f);
        through = through * (1 - f) * series;
    }
    return reflect;
}

glm::vec3 seenThrough(const std::vector<double>& layers, double angle)
{
    const auto r = static_cast<float>(reflectedBy(layers, angle));
    return r * above + (1 - r) * below;
}

/// A layer of glass between two heights.
struct Layer {
    float low, high;
    std::uint32_t material;
};

/// Layers of that extent, and a camera that looks at them at that angle.
SceneBuilder slabs(
    const std::vector<scene::Material>& materials, const std::vector<Layer>& layers, double angle, float extent = 400)
{
    SceneBuilder b;
    for (const scene::Material& m : materials)
        addMaterial(b, m);
    for (const Layer& l : layers) {
        b.newObject();
        b.box({ -extent, l.low, -extent }, { extent, l.high, extent }, l.material);
    }
    const glm::vec3 at(0.013f * extent, layers[0].high, 0.007f * extent);
    b.camera(at + 3.0f * glm::vec3(static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0), at,
        { 0, 0, 1 }, 0.2f);
    addTwoSkies(b.scene);
    return b;
}

constexpr double angles[] = { 0.3, 1.0, 1.3 };

void checkSlabs(const SceneBuilder& b, const device::Device& device, glm::vec3 expected)
{
    for (const render::Traversal traversal : { render::Traversal::Wide, render::Traversal::Scalar }) {
        render::Options options = renderOptions();
        options.traversal = traversal;
        render::Renderer renderer(b.scene, device, options);
        CAPTURE(static_cast<int>(traversal));
        checkMean(renderPixels(renderer, sized(render::monteCarlo(256), 16, 16)), expected, 1.5e-3);
    }
}

} // namespace

TEST_CASE("slabs that share planes are one slab, of one glass and of several, with foils between or not")
{
    const std::vector<scene::Material> materials { glass(1.5f), glass(1.33f), glass(1.7f) };
    onEveryDevice([&](const device::Device& device) {
        for (const double angle : angles)
            for (const float lift : { 0.0f, 0.73f }) {
                CAPTURE(angle);
                CAPTURE(lift);
                checkSlabs(slabs(materials, { { lift, lift + 0.1f, 1 }, { lift - 0.2f, lift, 1 } }, angle), device,
                    seenThrough({ 1.5 }, angle));
                std::vector<Layer> eight(8);
                for (std::size_t i = 0; i < eight.size(); ++i)
                    eight[i] = { lift - 0.1f * static_cast<float>(i + 1), lift - 0.1f * static_cast<float>(i), 1 };
                checkSlabs(slabs(materials, eight, angle), device, seenThrough({ 1.5 }, angle));
                // Foils thinner than rounding are nothing.
                checkSlabs(slabs(materials,
                               { { lift, lift + 0.1f, 1 }, { lift - 4e-4f, lift, 2 }, { lift - 8e-4f, lift - 4e-4f, 2 },
                                   { lift - 0.2f, lift - 8e-4f, 3 } },
                               angle),
                    device, seenThrough({ 1.5, 1.7 }, angle));
                checkSlabs(
                    slabs(materials,
                        { { lift, lift + 0.1f, 1 }, { lift - 0.2f, lift, 2 }, { lift - 0.3f, lift - 0.2f, 3 } }, angle),
                    device, seenThrough({ 1.5, 1.33, 1.7 }, angle));
            }
    });
}

TEST_CASE("gaps within rounding and above it are one slab or two, at every size of scene")
{
    const std::vector<scene::Material> materials { glass(1.5f), glass(1.33f) };
    onEveryDevice([&](const device::Device& device) {
        const double angle = 0.5; // refracted at less than the critical angle, so that gaps transmit
        for (const float extent : { 3.0f, 400.0f })
            for (const float lift : { 0.0f, 0.3f, 0.99f })
                // 1e-6 to 1.1e-6: two slabs, yet at 0.99 nearer than rays start off them.
                for (const float gap : { 3e-9f, 3e-8f, 1e-7f, 3e-7f, 6e-7f, 1e-6f, 1.04e-6f, 1.5e-6f, 3e-6f, 1e-5f }) {
                    const float size = 2 * extent, low = lift * extent, high = low + gap * size;
                    CAPTURE(extent);
                    CAPTURE(lift);
                    CAPTURE(gap);
                    const double is = high > low ? gap : 0;
                    CAPTURE(is);
                    const SceneBuilder b = slabs(materials,
                        { { high, high + 0.01f * extent, 1 }, { low - 0.01f * extent, low, 1 } }, angle, extent);
                    render::Renderer renderer(b.scene, device, renderOptions());
                    const std::vector<float> image = renderPixels(renderer, sized(render::monteCarlo(256), 16, 16));
                    REQUIRE(notFinite(image) == 0);
                    const Mean mean = meanOf(image, 0);
                    const float one = seenThrough({ 1.5 }, angle).x, two = seenThrough({ 1.5, 1, 1.5 }, angle).x;
                    CAPTURE(mean.value);
                    CAPTURE(mean.deviation);
                    CAPTURE(one);
                    CAPTURE(two);
                    const double off = std::min(std::abs(mean.value - one), std::abs(mean.value - two));
                    CHECK(off < 3 * mean.deviation + 1.5e-3 * one);
                    CHECK(mean.deviation < 0.25 * std::abs(one - two));
                }
    });
}

TEST_CASE("slabs in one another: the inner one counts, flush with the outer one or not, twenty deep")
{
    std::vector<scene::Material> materials { glass(1.5f), glass(1.2f), glass(1.7f) };
    for (int i = 0; i < 20; ++i)
        materials.push_back(glass(1.1f + 0.04f * static_cast<float>(i)));
    onEveryDevice([&](const device::Device& device) {
        for (const double angle : { 0.3, 1.1 }) {
            CAPTURE(angle);
            const glm::vec3 three = seenThrough({ 1.5, 1.2, 1.5 }, angle);
            checkSlabs(slabs(materials, { { 0, 1, 1 }, { 0.3f, 0.6f, 2 } }, angle), device, three);
            checkSlabs(
                slabs(materials, { { 0, 1, 3 }, { 0.3f, 0.6f, 3 } }, angle), device, seenThrough({ 1.7 }, angle));
            // Flush above, below, and on both sides.
            for (const bool first : { true, false }) {
                const auto both = [&](Layer outer, Layer inner) {
                    SceneBuilder b =
                        first ? slabs(materials, { outer, inner }, angle) : slabs(materials, { inner, outer }, angle);
                    b.box({ -500, -20, -500 }, { 500, -19, 500 }, 1); // far below, larger; one more slab
                    return b;
                };
                checkSlabs(both({ -1, 1, 1 }, { 0.3f, 1, 2 }), device, seenThrough({ 1.2, 1.5, 1, 1.5 }, angle));
                checkSlabs(both({ -1, 1, 1 }, { -1, 0.3f, 2 }), device, seenThrough({ 1.5, 1.2, 1, 1.5 }, angle));
            }
            std::vector<Layer> nested;
            std::vector<double> indices;
            for (int i = 0; i < 20; ++i) {
                const float inset = 0.04f * static_cast<float>(i);
                nested.push_back({ -1 + inset, 1 - inset, static_cast<std::uint32_t>(4 + i) });
                indices.push_back(materials[3 + static_cast<std::size_t>(i)].index);
            }
            for (int i = 18; i >= 0; --i)
                indices.push_back(indices[static_cast<std::size_t>(i)]);
            checkSlabs(slabs(materials, nested, angle), device, seenThrough(indices, angle));
        }
    });
}

TEST_CASE("liquid between panes: with a gap, with the same faces, overlapping, of either priority")
{
    std::vector<scene::Material> materials { glass(1.5f), glass(1.33f) };
    onEveryDevice([&](const device::Device& device) {
        for (const double angle : { 0.3, 1.1 })
            for (const int priority : { -1, 0, 1 }) {
                materials[1].priority = priority;
                CAPTURE(angle);
                CAPTURE(priority);
                const glm::vec3 wet = seenThrough({ 1.5, 1.33, 1.5 }, angle);
                const Layer upper { 1, 1.2f, 1 }, lower { -0.2f, 0, 1 };
                checkSlabs(slabs(materials, { upper, { 0, 1, 2 }, lower }, angle), device, wet);
                checkSlabs(slabs(materials, { upper, { -0.1f, 1.1f, 2 }, lower }, angle), device, wet);
                checkSlabs(slabs(materials, { upper, { 0.01f, 0.99f, 2 }, lower }, angle), device,
                    seenThrough({ 1.5, 1, 1.33, 1, 1.5 }, angle));
            }
        // Of an ambiguous overlap the priority says what is there: here all of it is one of the two.
        materials[1].priority = 1;
        checkSlabs(slabs(materials, { { 0, 1, 1 }, { -0.5f, 1.5f, 2 } }, 0.3), device, seenThrough({ 1.33 }, 0.3));
        materials[1].priority = -1;
        checkSlabs(
            slabs(materials, { { 0, 1, 1 }, { -0.5f, 1.5f, 2 } }, 0.3), device, seenThrough({ 1.33, 1.5, 1.33 }, 0.3));
    });
}

TEST_CASE("a camera inside of glass sees as from there, in one body and in two")
{
    onEveryDevice([](const device::Device& device) {
        // Up through the water's surface, and down through its floor: the angle inside is 0.4.
        const std::vector<scene::Material> materials { glass(1.33f), glass(1.6f) };
        for (const bool ball : { false, true })
            for (const bool turned : { false, true }) {
                SceneBuilder b;
                for (const scene::Material& m : materials)
                    addMaterial(b, m);
                b.newObject();
                b.box({ -40, -2, -40 }, { 40, 0, 40 }, 1);
                b.newObject();
                b.box({ -40, -0.5f, -40 }, { 40, -0.25f, 40 }, ball ? 2 : 1);
                const float up = turned ? -1.0f : 1.0f;
                b.camera({ 0, -1, 0 }, { std::sin(0.4f), -1 + up * std::cos(0.4f), 0 }, { 0, 0, 1 }, 0.2f);
                addTwoSkies(b.scene);
                // A closed form by the same series, of light in water: what goes in from below at the angle in air.
                float unused = 0;
                const double f = shared::dielectricFresnel(static_cast<float>(std::cos(0.4)), 1 / 1.33f, &unused);
                const double inner = ball ? [&] {
                    const double a = shared::dielectricFresnel(static_cast<float>(std::cos(0.4)), 1.6f / 1.33f, &unused);
                    return 2 * a / (1 + a); // of two faces
                }() : 0.0;
                CAPTURE(ball);
                CAPTURE(turned);
                const double t = 1 - f, s = inner, p = 1 - inner;
                // From the camera upwards the slab (s, p) and the surface (f, t), downwards the floor (f, t).
                const double upR = s + p * p * f / (1 - s * f), upT = p * t / (1 - s * f);
                const double cavity = 1 / (1 - upR * f);
                const double squared = 1.33 * 1.33;
                glm::vec3 expected;
                for (int c = 0; c < 3; ++c) {
                    const double towardsUp = (upT * above[c] + upR * t * below[c]) * cavity;
                    const double towardsDown = (t * below[c] + f * upT * above[c]) * cavity;
                    expected[c] = static_cast<float>(squared * (turned ? towardsDown : towardsUp));
                }
                checkSlabs(b, device, expected);
            }
    });
}

TEST_CASE("what stands on a surface is seen the same with a small gap and without, and so is what lies before it")
{
    onEveryDevice([](const device::Device& device) {
        std::vector<Mean> found;
        for (const float gap : { 1e-2f, 0.0f, 1e-7f, 1e-6f, 1e-5f }) {
            SceneBuilder b;
            b.quad({ 0, 0, 0 }, { 0, 0, 30 }, { 30, 0, 0 });
            b.newObject();
            b.box({ -30, gap, -30 }, { 30, gap + 1, 30 }, addMaterial(b, glass(1.5f)));
            b.camera({ 0, 4, 0.2f }, { 0, 0, 0 }, { 0, 0, 1 }, 3);
            addSky(b.scene, { even });
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings s = sized(render::monteCarlo(1024), 16, 16);
            s.bounces = 12;
            const std::vector<float> image = renderPixels(renderer, s);
            REQUIRE(notFinite(image) == 0);
            found.push_back(meanOf(image, 0));
            CAPTURE(gap);
            CAPTURE(found[0].value);
            CAPTURE(found.back().value);
            CAPTURE(found.back().deviation);
            CHECK(std::abs(found.back().value - found[0].value)
                < 4 * std::hypot(found[0].deviation, found.back().deviation));
            CHECK(found.back().deviation < 0.01 * found[0].value);
        }
    });
}

TEST_CASE("paths of light from surfaces go through bodies that touch as through one")
{
    onEveryDevice([](const device::Device& device) {
        std::vector<Mean> found;
        for (const bool touching : { false, true }) {
            SceneBuilder b;
            b.quad({ 0, 0, 0 }, { 0, 0, 0.01f }, { 0.01f, 0, 0 });
            const std::uint32_t material = addMaterial(b, glass(1.5f));
            b.newObject();
            if (touching) {
                for (int i = 0; i < 4; ++i)
                    b.box({ -80, 1 + 0.25f * static_cast<float>(i), -80 },
                        { 80, 1.25f + 0.25f * static_cast<float>(i), 80 }, material);
            } else {
                b.box({ -80, 1, -80 }, { 80, 2, 80 }, material);
            }
            b.camera({ 0.7f, 0.5f, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, 0.2f);
            addTwoSkies(b.scene);
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings s = sized(render::monteCarlo(1024), 16, 16);
            s.bounces = 2;
            const std::vector<float> image = renderPixels(renderer, s);
            REQUIRE(notFinite(image) == 0);
            found.push_back(meanOf(image, 0));
        }
        CAPTURE(found[0].value);
        CAPTURE(found[1].value);
        CHECK(found[0].value > 0.1);
        CHECK(std::abs(found[0].value - found[1].value) < 4 * std::hypot(found[0].deviation, found[1].deviation));
        CHECK(found[1].deviation < 0.01 * found[1].value);
    });
}

TEST_CASE("glass in an even sky cannot be seen: bodies that touch at edges and corners, overlap, and faceted balls")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        const std::uint32_t one = addMaterial(b, glass(1.5f)), two = addMaterial(b, glass(1.33f));
        b.box({ -1, -1, -1 }, { 0, 0, 0 }, one);
        b.newObject();
        b.box({ 0, 0, -1 }, { 1, 1, 0 }, two);
        b.newObject();
        b.box({ 0, -1, 0 }, { 1, 0, 1 }, one);
        b.newObject();
        b.sphere({ -0.2f, 0.5f, 0.6f }, 0.5f, 10, one);
        b.newObject();
        b.sphere({ -0.5f, 0.6f, 0.6f }, 0.5f, 10, two);
        b.newObject();
        b.sphere({ -0.45f, 0.6f, 0.6f }, 0.3f, 10, one);
        b.camera({ 0.4f, 0.9f, 5 }, { 0, 0, 0 }, { 0, 1, 0 }, 35);
        addSky(b.scene, { even });
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const bool antialias : { false, true }) {
            render::Settings s = sized(render::monteCarlo(256), 48, 36);
            s.antialias = antialias;
            CAPTURE(antialias);
            checkMean(renderPixels(renderer, s), even, 1e-4);
        }
    });
}
