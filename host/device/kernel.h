#pragma once

#include "host/device/cl_error.h"
#include "host/device/device.h"
#include "host/device/opencl.h"

#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>

namespace wedge::device {

/// Something that holds a cl::Buffer, as Buffer<T> does.
template <class T>
concept HoldsBuffer = requires(const T& holder)
{
    {
        holder.cl()
        } -> std::same_as<const cl::Buffer&>;
};

/// A scalar or a plain struct that a kernel takes by value. Not bool and no pointer: kernels cannot take those.
template <class T>
concept KernelValue =
    std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool> && !HoldsBuffer<T>;

/// One kernel of a program with its name, its file and its own set of arguments. Moves but does not copy, since
/// copies would share the arguments.
class Kernel {
public:
    /// Takes the kernel `name` from the program built of `file`. Throws Error, listing the program's kernels, if it
    /// holds no such kernel.
    Kernel(const Device& device, const cl::Program& program, std::string file, std::string name);
    Kernel(Kernel&&) = default;
    Kernel& operator=(Kernel&&) = default;
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;

    /// Sets all arguments in order: Buffer<T>, cl::Buffer, local memory (cl::Local(bytes)), or a value whose size is
    /// that of the kernel's parameter; a std::tuple stands for its elements. Throws Error if the count is not the
    /// kernel's, or the driver refuses one.
    template <class... Args>
    void setArgs(const Args&... args)
    {
        std::apply(
            [this](const auto&... flat) {
                requireCount(sizeof...(flat));
                unsigned index = 0;
                (setArg(index++, flat), ...);
            },
            std::tuple_cat(flattened(args)...));
    }

    /// Sets the argument at `index`, counted from 0.
    template <KernelValue T>
    void setArg(unsigned index, const T& value)
    {
        setRaw(index, sizeof(T), &value);
    }
    template <HoldsBuffer T>
    void setArg(unsigned index, const T& buffer)
    {
        setArg(index, buffer.cl());
    }
    void setArg(unsigned index, const cl::Buffer& buffer);
    /// A value by its bytes, as many as the kernel's parameter has.
    void setArgBytes(unsigned index, std::span<const std::byte> value) { setRaw(index, value.size(), value.data()); }
    void setArg(unsigned index, const cl::LocalSpaceArg& local) { setRaw(index, local.size_, nullptr); }

    /// Most items of a work-group that this kernel runs with on its device.
    std::size_t workGroupLimit() const { return workGroupLimit_; }
    /// Throws Error unless it runs in work-groups of that many items.
    void requireWorkGroup(std::size_t items) const;
    unsigned argCount() const { return argCount_; }
    /// Throws Error unless it takes so many arguments.
    void requireCount(std::size_t given) const;
    const std::string& name() const { return name_; }
    const std::string& file() const { return file_; }
    /// "kernel NAME (FILE)", what errors call it.
    std::string description() const;
    const cl::Kernel& cl() const { return kernel_; }

private:
    template <class T>
    static std::tuple<const T&> flattened(const T& argument)
    {
        return { argument };
    }
    template <class... Ts>
    static std::tuple<const Ts&...> flattened(const std::tuple<Ts...>& arguments)
    {
        return arguments;
    }
    void setRaw(unsigned index, std::size_t bytes, const void* value);

    cl::Kernel kernel_;
    std::string name_;
    std::string file_;
    std::string deviceName_;
    std::size_t workGroupLimit_ = 1;
    unsigned argCount_ = 0;
};

} // namespace wedge::device
