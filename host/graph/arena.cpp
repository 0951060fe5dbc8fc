#include "host/graph/arena.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

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

/// The tenants one after the other, each in the smallest gap that holds it.
Placement placeInOrder(const std::vector<Tenant>& tenants, const std::vector<std::size_t>& order,
    const std::function<std::uint64_t(std::uint64_t)>& aligned, const SlabRules& rules)
{
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
            const bool fits = rules.sharing == Sharing::Apart ? out.slabs[slab] == 0
                : rules.sharing == Sharing::Turns             ? taken.empty()
                                                              : offset == 0 || end(offset, bytes) <= rules.mostBytes;
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

/// Bytes of all that meets somewhere, at most, and at which step.
std::pair<std::uint64_t, std::uint64_t> mostAtOnce(
    const std::vector<Tenant>& tenants, const std::function<std::uint64_t(std::uint64_t)>& aligned)
{
    std::map<std::uint64_t, std::uint64_t> begins, ends; // of each step
    for (const Tenant& tenant : tenants) {
        begins[tenant.first] += aligned(tenant.bytes);
        ends[std::uint64_t { tenant.last } + 1] += aligned(tenant.bytes);
    }
    std::uint64_t now = 0, largest = 0, busiest = 0;
    for (const auto& [step, bytes] : begins) {
        while (!ends.empty() && ends.begin()->first <= step) {
            now -= ends.begin()->second;
            ends.erase(ends.begin());
        }
        now += bytes;
        if (now > largest) {
            largest = now;
            busiest = step;
        }
    }
    return { largest, busiest };
}

} // namespace

Placement place(const std::vector<Tenant>& tenants, std::uint64_t alignment, const SlabRules& slabRules)
{
    const auto aligned = [&](std::uint64_t bytes) {
        const std::uint64_t over = bytes % alignment;
        return over == 0 ? bytes : end(bytes, alignment - over);
    };
    const auto life = [&](std::size_t i) { return tenants[i].last - tenants[i].first; };
    const auto bytes = [&](std::size_t i) { return tenants[i].bytes; };
    const auto [least, busiest] = mostAtOnce(tenants, aligned);
    const auto crowded = [&, step = busiest](
                             std::size_t i) { return tenants[i].first <= step && step <= tenants[i].last; };
    // None of these is the best for all graphs.
    const std::function<bool(std::size_t, std::size_t)> rules[] = {
        [&](std::size_t a, std::size_t b) { return bytes(a) != bytes(b) ? bytes(a) > bytes(b) : life(a) > life(b); },
        [&](std::size_t a, std::size_t b) { return life(a) != life(b) ? life(a) > life(b) : bytes(a) > bytes(b); },
        [&](std::size_t a, std::size_t b) { return tenants[a].first < tenants[b].first; },
        [&](std::size_t a, std::size_t b) {
            return static_cast<double>(bytes(a)) * (life(a) + 1.0) > static_cast<double>(bytes(b)) * (life(b) + 1.0);
        },
        // Where most is held at once no gaps are left.
        [&](std::size_t a, std::size_t b) {
            return crowded(a) != crowded(b) ? crowded(a)
                : bytes(a) != bytes(b)      ? bytes(a) > bytes(b)
                                            : life(a) > life(b);
        },
        [&](std::size_t a, std::size_t b) {
            return crowded(a) != crowded(b) ? crowded(a) : life(a) != life(b) ? life(a) > life(b) : bytes(a) > bytes(b);
        },
    };
    const auto sum = [](const Placement& placement) {
        return std::accumulate(placement.slabs.begin(), placement.slabs.end(), std::uint64_t { 0 });
    };
    Placement best;
    const auto tries = [&](const std::vector<std::size_t>& order) {
        Placement found = placeInOrder(tenants, order, aligned, slabRules);
        if (best.places.empty() || sum(found) < sum(best)) {
            best = found;
        }
        return found;
    };
    struct Tried {
        std::vector<std::size_t> order;
        Placement found;
    };
    std::vector<Tried> tried;
    for (const auto& before : rules) {
        std::vector<std::size_t> order(tenants.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), before);
        Placement found = tries(order);
        tried.push_back({ std::move(order), std::move(found) });
        if (slabRules.sharing == Sharing::Apart || sum(best) <= least) {
            return best;
        }
    }
    // Who sticks out is placed first the next time. No order is the one to begin with for all graphs, either.
    std::ranges::stable_sort(tried, {}, [&](const Tried& one) { return sum(one.found); });
    for (Tried& one : tried) {
        for (int k = 0; k < 16 && sum(best) > least; ++k) {
            const auto top = [&](std::size_t i) { return end(one.found.places[i].offset, tenants[i].bytes); };
            const auto highest = std::ranges::max_element(one.order, {}, top);
            std::rotate(one.order.begin(), highest, highest + 1);
            one.found = tries(one.order);
        }
    }
    return best;
}

} // namespace wedge::graph
