// Images of the program end to end on a real device: what is in them, and that the same comes again.
#include "tests/app_testing.h"

#include "host/image/read_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

bool sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

bool sameBits(const image::LayeredImage& a, const image::LayeredImage& b)
{
    return a.channels.size() == b.channels.size()
        && std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(),
            [](const auto& x, const auto& y) { return x.name == y.name && sameBits(x.values, y.values); });
}

/// The part of a whole image's channel that a window covers.
std::vector<float> cut(const image::LayeredImage& image, const std::string& channel, const image::Window& window)
{
    const std::vector<float>& all = values(image, channel);
    std::vector<float> out;
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            out.push_back(all[static_cast<std::size_t>(y) * image.width + x]);
        }
    }
    return out;
}

std::array<float, 3> transformed(const std::array<float, 16>& m, const std::array<float, 3>& p, bool divide)
{
    std::array<float, 4> out {};
    for (std::size_t k = 0; k < 4; ++k) {
        out[k] = p[0] * m[k] + p[1] * m[4 + k] + p[2] * m[8 + k] + m[12 + k];
    }
    const float w = divide ? out[3] : 1.0f;
    return { out[0] / w, out[1] / w, out[2] / w };
}

TEST_CASE("layers of components add up to a light's visibility")
{
    const Workplace place;
    // The half plane of the scene hides nothing at the right, and all at the left.
    const image::LayeredImage image = render(place, scenes + "/penumbra.toml",
        { "--size", "64x48", "--method", "maaf", "--maaf", "refitted", "--components", "3", "--layers", "components" });
    std::set<std::string> found;
    for (const image::Channel& channel : image.channels) {
        found.insert(channel.name);
    }
    CHECK(found
        == std::set<std::string> { "R", "G", "B", "components.00", "components.01", "components.10", "components.11" });
    // What components see is the edge, an error function of a deviation of about seven pixels, but for what they blur.
    std::size_t several = 0;
    for (std::size_t x = 0; x < 64; ++x) {
        double mean = 0;
        for (std::size_t y = 8; y < 40; ++y) {
            const auto at = [&](const char* channel) { return values(image, channel)[y * 64 + x]; };
            mean += (at("components.00") + at("components.01") + at("components.10") + at("components.11")) / 32.0;
            several += std::abs(at("components.10")) > 0.02f ? 1 : 0; // across the edge, and not along it
        }
        CAPTURE(x);
        const double metres =
            (static_cast<double>(x) + 0.5 - 32) * 2 * 1.9 * std::tan(60 * 3.14159265358979 / 360) / 48;
        const double sigma = 0.25, cut = 2;
        const double seen = 0.5
            + 0.5 * std::erf(std::clamp(metres / sigma, -cut, cut) / std::sqrt(2.0)) / std::erf(cut / std::sqrt(2.0));
        CHECK(std::abs(mean - seen) < 0.08);
    }
    CHECK(several > 200);
}

TEST_CASE("of several lights each has components of its own")
{
    const Workplace place;
    std::string scene = readAll(scenes + "/penumbra.toml");
    for (std::size_t at = 0; (at = scene.find("\"meshes/", at)) != std::string::npos; at += scenes.size()) {
        scene.replace(at, 1, "\"" + scenes + "/");
    }
    place.write("two.toml",
        scene
            + "[[light]]\ntype = \"quad\"\ncentre = [0.3, 4, 0]\nhalf_u = [0.5, 0, 0]\nhalf_v = [0, 0, 0.5]\n"
              "radiance = 50\nprofile = \"gaussian\"\ncut = 2\nvisible = false\n");
    const image::LayeredImage image = render(place, "two.toml",
        { "--size", "32x24", "--method", "maaf", "--maaf", "printed", "--components", "3", "--layers", "components" });
    std::set<std::string> found;
    for (const image::Channel& channel : image.channels) {
        found.insert(channel.name);
    }
    CHECK(found
        == std::set<std::string> { "R", "G", "B", "components1.00", "components1.01", "components1.10",
            "components1.11", "components2.00", "components2.01", "components2.10", "components2.11" });
    CHECK(values(image, "components1.00") != values(image, "components2.00"));
}

