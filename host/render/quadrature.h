#pragma once

#include "host/scene/scene.h"

#include <vector>

namespace wedge::render {

/// One node of a quadrature rule on [-1, 1].
struct Node {
    double position;
    double weight;
};

/// Gauss-Legendre rule of `count` >= 1 nodes on [-1, 1], weights summing to 2: exact for polynomials of degree
/// 2 count - 1.
std::vector<Node> gaussLegendre(int count);

/// The rule that averages over one axis of a light's profile: Gauss-Legendre nodes, weights times the profile and
/// normalised to sum 1.
std::vector<Node> profileRule(scene::LightProfile profile, double cut, int count);

} // namespace wedge::render
