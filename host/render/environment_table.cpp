#include "host/render/environment_table.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

namespace wedge::render {
namespace {

/// Directions are chosen by at least this part of their brightness.
constexpr double leastPart = 0.1;
/// What hides directions that are darker than this part of the mean does not narrow filters (thesis, section 6.5.2).
constexpr double darkPart = 0.1;

/// Luminance of each texel as the lookup shows it, which goes from one texel's middle to the next: the mean over the
/// texel's square.
class Luminances {
public:
    explicit Luminances(const EnvironmentPicture& p)
        : p_(p)
    {
    }
    double mean(int x, int y) const
    {
        const double above = row(x, std::max(y - 1, 0)), below = row(x, std::min(y + 1, p_.height - 1));
        return 0.125 * above + 0.75 * row(x, y) + 0.125 * below;
    }

private:
    double row(int x, int y) const
    {
        const int before = x > 0 ? x - 1 : p_.width - 1, after = x + 1 < p_.width ? x + 1 : 0;
        return 0.125 * at(before, y) + 0.75 * at(x, y) + 0.125 * at(after, y);
    }
    double at(int x, int y) const
    {
        const float* texel = p_.radiance.data()
            + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p_.width) + static_cast<std::size_t>(x));
        return shared::luminance(shared::vec3(texel[0], texel[1], texel[2]));
    }

    const EnvironmentPicture& p_;
};

/// Numbers in [0, 1) that choose among weights, and where the search for each of as many stripes of them begins. Where
/// all weights are 0, all are chosen alike.
void choices(std::span<const double> weights, std::span<float> upTo, std::span<float> guide)
{
    double total = 0;
    for (const double w : weights) {
        total += w;
    }
    const auto n = static_cast<double>(weights.size());
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += total > 0 ? weights[i] / total : 1.0 / n;
        upTo[i] = std::min(static_cast<float>(sum), 1.0f);
    }
    upTo.back() = 1.0f;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const float from = static_cast<float>(i) / static_cast<float>(weights.size());
        while (chosen + 1 < weights.size() && upTo[chosen] <= from) {
            ++chosen;
        }
        guide[i] = shared::as_float(static_cast<std::uint32_t>(chosen));
    }
}

using Harmonics = std::array<double, WEDGE_HARMONICS>;

/// Real harmonics of a unit direction, without their constants.
Harmonics harmonicsAt(glm::dvec3 d)
{
    const double x = d.x, y = d.y, z = d.z;
    return { 1.0, x, y, z, x * y, y * z, z * x, 3.0 * z * z - 1.0, x * x - y * y };
}

/// Places along each axis at which a picture is looked at: few texels in several each.
struct ProjectedGrid {
    int across, down;
};

ProjectedGrid projectedGrid(const EnvironmentPicture& picture)
{
    const auto times = [](int texels, int least) { return texels > 0 ? std::max(1, least / texels) : 1; };
    return { picture.width * times(picture.width, 64), picture.height * times(picture.height, 32) };
}

/// Of each channel the integral of its radiance times harmonicsAt(), over projectedSolidAngle().
std::array<Harmonics, 3> projected(const EnvironmentPicture& picture)
{
    const auto [across, down] = projectedGrid(picture);
    std::vector<glm::dvec3> horizon(
        static_cast<std::size_t>(across)); // directions of columns, at a right angle to `up`
    for (std::size_t x = 0; x < horizon.size(); ++x) {
        const double angle = 2.0 * std::acos(-1.0) * ((static_cast<double>(x) + 0.5) / across - 0.5);
        horizon[x] = std::sin(angle) * glm::dvec3(picture.right) - std::cos(angle) * glm::dvec3(picture.back);
    }
    std::array<Harmonics, 3> sums {};
    for (int y = 0; y < down; ++y) {
        const double polar = std::acos(-1.0) * (y + 0.5) / down, sine = std::sin(polar);
        const glm::dvec3 upwards = std::cos(polar) * glm::dvec3(picture.up);
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.height)
            / static_cast<std::size_t>(down) * static_cast<std::size_t>(picture.width);
        for (std::size_t x = 0; x < horizon.size(); ++x) {
            const std::size_t texel = row + x * static_cast<std::size_t>(picture.width) / horizon.size();
            const Harmonics at = harmonicsAt(upwards + sine * horizon[x]);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double radiance = sine * double { picture.radiance[3 * texel + channel] };
                for (std::size_t i = 0; i < at.size(); ++i) {
                    sums[channel][i] += radiance * at[i];
                }
            }
        }
    }
    return sums;
}

