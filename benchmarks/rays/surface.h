#pragma once

#include "host/render/device_scene.h"
#include "host/scene/scene.h"
#include "kernels/shared/hit.h"
#include "kernels/shared/vec.h"

#include <vector>

namespace wedge::benchmark {

/// What a ray found, as shading and further rays need it.
struct SurfacePoint {
    shared::Vec3 position, origin, normal, geometric; ///< as kernels/trace/surface.h has them
    shared::Vec3 diffuse, emission;
};

/// The surfaces of a scene by the very code that the kernels run, compiled for the host. Untextured scenes only.
class HostSurfaces {
public:
    /// scene must outlive this.
    explicit HostSurfaces(const scene::Scene& scene);
    SurfacePoint at(const shared::Hit& hit, shared::Vec3 direction) const;

private:
    const scene::Scene& scene_;
    std::vector<shared::MaterialData> materials_;
};

/// Whether all that the scene reflects is diffuse and of one colour a material.
bool mattAndUntextured(const scene::Scene& scene);

} // namespace wedge::benchmark
