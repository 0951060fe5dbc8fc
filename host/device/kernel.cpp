#include "host/device/kernel.h"

#include <fmt/format.h>

namespace wedge::device {

Kernel::Kernel(const Device& device, const cl::Program& program, std::string file, std::string name)
    : name_(std::move(name))
    , file_(std::move(file))
    , deviceName_(device.info().name)
{
    checked(description(), deviceName_, [&] {
        try {
            kernel_ = cl::Kernel(program, name_.c_str());
        } catch (const cl::Error& error) {
            if (error.err() == CL_INVALID_KERNEL_NAME) {
                throw Error("no such kernel in " + file_, name_,
                    "choose one of: " + std::string(program.getInfo<CL_PROGRAM_KERNEL_NAMES>().c_str()));
            }
            throw;
        }
        argCount_ = kernel_.getInfo<CL_KERNEL_NUM_ARGS>();
        workGroupLimit_ = kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.cl());
    });
}

std::string Kernel::description() const { return fmt::format("kernel {} ({})", name_, file_); }

void Kernel::setArg(unsigned index, const cl::Buffer& buffer)
{
    const cl_mem handle = buffer();
    setRaw(index, sizeof(handle), &handle);
}

void Kernel::requireWorkGroup(std::size_t items) const
{
    if (items == 0 || items > workGroupLimit_) {
        throw Error(fmt::format("work-group size of {} on {}", description(), deviceName_), std::to_string(items),
            fmt::format("use 1 to {} items", workGroupLimit_));
    }
}

void Kernel::requireCount(std::size_t given) const
{
    if (given != argCount_) {
        throw Error(fmt::format("{} takes {} arguments", description(), argCount_), fmt::format("{} given", given),
            "make the kernel and its caller agree; with --kernel-dir, take the kernels of this version");
    }
}

void Kernel::setRaw(unsigned index, std::size_t bytes, const void* value)
{
    const cl_int status = ::clSetKernelArg(kernel_(), index, bytes, value);
    if (status != CL_SUCCESS) {
        throwClError(cl::Error(status, "clSetKernelArg"),
            fmt::format("argument {} ({} bytes) of {}", index, bytes, description()), deviceName_);
    }
}

} // namespace wedge::device
