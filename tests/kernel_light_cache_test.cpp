// fillLightCache and lookUpLight of light_cache.cl alone: tables of a map's light by normals, against sums over all of
// the map in double, and what pixels find in them.
#include "effects/shadow_lights/light_cache.h"
#include "effects/shadow_lights/light_tree.h"
#include "kernels/shared/bsdf.h"
#include "tests/light_cache_support.h"
#include "tests/map_directions.h"
#include "tests/shadow_frames.h"

#include <algorithm>
#include <random>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

constexpr std::size_t texels = std::size_t { WEDGE_CACHE_SIDE } * WEDGE_CACHE_SIDE;

/// A small scene of that map with lobes of these materials, on all of its triangles in turn.
scene::Scene glosses(const std::shared_ptr<render::EnvironmentPicture>& map, const std::vector<scene::Material>& of)
{
    scene::Scene scene = things(map);
    scene.materials = of;
    for (std::size_t i = 0; i < scene.geometry.materialIds.size(); ++i)
        scene.geometry.materialIds[i] = static_cast<std::uint32_t>(i % of.size());
    return scene;
}

scene::Material lobe(scene::SpecularModel model, float exponent, float roughness = 0.5f)
{
    scene::Material m;
    m.specular = glm::vec3(0.3f);
    m.specularModel = model;
    m.exponent = exponent;
    m.roughness = roughness;
    return m;
}

/// The tables of a scene, as the kernel fills them.
std::vector<float> filled(DeclaredFrame& frame, const std::vector<std::uint32_t>& of)
{
    PassBench fill(frame, "fillLightCache");
    fill.plane("tree", render::lightTree(render::mapPlaces(*frame.scene().picture())));
    fill.plane("glosses", of);
    fill.plane("table", std::vector<float>(3 * (of.size() + 1) * texels, -1.0f));
    fill.run();
    return fill.read<float>("table");
}

double greenOf(const std::vector<float>& table, std::size_t k, int x, int y)
{
    return table[3 * (k * texels + static_cast<std::size_t>(y * side + x)) + 1];
}

/// What a surface reflects of directions, green; gloss null: a matt one of albedo 1
double reflected(const std::vector<render::MapLight>& directions, const shared::Gloss* gloss, const glm::dvec3& n,
    const glm::dvec3& view)
{
    double sum = 0;
    for (const render::MapLight& direction : directions) {
        const double cosine = glm::dot(n, glm::dvec3(direction.towards));
        if (cosine > 0) {
            const double value = gloss == nullptr ? 1 / std::numbers::pi
                                                  : shared::lobeValue(shared::lobeOf(*gloss), toVec3(n), toVec3(view),
                                                      toVec3(glm::dvec3(direction.towards)));
            sum += value * cosine * direction.irradiance.y;
        }
    }
    return sum;
}

} // namespace

TEST_CASE("fillLightCache: tables hold what surfaces of each normal reflect of the map, seen from the camera's side")
{
    onEveryDevice([](const device::Device& device) {
        using scene::SpecularModel;
        const scene::Scene scene = glosses(spotted(),
            { lobe(SpecularModel::Phong, 40), lobe(SpecularModel::BlinnPhong, 60), lobe(SpecularModel::Ggx, 1) });
        DeclaredFrame frame(device, scene, with(Shadows::Ratio, 30, WholeLight::Cache));
        const std::vector<std::uint32_t> of = render::cachedGlosses(frame.scene());
        REQUIRE(of.size() == 4);
        const std::vector<float> table = filled(frame, of);
        const NormalDisc disc(PassBench(frame, "fillLightCache").own<shared::FrameParams>("frame"));
        const std::vector<render::MapLight> directions = directionsOf(*spotted(), 8);
        for (std::size_t k = 0; k <= of.size(); ++k) {
            CAPTURE(k);
            const shared::Gloss gloss = k > 0 ? shared::unpackGloss(of[k - 1]) : shared::Gloss {};
            double squares = 0, sum = 0;
            int count = 0, outside = 0;
            for (int y = 0; y < side; y += 5)
                for (int x = y % 3; x < side; x += 5) {
                    const double own = greenOf(table, k, x, y);
                    if (!NormalDisc::inside(x, y)) {
                        REQUIRE(own == -1); // not touched
                        ++outside;
                        continue;
                    }
                    const glm::dvec3 n = disc.normalAt(x, y);
                    if (k > 0 && glm::dot(n, disc.towards) < 0.1) // where sums over parts err more
                        continue;
                    const double right = reflected(directions, k > 0 ? &gloss : nullptr, n, disc.towards);
                    squares += (own - right) * (own - right);
                    sum += right;
                    ++count;
                }
            CHECK(outside > 50);
            REQUIRE(count > 200);
            CHECK(std::sqrt(squares / count) < (k > 0 ? 0.02 : 0.01) * sum / count);
        }
    });
}

