#include "host/device/cl_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace wedge::device {
namespace {

struct NamedCode {
    cl_int code;
    std::string_view name;
};

constexpr std::array codes {
    NamedCode { 0, "CL_SUCCESS" },
    NamedCode { -1, "CL_DEVICE_NOT_FOUND" },
    NamedCode { -2, "CL_DEVICE_NOT_AVAILABLE" },
    NamedCode { -3, "CL_COMPILER_NOT_AVAILABLE" },
    NamedCode { -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE" },
    NamedCode { -5, "CL_OUT_OF_RESOURCES" },
    NamedCode { -6, "CL_OUT_OF_HOST_MEMORY" },
    NamedCode { -7, "CL_PROFILING_INFO_NOT_AVAILABLE" },
    NamedCode { -8, "CL_MEM_COPY_OVERLAP" },
    NamedCode { -9, "CL_IMAGE_FORMAT_MISMATCH" },
    NamedCode { -10, "CL_IMAGE_FORMAT_NOT_SUPPORTED" },
    NamedCode { -11, "CL_BUILD_PROGRAM_FAILURE" },
    NamedCode { -12, "CL_MAP_FAILURE" },
    NamedCode { -13, "CL_MISALIGNED_SUB_BUFFER_OFFSET" },
    NamedCode { -14, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST" },
    NamedCode { -15, "CL_COMPILE_PROGRAM_FAILURE" },
    NamedCode { -16, "CL_LINKER_NOT_AVAILABLE" },
    NamedCode { -17, "CL_LINK_PROGRAM_FAILURE" },
    NamedCode { -18, "CL_DEVICE_PARTITION_FAILED" },
    NamedCode { -19, "CL_KERNEL_ARG_INFO_NOT_AVAILABLE" },
    NamedCode { -30, "CL_INVALID_VALUE" },
    NamedCode { -31, "CL_INVALID_DEVICE_TYPE" },
    NamedCode { -32, "CL_INVALID_PLATFORM" },
    NamedCode { -33, "CL_INVALID_DEVICE" },
    NamedCode { -34, "CL_INVALID_CONTEXT" },
    NamedCode { -35, "CL_INVALID_QUEUE_PROPERTIES" },
    NamedCode { -36, "CL_INVALID_COMMAND_QUEUE" },
    NamedCode { -37, "CL_INVALID_HOST_PTR" },
    NamedCode { -38, "CL_INVALID_MEM_OBJECT" },
    NamedCode { -39, "CL_INVALID_IMAGE_FORMAT_DESCRIPTOR" },
    NamedCode { -40, "CL_INVALID_IMAGE_SIZE" },
    NamedCode { -41, "CL_INVALID_SAMPLER" },
    NamedCode { -42, "CL_INVALID_BINARY" },
    NamedCode { -43, "CL_INVALID_BUILD_OPTIONS" },
    NamedCode { -44, "CL_INVALID_PROGRAM" },
    NamedCode { -45, "CL_INVALID_PROGRAM_EXECUTABLE" },
    NamedCode { -46, "CL_INVALID_KERNEL_NAME" },
    NamedCode { -47, "CL_INVALID_KERNEL_DEFINITION" },
    NamedCode { -48, "CL_INVALID_KERNEL" },
    NamedCode { -49, "CL_INVALID_ARG_INDEX" },
    NamedCode { -50, "CL_INVALID_ARG_VALUE" },
    NamedCode { -51, "CL_INVALID_ARG_SIZE" },
    NamedCode { -52, "CL_INVALID_KERNEL_ARGS" },
    NamedCode { -53, "CL_INVALID_WORK_DIMENSION" },
    NamedCode { -54, "CL_INVALID_WORK_GROUP_SIZE" },
    NamedCode { -55, "CL_INVALID_WORK_ITEM_SIZE" },
    NamedCode { -56, "CL_INVALID_GLOBAL_OFFSET" },
    NamedCode { -57, "CL_INVALID_EVENT_WAIT_LIST" },
    NamedCode { -58, "CL_INVALID_EVENT" },
    NamedCode { -59, "CL_INVALID_OPERATION" },
    NamedCode { -60, "CL_INVALID_GL_OBJECT" },
    NamedCode { -61, "CL_INVALID_BUFFER_SIZE" },
    NamedCode { -62, "CL_INVALID_MIP_LEVEL" },
    NamedCode { -63, "CL_INVALID_GLOBAL_WORK_SIZE" },
    NamedCode { -64, "CL_INVALID_PROPERTY" },
    NamedCode { -65, "CL_INVALID_IMAGE_DESCRIPTOR" },
    NamedCode { -66, "CL_INVALID_COMPILER_OPTIONS" },
    NamedCode { -67, "CL_INVALID_LINKER_OPTIONS" },
    NamedCode { -68, "CL_INVALID_DEVICE_PARTITION_COUNT" },
    NamedCode { -69, "CL_INVALID_PIPE_SIZE" },
    NamedCode { -70, "CL_INVALID_DEVICE_QUEUE" },
    NamedCode { -71, "CL_INVALID_SPEC_ID" },
    NamedCode { -72, "CL_MAX_SIZE_RESTRICTION_EXCEEDED" },
    NamedCode { -1001, "CL_PLATFORM_NOT_FOUND_KHR" },
    // NVIDIA's code for a kernel that read or wrote outside its buffers.
    NamedCode { -9999, "illegal memory access (NVIDIA)" },
};

std::string_view remedyFor(cl_int code)
{
    switch (code) {
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
    case CL_OUT_OF_HOST_MEMORY:
    case CL_OUT_OF_RESOURCES:
        return "render a smaller image, close programs that use the device's memory, or choose another device";
    case CL_INVALID_COMMAND_QUEUE:
        return "the driver may have dropped the queue, as a watchdog does after seconds in one launch; choose another "
               "device or update its driver";
    case CL_DEVICE_NOT_AVAILABLE:
    case CL_COMPILER_NOT_AVAILABLE:
        return "choose another device, or install its driver completely";
    default:
        return "choose another device; if it happens there too this is a fault in wedge, please report it";
    }
}

} // namespace

std::string_view clErrorName(cl_int code)
{
    const auto found = std::find_if(codes.begin(), codes.end(), [code](const NamedCode& c) { return c.code == code; });
    return found != codes.end() ? found->name : "unknown OpenCL error";
}

void throwClError(const cl::Error& error, std::string_view subject, std::string_view deviceName)
{
    throw Error(
        fmt::format("{} for {} on {}", error.what() != nullptr ? error.what() : "OpenCL call", subject, deviceName),
        fmt::format("{} ({})", clErrorName(error.err()), error.err()), std::string(remedyFor(error.err())));
}

} // namespace wedge::device