/// Steradians that each of the places stands for that projected() adds up, over the sine of its angle from `up`.
double projectedSolidAngle(const EnvironmentPicture& picture)
{
    const ProjectedGrid grid = projectedGrid(picture);
    return 2.0 * std::acos(-1.0) / grid.across * std::acos(-1.0) / grid.down;
}

/// Numbers that are looked up by a normal, and the largest sum that they were divided by.
struct UnshadowedHarmonics {
    std::array<float, WEDGE_HARMONICS> numbers;
    double most;
};

/// Irradiance of surfaces of each normal n is the sum of these numbers times harmonicsAt(n), over the largest that any
/// has (Ramamoorthi and Hanrahan, 2001: what a clamped cosine leaves of each order is pi, 2 pi / 3 and pi / 4).
/// Without light: 1. sums: projected(), of a channel
UnshadowedHarmonics unshadowedHarmonics(Harmonics sums)
{
    // Squared constants of the harmonics times what the cosine leaves, over those of the first.
    constexpr Harmonics factors { 1.0, 2.0, 2.0, 2.0, 3.75, 3.75, 3.75, 0.3125, 0.9375 };
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] *= factors[i];
    }
    // They are smooth: directions along a spiral over the sphere find the largest.
    constexpr int directions = 1024;
    double most = 0;
    for (int i = 0; i < directions; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / directions, r = std::sqrt(1.0 - z * z), turn = 2.399963229728653 * i;
        const Harmonics at = harmonicsAt({ r * std::cos(turn), r * std::sin(turn), z });
        most = std::max(most, std::inner_product(at.begin(), at.end(), sums.begin(), 0.0));
    }
    UnshadowedHarmonics out { { 1.0f }, most };
    for (std::size_t i = 0; most > 0 && i < out.numbers.size(); ++i) {
        out.numbers[i] = static_cast<float>(sums[i] / most);
    }
    return out;
}

/// R, G, B of means over the texels of a picture of `columns` columns and half as many rows, by area on the sphere.
void average(const EnvironmentPicture& p, int columns, std::span<float> out)
{
    const int rows = columns / 2;
    // As many points in each texel as meet all of the picture's.
    const int across = (p.width + columns - 1) / columns, down = (p.height + rows - 1) / rows;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            glm::dvec3 sum(0.0);
            double area = 0;
            for (int j = 0; j < down; ++j) {
                const double v = (y + (j + 0.5) / down) / rows, sine = std::sin(std::acos(-1.0) * v);
                const auto row = static_cast<std::size_t>(v * p.height) * static_cast<std::size_t>(p.width);
                for (int i = 0; i < across; ++i) {
                    const double u = (x + (i + 0.5) / across) / columns;
                    const float* texel = p.radiance.data() + 3 * (row + static_cast<std::size_t>(u * p.width));
                    sum += sine * glm::dvec3(texel[0], texel[1], texel[2]);
                    area += sine;
                }
            }
            const std::size_t at =
                3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                out[at + channel] = static_cast<float>(sum[static_cast<int>(channel)] / area);
            }
        }
    }
}

/// The same of half as many columns and rows.
void halve(std::span<const float> finer, int columns, std::span<float> out)
{
    const auto width = static_cast<std::size_t>(columns), rows = width / 2;
    const auto weight = [&](std::size_t row) {
        return std::sin(std::acos(-1.0) * (static_cast<double>(row) + 0.5) / static_cast<double>(rows));
    };
    for (std::size_t y = 0; y < rows / 2; ++y) {
        const double upper = weight(2 * y), lower = weight(2 * y + 1);
        for (std::size_t x = 0; x < width / 2; ++x) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const auto pair = [&](std::size_t row) {
                    const std::size_t at = 3 * (row * width + 2 * x) + channel;
                    return 0.5 * (double { finer[at] } + double { finer[at + 3] });
                };
                out[3 * (y * (width / 2) + x) + channel] =
                    static_cast<float>((upper * pair(2 * y) + lower * pair(2 * y + 1)) / (upper + lower));
            }
        }
    }
}

shared::Vec3 toVec3(glm::vec3 v) { return shared::vec3(v.x, v.y, v.z); }

