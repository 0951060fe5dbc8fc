#include "host/render/emitter_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace wedge::render {
namespace {

/// Of more parts than that it does not matter where exactly they are halved.
constexpr std::size_t mostSorted = 4096;
/// Parts nearer to each other than this share of all, along an axis, are in one row.
constexpr double sameRow = 1e-4;
constexpr std::uint32_t mostCellsOnSide = 1024;

class Tree {
public:
    Tree(std::vector<shared::Emitter>& list, const std::array<glm::dvec3, 3>& axes)
        : list_(list)
        , axes_(axes)
    {
    }

    /// Returns the part that they are together.
    std::uint32_t add(std::span<EmitterPart> parts, float pick, std::array<int, 2> splits)
    {
        if (parts.size() == 1) {
            parts[0].pick = pick;
            return parts[0].part;
        }
        const std::size_t at = list_.size();
        list_.push_back({});
        const std::size_t axis = longest(parts);
        const std::size_t number = axis == order_[0] ? 0 : axis == order_[1] ? 1 : splits[0] <= splits[1] ? 0 : 1;
        ++splits[number];
        const std::size_t middle = halve(parts, axes_[axis]);
        const std::span<EmitterPart> first = parts.first(middle), second = parts.subspan(middle);
        const double ofFirst = powerOf(first), ofSecond = powerOf(second);
        const auto split = static_cast<float>(ofFirst / (ofFirst + ofSecond));
        const std::uint32_t one = add(first, pick * split, splits), other = add(second, pick * (1.0f - split), splits);
        shared::Emitter& node = list_[at];
        node.upTo = split;
        node.extent = 1.0f / std::max(split, std::numeric_limits<float>::min());
        node.header = std::bit_cast<std::uint32_t>(1.0f / std::max(1.0f - split, std::numeric_limits<float>::min()));
        node.triangle = one;
        node.guide = other;
        const std::uint32_t kind = number == 0 ? WEDGE_PART_SPLIT_X : WEDGE_PART_SPLIT_Y;
        return kind << WEDGE_PART_SHIFT | static_cast<std::uint32_t>(at);
    }

