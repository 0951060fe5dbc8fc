#include "host/render/prepared_scene.h"

#include "host/render/device_scene.h"
#include "host/render/effect.h"
#include "host/render/glass.h"

#include <utility>
#include <vector>

namespace wedge::render {

SceneTraits traitsOf(const scene::Scene& scene)
{
    constexpr float leastPhong = 16.0f, leastBlinnPhong = 4.0f * leastPhong; // as wide: exponentAs()
    std::vector<bool> used(scene.materials.size(), false);
    for (const std::uint32_t id : scene.geometry.materialIds) {
        used[id] = true;
    }
    SceneTraits out;
    out.narrowLobes = true;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) {
            continue;
        }
        const scene::Material& m = scene.materials[i];
        const std::uint32_t kind = kindOf(m);
        const bool mirror = WEDGE_IS_MIRROR(kind);
        out.specular |= m.specular.r + m.specular.g + m.specular.b > 0.0f && !mirror;
        const bool narrow = kind != WEDGE_MICROFACETS && m.exponentTexture < 0
            && m.exponent >= (kind == WEDGE_PHONG ? leastPhong : leastBlinnPhong);
        out.narrowLobes &= m.specular == glm::vec3(0.0f) || mirror || narrow;
        out.mirrors |= mirror;
        out.microfacets |= kind == WEDGE_MICROFACETS;
        out.normalMaps |= m.normalTexture >= 0;
    }
    out.touchingGlass = hasTouchingGlass(scene) ? touchingDistance(scene) : 0.0f;
    out.moves = scene::geometryMoves(scene);
    return out;
}

PreparedScene::PreparedScene(scene::Scene scene)
    : scene::Scene(std::move(scene))
    , picture_(pictureOf(*this))
    , direct_(render::directLights(*this))
    , traits_(traitsOf(*this))
{
}

const SceneLights& PreparedScene::lights() const
{
    if (!lights_) {
        if (!beyond_) {
            beyond_ = std::make_shared<const EnvironmentTable>(environmentTable(picture_.get()));
        }
        lights_ = std::make_shared<const SceneLights>(*this, direct_, beyond_);
    }
    return *lights_;
}

void PreparedScene::change(const scene::Change& change, const std::function<void(scene::Scene&)>& alter)
{
    alter(*this);
    if (change.lights || change.geometry) {
        lights_.reset();
        direct_ = render::directLights(*this); // triangles that emit are among them
    }
    if (change.geometry) {
        traits_ = traitsOf(*this);
    }
}

} // namespace wedge::render