TEST_CASE("all layers of a frame fit together")
{
    const Workplace place;
    const image::LayeredImage image =
        render(place, materials, { "--layers", "all", "-o", "a.png", "--report", "r.json" });
    CHECK(image.width == 64);
    CHECK(image.height == 48);
    CHECK(image.window == image::Window { 0, 0, 64, 48 });
    const std::set<std::string> expected = { "R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y",
        "normal.Z", "position.X", "position.Y", "position.Z", "depth.Z", "emission.R", "emission.G", "emission.B",
        "direct.R", "direct.G", "direct.B", "directNoisy.R", "directNoisy.G", "directNoisy.B", "samples.Y", "rays.Y",
        "filterWidth1.world", "filterWidth1.pixels", "filterWidth2.world", "filterWidth2.pixels",
        "filterWidthLens.pixels", "filterWidthMotion.pixels", "motion.U", "motion.V", "primarySamples.Y", "pixelSize.Y",
        "objectId.I" };
    std::set<std::string> found;
    for (const image::Channel& channel : image.channels) {
        found.insert(channel.name);
    }
    CHECK(found == expected);

    std::size_t misses = 0, filtered = 0;
    double rays = 0;
    std::map<std::string, std::size_t> wrong; // pixels that break a rule, by the rule
    for (std::size_t i = 0; i < 64 * 48; ++i) {
        const auto at = [&](const std::string& channel) { return values(image, channel)[i]; };
        const bool miss = at("objectId.I") == 0;
        misses += miss;
        rays += at("rays.Y");
        wrong["one ray from the camera, at rest"] +=
            at("primarySamples.Y") != 1 || at("motion.U") != 0 || at("motion.V") != 0;
        wrong["nothing to blur"] += at("filterWidthLens.pixels") != 0 || at("filterWidthMotion.pixels") != 0;
        for (const std::string c : { "R", "G", "B" }) {
            wrong["beauty = emission + direct"] += at(c) != at("emission." + c) + at("direct." + c);
            wrong["radiance is finite and not negative"] += !std::isfinite(at(c)) || at(c) < 0;
            wrong["nothing reflected on a miss"] += miss && at("direct." + c) != 0;
        }
        const float squared =
            at("normal.X") * at("normal.X") + at("normal.Y") * at("normal.Y") + at("normal.Z") * at("normal.Z");
        wrong["normals are unit, 0 on a miss"] += std::abs(squared - (miss ? 0.0f : 1.0f)) > 1e-4f;
        wrong["depth is infinite on a miss"] += miss != (at("depth.Z") == std::numeric_limits<float>::infinity());
        wrong["surfaces are sampled"] += (at("samples.Y") == 0) != miss;
        // Widths are 0 where a light does not reach, and both lights see pixels of one size.
        const float first = at("filterWidth1.world"), second = at("filterWidth2.world");
        for (const char* width : { "1.world", "1.pixels", "2.world", "2.pixels" }) {
            wrong["widths are finite and not negative"] +=
                !(at(std::string("filterWidth") + width) >= 0 && std::isfinite(at(std::string("filterWidth") + width)));
        }
        wrong["no filter on a miss"] += miss && (first != 0 || second != 0);
        wrong["widths in both units"] += (first > 0) != (at("filterWidth1.pixels") > 0);
        if (first > 0 && second > 0) {
            ++filtered;
            const float sizes = first / at("filterWidth1.pixels") * at("filterWidth2.pixels") / second;
            wrong["pixels of one size"] += std::abs(sizes - 1.0f) > 1e-5f;
        }
    }
    CHECK(filtered > 1000);
    for (const auto& rule : wrong) {
        CAPTURE(rule.first);
        CHECK(rule.second == 0);
    }
    const nlohmann::json counted = nlohmann::json::parse(place.text("r.json")).at("frames").at(0).at("rays");
    CHECK(rays == counted.at("primary").get<double>() + counted.at("shadow").get<double>());
    CHECK(misses > 100);
    CHECK(misses < 64 * 48 / 2);
    CHECK(values(image, "direct.R") != values(image, "directNoisy.R"));

    const image::RgbImage png = image::readImage(place.path() / "a.png");
    REQUIRE(png.width == 64);
    REQUIRE(png.height == 48);
    double largest = 0;
    for (std::size_t i = 0; i < 64 * 48; ++i) {
        const float shown = std::clamp(values(image, "G")[i], 0.0f, 1.0f);
        largest = std::max(largest, std::abs(double { shown } - png.rgb[3 * i + 1]));
    }
    CHECK(largest < 0.006); // half a step of 8 bits where the sRGB curve is steepest towards linear
}

