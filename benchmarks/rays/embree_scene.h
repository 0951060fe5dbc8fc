#pragma once

#include "benchmarks/common/embree.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How Embree is asked to build.
struct EmbreeBuild {
    std::string name; ///< "default", "bvh8", "high", ...
    int width = 0; ///< 4 or 8: nodes of so many children, whatever Embree would choose
    bool highQuality = false; ///< spatial splits
    bool robust = false; ///< watertight
};

/// Triangles for Embree, shared by any number of its scenes.
class EmbreeMesh {
public:
    /// positions and indices as in bvh::Mesh; indices must outlive this.
    EmbreeMesh(std::span<const float> positions, std::span<const std::uint32_t> indices);

    std::vector<float> positions; ///< with what Embree reads beyond the last vertex
    std::span<const std::uint32_t> indices;
    std::size_t vertices;
};

/// A device and its committed scene over one mesh.
class EmbreeScene {
public:
    /// mesh must outlive this. Throws Error if Embree refuses anything, an acceleration structure's name included.
    EmbreeScene(const EmbreeMesh& mesh, const EmbreeBuild& build, unsigned threads);

    RTCScene scene() const { return scene_.get(); }
    const EmbreeBuild& build() const { return build_; }
    double buildSeconds() const { return buildSeconds_; }
    /// What Embree held on to when it had built, by its own count.
    std::int64_t bytes() const { return *bytes_; }
    /// "3.13.5"
    static std::string version();

private:
    void check(const char* call) const;

    struct DeviceRelease {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    struct SceneRelease {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    EmbreeBuild build_;
    std::unique_ptr<std::int64_t> bytes_; ///< outlives the device, which reports to it
    std::unique_ptr<RTCDeviceTy, DeviceRelease> device_;
    std::unique_ptr<RTCSceneTy, SceneRelease> scene_;
    double buildSeconds_ = 0;
};

} // namespace wedge::benchmark
