// The filter's passes on a device, and their comparison with the gather in double.
#pragma once

#include "effects/area_lights/maaf.h"
#include "host/render/filters/filter_graph.h"
#include "tests/filter_oracle.h"
#include "tests/pass_bench.h"

#include <string>

namespace wedge::test {

/// A graph that filters of an image are declared in, by the builder. lean: normals and sizes have fewer bits.
struct FilterGraph {
    FilterGraph(const render::Renderer& renderer, const FilterImage& image, bool lean)
        : graph(image.width(), image.height(), image.value.layout.size)
        , builder { graph, renderer.scene(), nullptr, settings, image.value.layout,
            render::packetSize(renderer.traversal()) }
        , channels(static_cast<std::uint32_t>(image.value.values.size() / image.value.layout.size))
    {
        builder.lean = lean;
        builder.surfaces.position = there<render::Position>("position", graph::vectors);
        builder.surfaces.normal = there<render::Normal>("normal", builder.normals(lean));
        builder.surfaces.pixelSize = there<render::Metres>("pixelSize", lean ? render::shortFloats : graph::floats);
        builder.surfaces.objectId = there<render::ObjectId>("objectId", graph::counts);
    }
    template <class Quantity>
    graph::Handle<Quantity> there(const char* name, const graph::Format& format)
    {
        return graph.imported<Quantity>(name, format, cl::Buffer());
    }

    graph::Graph graph;
    render::Settings settings;
    render::FrameBuilder builder;
    std::uint32_t channels; ///< of the image's value
};

/// Of one of these passes all that the image has for it.
inline PassBench passOf(
    render::Renderer& renderer, const FilterGraph& declared, const std::string& kernel, const FilterImage& image)
{
    PassBench out(renderer, declared.graph, kernel);
    out.plane("beta", image.beta);
    out.plane("position", image.position);
    out.plane("normal", image.normal);
    out.plane("pixelSize", image.pixelSize);
    out.plane("objectId", image.objectId);
    for (const char* name : { "filtered", "effective", "narrowRows", "wideRows", "narrowCounts", "wideCounts" })
        if (out.has(name)) // garbage
            out.plane(name, std::vector(out.read<float>(name).size(), -7.0f));
    return out;
}

/// The product's filters on one device: sheared ones of images that have gradients.
class FilterRun {
public:
    explicit FilterRun(const device::Device& device, bool lean = false)
        : renderer_(smallScene(), device, renderOptions())
        , lean_(lean)
    {
    }

    /// Both passes over the pixels of `window`, or all; only the first if rowsOnly.
    FilterResult operator()(const FilterImage& image, bool rowsOnly = false, image::Window window = {})
    {
        FilterGraph declared(renderer_, image, lean_);
        declare(declared, image);
        const bool sheared = image.gradients.has_value();
        const image::Window all = windowOf(image);
        if (window.width() == 0)
            window = all;
        PassBench rows = passOf(renderer_, declared, sheared ? "shearRows" : "filterRows", image);
        rows.plane("value", image.value);
        if (sheared) {
            rows.plane("gradients", *image.gradients);
            rows.plane("slopeWidth", image.slopeWidth);
        }
        rows.window({ window.x0, all.y0, window.x1, all.y1 });
        rows.run();
        // Filtering in place would race: what was filtered is still there.
        const auto after = rows.read<float>("value");
        CHECK(std::memcmp(after.data(), image.value.values.data(), after.size() * sizeof(float)) == 0);
        if (rowsOnly)
            return { rows.pixels<float>("filtered"), rows.pixels<float>("effective") };
        PassBench columns = passOf(renderer_, declared, sheared ? "shearColumns" : "filterColumns", image);
        columns.plane("value", rows.read<float>("filtered"));
        columns.plane("effectiveRows", rows.read<float>("effective"));
        if (sheared) {
            columns.plane("gradients", rows.read<float>("gradientsOfRows"));
            columns.plane("slopeWidth", image.slopeWidth);
        } else {
            columns.plane("beta", image.widthsAlong(false));
        }
        columns.window(window);
        columns.run();
        return { columns.pixels<float>("filtered"), columns.pixels<float>("effective") };
    }

    /// What the program of counts alone makes of it.
    Planes<float> counts(const FilterImage& image)
    {
        FilterGraph declared(renderer_, image, lean_);
        gatheredCounts(declared.builder, "counts", device::PassKind::Analysis, image.params,
            declared.there<render::Metres>("beta", graph::floats));
        PassBench pass = passOf(renderer_, declared, "gatherCounts", image);
        pass.window(windowOf(image));
        pass.run();
        return pass.pixels<float>("effective");
    }

private:
    static image::Window windowOf(const FilterImage& image)
    {
        return { 0, 0, static_cast<int>(image.params.x1), static_cast<int>(image.params.y1) };
    }
    static void declare(FilterGraph& declared, const FilterImage& image)
    {
        using namespace render;
        const render::FilterRun run { "filter", device::PassKind::Filter };
        const auto value = declared.there<Value>("value", graph::floatPlanes(declared.channels));
        const auto beta = declared.there<Metres>("beta", graph::floats);
        if (image.gradients) {
            const bool curved = image.gradients->values.size() == 5 * image.value.values.size();
            const graph::Format format = curved ? momentsFormat(declared.channels) : gradientsOf(declared.channels);
            Gathered out = filteredPlanes(declared.builder, declared.channels);
            shearedFilter(declared.builder, run, declared.channels, image.params, value, beta,
                { declared.there<Value>("gradients", format), declared.there<Metres>("slopeWidth", shortFloats), format,
                    curved },
                out);
        } else if (image.meanSquare) {
            gaussianFilter(declared.builder, run, declared.channels, image.params, value,
                { beta, declared.there<Metres>("beta of columns", graph::floats) });
        } else {
            gaussianFilter(declared.builder, run, declared.channels, image.params, value, beta);
        }
    }

    render::Renderer renderer_;
    bool lean_;
};

/// The same image with normals and sizes as lean frames keep them.
inline FilterImage keptLean(FilterImage image)
{
    everyPixel(image.value.layout, [&](int x, int y) {
        const std::uint32_t bits = shared::packNormal(toVec3(image.normal.vector(x, y)));
        image.normal.setVector(x, y, toGlm(shared::unpackNormal(bits)));
        image.pixelSize.at(x, y) = shared::unpackShort(shared::packShort(image.pixelSize.at(x, y)));
    });
    return image;
}

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

/// Of an image whose neighbours have gradients: NaN of a column of another object reaches no other pixel.
inline void checkThatNaNStays(const device::Device& device, FilterImage image)
{
    FilterRun filter(device);
    const FilterResult clean = filter(image);
    for (int y = 0; y < image.height(); ++y) {
        image.objectId.at(20, y) = 2;
        image.value.at(20, y) = 0.5f;
    }
    const FilterResult apart = filter(image);
    for (int y = 0; y < image.height(); ++y)
        for (std::size_t k = 0; k < image.gradients->values.size() / image.value.layout.size; ++k)
            image.gradients->at(20, y, k) = std::numeric_limits<float>::quiet_NaN();
    const FilterResult result = filter(image);
    everyPixel(image.value.layout, [&](int x, int y) {
        if (x != 20)
            REQUIRE(result.value.at(x, y) == apart.value.at(x, y));
    });
    CHECK(clean.value.at(19, 9) != apart.value.at(19, 9));
}

} // namespace wedge::test
