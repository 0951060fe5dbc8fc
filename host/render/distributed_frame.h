#pragma once

#include "host/render/effects/indirect.h"
#include "host/render/effects/soft_shadows.h"
#include "host/render/effects/term_context.h"
#include "host/render/waves.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace wedge::render {

/// Whether pixels of such a frame have several receivers: through a lens, a shutter, or all of their square.
bool isDistributed(const Settings& settings, const scene::Scene& scene);

/// Defocus, motion blur and antialiasing together with the other effects: thesis chapter 5 and appendix B,
/// docs/multiple-effects.md. A first pass finds circles of confusion, motion, slopes and distances; those make widths,
/// and variances the counts of primary and secondary samples; a second pass takes them; irradiances are filtered where
/// they can be taken apart from textures, then the image by what lens and shutter have blurred.
class DistributedFrame {
public:
    /// terms: of `lights` area lights, then of the components of indirect light; each receiver serves them all.
    /// keepLayers: filters emission, direct and indirect apart, too, so that they sum to the beauty; not of lean
    /// frames.
    DistributedFrame(const TermContext& context, Waves& waves, const std::vector<std::unique_ptr<Term>>& terms,
        std::size_t lights, const shared::CameraParams& camera, bool keepLayers);

    /// The whole frame: begin(), one refine(), compose(). Returns false if cancelled while sampling; the image is then
    /// made of what was sampled until then.
    bool render(const std::atomic<bool>* stop);

    /// Forgets all samples.
    void begin();
    /// Takes samples up to the settings' mean count. Those that there are stay and count: the analysis is made anew of
    /// all of them, and what is sampled are the differences. The settings that the context refers to may change from
    /// one call to the next. stop: looked at between waves, which are then whole; null: the queue's flag cancels
    /// anywhere. Returns false if stopped or cancelled.
    bool refine(const std::atomic<bool>* stop = nullptr);
    /// Makes the image of the samples taken so far. emission: where its filtered layer goes; null: in its own place,
    /// and no sample can be added any more.
    void compose(device::Buffer<float>* emission = nullptr);

    /// Counts follow the demands of another frame of the same terms once it has any: counts that know nothing of what
    /// they are for leave means unbiased. It is to live as long as this one refines.
    void followDemandsOf(const DistributedFrame& other) { guide_ = &other; }

    /// Whether terms got widths.
    bool analysed() const { return analysed_; }

private:
    bool monteCarlo();
    bool adaptive();
    std::uint32_t firstPaths() const; ///< samples of the first pass
    bool firstPass(std::uint32_t first);
    bool sample(const shared::FrameParams& frame, std::uint32_t last, bool slopes, double workUnits);
    void sampleWave(const shared::WaveParams& wave, bool slopes, double workUnits);
    void deltaLights(const shared::WaveParams& wave);
    void widths();
    void publishedCounts();
    void demands();
    void demandOf(Term& term, float rays, bool light);
    void counts();
    void limitStep();
    void startSums();
    void filter();
    void copy(const device::Buffer<float>& image, device::Buffer<float>& to);
    void addUnfiltered(device::Buffer<float>& direct, device::Buffer<float>& indirect);
    void blurWidths(float samples, const device::Buffer<float>& directions);
    /// What the motion's filters are made with: of packed frames for the analysis alone.
    const device::Buffer<float>& motionWidth() const;
    void blur(device::Buffer<float>& image);
    shared::DistributedParams params(const image::Window& window) const;
    /// Calls f(term, rays of a sample) for each term.
    template <class F>
    void eachTerm(const F& f);

    TermContext c_;
    Waves& waves_;
    const std::vector<std::unique_ptr<Term>>& terms_;
    shared::CameraParams camera_;
    std::vector<SoftShadows> lights_;
    std::vector<Indirect> paths_;
    bool keepLayers_;
    bool lit_;
    bool analysed_ = false;
    std::uint32_t taken_ = 0; ///< samples of a pixel, their mean
    const std::atomic<bool>* stop_ = nullptr;
    const DistributedFrame* guide_ = nullptr;
};

template <class F>
void DistributedFrame::eachTerm(const F& f)
{
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        const bool light = i < lights_.size();
        f(*terms_[i], light ? 1.0f : 2.0f * static_cast<float>(std::max(1, c_.settings.bounces)));
    }
}

} // namespace wedge::render
