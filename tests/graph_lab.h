// What tests run graphs on.
#pragma once

#include "device_testing.h"

#include "host/graph/execution.h"

namespace wedge::test {

struct Lab {
    explicit Lab(const device::Device& opened)
        : device(opened)
        , queue(device)
        , library(device, { {}, false, WEDGE_TEST_KERNELS })
        , kernels(library)
        , memory(device)
    {
    }
    device::Device device;
    device::TimedQueue queue;
    device::ProgramLibrary library;
    graph::Kernels kernels;
    graph::Memory memory;
};

} // namespace wedge::test
