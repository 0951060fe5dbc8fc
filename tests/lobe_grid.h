// Polar coordinates for tests of densities of directions.
#pragma once

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace wedge::test {

/// Unit vector at that angle from z.
inline shared::Vec3 polar(double theta, double phi = 0)
{
    return shared::vec3(static_cast<float>(std::sin(theta) * std::cos(phi)),
        static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta)));
}

/// Polar coordinates about a direction with rings at pi (3 t^2 - 2 t^3): fine where a lobe about it is high, with an
/// edge where it may end, at 90 degrees.
struct LobeGrid {
    explicit LobeGrid(shared::Vec3 about)
        : axis(about)
    {
        shared::tangentFrame(axis, &s, &t);
    }
    static double ringAngle(double at) { return std::numbers::pi * at * at * (3 - 2 * at); }
    static double ringAt(double angle)
    {
        return 0.5 - std::sin(std::asin(std::clamp(1 - 2 * angle / std::numbers::pi, -1.0, 1.0)) / 3);
    }

    /// Of f over the cell between those coordinates in [0,1]^2: halved both ways once, and then until that changes no
    /// more than `tolerance`.
    template <class Function>
    double integral(double ring0, double ring1, double sector0, double sector1, double tolerance, const Function& f,
        int depth = mostHalvings) const
    {
        const double ring = (ring0 + ring1) / 2, sector = (sector0 + sector1) / 2;
        const double whole = midpoints(ring0, ring1, sector0, sector1, f);
        const double parts = midpoints(ring0, ring, sector0, sector, f) + midpoints(ring, ring1, sector0, sector, f)
            + midpoints(ring0, ring, sector, sector1, f) + midpoints(ring, ring1, sector, sector1, f);
        if (depth == 0 || (depth < mostHalvings && std::fabs(whole - parts) < tolerance))
            return parts;
        return integral(ring0, ring, sector0, sector, tolerance / 2, f, depth - 1)
            + integral(ring, ring1, sector0, sector, tolerance / 2, f, depth - 1)
            + integral(ring0, ring, sector, sector1, tolerance / 2, f, depth - 1)
            + integral(ring, ring1, sector, sector1, tolerance / 2, f, depth - 1);
    }
    /// The same by steps x steps midpoints.
    template <class Function>
    double midpoints(double ring0, double ring1, double sector0, double sector1, const Function& f, int steps = 8) const
    {
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double a = ringAngle(ring0 + (ring1 - ring0) * i / steps);
            const double b = ringAngle(ring0 + (ring1 - ring0) * (i + 1) / steps);
            const double area = (std::cos(a) - std::cos(b)) * 2 * std::numbers::pi * (sector1 - sector0) / steps;
            for (int k = 0; k < steps; ++k)
                sum += area
                    * f(direction(
                        (a + b) / 2, 2 * std::numbers::pi * (sector0 + (sector1 - sector0) * (k + 0.5) / steps)));
        }
        return sum;
    }
    template <class Function>
    double overSphere(const Function& f) const
    {
        double sum = 0;
        for (int ring = 0; ring < rings; ++ring)
            for (int sector = 0; sector < sectors; ++sector)
                sum += cell(ring, sector, f);
        return sum;
    }
    template <class Function>
    double cell(int ring, int sector, const Function& f) const
    {
        return integral(static_cast<double>(ring) / rings, (ring + 1.0) / rings, static_cast<double>(sector) / sectors,
            (sector + 1.0) / sectors, 1e-6, f);
    }

    shared::Vec3 direction(double theta, double phi) const
    {
        const shared::Vec3 d = polar(theta, phi);
        return shared::vecMad(shared::vecMad(shared::vecScale(s, d.x), t, d.y), axis, d.z);
    }
    /// Number of the cell that a direction is in.
    std::size_t cellOf(shared::Vec3 d) const
    {
        const double theta = std::atan2(shared::vecLength(shared::vecCross(axis, d)), shared::vecDot(axis, d));
        const double phi = std::atan2(shared::vecDot(t, d), shared::vecDot(s, d));
        const int ring = std::min(rings - 1, static_cast<int>(ringAt(theta) * rings));
        const int sector =
            static_cast<int>((phi < 0 ? phi + 2 * std::numbers::pi : phi) / (2 * std::numbers::pi) * sectors);
        return static_cast<std::size_t>(ring * sectors + std::min(sectors - 1, sector));
    }

    static constexpr int rings = 24, sectors = 12, mostHalvings = 7;
    shared::Vec3 axis {}, s {}, t {};
};

} // namespace wedge::test
