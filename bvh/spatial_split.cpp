#include "bvh/spatial_split.h"

#include "bvh/triangle_blocks.h"

#include <cmath>

namespace wedge::bvh::detail {
namespace {

Float4 absolute(Float4 v) { return maxOf(v, -v); }

bool isEmpty(const Box& box) { return box.lo[0] > box.hi[0] || box.lo[1] > box.hi[1] || box.lo[2] > box.hi[2]; }

/// The common part of two boxes; the empty box where they do not meet.
Box intersect(const Box& part, const Box& box)
{
    const Box common { maxOf(part.lo, box.lo), minOf(part.hi, box.hi) };
    return isEmpty(common) ? Box::empty() : common;
}

/// Boxes of what lies left and right of a plane of the triangle within box. They contain the exact parts: a point on an
/// edge is at most 3.6e-7 of the edge's coordinates off, and so widened by 5e-7 of them.
SpatialSplitter::Parts cut(const Box& box, const Float4 (&vertices)[3], int axis, float plane)
{
    SpatialSplitter::Parts parts { Box::empty(), Box::empty() };
    for (int i = 0; i < 3; i++) {
        const Float4 a = vertices[i], b = vertices[(i + 1) % 3];
        if (a[axis] <= plane)
            parts.left.grow(a);
        if (a[axis] >= plane)
            parts.right.grow(a);
        if ((a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane)) {
            const Float4 point = a + (b - a) * ((plane - a[axis]) / (b[axis] - a[axis]));
            const Float4 error = (absolute(a) + absolute(b)) * 5e-7f;
            const Box around { point - error, point + error };
            parts.left.grow(around);
            parts.right.grow(around);
        }
    }
    parts.left.hi[axis] = std::min(parts.left.hi[axis], plane);
    parts.right.lo[axis] = std::max(parts.right.lo[axis], plane);
    return { intersect(parts.left, box), intersect(parts.right, box) };
}

void load(const Mesh& mesh, std::uint32_t triangle, Float4 (&vertices)[3])
{
    for (std::size_t corner = 0; corner < 3; corner++)
        vertices[corner] = vertexOf(mesh, triangle, corner);
}

bool isFlat(const Mesh& mesh, std::uint32_t triangle)
{
    Float4 v[3];
    load(mesh, triangle, v);
    const Float4 e1 = v[1] - v[0], e2 = v[2] - v[0];
    return isDegenerate({ e1[0], e1[1], e1[2] }, { e2[0], e2[1], e2[2] });
}

double blocksOf(std::uint32_t count, unsigned shift) { return (count + (1u << shift) - 1) >> shift; }

Box unite(Box a, const Box& b)
{
    a.grow(b);
    return a;
}

} // namespace

SpatialSplitter::SpatialSplitter(std::span<const Reference> references, const Box& box, const Mesh& mesh)
    : references_(references)
    , box_(box)
    , mesh_(mesh)
    , chunks_(references.size())
{
    const Float4 extent = box.hi - box.lo;
    for (int axis = 0; axis < 3; axis++) {
        width_[axis] = extent[axis] / bins;
        scale_[axis] = extent[axis] > 1e-30f ? bins * 0.99999f / extent[axis] : 0.0f;
    }
}

Int4 SpatialSplitter::binOf(Float4 point) const { return __builtin_convertvector((point - box_.lo) * scale_, Int4); }

void SpatialSplitter::add(const Reference& reference, Histogram& histogram) const
{
    const Box box = reference.box();
    const Int4 begin = binOf(box.lo), end = binOf(box.hi);
    Float4 vertices[3];
    bool loaded = false;
    for (int axis = 0; axis < 3; axis++) {
        histogram.begins[begin[axis]][axis]++;
        histogram.ends[end[axis]][axis]++;
        Box rest = box;
        for (int bin = begin[axis]; bin < end[axis] && !isEmpty(rest); bin++) {
            if (!loaded)
                load(mesh_, reference.index, vertices);
            loaded = true;
            const Parts parts = cut(rest, vertices, axis, planeAt(axis, bin + 1));
            histogram.boxes[bin][axis].grow(parts.left);
            rest = parts.right;
        }
        histogram.boxes[end[axis]][axis].grow(rest);
    }
}

SpatialSplit SpatialSplitter::find(unsigned blockShift) const
{
    const auto histograms = std::make_unique_for_overwrite<Histogram[]>(chunks_.count());
    chunks_.forEach([&](std::size_t chunk) {
        Histogram& histogram = histograms[chunk];
        for (unsigned bin = 0; bin < bins; bin++)
            for (int axis = 0; axis < 3; axis++) {
                histogram.boxes[bin][axis] = Box::empty();
                histogram.begins[bin][axis] = histogram.ends[bin][axis] = 0;
            }
        for (std::size_t i = chunks_.begin(chunk); i < chunks_.end(chunk); i++)
            add(references_[i], histogram);
    });
    Histogram& all = histograms[0];
    for (std::size_t chunk = 1; chunk < chunks_.count(); chunk++)
        for (unsigned bin = 0; bin < bins; bin++)
            for (int axis = 0; axis < 3; axis++) {
                all.boxes[bin][axis].grow(histograms[chunk].boxes[bin][axis]);
                all.begins[bin][axis] += histograms[chunk].begins[bin][axis];
                all.ends[bin][axis] += histograms[chunk].ends[bin][axis];
            }
    SpatialSplit best;
    double bestCost = 0;
    for (int axis = 0; axis < 3; axis++) {
        Box rights[bins];
        std::uint32_t rightCounts[bins];
        Box box = Box::empty();
        std::uint32_t count = 0;
        for (unsigned bin = bins; --bin > 0;) {
            box.grow(all.boxes[bin][axis]);
            rights[bin] = box;
            rightCounts[bin] = count += all.ends[bin][axis];
        }
        box = Box::empty();
        count = 0;
        for (unsigned bin = 1; bin < bins; bin++) {
            box.grow(all.boxes[bin - 1][axis]);
            count += all.begins[bin - 1][axis];
            if (count == 0 || rightCounts[bin] == 0)
                continue;
            const double cost = box.halfArea() * blocksOf(count, blockShift)
                + rights[bin].halfArea() * blocksOf(rightCounts[bin], blockShift);
            if (best.axis < 0 || cost < bestCost) {
                bestCost = cost;
                best = { axis, static_cast<int>(bin), 0, count, rightCounts[bin], box, rights[bin] };
            }
        }
    }
    const double area = box_.halfArea();
    best.cost = area > 0 ? static_cast<float>(bestCost / area) : 1e30f;
    return best;
}

SpatialSplitter::Parts SpatialSplitter::cutReference(const Reference& reference, const SpatialSplit& split) const
{
    Float4 vertices[3];
    load(mesh_, reference.index, vertices);
    return cut(reference.box(), vertices, split.axis, planeAt(split.axis, split.bin));
}

SpatialSplitter::Side SpatialSplitter::sideOf(
    const Reference& reference, const SpatialSplit& split, unsigned blockShift) const
{
    const Box box = reference.box();
    if (binOf(box.hi)[split.axis] < split.bin)
        return Side::Left;
    if (binOf(box.lo)[split.axis] >= split.bin)
        return Side::Right;
    const Parts parts = cutReference(reference, split);
    if (isEmpty(parts.right))
        return Side::Left;
    if (isEmpty(parts.left))
        return Side::Right;
    const double left = split.left.halfArea(), right = split.right.halfArea();
    // Without rounding to blocks: a single reference would hardly ever change their number.
    const double scale = 1.0 / (1u << blockShift);
    const double leftCount = split.leftCount * scale, rightCount = split.rightCount * scale;
    const double both = left * leftCount + right * rightCount;
    const double allLeft = unite(split.left, box).halfArea() * leftCount + right * (rightCount - scale);
    const double allRight = left * (leftCount - scale) + unite(split.right, box).halfArea() * rightCount;
    if (both <= allLeft && both <= allRight && !isFlat(mesh_, reference.index))
        return Side::Both;
    return allLeft <= allRight ? Side::Left : Side::Right;
}

Halves SpatialSplitter::count(const SpatialSplit& split, unsigned blockShift)
{
    sides_.resize(references_.size());
    firstLeft_.assign(chunks_.count() + 1, 0);
    firstRight_.assign(chunks_.count() + 1, 0);
    chunks_.forEach([&](std::size_t chunk) {
        std::uint32_t left = 0, right = 0;
        for (std::size_t i = chunks_.begin(chunk); i < chunks_.end(chunk); i++) {
            sides_[i] = sideOf(references_[i], split, blockShift);
            left += sides_[i] != Side::Right;
            right += sides_[i] != Side::Left;
        }
        firstLeft_[chunk + 1] = left;
        firstRight_[chunk + 1] = right;
    });
    for (std::size_t chunk = 0; chunk < chunks_.count(); chunk++) {
        firstLeft_[chunk + 1] += firstLeft_[chunk];
        firstRight_[chunk + 1] += firstRight_[chunk];
    }
    return { firstLeft_.back(), firstRight_.back(), {}, {} };
}

void SpatialSplitter::divide(const SpatialSplit& split, Halves& halves, Reference* left, Reference* right) const
{
    struct Found {
        Bounds left, right;
    };
    std::vector<Found> found(chunks_.count());
    chunks_.forEach([&](std::size_t chunk) {
        Found bounds;
        Reference* leftOut = left + firstLeft_[chunk];
        Reference* rightOut = right + firstRight_[chunk];
        for (std::size_t i = chunks_.begin(chunk); i < chunks_.end(chunk); i++) {
            const Reference& reference = references_[i];
            Parts parts { reference.box(), reference.box() };
            if (sides_[i] == Side::Both)
                parts = cutReference(reference, split);
            if (sides_[i] != Side::Right) {
                *leftOut = Reference(parts.left, reference.index);
                bounds.left.add(*leftOut++);
            }
            if (sides_[i] != Side::Left) {
                *rightOut = Reference(parts.right, reference.index);
                bounds.right.add(*rightOut++);
            }
        }
        found[chunk] = bounds;
    });
    for (const Found& bounds : found) {
        halves.left.merge(bounds.left);
        halves.right.merge(bounds.right);
    }
}

} // namespace wedge::bvh::detail
