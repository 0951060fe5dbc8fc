#include "host/render/environment_table.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
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

shared::Vec3 toVec3(glm::vec3 v) { return shared::vec3(v.x, v.y, v.z); }

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
    if (!picture->shown.empty()) { // no span is used from here on
        out.map.shown = static_cast<std::uint32_t>(out.numbers.size());
        out.numbers.insert(out.numbers.end(), picture->shown.begin(), picture->shown.end());
    }
    return out;
}

} // namespace wedge::render
