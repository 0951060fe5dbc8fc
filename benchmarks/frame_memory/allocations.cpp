#include "benchmarks/frame_memory/allocations.h"

#include "host/device/opencl.h"

#include <atomic>

#include <dlfcn.h>

namespace wedge::benchmark {
namespace {

std::atomic<std::uint64_t> now { 0 }, most { 0 };

/// What the library says that a buffer takes.
std::uint64_t bytesOf(cl_mem buffer)
{
    std::size_t bytes = 0;
    clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof bytes, &bytes, nullptr);
    return bytes;
}

void CL_CALLBACK onFreed(cl_mem, void* bytes) { now -= reinterpret_cast<std::uintptr_t>(bytes); }

void count(cl_mem buffer)
{
    const std::uint64_t bytes = bytesOf(buffer);
    const std::uint64_t sum = now += bytes;
    std::uint64_t known = most;
    while (known < sum && !most.compare_exchange_weak(known, sum)) { }
    clSetMemObjectDestructorCallback(buffer, onFreed, reinterpret_cast<void*>(static_cast<std::uintptr_t>(bytes)));
}

} // namespace

void Allocations::restart() { most = now.load(); }
std::uint64_t Allocations::largest() { return most; }
std::uint64_t Allocations::current() { return now; }

} // namespace wedge::benchmark

/// In the place of the library's, for the whole program.
extern "C" cl_mem CL_API_CALL clCreateBuffer(
    cl_context context, cl_mem_flags flags, std::size_t size, void* host, cl_int* error)
{
    static const auto library = reinterpret_cast<decltype(&clCreateBuffer)>(dlsym(RTLD_NEXT, "clCreateBuffer"));
    const cl_mem made = library(context, flags, size, host, error);
    if (made != nullptr) {
        wedge::benchmark::count(made);
    }
    return made;
}
