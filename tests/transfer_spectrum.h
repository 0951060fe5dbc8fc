// Power spectra of the transfer functions of thesis chapter 4, for tests of their bandlimits.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

namespace wedge::test {

/// In place, of a length that is a power of 2: sum over k of a[k] exp(-2 pi i j k / n).
inline void fourier(std::vector<std::complex<double>>& a)
{
    const std::size_t n = a.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n / 2;
        for (; (j & bit) != 0; bit /= 2)
            j ^= bit;
        j ^= bit;
        if (i < j)
            std::swap(a[i], a[j]);
    }
    for (std::size_t half = 1; half < n; half *= 2) {
        const std::complex<double> step = std::polar(1.0, -std::numbers::pi / static_cast<double>(half));
        for (std::size_t start = 0; start < n; start += 2 * half) {
            std::complex<double> turn = 1;
            for (std::size_t i = start; i < start + half; ++i, turn *= step) {
                const std::complex<double> odd = turn * a[i + half];
                a[i + half] = a[i] - odd;
                a[i] += odd;
            }
        }
    }
}

/// How much of some energy lies below each frequency, and the other way round. Energies are of bins of width `step`
/// about 0, step, 2 step...
class Cumulative {
public:
    Cumulative(std::vector<double> energies, double binWidth)
        : below_(std::move(energies))
        , step_(binWidth)
    {
        std::partial_sum(below_.begin(), below_.end(), below_.begin());
    }
    /// Part of the energy at frequencies up to that one.
    double held(double frequency) const
    {
        const double at = std::clamp(frequency / step_ - 0.5, 0.0, static_cast<double>(below_.size() - 1));
        const std::size_t bin = std::min(static_cast<std::size_t>(at), below_.size() - 2);
        const double between = at - static_cast<double>(bin);
        return (below_[bin] * (1 - between) + below_[bin + 1] * between) / below_.back();
    }
    /// Frequency below which that part of the energy lies.
    double limit(double part) const
    {
        const auto after = std::ranges::lower_bound(below_, part * below_.back());
        const auto bin = static_cast<std::size_t>(after - below_.begin());
        const double before = bin > 0 ? below_[bin - 1] : 0;
        return step_ * (static_cast<double>(bin) - 0.5 + (part * below_.back() - before) / (below_[bin] - before));
    }

private:
    std::vector<double> below_;
    double step_;
};

/// What "the band up to Omega" may mean in the plane of Omega_1 and Omega_2.
struct PlaneSpectrum {
    Cumulative first, second; ///< strips: one of them up to Omega, the other at will
    Cumulative box; ///< both
    Cumulative disc; ///< the length of (Omega_1, Omega_2)
};

/// Energies of function(v1, v2), sampled over [-extent, extent)^2 by n x n points.
template <class Function>
PlaneSpectrum planeSpectrum(const Function& function, double extent = 16, std::size_t n = 512)
{
    std::vector<std::vector<std::complex<double>>> rows(n, std::vector<std::complex<double>>(n));
    for (std::size_t j = 0; j < n; ++j) {
        const double v2 = 2 * extent * static_cast<double>(j) / static_cast<double>(n) - extent;
        for (std::size_t i = 0; i < n; ++i)
            rows[j][i] = function(2 * extent * static_cast<double>(i) / static_cast<double>(n) - extent, v2);
        fourier(rows[j]);
    }
    std::vector<double> first(n / 2), second(n / 2), box(n / 2), disc(n);
    std::vector<std::complex<double>> column(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
            column[j] = rows[j][i];
        fourier(column);
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t a = std::min(i, n - i), b = std::min(j, n - j);
            if (a == n / 2 || b == n / 2)
                continue;
            const double energy = std::norm(column[j]);
            first[a] += energy;
            second[b] += energy;
            box[std::max(a, b)] += energy;
            disc[static_cast<std::size_t>(std::lround(std::hypot(a, b)))] += energy;
        }
    }
    const double step = std::numbers::pi / extent;
    return { { first, step }, { second, step }, { box, step }, { disc, step } };
}

} // namespace wedge::test
