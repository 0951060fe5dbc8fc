// Statistics for tests of random numbers.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace wedge::test {

/// Upper incomplete gamma function over the gamma function, Q(a, x), for a > 0, x >= 0: its series or its continued
/// fraction (Lentz's method), whichever converges.
inline double upperGamma(double a, double x)
{
    if (x <= 0)
        return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > 1e-16 * sum; n += 1)
            sum += term *= x / n;
        return 1 - front * sum;
    }
    double b = x + 1 - a, d = 1 / b, c = 1e300, fraction = d;
    for (int i = 1; i < 10000; ++i) {
        const double numerator = -i * (i - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (std::fabs(c * d - 1) < 1e-15)
            break;
    }
    return front * fraction;
}

/// Probability that counts as far from the expected ones as `observed`, or farther, come by chance (Pearson's test).
/// Neighbouring cells are merged until each expects at least 10; counts where none are expected give 0.
inline double chiSquareP(const std::vector<double>& observed, const std::vector<double>& expected)
{
    std::vector<double> seen(1), wanted(1);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] <= 0 && observed[i] > 0)
            return 0;
        if (wanted.back() >= 10) {
            seen.push_back(0);
            wanted.push_back(0);
        }
        seen.back() += observed[i];
        wanted.back() += expected[i];
    }
    double statistic = 0, cells = 0, seenLast = 0, wantedLast = 0;
    for (std::size_t i = wanted.size(); i-- > 0;) {
        seenLast += seen[i];
        wantedLast += wanted[i];
        if (wantedLast >= 10) {
            statistic += (seenLast - wantedLast) * (seenLast - wantedLast) / wantedLast;
            cells += 1;
            seenLast = wantedLast = 0;
        }
    }
    return cells > 1 ? upperGamma(0.5 * (cells - 1), 0.5 * statistic) : 1;
}

} // namespace wedge::test
