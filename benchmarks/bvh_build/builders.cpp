#include "benchmarks/bvh_build/builders.h"

#include "benchmarks/common/embree.h"
#include "bvh/refit.h"
#include "host/error.h"

#include <atomic>
#include <cassert>

#include <fmt/format.h>
#include <tbb/global_control.h>

namespace wedge::benchmark {
namespace {

/// One of our modes, on no more threads than that.
class OwnBuilder : public Builder {
public:
    OwnBuilder(bvh::Mode mode, unsigned threads)
        : config_(bvh::config(mode))
        , threads_(threads)
    {
    }
    void prepare(const bvh::Mesh& mesh) override { mesh_ = mesh; }
    void build() override
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads_);
        bvh_ = bvh::build(mesh_, config_);
    }
    std::size_t bytes() const override { return bvh_.statistics.bytes; }
    void release() override { bvh_ = {}; }

protected:
    bvh::Config config_;
    unsigned threads_;
    bvh::Mesh mesh_;
    bvh::Bvh bvh_;
};

/// Refits a hierarchy of the default mode.
class Refitter : public OwnBuilder {
public:
    explicit Refitter(unsigned threads)
        : OwnBuilder(bvh::Mode::Default, threads)
    {
    }
    void prepare(const bvh::Mesh& mesh) override
    {
        OwnBuilder::prepare(mesh);
        OwnBuilder::build();
    }
    void build() override
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads_);
        [[maybe_unused]] const bool fits = bvh::refit(bvh_, mesh_);
        assert(fits);
    }
};

/// Embree's device and the bytes that it holds. Hierarchies share it.
class EmbreeDevice {
public:
    explicit EmbreeDevice(unsigned threads)
        : device_(rtcNewDevice(fmt::format("threads={}", threads).c_str()))
    {
        if (!device_)
            throw Error("Embree", fmt::format("error {}", static_cast<int>(rtcGetDeviceError(nullptr))),
                "install a libembree, 3.13 or 4, that this machine can run");
        rtcSetDeviceMemoryMonitorFunction(device_, count, this);
    }
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    ~EmbreeDevice() { rtcReleaseDevice(device_); }

    RTCDevice get() const { return device_; }
    std::size_t bytes() const { return static_cast<std::size_t>(std::max<std::ptrdiff_t>(bytes_, 0)); }

private:
    static bool count(void* self, std::ptrdiff_t bytes, bool)
    {
        static_cast<EmbreeDevice*>(self)->bytes_ += bytes;
        return true;
    }
    std::atomic<std::ptrdiff_t> bytes_ = 0;
    RTCDevice device_;
};

/// A scene of one quality, its commit timed.
class EmbreeBuilder : public Builder {
public:
    EmbreeBuilder(std::shared_ptr<EmbreeDevice> device, RTCBuildQuality quality)
        : device_(std::move(device))
        , quality_(quality)
    {
    }
    EmbreeBuilder(const EmbreeBuilder&) = delete;
    EmbreeBuilder& operator=(const EmbreeBuilder&) = delete;
    ~EmbreeBuilder() override { EmbreeBuilder::release(); }

    void prepare(const bvh::Mesh& mesh) override
    {
        if (padded_.size() != mesh.positions.size() + 4) {
            padded_.assign(mesh.positions.begin(), mesh.positions.end());
            padded_.resize(padded_.size() + 4); // Embree reads 16 bytes a vertex
        }
        before_ = device_->bytes();
        scene_ = rtcNewScene(device_->get());
        rtcSetSceneBuildQuality(scene_, quality_);
        const RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, quality_);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, padded_.data(), 0,
            3 * sizeof(float), mesh.positions.size() / 3);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
            3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    void build() override { rtcCommitScene(scene_); }
    std::size_t bytes() const override { return device_->bytes() - std::min(before_, device_->bytes()); }
    void release() override
    {
        if (scene_)
            rtcReleaseScene(scene_);
        scene_ = nullptr;
    }

private:
    std::shared_ptr<EmbreeDevice> device_;
    RTCBuildQuality quality_;
    RTCScene scene_ = nullptr;
    std::size_t before_ = 0;
    std::vector<float> padded_;
};

} // namespace

std::vector<NamedBuilder> makeBuilders(unsigned threads)
{
    const auto device = std::make_shared<EmbreeDevice>(threads);
    std::vector<NamedBuilder> out;
    const auto own = [&](bvh::Mode mode, const char* peer) {
        out.push_back({ std::string(bvh::modeName(mode)), peer, std::make_unique<OwnBuilder>(mode, threads) });
    };
    const auto embree = [&](const char* name, RTCBuildQuality quality) {
        out.push_back({ name, "", std::make_unique<EmbreeBuilder>(device, quality) });
    };
    own(bvh::Mode::Default, "embree_default");
    embree("embree_default", RTC_BUILD_QUALITY_MEDIUM);
    own(bvh::Mode::Fast, "embree_low");
    embree("embree_low", RTC_BUILD_QUALITY_LOW);
    own(bvh::Mode::Quality, "embree_high");
    embree("embree_high", RTC_BUILD_QUALITY_HIGH);
    out.push_back({ "refit", "fast", std::make_unique<Refitter>(threads) });
    return out;
}

} // namespace wedge::benchmark
