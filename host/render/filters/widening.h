#pragma once

#include "host/render/effects/term_context.h"
#include "host/render/filters/gaussian.h"

namespace wedge::render {

/// Whether narrow filters of lights and of indirect light are compared with wider ones, and widened where nothing
/// speaks for them. Not where samples know nothing of what their light is worth in the image.
bool widens(const Settings& settings);

/// Pixels beyond a filter's that widths depend on.
int widenReach(const Settings& settings);

/// Pixels over which filters that are compared reach; a width covers more of them where surfaces are seen at a slant.
int comparedReach(const Settings& settings, float pixels);

// How much of the samples' variance counts. It is known from two parts of a sequence, whose points complement each
// other as long as nothing else is drawn with them: then it comes out too large.
constexpr float pinholeNoise = 0.5f, distributedNoise = 0.6f;

/// How one term's filter is widened (kernels/widen.cl), in two steps.
class Widening {
public:
    /// params: of the term's filter; pixels: the width that others are compared with
    Widening(const TermContext& context, std::string_view pass, const shared::FilterParams& params, float pixels);

    /// Where the widths beta are less than that to compare with, filters `value`, one plane of all pixels, with both
    /// and puts their difference in its place (kernels/compare_widths.cl). deviation: of value's samples (deviation16()
    /// of kernels/deviation.h). Neither that plane nor scratch.effective is to change until apply(); weights are made
    /// after this, in lean frames their plane is used here.
    void compare(
        device::Buffer<float>& value, const device::Buffer<float>& deviation, const device::Buffer<float>& beta) const;

    /// Widens beta. difference: what compare() left in the place of the value; weights: what values are multiplied by
    /// in the image
    void apply(const device::Buffer<float>& difference, const device::Buffer<float>& deviation,
        const device::Buffer<float>& weights, device::Buffer<float>& beta) const;

    std::string_view pass() const { return pass_; }

private:
    const TermContext& c_;
    std::string_view pass_;
    shared::FilterParams params_;
    float pixels_;
    image::Window widened_; ///< the pixels that the filter reaches
    image::Window shared_, compared_; ///< those whose shares, and whose squares, their widths depend on
};

/// Widens the filter of a distributed frame's term, once its samples are complete.
void widenDistributed(
    const TermContext& context, Term& term, const shared::DistributedParams& params, const Widening& widening);

} // namespace wedge::render
