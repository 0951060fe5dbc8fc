#include "bvh/morton.h"

#include "bvh/chunks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

namespace wedge::bvh::detail {
namespace {

/// A place on the curve above a reference's place in its array, so that all differ.
using Key = std::uint64_t;
constexpr unsigned placeBits = 28, axisBits = 12, digitBits = 12, digits = 3;
constexpr std::size_t buckets = std::size_t { 1 } << digitBits;
constexpr Key placeMask = (Key { 1 } << placeBits) - 1;

/// Two zeros between each of 12 bits.
Key spread(Key x)
{
    x = (x | x << 16) & 0x0000ff0000ffull;
    x = (x | x << 8) & 0x00f00f00f00full;
    x = (x | x << 4) & 0x0c30c30c30c3ull;
    return (x | x << 2) & 0x249249249249ull;
}

std::unique_ptr<Key[]> makeKeys(const ReferenceArrays& references)
{
    std::unique_ptr<Key[]> keys(new Key[references.count]);
    const Box& centres = references.bounds.centres;
    const Float4 extent = centres.hi - centres.lo;
    Float4 scale {};
    for (int axis = 0; axis < 3; axis++)
        scale[axis] = extent[axis] > 1e-30f ? (1 << axisBits) * 0.9999f / extent[axis] : 0.0f;
    const Chunks chunks(references.count);
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            const Float4 centre = references.current[i].centre();
            const Int4 cell = __builtin_convertvector((centre - centres.lo) * scale, Int4);
            const Key code = spread(static_cast<Key>(cell[0])) | spread(static_cast<Key>(cell[1])) << 1
                | spread(static_cast<Key>(cell[2])) << 2;
            keys[i] = code << placeBits | i;
        }
    });
    return keys;
}

/// Sorts keys by one digit into sorted, equal ones in their order.
void sortByDigit(std::span<const Key> keys, unsigned shift, Key* sorted)
{
    const auto digitOf = [shift](Key key) { return key >> shift & (buckets - 1); };
    const Chunks chunks(keys.size());
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

std::unique_ptr<Key[]> sortedKeys(const ReferenceArrays& references)
{
    std::unique_ptr<Key[]> keys = makeKeys(references);
    constexpr std::uint32_t few = 4096; // clearing the buckets would take longer
    if (references.count < few) {
        std::sort(keys.get(), keys.get() + references.count);
        return keys;
    }
    std::unique_ptr<Key[]> other(new Key[references.count]);
    for (unsigned digit = 0; digit < digits; digit++) {
        sortByDigit({ keys.get(), references.count }, placeBits + digit * digitBits, other.get());
        keys.swap(other);
    }
    return keys;
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

MortonRuns makeMortonRuns(ReferenceArrays references)
{
    const std::unique_ptr<Key[]> keys = sortedKeys(references);
    const Chunks chunks(references.count);
    std::vector<std::vector<std::uint32_t>> starts(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        starts[chunk].reserve((chunks.end(chunk) - chunks.begin(chunk)) / 3);
        findRuns(keys.get(), static_cast<std::uint32_t>(chunks.begin(chunk)),
            static_cast<std::uint32_t>(chunks.end(chunk)), starts[chunk]);
    });
    std::vector<std::size_t> firstRun(chunks.count() + 1, 0);
    for (std::size_t chunk = 0; chunk < chunks.count(); chunk++)
        firstRun[chunk + 1] = firstRun[chunk] + starts[chunk].size();

    MortonRuns runs;
    const std::size_t count = firstRun.back();
    runs.first.resize(count + 1, references.count);
    runs.triangles.reset(new std::uint32_t[references.count]);
    runs.references.count = static_cast<std::uint32_t>(count);
    runs.references.current.reset(new Reference[count]);
    std::vector<Bounds> bounds(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t run = firstRun[chunk]; run < firstRun[chunk + 1]; run++) {
            const std::size_t local = run - firstRun[chunk];
            const std::size_t begin = starts[chunk][local];
            const std::size_t end = local + 1 < starts[chunk].size() ? starts[chunk][local + 1] : chunks.end(chunk);
            Box box = Box::empty();
            for (std::size_t i = begin; i < end; i++) {
                const Reference& reference = references.current[keys[i] & placeMask];
                box.grow(reference.box());
                runs.triangles[i] = reference.index;
            }
            runs.first[run] = static_cast<std::uint32_t>(begin);
            runs.references.current[run] = Reference(box, static_cast<std::uint32_t>(run));
            bounds[chunk].add(runs.references.current[run]);
        }
    });
    for (const Bounds& part : bounds)
        runs.references.bounds.merge(part);
    runs.references.other = std::move(references.current); // as large at least, and no longer needed
    return runs;
}

} // namespace wedge::bvh::detail
