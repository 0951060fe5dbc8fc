// widening.cl alone: a plane filtered with two widths at once, against the gather in double with one after the
// other.
#include "tests/filter_oracle.h"
#include "tests/packed_support.h"

#include <bit>

using namespace wedge;
using namespace wedge::test;

namespace {

/// An image whose beta holds the pixels' own widths, and those to compare with: greater, or 0, or -1 where there is no
/// value.
struct Compared {
    FilterImage image;
    Planes<float> wide;

    Compared(Shape shape, unsigned seed)
        : image(randomImage(61, 29, shape, seed))
        , wide(image.value.layout, 1, -1.0f)
    {
        std::mt19937 random(seed);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const float own = image.beta.at(x, y) > 1 ? 0.3f : image.beta.at(x, y);
                image.beta.at(x, y) = own;
                if (own >= 0)
                    // A third of the image is compared nowhere, so that whole blocks are not.
                    wide.at(x, y) =
                        random() % 4 == 0 || x < 20 ? 0.0f : own + static_cast<float>(uniform(random, 0.05, 0.2));
            }
    }

    /// The same with one of both widths, as a gather alone has it.
    FilterImage with(bool narrow) const
    {
        FilterImage out = image;
        for (std::size_t i = 0; i < wide.values.size(); ++i)
            out.beta.values[i] = narrow && wide.values[i] > 0 ? image.beta.values[i] : wide.values[i];
        return out;
    }
};

struct Difference {
    Planes<float> difference, apart;
    Planes<float> rowCounts; ///< what is in the difference's place before
};

/// normals, sizes: of the image, as the program has them; window: the pixels to compare, all by default
Difference differenceOf(KernelBench& bench, const Compared& in, const Planes<float>& normals,
    const Planes<float>& sizes, const device::ProgramSource& program = "analysis/widening.cl",
    image::Window window = {})
{
    const FilterImage& image = in.image;
    const std::size_t size = image.value.layout.size;
    shared::FilterParams p = image.params;
    const auto run = [&](const char* kernel, const auto&... args) {
        bench.passes.rows("compare", device::PassKind::Filter, program, kernel, p, WEDGE_BLOCK_PIXELS, args...);
    };
    if (window.width() > 0) {
        const int reach = static_cast<int>(p.maxRadius);
        render::setRectangle(
            p, { window.x0, std::max(0, window.y0 - reach), window.x1, std::min(image.height(), window.y1 + reach) });
    }
    const auto value = bench.buffer(image.value.values), beta = bench.buffer(image.beta.values),
               wide = bench.buffer(in.wide.values), position = bench.buffer(image.position.values),
               normal = bench.buffer(normals.values), pixelSize = bench.buffer(sizes.values);
    const auto objectId = bench.buffer(image.objectId.values);
    const auto narrowRows = bench.filled(size, -7.0f), wideRows = bench.filled(size, -7.0f),
               difference = bench.filled(size, -7.0f), apart = bench.filled(size, -7.0f);
    run("compareRows", value, beta, wide, position, normal, pixelSize, objectId, narrowRows, wideRows, difference,
        apart);
    const std::vector<float> rowCounts = bench.read(difference);
    if (window.width() > 0)
        render::setRectangle(p, window);
    run("compareColumns", narrowRows, wideRows, beta, wide, position, normal, pixelSize, objectId, difference, apart);
    return { planesOf(image.value.layout, bench.read(difference)), planesOf(image.value.layout, bench.read(apart)),
        planesOf(image.value.layout, rowCounts) };
}

