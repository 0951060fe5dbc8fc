#include "benchmarks/lottery/measure.h"

#include "benchmarks/common/statistics.h"
#include "benchmarks/common/variants.h"
#include "benchmarks/harness/image_blur.h"
#include "data/generator/lottery/lottery.h"
#include "host/image/png.h"
#include "host/render/distributed_frame.h"

#include <chrono>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Apart from those of the references.
constexpr std::uint32_t referenceSeed = 0x2e5eed;

/// One setting with all its seeds.
struct Renders {
    std::vector<image::RgbImage> images;
    std::vector<double> device, wall; ///< milliseconds
};

class SeedLab {
public:
    SeedLab(const scene::Scene& scene, const device::Device& device, const LotteryPlan& plan, const std::string& name)
        : plan_(plan)
        , scene_(scene)
        , renderer_(scene, device)
        , name_(name)
        , reference_(obtainReference(
              renderer_, sized(render::monteCarlo(plan.referenceSpp), referenceSeed), plan.referenceFolder, name))
    {
    }

    /// Both methods in turns, so that a neighbour's load falls on both.
    void measureBudgets(LotteryResult& out)
    {
        renderer_.rehearse(sized(render::monteCarlo(plan_.compared), 1));
        renderer_.rehearse(sized(render::axisAligned(plan_.compared), 1));
        for (const int spp : plan_.budgets) {
            Renders plain, filtered;
            const auto seeds = static_cast<std::uint32_t>(spp <= plan_.pooledUpTo ? plan_.seeds : 1);
            for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
                add(plain, render::monteCarlo(spp), seed);
                add(filtered, render::axisAligned(spp), seed);
            }
            out.plain.push_back(pointOf(spp, plain));
            out.filtered.push_back(pointOf(spp, filtered));
            if (spp == plan_.compared) {
                measureBlurs(plain.images, out);
                writePictures(plain, filtered);
            }
        }
        out.referenceNoise = reference_.noise;
    }

private:
    render::Settings sized(render::Settings s, std::uint32_t seed) const
    {
        s.width = plan_.width;
        s.height = plan_.height;
        s.seed = seed;
        s.bounces = scene_.settings.bounces.value_or(0);
        s.antialias = scene_.settings.antialias;
        return s;
    }

    void add(Renders& renders, const render::Settings& wanted, std::uint32_t seed)
    {
        const render::Settings settings = sized(wanted, seed);
        const render::FrameStatistics frame = renderer_.render(settings);
        renders.images.push_back(imageOf(renderer_, settings, frame));
        renders.device.push_back(frame.deviceMilliseconds);
        renders.wall.push_back(frame.wallMilliseconds);
    }

    LotteryPoint pointOf(int spp, const Renders& renders) const
    {
        return { spp, squaredError(renders.images, reference_), summarize(renders.device).median,
            summarize(renders.wall).median };
    }

    void measureBlurs(const std::vector<image::RgbImage>& plain, LotteryResult& out)
    {
        std::optional<SquaredError> best;
        const auto consider = [&](const std::string& name, const std::vector<image::RgbImage>& images) {
            const SquaredError found = squaredError(images, reference_);
            if (!best || found.mean < best->mean) {
                best = found;
                out.fixedBlurName = name;
            }
        };
        for (const double sigma : plan_.imageBlurs) {
            std::vector<image::RgbImage> images;
            images.reserve(plain.size());
            for (const image::RgbImage& image : plain) {
                images.push_back(blurred(image, sigma));
            }
            consider(fmt::format("image {:g} px", sigma), images);
        }
        // Distributed frames have no setting for it.
        const render::Settings equal = uniform(render::axisAligned(plan_.compared), plan_.compared, plan_.compared);
        const bool pinhole = !render::isDistributed(sized(equal, 1), scene_);
        for (const float width : pinhole ? plan_.termBlurs : std::vector<float> {}) {
            Renders renders;
            for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(plan_.seeds); ++seed) {
                add(renders, fixed(equal, width), seed);
            }
            consider(fmt::format("terms {:g} px", width), renders.images);
        }
        out.fixedBlur = *best;
    }

    void writePictures(const Renders& plain, const Renders& filtered) const
    {
        if (plan_.imageFolder.empty()) {
            return;
        }
        const auto write = [&](const char* what, const image::RgbImage& image) {
            image::writePng(
                (std::filesystem::path(plan_.imageFolder) / fmt::format("{}_{}.png", name_, what)).string(), image);
        };
        write("reference", reference_.image);
        write("mc", plain.images.front());
        write("aaf", filtered.images.front());
    }

    const LotteryPlan& plan_;
    const scene::Scene& scene_;
    render::Renderer renderer_;
    std::string name_;
    Reference reference_;
};

} // namespace

std::string lotterySceneFolder() { return WEDGE_BENCHMARK_DATA "/lottery"; }

scene::Scene lotteryScene(std::uint32_t seed, int version, const std::string& folder)
{
    const generator::GeneratedScene made = generator::makeLottery(seed, version);
    generator::writeScene(made, folder);
    scene::Scene scene = scene::loadScene((std::filesystem::path(folder) / (made.name + ".toml")).string());
    for (scene::Material& material : scene.materials) {
        if (material.name.starts_with("phong")) {
            material.specularModel = scene::SpecularModel::Phong;
        }
    }
    return scene;
}

LotteryResult measureSeed(std::uint32_t seed, const device::Device& device, const LotteryPlan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    LotteryResult out;
    out.seed = seed;
    out.traits = generator::lotteryTraits(seed, plan.version);
    const scene::Scene scene = lotteryScene(seed, plan.version, lotterySceneFolder());
    out.triangles = scene.geometry.indices.size() / 3;
    SeedLab(
        scene, device, plan, fmt::format("lottery{}_{}", plan.version == 1 ? "" : std::to_string(plan.version), seed))
        .measureBudgets(out);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

} // namespace wedge::benchmark
