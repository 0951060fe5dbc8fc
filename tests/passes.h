#pragma once

#include "host/device/program.h"
#include "host/device/queue.h"
#include "host/graph/execution.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/frame.h"
#include "tests/product_programs.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace wedge::test {

/// Kernels launched one by one as a frame's graph launches them.
class Passes {
public:
    /// packetSize: pixels that one work-item of a pass over tiles takes.
    Passes(device::ProgramLibrary& library, device::TimedQueue& queue, std::size_t packetSize)
        : kernels_(library)
        , queue_(queue)
        , packetSize_(packetSize)
    {
    }

    /// A pass over the tiles of frame's rectangle. The kernel takes FrameParams first and firstGroup last.
    template <class... Args>
    void tiles(std::string_view pass, device::PassKind kind, const device::ProgramSource& program,
        const std::string& kernel, shared::FrameParams frame, double workUnits, const Args&... args)
    {
        tiles(pass, kind, find(program, kernel), frame, workUnits, args...);
    }
    template <class... Args>
    void tiles(std::string_view pass, device::PassKind kind, device::Kernel& k, shared::FrameParams frame,
        double workUnits, const Args&... args)
    {
        const std::size_t items = WEDGE_TILE_PIXELS / packetSize_;
        const std::size_t local = localSize(k, items);
        k.setArgs(frame, args..., std::uint32_t { 0 });
        queue_.launchTiled(pass, kind, k, frame.tileCount * (items / local), local, k.argCount() - 1, workUnits);
    }

    /// A pass over blocks of 16 pixels of a row (`across` = 16), or over pixels (`across` = 1). The kernel takes
    /// Params, which have the rectangle, first. Large images go in bands of rows, so that no launch is long.
    template <class Params, class... Args>
    void rows(std::string_view pass, device::PassKind kind, const device::ProgramSource& program,
        const std::string& kernel, Params params, std::uint32_t across, const Args&... args)
    {
        device::Kernel& k = find(program, kernel);
        const std::size_t columns = (params.x1 - params.x0 + across - 1) / across;
        const std::size_t local = localSize(k, 64);
        const std::size_t localX = std::min<std::size_t>(local, across == 1 ? 16 : 4);
        const std::uint32_t first = params.y0, end = params.y1;
        const std::uint32_t band = std::max(16u, bandPixels / std::max(1u, params.x1 - params.x0));
        for (std::uint32_t y = first; y < end; y += std::min(band, end - y)) {
            params.y0 = y;
            params.y1 = y + std::min(band, end - y);
            k.setArgs(params, args...);
            queue_.launch2D(pass, kind, k, columns, params.y1 - params.y0, localX, local / localX);
        }
    }

    /// A pass over `items` items of a list. The kernel takes FrameParams first, and tests for the end itself. Its time
    /// is all that is recorded.
    template <class... Args>
    void list(std::string_view pass, device::PassKind kind, const device::ProgramSource& program,
        const std::string& kernel, std::size_t items, shared::FrameParams frame, const Args&... args)
    {
        device::Kernel& k = find(program, kernel);
        k.setArgs(frame, args...);
        queue_.launch(pass, kind, k, items, localSize(k, listGroup));
    }

    /// The kernel, compiled when first asked for. Parameters of the product's are as its frames declare them, if
    /// the program does not say.
    device::Kernel& find(device::ProgramSource program, const std::string& kernel)
    {
        if (program.generated.empty()) {
            program.generated = productProgram(queue_.device(), program.file, kernel).generated;
        }
        return kernels_.find(program, kernel);
    }

private:
    static constexpr std::uint32_t bandPixels = 1u << 21;
    static constexpr std::size_t listGroup = 16;

    /// The largest power of two that the kernel allows, at most `most`.
    static std::size_t localSize(const device::Kernel& kernel, std::size_t most)
    {
        return std::min(most, std::bit_floor(kernel.workGroupLimit()));
    }

    graph::Kernels kernels_;
    device::TimedQueue& queue_;
    std::size_t packetSize_;
};

} // namespace wedge::test
