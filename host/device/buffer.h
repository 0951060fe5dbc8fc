#pragma once

#include "host/device/cl_error.h"
#include "host/device/device.h"
#include "host/device/memory_plan.h"
#include "host/device/opencl.h"
#include "host/device/paged_memory.h"
#include "host/device/queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace wedge::device {

/// Where parts of a buffer may start, bytes: no device that renders asks for more.
constexpr std::size_t partAlignment = 1024;
/// Buffers of CPU devices of at least so many bytes are pagedMemory().
constexpr std::size_t leastPaged = std::size_t { 2 } << 20;

/// `count` elements of T in device memory, uninitialised. Copies share the memory. Transfers are recorded by the
/// queue as "upload NAME", "download NAME" and "fill NAME", wait, and throw Error where they leave the buffer.
///
/// CPU devices get no CL_MEM_ALLOC_HOST_PTR: transfers between a span and a buffer copy once there either way.
template <class T>
class Buffer { // NOLINT(bugprone-exception-escape): what cl::Buffer does when it is assigned to, a programming error
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool>);

public:
    using Element = T;

    /// name: what errors and records call it. A count of 0 allocates one element, for kernels to have an argument.
    /// Throws Error if the device does not allocate so much at once.
    Buffer(const Device& device, std::size_t count, std::string name)
        : name_(std::move(name))
        , size_(count)
    {
        requireAllocation(device.info());
        const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(T);
        checked(fmt::format("buffer {} ({})", name_, mebibytes(bytes)), device.info().name, [&] {
            const bool paged = device.info().type == DeviceType::Cpu && bytes >= leastPaged;
            buffer_ =
                paged ? pagedMemory(device.context(), bytes) : cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes);
        });
    }

    /// Elements that kernels only read, with the values of `values`. A CPU device works on that memory itself, which
    /// must then outlive the buffer and stay as it is: nothing is copied, and how it is paged stays the owner's choice.
    /// Other devices get a copy.
    static Buffer readOnly(const Device& device, TimedQueue& queue, std::span<const T> values, std::string name)
    {
        if (device.info().type != DeviceType::Cpu || values.empty()) {
            Buffer copy(device, values.size(), std::move(name));
            if (!values.empty()) {
                copy.upload(queue, values);
            }
            return copy;
        }
        Buffer shared(std::move(name), values.size());
        shared.requireAllocation(device.info());
        shared.readOnly_ = true;
        checked(fmt::format("buffer {} ({})", shared.name_, mebibytes(shared.bytes())), device.info().name, [&] {
            shared.buffer_ = cl::Buffer(device.context(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, shared.bytes(),
                const_cast<std::remove_const_t<T>*>(values.data()));
        });
        return shared;
    }

    /// `count` elements at the start of memory that somebody else has allocated, and which the buffer keeps alive.
    static Buffer over(const cl::Buffer& memory, std::size_t count, std::string name)
    {
        Buffer out(std::move(name), count);
        out.buffer_ = memory;
        return out;
    }

    /// A buffer in this one's memory, of `count` elements of U from this one's element `first` on, which lies at a
    /// multiple of partAlignment bytes. Both keep the memory alive. A part that is all of it is the same memory object,
    /// of which a kernel may have both, for different elements; of others that overlap it may have but one.
    template <class U>
    Buffer<U> part(std::size_t first, std::size_t count, std::string name) const
    {
        requireInside("part of", (count * sizeof(U) + sizeof(T) - 1) / sizeof(T), first);
        assert(first * sizeof(T) % partAlignment == 0);
        Buffer<U> out(std::move(name), count);
        if (out.bytes() == bytes() && count > 0) {
            out.buffer_ = buffer_;
            return out;
        }
        const cl_buffer_region region { first * sizeof(T), std::max<std::size_t>(count, 1) * sizeof(U) };
        cl::Buffer whole = buffer_;
        checked("part of buffer " + name_, "its device",
            [&] { out.buffer_ = whole.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region); });
        return out;
    }

    /// Copies values to the elements from `offset` on.
    void upload(TimedQueue& queue, std::span<const T> values, std::size_t offset = 0)
    {
        assert(!readOnly_);
        requireInside("upload to", values.size(), offset);
        queue.write("upload " + name_, buffer_, offset * sizeof(T), values.size_bytes(), values.data());
    }

    /// Copies the elements from `offset` on to values, after all that was launched before.
    void download(TimedQueue& queue, std::span<T> values, std::size_t offset = 0) const
    {
        requireInside("download from", values.size(), offset);
        queue.read("download " + name_, buffer_, offset * sizeof(T), values.size_bytes(), values.data());
    }

    /// All elements, as download() copies them.
    std::vector<T> downloadAll(TimedQueue& queue) const
    {
        std::vector<T> values(size_);
        download(queue, values);
        return values;
    }

    /// Sets all elements to value.
    void fill(TimedQueue& queue, T value)
    {
        assert(!readOnly_);
        if constexpr (std::has_single_bit(sizeof(T)) && sizeof(T) <= 128) {
            queue.fill("fill " + name_, buffer_, bytes(), &value, sizeof(T));
        } else {
            // OpenCL fills with patterns of 1, 2, 4 ... 128 bytes only.
            const std::vector<T> values(size_, value);
            queue.write("fill " + name_, buffer_, 0, bytes(), values.data());
        }
    }

    std::size_t size() const { return size_; }
    std::size_t bytes() const { return size_ * sizeof(T); }
    const std::string& name() const { return name_; }
    const cl::Buffer& cl() const { return buffer_; }

private:
    template <class U>
    friend class Buffer;

    Buffer(std::string name, std::size_t count)
        : name_(std::move(name))
        , size_(count)
    {
    }

    void requireAllocation(const DeviceInfo& info) const
    {
        // Tested here because some drivers abort the program.
        if (size_ > info.maxAllocation / sizeof(T)) {
            throw Error(fmt::format("buffer {} of {} elements on {}", name_, size_, info.name),
                fmt::format("{:.1f} MiB, the limit is {}", static_cast<double>(size_) * sizeof(T) / 1048576.0,
                    mebibytes(info.maxAllocation)),
                "render a smaller image, or choose a device with more memory");
        }
    }

    void requireInside(const char* action, std::size_t count, std::size_t offset) const
    {
        if (offset > size_ || count > size_ - offset) {
            throw Error(fmt::format("{} buffer {} of {} elements", action, name_, size_),
                fmt::format("{} elements at {}", count, offset), "this is a fault in wedge, please report it");
        }
    }

    std::string name_;
    std::size_t size_ = 0;
    bool readOnly_ = false; ///< shares its owner's memory, which nothing here may write
    cl::Buffer buffer_;
};

} // namespace wedge::device
