// Which lobes have tables of a map's whole light.
#include "effects/shadow_lights/light_cache.h"
#include "kernels/shared/material.h"
#include "kernels/shared/shadow_lights.h"
#include "tests/render_support.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

/// A scene of a triangle of each of these, and of another material that none has.
scene::Scene of(const std::vector<scene::Material>& materials)
{
    scene::Scene scene;
    scene.materials = materials;
    scene.geometry.materialIds.reserve(materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i)
        scene.geometry.materialIds.push_back(static_cast<std::uint32_t>(i));
    scene::Material unused;
    unused.specular = glm::vec3(1);
    unused.exponent = 7;
    scene.materials.push_back(unused);
    return scene;
}

scene::Material lobe(scene::SpecularModel model, float exponent)
{
    scene::Material m;
    m.specular = glm::vec3(0.2f);
    m.specularModel = model;
    m.exponent = exponent;
    m.roughness = 0.5f;
    return m;
}

std::vector<shared::Gloss> glosses(const scene::Scene& scene)
{
    const std::vector<std::uint32_t> all = render::cachedGlosses(scene);
    std::vector<shared::Gloss> out;
    out.reserve(all.size());
    for (const std::uint32_t packed : all)
        out.push_back(shared::unpackGloss(packed));
    return out;
}

} // namespace

TEST_CASE("each lobe of a scene has its table, once, and microfacets two")
{
    using scene::SpecularModel;
    scene::Material matt, mirror = lobe(SpecularModel::Mirror, 1);
    const std::vector<shared::Gloss> all = glosses(of({ matt, mirror, lobe(SpecularModel::Ggx, 1),
        lobe(SpecularModel::Phong, 50), lobe(SpecularModel::Phong, 5), lobe(SpecularModel::Phong, 50) }));
    REQUIRE(all.size() == 4);
    CHECK(all[0].kind == WEDGE_PHONG);
    CHECK(all[0].exponent == doctest::Approx(5));
    CHECK(all[1].exponent == doctest::Approx(50));
    CHECK(all[2].kind == WEDGE_MICROFACETS);
    CHECK(all[2].exponent == doctest::Approx(64).epsilon(1e-3)); // 4 / 0.5^4
    CHECK(all[2].rise == 0);
    CHECK(all[3].rise == WEDGE_CACHE_RISE);
    CHECK(glosses(of({ matt })).empty());
}

TEST_CASE("more lobes than there are tables lie between those, which are evenly apart")
{
    std::vector<scene::Material> many;
    many.reserve(17);
    for (int k = 0; k < 17; ++k)
        many.push_back(lobe(scene::SpecularModel::BlinnPhong, static_cast<float>(3 + k * k)));
    std::vector<shared::Gloss> all = glosses(of(many));
    REQUIRE(all.size() == render::mostCachedExponents);
    CHECK(all.front().exponent == doctest::Approx(3));
    CHECK(all.back().exponent == doctest::Approx(259));
    for (std::size_t k = 1; k < all.size(); ++k)
        CHECK((1 + all[k].exponent) / (1 + all[k - 1].exponent) == doctest::Approx(std::pow(260 / 4.0, 1 / 15.0)));
    many.pop_back();
    CHECK(glosses(of(many)).size() == 16);
    CHECK(glosses(of(many))[1].exponent == doctest::Approx(4));
}

TEST_CASE("a texture of exponents has tables from its least to its most")
{
    scene::Material m = lobe(scene::SpecularModel::Phong, 510);
    m.exponentTexture = 0;
    scene::Scene scene = of({ m });
    scene::Texture texture;
    texture.width = 3;
    texture.height = 1;
    texture.rgba = { 0xff000004u, 0xff0000ffu, 0xff000080u };
    scene.textures = { texture };
    const std::vector<shared::Gloss> all = glosses(scene);
    REQUIRE(all.size() == render::mostCachedExponents);
    CHECK(all.front().exponent == doctest::Approx(8));
    CHECK(all.back().exponent == doctest::Approx(510));
    scene.textures[0].rgba = { 0xff000004u, 0xff000004u, 0xff000004u }; // even
    CHECK(glosses(scene).size() == 1);
}
