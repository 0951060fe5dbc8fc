#pragma once

#include "host/scene/mesh.h"

namespace wedge::scene {

/// Gives every corner without a normal one: the mean of the triangles around its position, weighted by their angle
/// there, over those whose plane turns from the corner's own by at most maxAngle (degrees, 0 to 180). Corners at equal
/// positions count as one. Corners of triangles without area get none.
void smoothNormals(Mesh& mesh, float maxAngle);

/// Takes all normals away, so that the geometric ones are used.
void flattenNormals(Mesh& mesh);

} // namespace wedge::scene
