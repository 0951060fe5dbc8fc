#pragma once

#include "bvh/bvh.h"

namespace wedge::bvh {

/// Fits a hierarchy to new positions of the mesh that it was built over, on all threads: the tree stays, boxes,
/// triangles, unit and statistics (buildSeconds: of this call) become what they would be for it. mesh has the same
/// triangles, in the same order. Several times faster than any build; the farther triangles move from their
/// neighbours, the slower rays get, which sahCost tells. Boxes hold whole triangles, so that a hierarchy with spatial
/// splits loses what they gained.
///
/// Triangles left out of the build stay out. Returns false and changes nothing if one that is in the hierarchy now has
/// a vertex that is NaN, infinite or beyond maxCoordinate: build anew then.
[[nodiscard]] bool refit(Bvh& bvh, const Mesh& mesh);

} // namespace wedge::bvh
