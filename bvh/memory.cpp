#include "bvh/memory.h"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace wedge::bvh {

void* allocateMemory(std::size_t bytes)
{
    constexpr std::size_t line = 64, hugePage = std::size_t { 2 } << 20;
    const std::size_t alignment = bytes >= hugePage ? hugePage : line;
    void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (!memory)
        throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (bytes >= hugePage)
        madvise(memory, bytes, MADV_HUGEPAGE); // where it is refused, small pages do
#endif
    return memory;
}

void freeMemory(void* memory) noexcept { std::free(memory); }

} // namespace wedge::bvh
