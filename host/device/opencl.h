// The one place that includes opencl.hpp, so that every file sees it with the same settings: exceptions on, and
// OpenCL 1.2 both as target and as minimum (some distributions' headers do not compile with a later target).
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
