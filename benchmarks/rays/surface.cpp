#include "benchmarks/rays/surface.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>

// The kernels' own functions; address spaces mean nothing here.
namespace wedge::benchmark::kernel {
using namespace wedge::shared;
#define __global
#define restrict
#include "kernels/trace/surface.h"
#undef restrict
#undef __global
} // namespace wedge::benchmark::kernel

namespace wedge::benchmark {
namespace {

shared::Vec3 toVec3(const glm::vec3& v) { return shared::vec3(v.x, v.y, v.z); }

} // namespace

HostSurfaces::HostSurfaces(const scene::Scene& scene)
    : scene_(scene)
{
    for (const scene::Material& material : scene.materials) {
        shared::MaterialData data {};
        data.diffuse = toVec3(material.diffuse);
        data.specular = toVec3(material.specular);
        data.emission = toVec3(material.emission);
        data.exponent = material.exponent;
        data.diffuseTexture = data.specularTexture = data.exponentTexture = data.emissionTexture = WEDGE_NO_TEXTURE;
        materials_.push_back(data);
    }
}

SurfacePoint HostSurfaces::at(const shared::Hit& hit, shared::Vec3 direction) const
{
    const scene::Geometry& g = scene_.geometry;
    const kernel::SurfaceData data { g.positions.data(), g.normals.data(), g.texcoords.data(), g.indices.data(),
        g.materialIds.data(), materials_.data(), nullptr, nullptr, nullptr, nullptr, nullptr };
    const kernel::Facet f = kernel::facetOf(kernel::cornersOf(data, hit.triangle, 0.0f), hit.u, hit.v, direction);
    const shared::MaterialData& material = materials_[g.materialIds[hit.triangle]]; // of scenes without textures
    return { f.position, f.origin, f.normal, f.geometric, material.diffuse, material.emission };
}

bool mattAndUntextured(const scene::Scene& scene)
{
    return std::ranges::all_of(scene.materials, [](const scene::Material& m) {
        return m.specular == glm::vec3(0) && m.diffuseTexture < 0 && m.specularTexture < 0 && m.exponentTexture < 0
            && m.emissionTexture < 0;
    });
}

} // namespace wedge::benchmark
