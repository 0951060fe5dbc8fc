// The programs of the frames that the product renders, as their passes declare them: what tests of single kernels
// compile, and what the linter reads.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"

#include <functional>
#include <string>

namespace wedge::test {

/// A program, and the options that it is built with besides.
struct ProductProgram {
    device::BuildOptions options;
    device::ProgramSource source;
};

/// Calls visit(program) for those of frames of many kinds on a device, until it returns false.
void everyProgram(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit);

/// The first program of that file in which there is the kernel; without interfaces where no frame has it, as of
/// kernels of the tests' own.
device::ProgramSource productProgram(const device::Device& device, const std::string& file, const std::string& kernel);

} // namespace wedge::test
