#pragma once

#include "host/device/opencl.h"
#include "host/error.h"

#include <string>
#include <string_view>
#include <utility>

namespace wedge::device {

/// The name of an OpenCL status code, "CL_OUT_OF_RESOURCES"; "unknown OpenCL error" for codes that are no standard's.
std::string_view clErrorName(cl_int code);

/// Throws the Error that says which call failed on what (subject: "kernel trace (primary.cl)") and which device, with
/// the code's name and what the user can do about it.
[[noreturn]] void throwClError(const cl::Error& error, std::string_view subject, std::string_view deviceName);

/// Calls f() and returns its result; a cl::Error that it throws becomes a wedge::Error. Every OpenCL call of this
/// folder runs inside one, so that no cl::Error leaves it.
template <class F>
decltype(auto) checked(std::string_view subject, std::string_view deviceName, F&& f)
{
    try {
        return std::forward<F>(f)();
    } catch (const cl::Error& error) {
        throwClError(error, subject, deviceName);
    }
}

/// For calls of the C interface inside checked(): throws cl::Error unless the status is CL_SUCCESS.
inline void require(cl_int status, const char* call)
{
    if (status != CL_SUCCESS) {
        throw cl::Error(status, call);
    }
}

} // namespace wedge::device
