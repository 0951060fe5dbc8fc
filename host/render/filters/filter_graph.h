#pragma once

#include "host/render/filters/gaussian.h"
#include "host/render/frame_builder.h"

#include <string>
#include <string_view>

namespace wedge::render {

/// What gathers ask of the pixels that they may reach.
Arguments gathered(const FrameBuilder& frame, graph::Reach reach);

/// A value filtered, and the equal samples that the gather amounts to.
struct Gathered {
    graph::Handle<Value> value;
    graph::Handle<Count> effective;
};

/// Declares the separable world-space Gaussian of kernels/filter/gather.h, of as many planes of `value` as the program
/// has channels; widths are beta. params: of filterParams(); its rectangle does not matter.
Gathered gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta);

/// Widths along the image's axes, metres.
struct AxisWidths {
    graph::Handle<Metres> x, y;
};

/// The same with widths of their own along x and along y; a pair is weighted by the mean of both bandwidths' squares
/// (6.23).
Gathered gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const AxisWidths& widths);

/// The same into planes that were there before, so that they may be read after the group of passes in hand.
Gathered filteredPlanes(FrameBuilder& frame, std::uint32_t channels);
void gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta,
    Gathered& out);

/// What the sheared filter takes besides (kernels/filter/gather_sheared.h), of 16 bits: two gradients a channel, or
/// five numbers with second derivatives, and widths that go with the occluders' slopes alone.
struct Shearing {
    graph::Handle<Value> gradients;
    graph::Handle<Metres> slopeWidth;
    graph::Format format; ///< of gradients
    bool curved; ///< these have second derivatives
};

/// The same as gaussianFilter() into planes that were there, sheared. params: with shearU and shearV.
void shearedFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta,
    const Shearing& shearing, Gathered& out);

/// The equal samples alone that it amounts to, of whatever value.
graph::Handle<Count> gatheredCounts(FrameBuilder& frame, std::string_view pass, device::PassKind kind,
    const shared::FilterParams& params, const graph::Handle<Metres>& beta);

/// What widening takes of a term: one value of all pixels, numbers whose squares are its variances in the mean, and
/// what values are multiplied by in the image.
struct Compared {
    graph::Handle<Value> value;
    graph::Handle<Deviation> deviation;
    graph::Handle<Share> weights;
};

/// Declares the passes that widen beta where the samples do not speak against it (kernels/analysis/widening.cl),
/// towards `pixels`. noise: how much of their variance counts, pinholeNoise or distributedNoise.
void widen(FrameBuilder& frame, std::string_view pass, shared::FilterParams params, float pixels, float noise,
    Compared compared, graph::Handle<Metres>& beta);

/// Which pixels have a part in the demand of one: those of its object around it, or all around it; and itself, or the
/// others alone.
struct Demanding {
    bool oneObject, ownToo;
};

/// Declares how demands follow from uncertainties, by params.countExponent and varianceSpread (demand.cl).
void demandOf(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Uncertainty>& uncertainty,
    Demanding demanding, graph::Handle<Demand>& demand);

} // namespace wedge::render
