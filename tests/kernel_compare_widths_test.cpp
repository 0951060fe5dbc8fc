// widening.cl alone: a plane filtered with two widths at once, against the gather in double with one after the
// other.
#include "host/render/filters/widening.h"
#include "tests/filter_run.h"

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

/// window: the pixels to compare, all by default
Difference differenceOf(render::Renderer& renderer, const Compared& in, image::Window window = {}, bool lean = false)
{
    const FilterImage& image = in.image;
    FilterGraph declared(renderer, image, lean);
    auto beta = declared.there<render::Metres>("beta", graph::floats);
    render::widen(declared.builder, "compare", image.params, 8, render::pinholeNoise,
        { declared.there<render::Value>("value", graph::floats),
            declared.there<render::Deviation>("deviation", graph::floats),
            declared.there<render::Share>("weights", graph::floats) },
        beta);
    if (window.width() == 0)
        window = { 0, 0, image.width(), image.height() };
    const int reach = static_cast<int>(image.params.maxRadius);
    const auto run = [&](PassBench& pass, const image::Window& pixels) {
        shared::FilterParams p = image.params; // of another radius than the pass's own
        render::setRectangle(p, pixels);
        pass.value("p", p);
        pass.window(pixels);
        pass.plane("compared", in.wide);
        pass.run();
    };
    PassBench rows = passOf(renderer, declared, "compareRows", image);
    rows.plane("value", image.value);
    run(rows, { window.x0, std::max(0, window.y0 - reach), window.x1, std::min(image.height(), window.y1 + reach) });
    PassBench columns = passOf(renderer, declared, "compareColumns", image);
    columns.plane("narrowRows", rows.read<float>("narrowRows"));
    columns.plane("wideRows", rows.read<float>("wideRows"));
    columns.plane("difference", rows.read<float>("narrowCounts"));
    columns.plane("apart", rows.read<float>("wideCounts"));
    run(columns, window);
    return { columns.pixels<float>("difference"), columns.pixels<float>("apart"), rows.pixels<float>("narrowCounts") };
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
        render::Renderer renderer(smallScene(), device, renderOptions());
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough }) {
            CAPTURE(static_cast<int>(shape));
            Compared in(shape, 40);
            in.image.params.fitted = 1;
            check(in, differenceOf(renderer, in));
            in.image = withoutLight(in.image);
            check(in, differenceOf(renderer, in));
        }
    });
}

TEST_CASE("two widths at once by the settings of a gather: the pixel's own width for each, all surfaces, means")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        for (const bool narrower : { false, true })
            for (const bool surface : { false, true }) {
                CAPTURE(narrower);
                CAPTURE(surface);
                Compared in(Shape::Rough, 42);
                in.image.params.narrower = narrower ? 1 : 0;
                in.image.params.surface = surface ? 1 : 0;
                check(in, differenceOf(renderer, in));
            }
    });
}

TEST_CASE("what is no number where there is no value to take reaches no other pixel")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        Compared in(Shape::Steps, 43);
        int without = 0;
        for (int y = 0; y < in.image.height(); ++y)
            for (int x = 0; x < in.image.width(); ++x)
                if (in.wide.at(x, y) < 0) {
                    in.image.value.at(x, y) = std::nanf("");
                    ++without;
                }
        CHECK(without > 100);
        const Difference found = differenceOf(renderer, in);
        // The gather in double knows numbers alone, and takes none of these.
        for (float& v : in.image.value.values)
            v = std::isnan(v) ? 0.0f : v;
        check(in, found);
    });
}

TEST_CASE("two widths at once in a window are the whole image's, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(smallScene(), device, renderOptions());
        const Compared in(Shape::Tilted, 44);
        const Difference whole = differenceOf(renderer, in);
        const image::Window window { 16, 7, 48, 19 };
        const Difference part = differenceOf(renderer, in, window);
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
        render::Renderer renderer(smallScene(), device, renderOptions());
        Compared in(Shape::Tilted, 41);
        in.image = keptLean(in.image);
        check(in, differenceOf(renderer, in, {}, true));
    });
}
