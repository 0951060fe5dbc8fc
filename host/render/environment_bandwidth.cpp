#include "host/render/environment_bandwidth.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include <kiss_fftnd.h>

namespace wedge::render {
namespace {

constexpr std::size_t mostColumns = 2048, mostRows = 1024;
constexpr double part = 0.99;

/// The largest number that is at most n and has no prime factors but 2, 3 and 5.
std::size_t fastSize(std::size_t n)
{
    const auto isFast = [](std::size_t m) {
        for (const std::size_t prime : { 2, 3, 5 }) {
            while (m % prime == 0) {
                m /= prime;
            }
        }
        return m == 1;
    };
    while (!isFast(n)) {
        --n;
    }
    return n;
}

/// Numbers of a grid, rows one after the other.
struct Grid {
    std::size_t columns, rows;
    std::vector<double> values;
};

/// Averaged onto `columns` columns, at most as many as there are, and turned over: its rows become columns.
Grid averagedAndTurned(const Grid& from, std::size_t columns)
{
    Grid out { from.rows, columns, std::vector<double>(from.rows * columns) };
    const double across = static_cast<double>(from.columns) / static_cast<double>(columns);
    for (std::size_t column = 0; column < columns; ++column) {
        const double begin = across * static_cast<double>(column), end = begin + across;
        const auto first = static_cast<std::size_t>(begin);
        for (std::size_t i = first; i < from.columns && static_cast<double>(i) < end; ++i) {
            const double share =
                (std::min(end, static_cast<double>(i + 1)) - std::max(begin, static_cast<double>(i))) / across;
            for (std::size_t row = 0; row < from.rows; ++row) {
                out.values[column * from.rows + row] += share * from.values[row * from.columns + i];
            }
        }
    }
    return out;
}

Grid luminanceOf(const EnvironmentPicture& picture)
{
    Grid out { static_cast<std::size_t>(picture.width), static_cast<std::size_t>(picture.height), {} };
    out.values.reserve(out.columns * out.rows);
    for (std::size_t i = 0; i < 3 * out.columns * out.rows; i += 3) {
        out.values.push_back(
            shared::luminance(shared::vec3(picture.radiance[i], picture.radiance[i + 1], picture.radiance[i + 2])));
    }
    return out;
}

/// Of a sequence of n numbers, how often the wave of the element i of its transform goes up and down.
std::size_t frequencyOf(std::size_t i, std::size_t n) { return std::min(i, n - i); }

} // namespace

float environmentBandwidth(const EnvironmentPicture& picture)
{
    Grid grid = luminanceOf(picture);
    grid = averagedAndTurned(grid, fastSize(std::min(grid.columns, mostColumns)));
    grid = averagedAndTurned(grid, fastSize(std::min(grid.columns, mostRows)));
    // Energies are squares of what may be of any magnitude, in floats.
    const double largest = *std::ranges::max_element(grid.values);
    std::vector<kiss_fft_cpx> values(grid.values.size()), spectrum(grid.values.size());
    for (std::size_t i = 0; largest > 0 && i < values.size(); ++i) {
        values[i].r = static_cast<float>(grid.values[i] / largest);
    }
    const int sizes[] = { static_cast<int>(grid.rows), static_cast<int>(grid.columns) };
    const std::unique_ptr<kiss_fftnd_state, void (*)(void*)> transform(
        kiss_fftnd_alloc(sizes, 2, 0, nullptr, nullptr), kiss_fft_free);
    if (transform == nullptr) {
        throw std::bad_alloc();
    }
    kiss_fftnd(transform.get(), values.data(), spectrum.data());
    std::vector<double> energies; // by radius, rounded up
    double total = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const kiss_fft_cpx& s = spectrum[row * grid.columns + column];
            const double energy = static_cast<double>(s.r) * s.r + static_cast<double>(s.i) * s.i;
            const auto x = static_cast<double>(frequencyOf(column, grid.columns)),
                       y = 2.0 * static_cast<double>(frequencyOf(row, grid.rows));
            const auto radius = static_cast<std::size_t>(std::ceil(std::sqrt(x * x + y * y)));
            energies.resize(std::max(energies.size(), radius + 1));
            energies[radius] += energy;
            total += energy;
        }
    }
    double within = 0;
    std::size_t radius = 0;
    for (; radius + 1 < energies.size(); ++radius) {
        within += energies[radius];
        if (within >= part * total) {
            break;
        }
    }
    return static_cast<float>(radius);
}

EnvironmentBandwidth::EnvironmentBandwidth(std::shared_ptr<const EnvironmentPicture> picture)
    : picture_(std::move(picture))
{
}

float EnvironmentBandwidth::value() const
{
    if (!value_) {
        value_ = picture_ != nullptr ? environmentBandwidth(*picture_) : 0.0f;
    }
    return *value_;
}

} // namespace wedge::render
