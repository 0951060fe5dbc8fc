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

/// The Gauss rule of 1 to 16 nodes whose weight function is a light's profile along one axis, weights summing to 1:
/// averages polynomials of degree 2 count - 1 over it exactly. cut: half extent in standard deviations, of a Gaussian
std::vector<Node> profileRule(scene::LightProfile profile, double cut, int count);

/// (position, weight) of all rules that the kernels have for a light (WEDGE_COARSE_NODES and what follows in
/// kernels/shared/light.h).
std::vector<float> lightNodes(const scene::AreaLight& light);

} // namespace wedge::render
