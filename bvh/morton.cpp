#include "bvh/morton.h"

#include "bvh/chunks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace wedge::bvh::detail {
namespace {

/// A place on the curve above a triangle's index, so that all differ.
using Key = std::uint64_t;
constexpr unsigned indexBits = 28, axisBits = 12, digitBits = 9, digits = 4;
constexpr std::size_t buckets = std::size_t { 1 } << digitBits;
constexpr Key indexMask = (Key { 1 } << indexBits) - 1;

/// Two zeros between each of 12 bits.
Key spread(Key x)
{
    x = (x | x << 16) & 0x0000ff0000ffull;
    x = (x | x << 8) & 0x00f00f00f00full;
    x = (x | x << 4) & 0x0c30c30c30c3ull;
    return (x | x << 2) & 0x249249249249ull;
}

/// The keys of the valid triangles, in ascending order of their indices.
Array<Key> makeKeys(const Mesh& mesh)
{
    const Chunks chunks(mesh.indices.size() / 3);
    const auto forEachValid = [&](std::size_t chunk, const auto& body) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            bool valid;
            const Box box = boxOf(mesh, static_cast<std::uint32_t>(i), valid);
            if (valid)
                body(i, box.lo + box.hi);
        }
    };
    std::vector<Box> boxes(chunks.count(), Box::empty());
    std::vector<std::size_t> first(chunks.count() + 1, 0);
    chunks.forEach([&](std::size_t chunk) {
        Box box = Box::empty();
        std::size_t count = 0;
        forEachValid(chunk, [&](std::size_t, Float4 centre) {
            box.grow(centre);
            count++;
        });
        boxes[chunk] = box;
        first[chunk + 1] = count;
    });
    Box centres = Box::empty();
    for (std::size_t chunk = 0; chunk < chunks.count(); chunk++) {
        centres.grow(boxes[chunk]);
        first[chunk + 1] += first[chunk];
    }
    Float4 scale {};
    for (int axis = 0; axis < 3; axis++) {
        const float extent = centres.hi[axis] - centres.lo[axis];
        scale[axis] = extent > 1e-30f ? (1 << axisBits) * 0.9999f / extent : 0.0f;
    }
    Array<Key> keys(first.back());
    chunks.forEach([&](std::size_t chunk) {
        Key* next = keys.data() + first[chunk];
        forEachValid(chunk, [&](std::size_t i, Float4 centre) {
            const Int4 cell = __builtin_convertvector((centre - centres.lo) * scale, Int4);
            const Key code = spread(static_cast<Key>(cell[0])) | spread(static_cast<Key>(cell[1])) << 1
                | spread(static_cast<Key>(cell[2])) << 2;
            *next++ = code << indexBits | i;
        });
    });
    return keys;
}

/// Sorts keys by one digit into sorted, equal ones in their order.
void sortByDigit(std::span<const Key> keys, unsigned shift, Key* sorted)
{
    const auto digitOf = [shift](Key key) { return key >> shift & (buckets - 1); };
    const Chunks chunks(keys.size(), 64);
    const auto next = std::make_unique_for_overwrite<std::array<std::uint32_t, buckets>[]>(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        next[chunk].fill(0);
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++)
            next[chunk][digitOf(keys[i])]++;
    });
    std::uint32_t sum = 0;
    for (std::size_t bucket = 0; bucket < buckets; bucket++)
        for (std::size_t chunk = 0; chunk < chunks.count(); chunk++)
            sum += std::exchange(next[chunk][bucket], sum);
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++)
            sorted[next[chunk][digitOf(keys[i])]++] = keys[i];
    });
}

void sort(Array<Key>& keys)
{
    constexpr std::size_t few = 1024; // clearing the buckets would take longer
    if (keys.size() < few)
        return std::sort(keys.begin(), keys.end());
    Array<Key> other(keys.size());
    for (unsigned digit = 0; digit < digits; digit++) {
        sortByDigit(keys, indexBits + digit * digitBits, other.data());
        keys.swap(other);
    }
}

/// Appends where runs start in [first, last) to starts: splits at the highest bit in which keys differ until they fit.
void findRuns(const Key* keys, std::uint32_t first, std::uint32_t last, std::vector<std::uint32_t>& starts)
{
    if (last - first <= WEDGE_BLOCK_SIZE) {
        starts.push_back(first);
        return;
    }
    const Key bit = std::bit_floor(keys[first] ^ keys[last - 1]);
    const Key* middle = std::partition_point(keys + first, keys + last, [&](Key key) { return (key & bit) == 0; });
    const auto split = static_cast<std::uint32_t>(middle - keys);
    findRuns(keys, first, split, starts);
    findRuns(keys, split, last, starts);
}

} // namespace

MortonRuns makeMortonRuns(const Mesh& mesh)
{
    Array<Key> keys = makeKeys(mesh);
    MortonRuns runs;
    if (keys.empty())
        return runs;
    sort(keys);
    const Chunks chunks(keys.size());
    std::vector<std::vector<std::uint32_t>> starts(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        starts[chunk].reserve((chunks.end(chunk) - chunks.begin(chunk)) / 3);
        findRuns(keys.data(), static_cast<std::uint32_t>(chunks.begin(chunk)),
            static_cast<std::uint32_t>(chunks.end(chunk)), starts[chunk]);
    });
    std::vector<std::size_t> firstRun(chunks.count() + 1, 0);
    for (std::size_t chunk = 0; chunk < chunks.count(); chunk++)
        firstRun[chunk + 1] = firstRun[chunk] + starts[chunk].size();

    const std::size_t count = firstRun.back();
    runs.first.resize(count + 1, static_cast<std::uint32_t>(keys.size()));
    runs.triangles.resize(keys.size());
    runs.references.count = static_cast<std::uint32_t>(count);
    runs.references.current.resize(count);
    runs.references.other.resize(count);
    std::vector<Bounds> bounds(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t run = firstRun[chunk]; run < firstRun[chunk + 1]; run++) {
            const std::size_t local = run - firstRun[chunk];
            const std::size_t begin = starts[chunk][local];
            const std::size_t end = local + 1 < starts[chunk].size() ? starts[chunk][local + 1] : chunks.end(chunk);
            Box box = Box::empty();
            for (std::size_t i = begin; i < end; i++) {
                bool valid;
                runs.triangles[i] = static_cast<std::uint32_t>(keys[i] & indexMask);
                box.grow(boxOf(mesh, runs.triangles[i], valid));
            }
            runs.first[run] = static_cast<std::uint32_t>(begin);
            runs.references.current[run] = Reference(box, static_cast<std::uint32_t>(run));
            bounds[chunk].add(runs.references.current[run]);
        }
    });
    for (const Bounds& part : bounds)
        runs.references.bounds.merge(part);
    return runs;
}

} // namespace wedge::bvh::detail
