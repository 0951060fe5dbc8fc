#include "benchmarks/rays/embree_scene.h"

#include "host/error.h"

#include <atomic>
#include <chrono>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

std::string configuration(const EmbreeBuild& build, unsigned threads)
{
    return fmt::format("threads={}", threads)
        + (build.width ? fmt::format(",tri_accel=bvh{}.triangle4", build.width) : "");
}

} // namespace

EmbreeMesh::EmbreeMesh(std::span<const float> positionsOf, std::span<const std::uint32_t> indicesOf)
    : positions(positionsOf.begin(), positionsOf.end())
    , indices(indicesOf)
    , vertices(positionsOf.size() / 3)
{
    positions.push_back(0); // vertices are read 16 bytes at a time
}

EmbreeScene::EmbreeScene(const EmbreeMesh& mesh, const EmbreeBuild& build, unsigned threads)
    : build_(build)
    , bytes_(std::make_unique<std::int64_t>(0))
    , device_(rtcNewDevice(configuration(build, threads).c_str()))
{
    check("rtcNewDevice");
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* sum, ssize_t bytes, bool) {
            std::atomic_ref(*static_cast<std::int64_t*>(sum)) += bytes;
            return true;
        },
        bytes_.get());
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneBuildQuality(scene_.get(), build.highQuality ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(scene_.get(), build.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
        3 * sizeof(float), mesh.vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
        3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    check("rtcAttachGeometry");
    const auto start = std::chrono::steady_clock::now();
    rtcCommitScene(scene_.get());
    buildSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    check("rtcCommitScene");
}

void EmbreeScene::check(const char* call) const
{
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree, build {}", build_.name),
            fmt::format("{} failed with code {}", call, static_cast<int>(error)),
            "check its version, 3.13 or 4, and the memory left");
}

std::string EmbreeScene::version()
{
    return fmt::format("{}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

} // namespace wedge::benchmark