/// Means over ever larger parts of the picture, one level after the other.
void averageLevels(const EnvironmentPicture& picture, std::span<float> averages)
{
    const auto levelOf = [&](std::uint32_t level) {
        const std::uint32_t from = shared::coarseLevelAt(level);
        return averages.subspan(from, shared::coarseLevelAt(level + 1) - from);
    };
    const std::uint32_t levels = shared::coarseLevels(static_cast<std::uint32_t>(picture.width));
    average(picture, static_cast<int>(WEDGE_COARSE_COLUMNS << (levels - 1)), levelOf(levels - 1));
    for (std::uint32_t level = levels - 1; level > 0; --level) {
        halve(levelOf(level), static_cast<int>(WEDGE_COARSE_COLUMNS << level), levelOf(level - 1));
    }
}

} // namespace

EnvironmentTable environmentTable(const EnvironmentPicture* picture)
{
    EnvironmentTable out;
    if (picture == nullptr) {
        return out;
    }
    const auto w = static_cast<std::size_t>(picture->width), h = static_cast<std::size_t>(picture->height);
    assert(picture->radiance.size() == 3 * w * h);
    out.map.width = static_cast<std::uint32_t>(w);
    out.map.height = static_cast<std::uint32_t>(h);
    out.map.right = toVec3(picture->right);
    out.map.up = toVec3(picture->up);
    out.map.back = toVec3(picture->back);
    out.map.seen = picture->seen ? 1 : 0;
    out.numbers.resize(shared::environmentTableSize(out.map.width, out.map.height));
    const std::span<float> all(out.numbers);
    std::ranges::copy(picture->radiance, all.begin());
    const std::span<float> rows = all.subspan(3 * w * h, h), columns = all.subspan(3 * w * h + h, w * h),
                           rowGuide = all.subspan(4 * w * h + h, h),
                           columnGuide = all.subspan(4 * w * h + 2 * h, w * h),
                           cosines = all.subspan(5 * w * h + 2 * h, h + 1);
    for (std::size_t y = 0; y <= h; ++y) {
        cosines[y] = static_cast<float>(std::cos(std::acos(-1.0) * static_cast<double>(y) / static_cast<double>(h)));
    }
    const Luminances luminances(*picture);
    const auto solidAngle = [&](std::size_t y) {
        return 2.0 * std::acos(-1.0) / static_cast<double>(w) * (double { cosines[y] } - double { cosines[y + 1] });
    };
    for (std::size_t y = 0; y < h; ++y) {
        for (std::size_t x = 0; x < w; ++x) {
            out.irradiance += solidAngle(y) * luminances.mean(static_cast<int>(x), static_cast<int>(y));
        }
    }
    const double mean = out.irradiance / (4.0 * std::acos(-1.0));
    out.map.dark = static_cast<float>(darkPart * mean);
    std::vector<double> ofRows(h), ofColumns(w);
    for (std::size_t y = 0; y < h; ++y) {
        for (std::size_t x = 0; x < w; ++x) {
            const double l = luminances.mean(static_cast<int>(x), static_cast<int>(y));
            ofColumns[x] = std::max(l - mean, leastPart * l);
            ofRows[y] += solidAngle(y) * ofColumns[x];
        }
        choices(ofColumns, columns.subspan(y * w, w), columnGuide.subspan(y * w, w));
    }
    choices(ofRows, rows, rowGuide);
    const std::array<Harmonics, 3> sums = projected(*picture);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const std::span<float> to = all.subspan(
            shared::environmentHarmonics(out.map.width, out.map.height) + WEDGE_HARMONICS * channel, WEDGE_HARMONICS);
        const UnshadowedHarmonics harmonics = unshadowedHarmonics(sums[channel]);
        std::ranges::copy(harmonics.numbers, to.begin());
        // The first of them is a constant, whose square is 1 / (4 pi), times what the cosine leaves, pi.
        out.mostIrradiance[static_cast<int>(channel)] = 0.25 * projectedSolidAngle(*picture) * harmonics.most;
    }
    averageLevels(*picture, all.subspan(shared::environmentAverages(out.map.width, out.map.height)));
    if (!picture->shown.empty()) { // no span is used from here on
        out.map.shown = static_cast<std::uint32_t>(out.numbers.size());
        out.numbers.insert(out.numbers.end(), picture->shown.begin(), picture->shown.end());
        out.numbers.push_back(0.0f); // behind the last texel
    }
    return out;
}

} // namespace wedge::render