/// Compares with the oracle where no test of it hangs on a rounding.
void check(const Compared& in, const Difference& found)
{
    const FilterImage narrow = in.with(true), wide = in.with(false);
    const OracleResult n = oracleColumns(narrow, oracleRows(narrow)), w = oracleColumns(wide, oracleRows(wide));
    int certain = 0, apart = 0, wrong = 0;
    for (int y = 0; y < in.image.height(); ++y)
        for (int x = 0; x < in.image.width(); ++x) {
            if (n.uncertain(x, y) || w.uncertain(x, y) || in.wide.at(x, y) < 0)
                continue;
            const double k = n.effective(x, y), kWide = w.effective(x, y);
            const double expected = kWide > k ? 1 / k - 2 / (k + kWide) : 0;
            const double difference = n.value(x, y, 0) - w.value(x, y, 0);
            wrong += std::fabs(found.difference.at(x, y) - difference) <= 4e-4 ? 0 : 1;
            wrong += std::fabs(found.apart.at(x, y) - expected) <= 2e-3 ? 0 : 1;
            ++certain;
            apart += expected > 0.01 ? 1 : 0;
        }
    CHECK(wrong == 0);
    CHECK(certain > 500);
    CHECK(apart > 100);
}

} // namespace

TEST_CASE("two widths at once are what a gather with each makes, and what noise both have apart")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough }) {
            CAPTURE(static_cast<int>(shape));
            Compared in(shape, 40);
            in.image.params.fitted = 1;
            check(in, differenceOf(bench, in, in.image.normal, in.image.pixelSize));
            in.image = withoutLight(in.image);
            check(in, differenceOf(bench, in, in.image.normal, in.image.pixelSize));
        }
    });
}

TEST_CASE("two widths at once by the settings of a gather: the pixel's own width for each, all surfaces, means")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const bool narrower : { false, true })
            for (const bool surface : { false, true }) {
                CAPTURE(narrower);
                CAPTURE(surface);
                Compared in(Shape::Rough, 42);
                in.image.params.narrower = narrower ? 1 : 0;
                in.image.params.surface = surface ? 1 : 0;
                check(in, differenceOf(bench, in, in.image.normal, in.image.pixelSize));
            }
    });
}

TEST_CASE("what is no number where there is no value to take reaches no other pixel")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        Compared in(Shape::Steps, 43);
        int without = 0;
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x)
                if (in.wide.at(x, y) < 0) {
                    in.image.value.at(x, y) = std::nanf("");
                    ++without;
                }
        CHECK(without > 100);
        const Difference found = differenceOf(bench, in, in.image.normal, in.image.pixelSize);
        // The gather in double knows numbers alone, and takes none of these.
        for (float& v : in.image.value.values)
            v = std::isnan(v) ? 0.0f : v;
        check(in, found);
    });
}

TEST_CASE("two widths at once in a window are the whole image's, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const Compared in(Shape::Tilted, 44);
        const Difference whole = differenceOf(bench, in, in.image.normal, in.image.pixelSize);
        const image::Window window { 16, 7, 48, 19 };
        const Difference part =
            differenceOf(bench, in, in.image.normal, in.image.pixelSize, "analysis/widening.cl", window);
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x) {
                const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
                REQUIRE(part.difference.at(x, y) == (inside ? whole.difference.at(x, y) : part.rowCounts.at(x, y)));
                if (inside)
                    REQUIRE(part.apart.at(x, y) == whole.apart.at(x, y));
            }
    });
}

TEST_CASE("two widths at once with packed normals and sizes")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        Compared in(Shape::Tilted, 41);
        Planes<float> packed(in.image.value.layout, 1, 0.0f);
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x) {
                const std::uint32_t bits = shared::packNormal(toShared(in.image.normal.vector(x, y)));
                const shared::Vec3 rounded = shared::unpackNormal(bits);
                packed.at(x, y) = std::bit_cast<float>(bits);
                in.image.normal.setVector(x, y, { rounded.x, rounded.y, rounded.z });
                float& size = in.image.pixelSize.at(x, y);
                size = test::rounded(size);
            }
        const Planes<float> sizes = packedNumbers(in.image.pixelSize, in.image.pixelSize);
        check(in,
            differenceOf(bench, in, packed, sizes,
                { "analysis/widening.cl",
                    { { "WEDGE_NORMAL_FORMAT", "normal32" }, { "WEDGE_SIZE_FORMAT", "short1" } } }));
    });
}
