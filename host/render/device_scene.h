#pragma once

#include "host/device/buffer.h"
#include "host/device/memory_plan.h"
#include "host/render/emitters.h"
#include "host/render/environment_bandwidth.h"
#include "host/render/hierarchy.h"
#include "host/render/prepared_scene.h"
#include "host/scene/scene.h"
#include "kernels/shared/bvh_types.h"
#include "kernels/shared/emitter.h"
#include "kernels/shared/environment.h"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"

#include <vector>

namespace wedge::render {

/// Of MaterialData: what a material reflects besides diffusely, WEDGE_LAMBERT if nothing.
std::uint32_t kindOf(const scene::Material& m);

/// The light as kernels take it: profile integrated, axes, standard deviations.
shared::AreaLight deviceLight(const scene::AreaLight& light);

/// Area of a light, m^2, each point as much as it has of the radiance in the middle.
double profileArea(const scene::AreaLight& light);

/// The scene on the device: hierarchy, geometry, materials, textures, lights.
class DeviceScene {
public:
    /// Adds what the scene will take to the plan.
    static void plan(device::MemoryPlan& plan, const PreparedScene& scene, const Hierarchy& hierarchy);

    /// Uploads everything; scene and hierarchy must outlive this, since a CPU device works on their memory. Throws
    /// Error from the device.
    DeviceScene(const PreparedScene& scene, const Hierarchy& hierarchy, const device::Device& device,
        device::TimedQueue& queue);

    DeviceScene(const PreparedScene&, Hierarchy&&, const device::Device&, device::TimedQueue&) = delete;
    DeviceScene(PreparedScene&&, const Hierarchy&, const device::Device&, device::TimedQueue&) = delete;

    device::Buffer<std::byte> nodes; ///< of the hierarchy's family of traversals
    device::Buffer<std::byte> blocks;
    device::Buffer<float> positions, normals, texcoords;
    device::Buffer<float> positionsAtClose, normalsAtClose; ///< one element that nobody reads where nothing moves
    device::Buffer<std::uint32_t> indices, materialIds, objectIds;
    device::Buffer<shared::MaterialData> materials;
    device::Buffer<shared::TextureData> textures;
    device::Buffer<std::uint32_t> texels;
    device::Buffer<float> srgbToLinear;
    device::Buffer<shared::AreaLight> areaLights;
    device::Buffer<shared::DeltaLight> deltaLights;
    device::Buffer<shared::DeltaLight> plainLights; ///< those of them whose shadows have no style
    /// SceneLights::emitters and shared; one element that nobody reads where there are none.
    device::Buffer<shared::Emitter> emitters, sharedLights;
    device::Buffer<float> emitterPicks, sharedPicks;
    device::Buffer<shared::EnvironmentMap> environment; ///< SceneLights::beyond; of no texels without a picture
    device::Buffer<float> environmentTable;

    std::vector<shared::AreaLight> areaLightList; ///< the same as areaLights, for kernels that take one by value
    std::vector<device::Buffer<float>>
        quadratures; ///< one of DirectLights::own each: the nodes of all rules, lightNodes()
    std::uint32_t deltaLightCount = 0, plainLightCount = 0, emitterCount = 0;
    /// The term of direct light that lights share.
    struct SharedTerm {
        bool ofEmitters = true; ///< it chooses among emitters; else among sharedLights
        bool quads = false; ///< there are area lights among them
        std::uint32_t count = 0;
        glm::vec3 low { 0 }, high { 0 }; ///< as of the EmitterList
        float directedWithin = 0;
    } sharedTerm;
    float emitterShare = 0; ///< probability that a path's vertex samples them and no other light
    float environmentShare = 0; ///< the same of what is beyond the scene
    EnvironmentBandwidth environmentBandwidth; ///< of what is beyond the scene
    float diameter = 0; ///< metres, diagonal of the bounds
    float largestDimension = 0; ///< metres, of the bounds
};

} // namespace wedge::render
