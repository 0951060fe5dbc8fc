#include "host/render/quadrature.h"

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

} // namespace wedge::render
