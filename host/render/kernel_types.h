// What kernels call the structs that they are handed by value.
#pragma once

#include "host/graph/graph.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/components.h"
#include "kernels/shared/curvature.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "kernels/shared/path.h"
#include "kernels/shared/temporal.h"
#include "kernels/shared/wave.h"

namespace wedge::graph {

template <>
inline constexpr std::string_view kernelType<shared::AnalysisParams> = "AnalysisParams";
template <>
inline constexpr std::string_view kernelType<shared::AreaLight> = "AreaLight";
template <>
inline constexpr std::string_view kernelType<shared::CameraParams> = "CameraParams";
template <>
inline constexpr std::string_view kernelType<shared::CurvatureParams> = "CurvatureParams";
template <>
inline constexpr std::string_view kernelType<shared::DistributedParams> = "DistributedParams";
template <>
inline constexpr std::string_view kernelType<shared::FilterParams> = "FilterParams";
template <>
inline constexpr std::string_view kernelType<shared::FrameParams> = "FrameParams";
template <>
inline constexpr std::string_view kernelType<shared::LightAxes> = "LightAxes";
template <>
inline constexpr std::string_view kernelType<shared::LightMoments> = "LightMoments";
template <>
inline constexpr std::string_view kernelType<shared::LightScore> = "LightScore";
template <>
inline constexpr std::string_view kernelType<shared::PathParams> = "PathParams";
template <>
inline constexpr std::string_view kernelType<shared::ReflectorParams> = "ReflectorParams";
template <>
inline constexpr std::string_view kernelType<shared::SampleParams> = "SampleParams";
template <>
inline constexpr std::string_view kernelType<shared::TemporalParams> = "TemporalParams";
template <>
inline constexpr std::string_view kernelType<shared::WaveParams> = "WaveParams";

} // namespace wedge::graph
