#include "host/render/quadrature.h"

#include "kernels/shared/light.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace wedge::render {
namespace {

/// Legendre polynomial of degree n and its derivative at x, by the three-term recurrence.
std::pair<double, double> legendre(int n, double x)
{
    double previous = 1.0;
    double current = x;
    for (int k = 2; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k;
        previous = current;
        current = next;
    }
    return { current, n * (x * current - previous) / (x * x - 1.0) };
}

} // namespace

std::vector<Node> gaussLegendre(int count)
{
    assert(count >= 1);
    std::vector<Node> nodes(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // Newton's method from Tricomi's estimate; converges in a handful of steps.
        double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 100; ++step) {
            const auto [value, derivative] = legendre(count, x);
            slope = derivative;
            const double change = value / derivative;
            x -= change;
            if (std::fabs(change) < 1e-15) {
                break;
            }
        }
        slope = legendre(count, x).second;
        nodes[static_cast<std::size_t>(i)] = { x, 2.0 / ((1.0 - x * x) * slope * slope) };
    }
    return nodes;
}

std::vector<Node> profileRule(scene::LightProfile profile, double cut, int count)
{
    std::vector<Node> nodes = gaussLegendre(count);
    double total = 0.0;
    for (Node& node : nodes) {
        if (profile == scene::LightProfile::Gaussian) {
            node.weight *= std::exp(-0.5 * cut * cut * node.position * node.position);
        }
        total += node.weight;
    }
    for (Node& node : nodes) {
        node.weight /= total;
    }
    return nodes;
}

std::vector<Node> threeNodeRule(scene::LightProfile profile, double cut)
{
    // Nodes 0 and +-x: the second and fourth moments fix x and its weight.
    double second = 0.0, fourth = 0.0;
    for (const Node& node : profileRule(profile, cut, 32)) {
        const double squared = node.position * node.position;
        second += node.weight * squared;
        fourth += node.weight * squared * squared;
    }
    const double x = std::sqrt(fourth / second), weight = 0.5 * second * second / fourth;
    return { { -x, weight }, { 0.0, 1.0 - 2.0 * weight }, { x, weight } };
}

std::vector<float> lightNodes(const scene::AreaLight& light)
{
    std::vector<float> out;
    for (const std::vector<Node>& rule : { profileRule(light.profile, light.cut, WEDGE_COARSE_NODES),
             profileRule(light.profile, light.cut, WEDGE_FINE_NODES), threeNodeRule(light.profile, light.cut),
             gaussLegendre(WEDGE_FITTED_NODES), gaussLegendre(WEDGE_CLIPPED_NODES) }) {
        for (const Node& node : rule) {
            out.push_back(static_cast<float>(node.position));
            out.push_back(static_cast<float>(node.weight));
        }
    }
    return out;
}

} // namespace wedge::render
