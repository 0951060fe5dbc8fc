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

/// The Gauss rule of three nodes whose weight function is the profile itself, weights summing to 1: averages
/// polynomials of degree 5 over one axis of the profile exactly.
std::vector<Node> threeNodeRule(scene::LightProfile profile, double cut);

/// (position, weight) of all rules that the kernels have for a light (WEDGE_COARSE_NODES and what follows in
/// kernels/shared/light.h).
std::vector<float> lightNodes(const scene::AreaLight& light);

} // namespace wedge::render
