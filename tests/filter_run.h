// The filter's passes on a device, and their comparison with the gather in double.
#pragma once

#include "tests/filter_oracle.h"

#include <string>

namespace wedge::test {

/// The passes of filter.cl, compiled with these defines, on one device.
class FilterRun {
public:
    explicit FilterRun(const device::Device& device, const Defines& defines = { { "WEDGE_GATHER_CHANNELS", "1" } })
        : bench_(device, defines)
    {
    }

    /// Both passes over the pixels of `window`, or all; only the first if rowsOnly.
    FilterResult operator()(const FilterImage& image, bool rowsOnly = false, image::Window window = {})
    {
        shared::FilterParams p = image.params;
        if (window.width() > 0) {
            p.x0 = static_cast<std::uint32_t>(window.x0);
            p.x1 = static_cast<std::uint32_t>(window.x1);
        }
        const auto value = bench_.buffer(image.value.values);
        const auto beta = bench_.buffer(image.beta.values),
                   betaOfColumns = bench_.buffer(image.widthsAlong(false).values);
        const auto position = bench_.buffer(image.position.values);
        const auto normal = bench_.buffer(image.normal.values);
        const auto pixelSize = bench_.buffer(image.pixelSize.values);
        const auto objectId = bench_.buffer(image.objectId.values);
        const auto rows = bench_.filled(image.value.values.size(), -7.0f);
        const auto rowsEffective = bench_.filled(image.value.layout.size, -7.0f);
        const auto gradients = bench_.buffer(image.gradients ? inShorts(*image.gradients) : std::vector<float>(1));
        const auto slopeWidth = bench_.buffer(inShorts(image.slopeWidth));
        const auto rowGradients = bench_.filled(gradients.size(), -7.0f);
        if (image.gradients)
            launch("shearRows", p, value, beta, position, normal, pixelSize, objectId, gradients, slopeWidth, rows,
                rowsEffective, rowGradients);
        else
            launch("filterRows", p, value, beta, position, normal, pixelSize, objectId, rows, rowsEffective);
        if (rowsOnly)
            return result(image, rows, rowsEffective);
        if (window.width() > 0) {
            p.y0 = static_cast<std::uint32_t>(window.y0);
            p.y1 = static_cast<std::uint32_t>(window.y1);
        }
        const auto out = bench_.filled(image.value.values.size(), -7.0f);
        const auto effective = bench_.filled(image.value.layout.size, -7.0f);
        if (image.gradients)
            launch("shearColumns", p, rows, beta, position, normal, pixelSize, objectId, rowGradients, slopeWidth,
                rowsEffective, out, effective);
        else
            launch("filterColumns", p, rows, betaOfColumns, position, normal, pixelSize, objectId, rowsEffective, out,
                effective);
        // Filtering in place would race: what was filtered is still there.
        const std::vector<float> after = bench_.read(value);
        CHECK(std::memcmp(after.data(), image.value.values.data(), after.size() * sizeof(float)) == 0);
        return result(image, out, effective);
    }

    /// What the program of counts alone makes of it.
    Planes<float> counts(const FilterImage& image)
    {
        const auto effective = bench_.filled(image.value.layout.size, -7.0f);
        bench_.passes.rows("counts", device::PassKind::Analysis, "filter/filter_counts.cl", "gatherCounts",
            image.params, WEDGE_BLOCK_PIXELS, bench_.buffer(image.beta.values), bench_.buffer(image.position.values),
            bench_.buffer(image.normal.values), bench_.buffer(image.pixelSize.values),
            bench_.buffer(image.objectId.values), effective);
        return planesOf(image.value.layout, bench_.read(effective));
    }

private:
    template <class... Args>
    void launch(const std::string& kernel, const shared::FilterParams& p, const Args&... args)
    {
        bench_.passes.rows(
            "filter", device::PassKind::Filter, "filter/filter.cl", kernel, p, WEDGE_BLOCK_PIXELS, args...);
    }
    FilterResult result(
        const FilterImage& image, const device::Buffer<float>& value, const device::Buffer<float>& effective)
    {
        return { planesOf(image.value.layout, bench_.read(value)),
            planesOf(image.value.layout, bench_.read(effective)) };
    }

    KernelBench bench_;
};

/// Compares with the oracle wherever no test of it hangs on a rounding. Returns the fraction of pixels left out.
inline double compare(
    const FilterImage& image, const FilterResult& found, const OracleResult& expected, int channels = 1)
{
    const int width = image.width(), height = image.height();
    int uncertain = 0, wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (expected.uncertain(x, y)) {
                ++uncertain;
                continue;
            }
            for (int c = 0; c < channels; ++c) {
                const double want = expected.value(x, y, c), got = found.value.at(x, y, static_cast<std::size_t>(c));
                if (!(std::fabs(got - want) <= 2e-4) && ++wrong <= 3)
                    CHECK_MESSAGE(false,
                        "pixel " << x << "," << y << " of channel " << c << ": " << got << " instead of " << want);
            }
            const double want = expected.effective(x, y), got = found.effective.at(x, y);
            if (!(std::fabs(got - want) <= 2e-3 * want) && ++wrong <= 3)
                CHECK_MESSAGE(false, "effective count at " << x << "," << y << ": " << got << " instead of " << want);
        }
    CHECK(wrong == 0);
    return static_cast<double>(uncertain) / (width * height);
}

} // namespace wedge::test
