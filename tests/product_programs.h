// The programs of the frames that the product renders, as their passes declare them: what tests of single kernels
// compile, and what the linter reads.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"
#include "host/render/frame_graph.h"
#include "host/render/halves.h"
#include "host/render/renderer.h"

#include <functional>
#include <memory>
#include <string>

namespace wedge::test {

/// A program, and the options that it is built with besides.
struct ProductProgram {
    device::BuildOptions options;
    device::ProgramSource source;
};

/// A frame of the renderer's scene, of a progressive one the first step, that is declared and not run. deviceScene:
/// null for one that cannot be run.
std::unique_ptr<render::FrameGraph> declareFrame(const render::Renderer& renderer,
    const render::DeviceScene* deviceScene, const render::Settings& settings, bool keepLayers,
    render::HalfMemories& memories, render::FrameFilter* filter = nullptr);

/// Calls visit(graph) for frames of many kinds, some of which are filtered over time.
void everyGraph(const device::Device& device, const std::function<void(const graph::Graph&)>& visit);

/// Calls visit(program) for those of the same frames on a device, until it returns false.
void everyProgram(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit);

} // namespace wedge::test
