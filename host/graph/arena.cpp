#include "host/graph/arena.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace wedge::graph {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

struct Taken {
    std::uint64_t begin, end;
};

std::uint64_t end(std::uint64_t offset, std::uint64_t bytes) { return bytes > most - offset ? most : offset + bytes; }

/// Start of the smallest gap between what is taken that holds so many bytes, else the end of it all. taken: sorted.
std::uint64_t bestGap(const std::vector<Taken>& taken, std::uint64_t bytes)
{
    std::optional<Taken> best;
    std::uint64_t free = 0;
    for (const Taken& part : taken) {
        if (part.begin > free && part.begin - free >= bytes && (!best || part.begin - free < best->end - best->begin)) {
            best = Taken { free, part.begin };
        }
        free = std::max(free, part.end);
    }
    return best ? best->begin : free;
}

} // namespace

Placement place(const std::vector<Tenant>& tenants, std::uint64_t alignment, std::uint64_t mostSlabBytes)
{
    const auto aligned = [&](std::uint64_t bytes) {
        const std::uint64_t over = bytes % alignment;
        return over == 0 ? bytes : end(bytes, alignment - over);
    };
    std::vector<std::size_t> order(tenants.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(
        order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tenants[a].bytes > tenants[b].bytes; });
    Placement out;
    out.places.resize(tenants.size());
    std::vector<std::size_t> placed;
    for (const std::size_t i : order) {
        const std::uint64_t bytes = aligned(tenants[i].bytes);
        for (std::uint32_t slab = 0;; ++slab) {
            if (slab == out.slabs.size()) {
                out.slabs.push_back(0);
            }
            std::vector<Taken> taken;
            for (const std::size_t other : placed) {
                if (out.places[other].slab == slab && tenants[other].meets(tenants[i])) {
                    const std::uint64_t at = out.places[other].offset;
                    taken.push_back({ at, end(at, aligned(tenants[other].bytes)) });
                }
            }
            std::sort(taken.begin(), taken.end(), [](const Taken& a, const Taken& b) { return a.begin < b.begin; });
            const std::uint64_t offset = bestGap(taken, bytes);
            const bool fits =
                mostSlabBytes == 0 ? out.slabs[slab] == 0 : offset == 0 || end(offset, bytes) <= mostSlabBytes;
            if (fits) {
                out.places[i] = { slab, offset };
                out.slabs[slab] = std::max(out.slabs[slab], end(offset, bytes));
                break;
            }
        }
        placed.push_back(i);
    }
    return out;
}

} // namespace wedge::graph
