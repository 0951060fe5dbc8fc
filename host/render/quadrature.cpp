#include "host/render/quadrature.h"

#include "kernels/shared/light.h"

#include <algorithm>
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

/// Orthonormal polynomials of an even weight function on [-1, 1] that integrates to 1, which is known by a rule of many
/// nodes (Stieltjes' procedure): x p_k = b_(k+1) p_(k+1) + b_k p_(k-1).
class Orthonormal {
public:
    explicit Orthonormal(const std::vector<Node>& weight)
        : before_(weight.size(), 0.0)
        , last_(weight.size(), 1.0)
    {
    }

    /// By the polynomial of one more degree.
    void extend(const std::vector<Node>& weight)
    {
        const double b = b_.empty() ? 0.0 : b_.back();
        double squared = 0.0;
        for (std::size_t i = 0; i < weight.size(); ++i) {
            const double next = weight[i].position * last_[i] - b * before_[i];
            before_[i] = last_[i];
            last_[i] = next;
            squared += weight[i].weight * next * next;
        }
        b_.push_back(std::sqrt(squared));
        for (double& value : last_) {
            value /= b_.back();
        }
    }

    /// The root of the last polynomial in an interval that has one.
    double rootBetween(double lo, double hi) const
    {
        const bool rises = valuesAt(hi).last > 0.0;
        for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (lo + hi);
            ((valuesAt(middle).last > 0.0) == rises ? hi : lo) = middle;
        }
        return 0.5 * (lo + hi);
    }

    /// Of the Gauss rule whose nodes are the last polynomial's roots, at one of these.
    double weightAt(double x) const { return 1.0 / valuesAt(x).squares; }

private:
    struct Values {
        double last; ///< the last polynomial
        double squares; ///< of those before it, their sum
    };
    Values valuesAt(double x) const
    {
        double before = 0.0, value = 1.0, squares = 0.0;
        for (std::size_t k = 0; k < b_.size(); ++k) {
            squares += value * value;
            const double next = (x * value - (k == 0 ? 0.0 : b_[k - 1]) * before) / b_[k];
            before = value;
            value = next;
        }
        return { value, squares };
    }

    std::vector<double> b_;
    std::vector<double> before_, last_; ///< polynomials at the nodes of the weight function
};

} // namespace

std::vector<Node> gaussLegendre(int count)
{
    assert(count >= 1);
    std::vector<Node> nodes(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // Newton's method from Tricomi's estimate; converges in a handful of steps.
        double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        for (int step = 0; step < 100; ++step) {
            const auto [value, derivative] = legendre(count, x);
            const double change = value / derivative;
            x -= change;
            if (std::fabs(change) < 1e-15) {
                break;
            }
        }
        const double slope = legendre(count, x).second;
        nodes[static_cast<std::size_t>(i)] = { x, 2.0 / ((1.0 - x * x) * slope * slope) };
    }
    return nodes;
}

std::vector<Node> profileRule(scene::LightProfile profile, double cut, int count)
{
    assert(count >= 1 && count <= 16);
    // Beyond nine standard deviations there is nothing.
    const bool gaussian = profile == scene::LightProfile::Gaussian;
    const double reach = gaussian ? std::min(1.0, 9.0 / cut) : 1.0;
    std::vector<Node> dense = gaussLegendre(64);
    double total = 0.0;
    for (Node& node : dense) {
        node.position *= reach;
        node.weight *= gaussian ? std::exp(-0.5 * cut * cut * node.position * node.position) : 1.0;
        total += node.weight;
    }
    for (Node& node : dense) {
        node.weight /= total;
    }
    // Roots of one polynomial lie between those of the one before and the ends.
    Orthonormal polynomials(dense);
    std::vector<double> roots;
    for (int degree = 1; degree <= count; ++degree) {
        polynomials.extend(dense);
        std::vector<double> next;
        for (std::size_t i = 0; i <= roots.size(); ++i) {
            next.push_back(
                polynomials.rootBetween(i == 0 ? -reach : roots[i - 1], i < roots.size() ? roots[i] : reach));
        }
        roots = next;
    }
    std::vector<Node> nodes;
    nodes.reserve(roots.size());
    for (const double x : roots) {
        nodes.push_back({ x, polynomials.weightAt(x) });
    }
    return nodes;
}

std::vector<float> lightNodes(const scene::AreaLight& light)
{
    std::vector<float> out;
    for (const std::vector<Node>& rule : { profileRule(light.profile, light.cut, WEDGE_COARSE_NODES),
             profileRule(light.profile, light.cut, WEDGE_FINE_NODES),
             profileRule(light.profile, light.cut, WEDGE_FEW_NODES), gaussLegendre(WEDGE_FITTED_NODES),
             gaussLegendre(WEDGE_CLIPPED_NODES), profileRule(light.profile, light.cut, WEDGE_MEDIUM_NODES) }) {
        for (const Node& node : rule) {
            out.push_back(static_cast<float>(node.position));
            out.push_back(static_cast<float>(node.weight));
        }
    }
    return out;
}

} // namespace wedge::render
