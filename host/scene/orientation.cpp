#include "host/scene/orientation.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host/scene/single_precision.h"

namespace wedge::scene {
namespace {

int signOf(double value) { return (value > 0.0) - (value < 0.0); }

/// The sign of an exact sum: an expansion of terms that do not overlap grows by one summand at a time (Shewchuk,
/// Adaptive Precision Floating-Point Arithmetic, 1997), and its largest term has the sign of all.
template <std::size_t n>
int signOfSum(const std::array<double, n>& summands)
{
    std::array<double, n> expansion {};
    for (std::size_t i = 0; i < n; ++i) {
        double carried = summands[i];
        for (std::size_t k = 0; k < i; ++k) {
            const double sum = carried + expansion[k];
            const double virtualPart = sum - carried;
            expansion[k] = (carried - (sum - virtualPart)) + (expansion[k] - virtualPart);
            carried = sum;
        }
        expansion[i] = carried;
    }
    int sign = 0;
    for (const double term : expansion)
        sign = term == 0.0 ? sign : signOf(term);
    return sign;
}

/// Whether the difference of two points is exact and of so few bits that a product with another such one is exact too.
bool isShort(const glm::dvec2& difference, const glm::dvec2& from, const glm::dvec2& to)
{
    constexpr double most = std::numeric_limits<float>::max();
    if (!(std::abs(difference.x) <= most && std::abs(difference.y) <= most))
        return false;
    return inSingle(difference) == difference && from + difference == to && to - difference == from;
}

} // namespace

int exactOrientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    const glm::dvec2 ab = b - a, ac = c - a;
    if (isShort(ab, a, b) && isShort(ac, a, c))
        return signOf(ab.x * ac.y - ab.y * ac.x);
    const double factors[][2] = { { b.x, c.y }, { -b.y, c.x }, { a.y, c.x }, { -a.x, c.y }, { a.x, b.y },
        { -a.y, b.x } };
    std::array<double, 12> summands {};
    for (std::size_t i = 0; i < 6; ++i) {
        const double product = factors[i][0] * factors[i][1];
        summands[2 * i] = std::fma(factors[i][0], factors[i][1], -product); // what rounding took, exactly
        summands[2 * i + 1] = product;
    }
    return signOfSum(summands);
}

bool onOneLine(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    for (int axis = 0; axis < 3; ++axis) {
        const auto flat = [axis](const glm::dvec3& p) { return glm::dvec2(p[axis], p[(axis + 1) % 3]); };
        if (orientation(flat(a), flat(b), flat(c)) != 0)
            return false;
    }
    return true;
}

} // namespace wedge::scene