    /// The two numbers stand for the axes along which the mesh is longest, in their order: a pair that has the first
    /// one for a side goes on within itself as the mesh does.
    void orderAxes(std::span<const EmitterPart> parts)
    {
        const glm::dvec3 e = extentsOf(parts);
        const std::size_t shortest = e.z <= std::min(e.x, e.y) * (1 + sameRow) ? 2 : e.y <= e.x ? 1 : 0;
        order_ = { shortest == 0 ? 1u : 0u, shortest == 2 ? 1u : 2u, shortest };
    }

private:
    static double powerOf(std::span<const EmitterPart> parts)
    {
        double sum = 0;
        for (const EmitterPart& p : parts) {
            sum += p.power;
        }
        return sum;
    }
    glm::dvec3 extentsOf(std::span<const EmitterPart> parts) const
    {
        glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
        for (const EmitterPart& p : parts) {
            const glm::dvec3 at(glm::dot(p.at, axes_[0]), glm::dot(p.at, axes_[1]), glm::dot(p.at, axes_[2]));
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        return high - low;
    }
    std::size_t longest(std::span<const EmitterPart> parts) const
    {
        const glm::dvec3 e = extentsOf(parts);
        // By a margin, so that rounding does not decide for squares.
        std::size_t most = order_[0];
        for (const std::size_t axis : { order_[1], order_[2] }) {
            most = e[static_cast<int>(axis)] > (1 + sameRow) * e[static_cast<int>(most)] ? axis : most;
        }
        return most;
    }
    /// Sorts parts along an axis and returns how many of them are the first half, by power, without parting rows if
    /// there is a choice: between a quarter and three.
    static std::size_t halve(std::span<EmitterPart> parts, glm::dvec3 axis)
    {
        const std::size_t n = parts.size();
        const auto along = [&](const EmitterPart& p) { return glm::dot(p.at, axis); };
        const auto before = [&](const EmitterPart& a, const EmitterPart& b) {
            const double x = along(a), y = along(b);
            return x != y ? x < y : a.number < b.number;
        };
        if (n > mostSorted) {
            std::ranges::nth_element(parts, parts.begin() + static_cast<std::ptrdiff_t>(n / 2), before);
            return n / 2;
        }
        std::ranges::sort(parts, before);
        const double row = sameRow * (along(parts.back()) - along(parts.front())), half = 0.5 * powerOf(parts);
        std::size_t best = 0;
        double bestOff = 0, sum = 0;
        bool bestParts = true;
        for (std::size_t i = 1; i < n; ++i) {
            sum += parts[i - 1].power;
            if (i < std::max<std::size_t>(n / 4, 1) || i > n - std::max<std::size_t>(n / 4, 1)) {
                continue;
            }
            const bool partsRow = !(along(parts[i]) - along(parts[i - 1]) > row);
            const double off = std::abs(sum - half);
            if (best == 0 || (bestParts && !partsRow) || (bestParts == partsRow && off < bestOff)) {
                best = i;
                bestOff = off;
                bestParts = partsRow;
            }
        }
        return best;
    }

    std::vector<shared::Emitter>& list_;
    const std::array<glm::dvec3, 3>& axes_;
    std::array<std::size_t, 3> order_ { 0, 1, 2 };
};

/// Of a tree from `part` on, what all numbers of a cell choose a part of.
shared::Emitter cellOf(
    const std::vector<shared::Emitter>& list, std::uint32_t part, std::array<double, 2> from, double side)
{
    constexpr double rounding = 1e-7;
    std::array<double, 2> low { 0, 0 }, size { 1, 1 };
    while (part >> WEDGE_PART_SHIFT >= WEDGE_PART_SPLIT_X) {
        const shared::Emitter& node = list[part & WEDGE_PART_NUMBER];
        const std::size_t number = part >> WEDGE_PART_SHIFT == WEDGE_PART_SPLIT_X ? 0 : 1;
        const double split = node.upTo, border = low[number] + size[number] * split;
        if (from[number] + side <= border + rounding) {
            size[number] *= split;
            part = node.triangle;
        } else if (from[number] >= border - rounding) {
            low[number] = border;
            size[number] *= 1.0 - split;
            part = node.guide;
        } else {
            break;
        }
    }
    const auto bits = [](double x) { return std::bit_cast<std::uint32_t>(static_cast<float>(x)); };
    shared::Emitter cell {};
    cell.triangle = part;
    cell.upTo = static_cast<float>(1.0 / size[0]);
    cell.extent = static_cast<float>(-low[0] / size[0]);
    cell.guide = bits(1.0 / size[1]);
    cell.header = bits(-low[1] / size[1]);
    return cell;
}

} // namespace

shared::Emitter addMesh(
    std::vector<shared::Emitter>& list, std::span<EmitterPart> parts, const std::array<glm::dvec3, 3>& axes, float pick)
{
    Tree tree(list, axes);
    tree.orderAxes(parts);
    const std::uint32_t root = tree.add(parts, pick, { 0, 0 });
    // About as many cells as parts.
    std::uint32_t side = 1;
    while (4 * std::size_t { side } * side <= 2 * parts.size() && side < mostCellsOnSide) {
        side *= 2;
    }
    shared::Emitter mesh {};
    mesh.pair = WEDGE_PAIR_MESH;
    mesh.triangle = static_cast<std::uint32_t>(list.size());
    mesh.header = side;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint32_t column = i % side, row = i / side;
        list.push_back(
            cellOf(list, root, { column / static_cast<double>(side), row / static_cast<double>(side) }, 1.0 / side));
    }
    return mesh;
}

} // namespace wedge::render
