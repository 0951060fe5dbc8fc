#pragma once

#include "host/render/receiver_set.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/wave.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

/// The waves in which the receivers of tiles are traced, and where those of each tile start in theirs.
struct WaveSchedule {
    std::vector<shared::WaveParams> waves;
    std::vector<std::uint32_t> first;

    /// counts: receivers of each tile. settings: what all waves have alike. room: receivers of a wave at most; no tile
    /// has more.
    WaveSchedule(
        const std::vector<std::uint32_t>& counts, const shared::WaveParams& settings, std::uint32_t room = capacity);

    static constexpr std::uint32_t capacity = WEDGE_WAVE_RECEIVERS; ///< of any wave
};

/// Planes of a wave's receivers, see kernels/waves/wave_primary.cl and waves.cl.
struct Receivers : Surfaces {
    graph::Handle<Packed> view;
    graph::Handle<Listed> pixelOf, sampleOf, shareOf; ///< of receivers
    graph::Handle<Listed> pixelFirst, pixelCount; ///< of the pixels of the wave's tiles
    graph::Handle<Share> time;
    graph::Handle<Pixels> motion;
    graph::Handle<Count> rays, pathRays;
};

/// How many primary samples pixels have, and how many they want.
struct PrimaryCounts {
    graph::Handle<Count> taken;
    graph::Handle<Count> wanted; ///< of a size that kernels may read, whatever is in it, where waves omit counts
};

/// Samples of the image in waves of receivers: in a graph, a loop over rounds, and in each over waves. What passes in
/// them take for arguments, and how they are declared.
class Waves : public ReceiverSet {
public:
    /// One sampling of the image.
    struct Sampling {
        std::size_t rounds = 1;
        std::function<std::uint32_t(std::size_t round)> last; ///< primary samples that pixels have at most after one
        double most = 0; ///< new ones of a pixel in a round, at most, in the mean over the image's tiles
        double workUnits = 0; ///< of all rounds together
        std::size_t terms = 0; ///< of the frame, among which the work is shared out with the camera's rays
        bool everywhere = false; ///< all of the image, whatever is wanted
        std::optional<graph::Handle<Radiance>> seenLights = {}; ///< of pixels, see seenLights()
    };

    /// settings: of the waves, as far as they are known. counts: of the frame.
    Waves(FrameBuilder& frame, const shared::WaveParams& settings, const shared::CameraParams& camera,
        PrimaryCounts& counts, Sampling sampling);

    /// Declares the loops. body(): declares what a wave's receivers are sampled for, after their primary rays; the last
    /// pass is to add to counts.taken.
    template <class Body>
    void declare(bool lit, const Body& body)
    {
        const std::size_t rounds = sampling_.rounds;
        f_.graph.tiledLoop(
            "rounds", WEDGE_TILE, [rounds](graph::Run&) { return rounds; },
            [&] {
                schedule();
                f_.graph.loop("waves", counter(), [&] {
                    traceReceivers(lit);
                    body();
                });
            });
    }

    const shared::WaveParams& settings() const { return settings_; }
    const shared::CameraParams& camera() const { return camera_; }
    const Receivers& receivers() const { return r_; }
    PrimaryCounts& counts() { return counts_; }

    /// A list of the receivers, or of the pixels of the wave's tiles, in the loop's body.
    template <class Quantity>
    graph::Handle<Quantity> list(std::string name, const graph::Format& format) const
    {
        return f_.graph.list<Quantity>("receivers' " + name, format, settings_.planeSize);
    }

    graph::Argument params() const; ///< WaveParams
    /// FrameParams of the pixels, and of the wave's receivers.
    graph::Argument pixelParams() const;
    graph::Argument frame() const override;
    const Surfaces& surfaces() const override { return r_; }
    Arguments arguments() const override;
    graph::Argument sampleOf() const override { return graph::reads("sampleOf", r_.sampleOf); }
    std::optional<std::uint32_t> samples() const override { return std::nullopt; }
    /// What accumulateSurfaces reads of the receivers.
    std::vector<graph::Argument> receiverSurfaces() const
    {
        return graph::together("surfaces", f_.readBy(ReadBy::Pixels, r_));
    }
    /// Of wavePixel() of accumulate.h; taken: counts().taken, read or updated.
    std::vector<graph::Argument> pixelLists(graph::Argument taken) const;

    /// A pass over tiles of receivers; rays: whether it has a share in the work.
    void tiles(std::string name, graph::KernelName kernel, std::vector<graph::Argument> arguments, bool rays = true);
    void trace(std::string name, graph::KernelName kernel, Arguments arguments,
        const std::function<double(const graph::Launch&)>& /*workUnits*/) override
    {
        tiles(std::move(name), std::move(kernel), std::move(arguments), false);
    }
    /// One over blocks of `across` receivers.
    void list(std::string name, graph::KernelName kernel, std::uint32_t across, std::vector<graph::Argument> arguments);
    /// One over the pixels of the wave's tiles, of accumulate.cl.
    void pixels(std::string kernel, std::vector<graph::Argument> arguments);

    graph::Argument tallyRays() override { return graph::tallies("rays", r_.rays); }
    graph::Argument tallyPathRays() override { return graph::tallies("pathRays", r_.pathRays); }

private:
    struct State {
        std::vector<shared::WaveParams> waves; ///< of the round in hand
        shared::WaveParams settings;

        const shared::WaveParams& wave(const graph::Run& run) const;
    };

    std::size_t tilesOfWave() const; ///< at most
    std::function<std::size_t(graph::Run&)> counter() const;
    void schedule();
    void traceReceivers(bool lit);

    FrameBuilder& f_;
    shared::WaveParams settings_;
    shared::CameraParams camera_;
    PrimaryCounts& counts_;
    Sampling sampling_;
    std::uint32_t room_; ///< of waves: of small images none is as large as can be
    std::shared_ptr<State> state_;
    Receivers r_;
    graph::Handle<Listed> tileFirst_;
};

/// WEDGE_SAMPLER_* of receivers in waves. Strata are for counts that are known before the first sample is taken, and
/// frames with counts of their own a pixel, and progressive ones, take a sequence in their place.
std::uint32_t waveSampler(const Settings& settings);

/// Receivers of a wave at most, where pixels have `most` new samples in the mean over tiles: of small images fewer than
/// WaveSchedule::capacity.
std::uint32_t roomOfWaves(const PlaneLayout& layout, double most);

/// Declares that no tile's pixels together want more new samples than a wave has room for, whatever they demand.
void limitTiles(FrameBuilder& frame, PrimaryCounts& counts, std::uint32_t room);

} // namespace wedge::render