TEST_CASE("fillLightCache: of a map that is everywhere the same, matt surfaces reflect what it has, all around")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, things(even({ 1, 2, 3 }, 64, 32)), with(Shadows::Ratio, 30, WholeLight::Cache));
        REQUIRE(render::cachedGlosses(frame.scene()).empty());
        PassBench fill(frame, "fillLightCache");
        fill.plane("tree", render::lightTree(render::mapPlaces(*frame.scene().picture())));
        fill.run();
        const std::vector<float> table = fill.read<float>("table");
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                if (NormalDisc::inside(x, y))
                    REQUIRE(greenOf(table, 0, x, y) == doctest::Approx(2).epsilon(0.004));
    });
}

TEST_CASE("lookUpLight: pixels find what is between four texels, two exponents and two rises")
{
    onEveryDevice([](const device::Device& device) {
        using scene::SpecularModel;
        const scene::Scene scene = glosses(spotted(),
            { lobe(SpecularModel::Phong, 10), lobe(SpecularModel::Phong, 100), lobe(SpecularModel::Ggx, 1, 0.7f),
                lobe(SpecularModel::Ggx, 1, 0.4f) });
        DeclaredFrame frame(device, scene, with(Shadows::Ratio, 30, WholeLight::Cache));
        const std::vector<std::uint32_t> of = render::cachedGlosses(frame.scene());
        REQUIRE(of.size() == 6);
        PassBench look(frame, "lookUpLight");
        const NormalDisc disc(look.own<shared::FrameParams>("frame"));
        std::mt19937 random(11);
        const std::size_t size = frame.layout.size;
        std::vector<float> table = someNumbers(random, 3 * 7 * texels, 0, 1), normals(3 * size), reflects(3 * size, 1);
        for (std::size_t i = 0; i < 3 * texels * 7; ++i) // what has risen is more
            table[i] += i / (3 * texels) % 2 == 0 && i / (3 * texels) > 2 ? 20.0f : 0.0f;
        std::vector<std::uint32_t> gloss(size), object(size, 1);
        for (std::size_t i = 0; i < size; ++i) {
            glm::dvec3 n(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
            n = i % 9 == 0 ? disc.towards : i % 9 == 1 ? disc.towards + 1e-4 * n : n;
            n = i % 9 == 2 ? disc.across - disc.towards * 1e-3 : n;
            for (int axis = 0; axis < 3; ++axis)
                normals[static_cast<std::size_t>(axis) * size + i] = static_cast<float>(glm::normalize(n)[axis]);
            const bool phong = random() % 2 == 0;
            shared::Gloss g = shared::makeGloss(
                static_cast<float>(std::pow(10.0, uniform(random, 0.5, 2.5))), phong ? WEDGE_PHONG : WEDGE_MICROFACETS);
            g.rise = phong ? 0.0f : static_cast<float>(uniform(random, 0, 30));
            gloss[i] = i % 4 == 0 ? of[random() % 6] : shared::packGloss(g);
            object[i] = i % 13 == 0 ? 0 : 1;
            reflects[i] = reflects[size + i] = reflects[2 * size + i] = i % 7 == 0 ? 0.0f : 1.0f;
        }
        look.plane("normal", normals);
        look.plane("specular", reflects);
        look.plane("gloss", gloss);
        look.plane("objectId", object);
        look.plane("glosses", of);
        look.plane("table", table);
        look.run();
        const auto at = [&](const char* name) { return look.pixels<float>(name); };
        const auto matt = at("wholeMatt"), whole = at("whole"), normal = at("normal"), specular = at("specular");
        const auto own = look.pixels<std::uint32_t>("gloss"), there = look.pixels<std::uint32_t>("objectId");
        everyPixel(frame.layout, [&](int x, int y) {
            const glm::dvec2 place = disc.placeOf(glm::normalize(normal.vector(x, y)));
            const int left = static_cast<int>(place.x), top = static_cast<int>(place.y);
            const double u = place.x - left, v = place.y - top;
            REQUIRE(NormalDisc::inside(left, top));
            REQUIRE(NormalDisc::inside(left + 1, top + 1));
            const auto found = [&](std::size_t k) {
                return (1 - v) * ((1 - u) * greenOf(table, k, left, top) + u * greenOf(table, k, left + 1, top))
                    + v * ((1 - u) * greenOf(table, k, left, top + 1) + u * greenOf(table, k, left + 1, top + 1));
            };
            const bool any = there.at(x, y) != 0, shines = any && specular.at(x, y) > 0;
            REQUIRE(matt.at(x, y, 1) == doctest::Approx(any ? found(0) : 0).epsilon(1e-3));
            const shared::Gloss g = shared::unpackGloss(own.at(x, y));
            const std::size_t first = g.kind == WEDGE_PHONG ? 1 : 3, step = g.kind == WEDGE_PHONG ? 1 : 2;
            const auto exponent = [&](std::size_t k) {
                return std::log1p(double { shared::unpackGloss(of[k - 1]).exponent });
            };
            const double share =
                (std::log1p(double { g.exponent }) - exponent(first)) / (exponent(first + step) - exponent(first));
            const auto risen = [&](std::size_t k) {
                const double rise = g.kind == WEDGE_PHONG ? 0 : double { g.rise } / 15;
                return rise > 0 ? found(k) + rise * (found(k + 1) - found(k)) : found(k);
            };
            const double t = std::clamp(share, 0.0, 1.0), expected = (1 - t) * risen(first) + t * risen(first + step);
            REQUIRE(whole.at(x, y, 1) == doctest::Approx(shines ? expected : 0).epsilon(2e-3));
        });
    });
}

TEST_CASE("lookUpLight: a normal that faces away looks at the rim, and none looks beside what is filled")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = things(spotted());
        scene.camera.eye = { 0, 0, 5 }; // along an axis, so that the view has no rounding
        scene.camera.lookAt = { 0, 0, 0 };
        DeclaredFrame frame(device, scene, with(Shadows::Ratio, 30, WholeLight::Cache));
        PassBench look(frame, "lookUpLight");
        const NormalDisc disc(look.own<shared::FrameParams>("frame"));
        const std::size_t size = frame.layout.size;
        std::vector<float> table(3 * texels, std::numeric_limits<float>::quiet_NaN()), normals(3 * size);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                for (std::size_t c = 0; c < 3 && NormalDisc::inside(x, y); ++c) {
                    const glm::dvec3 n = disc.normalAt(x, y);
                    table[3 * static_cast<std::size_t>(y * side + x) + c] =
                        static_cast<float>(glm::dot(n, disc.towards)); // as far off as it is
                }
        std::mt19937 random(5);
        for (std::size_t i = 0; i < size; ++i) {
            const glm::dvec3 n(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
            const glm::dvec3 own = glm::normalize(i % 3 == 0 ? n
                    : i % 3 == 1                             ? -disc.towards + 1e-3 * n
                                                             : -disc.towards);
            for (int axis = 0; axis < 3; ++axis)
                normals[static_cast<std::size_t>(axis) * size + i] = static_cast<float>(own[axis]);
        }
        look.plane("normal", normals);
        look.plane("objectId", std::vector<std::uint32_t>(size, 1));
        look.plane("table", table);
        look.run();
        const auto matt = look.pixels<float>("wholeMatt"), normal = look.pixels<float>("normal");
        everyPixel(frame.layout, [&](int x, int y) {
            const double z = glm::dot(normal.vector(x, y), disc.towards);
            REQUIRE(matt.at(x, y, 1) == doctest::Approx(std::max(z, std::cos(disc.widest))).epsilon(1e-3).scale(1));
        });
    });
}