TEST_CASE("positions, depths and the camera's matrices agree")
{
    const Workplace place;
    const image::LayeredImage image = render(place, materials, { "--layers", "position,depth,objectId" });
    const auto toCamera = std::get<std::array<float, 16>>(image.metadata.at("worldToCamera"));
    const auto toNdc = std::get<std::array<float, 16>>(image.metadata.at("worldToNDC"));
    // The scene's camera: eye (0, 2.2, 6.2), looking at (0, 0.8, 0), which is 6.3561 m ahead.
    const std::array<float, 3> target = transformed(toCamera, { 0, 0.8f, 0 }, false);
    CHECK(target[0] == doctest::Approx(0).epsilon(1e-5));
    CHECK(target[1] == doctest::Approx(0).epsilon(1e-5));
    CHECK(target[2] == doctest::Approx(6.3561).epsilon(1e-4));
    CHECK(transformed(toCamera, { 1, 0.8f, 0 }, false)[0] == doctest::Approx(1)); // x right
    CHECK(transformed(toCamera, { 0, 1.8f, 0 }, false)[1] > 0.9f); // y up
    std::size_t hits = 0;
    double worstImage = 0, worstDepth = 0;
    for (std::size_t i = 0; i < 64 * 48; ++i) {
        if (values(image, "objectId.I")[i] == 0) {
            continue;
        }
        ++hits;
        const std::array<float, 3> p = { values(image, "position.X")[i], values(image, "position.Y")[i],
            values(image, "position.Z")[i] };
        const std::array<float, 3> ndc = transformed(toNdc, p, true);
        const std::size_t row = i / 64;
        const double x = static_cast<double>(i % 64) + 0.5, y = static_cast<double>(row) + 0.5;
        worstImage = std::max({ worstImage, std::abs(64.0 * ndc[0] - x), std::abs(48.0 * ndc[1] - y) });
        const std::array<float, 3> c = transformed(toCamera, p, false);
        const double distance = std::hypot(c[0], c[1], c[2]);
        worstDepth = std::max(worstDepth, std::abs(distance - values(image, "depth.Z")[i]));
    }
    CHECK(hits > 1000);
    CHECK(worstImage < 0.01); // pixels
    CHECK(worstDepth < 1e-4); // metres
}

TEST_CASE("metadata tells how the image was made")
{
    const Workplace place;
    const image::LayeredImage image = render(place, box, { "--method", "mc", "--spp", "12", "--seed", "4000000000" });
    CHECK(image.channels.size() == 3); // without --layers, the beauty alone
    CHECK(textOf(image, "wedgeVersion") == WEDGE_TEST_VERSION);
    CHECK(textOf(image, "seed") == "4000000000");
    CHECK(textOf(image, "method") == "mc");
    CHECK(textOf(image, "method.sampler") == "owen-sobol");
    CHECK(textOf(image, "method.antialias") == "false");
    CHECK(textOf(image, "device") != "");
    CHECK(textOf(image, "driver") != "");
    CHECK(contains(textOf(image, "buildOptions"), "-cl-std=CL1.2"));
    CHECK(contains(textOf(image, "depthConvention"), "along the ray"));
    CHECK(std::get<float>(image.metadata.at("samplesPerPixel")) == 12.0f);
    CHECK(std::get<float>(image.metadata.at("renderTimeSeconds")) > 0.0f);
    CHECK(std::get<int>(image.metadata.at("complete")) == 1);
}

TEST_CASE("two runs give the same bits, another seed does not")
{
    const Workplace place;
    for (const Arguments& method : { Arguments { "--method", "mc", "--spp", "8" }, { "--spp", "12" } }) {
        const auto with = [&](const char* seed) {
            Arguments arguments = { "--layers", "all", "--seed", seed };
            arguments.insert(arguments.end(), method.begin(), method.end());
            return render(place, materials, arguments);
        };
        const image::LayeredImage first = with("1");
        CHECK(sameBits(first, with("1")));
        CHECK_FALSE(sameBits(values(first, "direct.R"), values(with("2"), "direct.R")));
    }
}

TEST_CASE("checking each launch changes no bit")
{
    const Workplace place;
    CHECK(sameBits(
        render(place, materials, { "--spp", "12" }), render(place, materials, { "--spp", "12", "--check-launches" })));
}

TEST_CASE("a crop has the bits of the whole image")
{
    const Workplace place;
    const image::Window window { 17, 9, 50, 40 };
    const std::vector<Arguments> methods = { { "--method", "mc", "--spp", "8" }, { "--spp", "12" },
        { "--as-published", "--max-spp", "40" }, { "--filter", "fixed", "--sampling", "uniform", "--spp", "12" },
        { "--method", "maaf", "--maaf", "refitted", "--components", "3", "--spp", "12" } };
    for (const Arguments& method : methods) {
        CAPTURE(method.front());
        Arguments arguments = { "--layers", "all", "--size", "90x70" };
        arguments.insert(arguments.end(), method.begin(), method.end());
        const image::LayeredImage whole = render(place, materials, arguments);
        arguments.insert(arguments.end(), { "--crop", "17,9,50,40" });
        const image::LayeredImage part = render(place, materials, arguments);
        CHECK(part.width == 90);
        CHECK(part.height == 70);
        CHECK(part.window == window);
        REQUIRE(part.channels.size() == whole.channels.size());
        for (const image::Channel& channel : part.channels) {
            CAPTURE(channel.name);
            CHECK(sameBits(channel.values, cut(whole, channel.name, window)));
        }
    }
}

} // namespace
} // namespace wedge::app::test
