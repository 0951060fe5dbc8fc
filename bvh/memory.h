#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace wedge::bvh {

/// Memory of that many bytes, aligned to a cache line at least; large blocks lie in huge pages where the system has
/// them, which are quicker to get and to find one's way in. Throws std::bad_alloc.
void* allocateMemory(std::size_t bytes);
void freeMemory(void* memory) noexcept;

/// Gives vectors such memory, and leaves what they make room for as it is, so that threads can fill it without one
/// having cleared it first.
template <typename T>
struct Uninitialized {
    using value_type = T;
    Uninitialized() = default;
    template <typename U>
    Uninitialized(const Uninitialized<U>&) noexcept
    {
    }

    T* allocate(std::size_t count) { return static_cast<T*>(allocateMemory(count * sizeof(T))); }
    void deallocate(T* memory, std::size_t) noexcept { freeMemory(memory); }
    template <typename U>
    void construct(U* place) noexcept
    {
        ::new (static_cast<void*>(place)) U;
    }
    template <typename U, typename... Arguments>
    void construct(U* place, Arguments&&... arguments)
    {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
    template <typename U>
    bool operator==(const Uninitialized<U>&) const noexcept
    {
        return true;
    }
};

template <typename T>
using Array = std::vector<T, Uninitialized<T>>;

} // namespace wedge::bvh
