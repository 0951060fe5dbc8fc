// Lens, shutter and antialiasing from the command line and the scene file: precedence, layers, what is reported.
#include "tests/app_testing.h"

#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

constexpr int width = 48, height = 36;
constexpr double depth = 4; ///< metres from the camera to the wall

/// Metres between pixels' rays at distance 1.
double step() { return 2 * std::tan(22.5 * std::acos(-1.0) / 180) / height; }

/// A wall across the view, wider than the image's middle third, and a light behind the camera. lens: more keys of the
/// camera; rest: more of the file.
void writeScene(const Workplace& place, const std::string& name, const std::string& lens = "",
    const std::string& rest = "", const std::string& integrator = "")
{
    place.write("wall.obj", "v -1 -0.8 0\nv 1 -0.8 0\nv 1 0.8 0\nv -1 0.8 0\nf 1 2 3 4\n");
    place.write(name,
        "[image]\nwidth = 48\nheight = 36\n[background]\nradiance = [0.1, 0.2, 0.3]\n[integrator]\nspp = 16\n"
            + integrator + "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\n" + lens
            + "[[light]]\ntype = 'quad'\ncentre = [0, 1, 6]\nhalf_u = [0, 0.5, 0]\nhalf_v = [0.5, 0, 0]\nradiance = "
              "30\n"
            + rest + "[[material]]\nname = 'grey'\n[[mesh]]\nfile = 'wall.obj'\nmaterial = 'grey'\n"
            + (rest.empty() ? "" : "key = [{ time = 0 }, { time = 1, translate = [0.5, -0.25, 0] }]\n"));
}

const std::string lens = "aperture = 0.4\nfocus = 2\n";
const std::string shutter = "[shutter]\nclose = 1\n";

/// The scene through a lens with that key in place of its 16 samples.
void writeCounted(
    const Workplace& place, const std::string& name, const std::string& key, const std::string& integrator = "")
{
    writeScene(place, name, lens, "", integrator);
    std::string text = place.text(name);
    text.replace(text.find("spp = 16"), 8, key);
    place.write(name, text);
}

image::LayeredImage rendered(const Workplace& place, const std::string& scene, Arguments more = {})
{
    more.insert(more.end(), { "--size", "48x36" });
    return render(place, scene, more);
}

/// The pixel in the middle of the image.
float middle(const image::LayeredImage& image, const std::string& channel)
{
    return values(image, channel)[width * (height / 2) + width / 2];
}

double sum(const image::LayeredImage& image, const std::string& channel)
{
    const std::vector<float>& v = values(image, channel);
    return std::accumulate(v.begin(), v.end(), 0.0);
}

float numberOf(const image::LayeredImage& image, const std::string& name)
{
    return std::get<float>(image.metadata.at(name));
}

} // namespace

TEST_CASE("the lens of the command line goes before the scene file's")
{
    const Workplace place;
    writeScene(place, "pinhole.toml");
    writeScene(place, "lens.toml", lens);
    const image::LayeredImage sharp = rendered(place, "pinhole.toml"), blurred = rendered(place, "lens.toml");
    CHECK(values(sharp, "G") != values(blurred, "G"));
    const image::LayeredImage given = rendered(place, "pinhole.toml", { "--aperture", "0.4", "--focus", "2" });
    CHECK(values(given, "G") == values(blurred, "G"));
    CHECK(values(rendered(place, "lens.toml", { "--aperture", "0" }), "G") == values(sharp, "G"));
    CHECK(numberOf(given, "apertureRadius") == 0.4f);
    CHECK(numberOf(given, "focusDistance") == 2.0f);
    CHECK(textOf(given, "apertureProfile") == "uniform");
    CHECK(numberOf(sharp, "apertureRadius") == 0.0f);
    CHECK(numberOf(sharp, "focusDistance") == 4.0f); // as far as look_at
    CHECK(numberOf(sharp, "primarySamplesPerPixel") == 1.0f);

    checkRenderRefused(place, "pinhole.toml", { "--focus", "2" }, wrongCall,
        "option has no effect with a pinhole: --focus 2: leave it out, or add --aperture");
    checkRenderRefused(place, "lens.toml", { "--focus", "2", "--aperture", "0" }, wrongCall, "--focus 2");
    for (const char* length : { "-1", "nan", "inf", "1e13", "wide" }) {
        checkRenderRefused(place, "lens.toml", { "--aperture", length }, wrongCall, length);
        checkRenderRefused(place, "lens.toml", { "--focus", length }, wrongCall, length);
    }
    checkRenderRefused(place, "lens.toml", { "--focus", "0" }, wrongCall, "--focus");
}

TEST_CASE("layers of what lens and shutter blur, and the rays that it took")
{
    const Workplace place;
    writeScene(place, "lens.toml", lens, shutter);
    const image::LayeredImage image = rendered(place, "lens.toml", { "--layers", "all", "--report", "r.json" });
    const float n = middle(image, "primarySamples.Y");
    CHECK(n >= 8);
    const double u = 0.5 / (depth * step()), v = 0.25 / (depth * step());
    CHECK(middle(image, "motion.U") == doctest::Approx(u).epsilon(1e-3));
    CHECK(middle(image, "motion.V") == doctest::Approx(v).epsilon(1e-3)); // down
    const double r = 0.4 / step() * (1.0 / 2 - 1 / depth), h = std::hypot(u, v) / 2;
    CHECK(middle(image, "filterWidthLens.pixels")
        == doctest::Approx(0.65 * r * std::pow(n * r * r, -0.176)).epsilon(1e-3));
    CHECK(
        middle(image, "filterWidthMotion.pixels") == doctest::Approx(0.86 * h * std::pow(n * h, -0.25)).epsilon(1e-3));
    CHECK(values(image, "motion.U")[0] == 0); // a miss

    const nlohmann::json report = nlohmann::json::parse(place.text("r.json"));
    const nlohmann::json& frame = report.at("frames").at(0);
    CHECK(sum(image, "primarySamples.Y") == frame.at("rays").at("primary").get<double>());
    CHECK(sum(image, "rays.Y")
        == frame.at("rays").at("primary").get<double>() + frame.at("rays").at("shadow").get<double>());
    const double mean = sum(image, "primarySamples.Y") / (width * height);
    CHECK(frame.at("spp_primary").get<double>() == doctest::Approx(mean));
    CHECK(numberOf(image, "primarySamplesPerPixel") == doctest::Approx(mean));
    CHECK(report.at("scene").at("lens").at("aperture").get<double>() == doctest::Approx(0.4));
    CHECK(report.at("scene").at("lens").at("focus") == 2.0);
    CHECK(report.at("scene").at("shutter").at("close") == 1.0);
    CHECK(report.at("scene").at("moving_triangles") == 2);
    CHECK(report.at("method").at("antialias") == false);
    CHECK(numberOf(image, "shutterOpen") == 0.0f);
    CHECK(numberOf(image, "shutterClose") == 1.0f);
    CHECK(textOf(image, "shutterProfile") == "box");
    CHECK(contains(textOf(image, "depthConvention"), "mean"));

    const image::LayeredImage plain =
        rendered(place, "lens.toml", { "--method", "mc", "--spp", "5", "--layers", "all" });
    CHECK(std::ranges::all_of(values(plain, "primarySamples.Y"), [](float taken) { return taken == 5; }));
    CHECK(plain.find("filterWidthLens.pixels") == nullptr);
    const image::LayeredImage glossy =
        rendered(place, materials, { "--aperture", "0.1", "--bounces", "1", "--method", "mc", "--spp", "5" });
    CHECK(numberOf(glossy, "samplesPerPixel") == 5);
    CHECK(numberOf(glossy, "primarySamplesPerPixel") == 5);
    checkRenderRefused(
        place, "lens.toml", { "--method", "mc", "--layers", "filterWidthLens" }, wrongCall, "filterWidthLens");
    const image::LayeredImage unfiltered =
        rendered(place, "lens.toml", { "--filter", "none", "--layers", "filterWidthLens" });
    CHECK(sum(unfiltered, "filterWidthLens.pixels") == 0);
}

TEST_CASE("emission, direct and indirect light through lens and shutter add up to the beauty")
{
    const Workplace place;
    writeScene(place, "lens.toml", lens, shutter, "bounces = 1\n");
    for (const std::string layers : { "emission,direct,indirect", "all" }) {
        const image::LayeredImage image = rendered(place, "lens.toml", { "--layers", layers });
        double largest = 0;
        for (const std::string c : { "R", "G", "B" }) {
            for (std::size_t i = 0; i < values(image, c).size(); ++i) {
                const double parts = values(image, "emission." + c)[i] + values(image, "direct." + c)[i]
                    + values(image, "indirect." + c)[i];
                largest = std::max(largest, std::fabs(parts - values(image, c)[i]));
            }
        }
        CHECK(largest < 1e-5);
        CHECK(sum(image, "direct.G") > 10);
    }
}

TEST_CASE("antialiasing from the command line and the scene file")
{
    const Workplace place;
    writeScene(place, "plain.toml");
    writeScene(place, "smooth.toml", "", "", "antialias = true\n");
    const image::LayeredImage plain = rendered(place, "plain.toml"), smooth = rendered(place, "smooth.toml");
    CHECK(textOf(plain, "method.antialias") == "false");
    CHECK(textOf(smooth, "method.antialias") == "true");
    CHECK(numberOf(smooth, "primarySamplesPerPixel") >= 8);
    CHECK(values(plain, "G") != values(smooth, "G"));
    CHECK(values(rendered(place, "plain.toml", { "--antialias" }), "G") == values(smooth, "G"));
    CHECK(values(rendered(place, "smooth.toml", { "--no-antialias" }), "G") == values(plain, "G"));
    CHECK(values(rendered(place, "plain.toml", { "--antialias", "--no-antialias" }), "G") == values(plain, "G"));
    // The wall's left edge is at 13.14 pixels: the background has 14 % of its column, but not the middle of that.
    const auto at = [&](const image::LayeredImage& of, std::size_t x) {
        return values(of, "B")[width * (height / 2) + x];
    };
    const auto edge = static_cast<std::size_t>(0.5 * width - 1 / (depth * step()));
    CHECK(at(plain, edge - 1) == 0.3f);
    CHECK(at(plain, edge) < 0.1f);
    CHECK(at(smooth, edge - 1) == doctest::Approx(0.3));
    CHECK(at(smooth, edge) > 1.1f * at(plain, edge));
    CHECK(at(smooth, edge) < 0.2f);
}

TEST_CASE("the filter of antialiased pixels from the command line and the scene file")
{
    const Workplace place;
    writeScene(place, "plain.toml");
    writeScene(place, "wide.toml", "", "", "antialias = true\npixel_filter = 'gaussian'\n");
    const image::LayeredImage wide = rendered(place, "wide.toml");
    CHECK(textOf(wide, "method.pixelFilter") == "gaussian");
    const image::LayeredImage square = rendered(place, "plain.toml", { "--antialias" });
    CHECK(textOf(square, "method.pixelFilter") == "box");
    CHECK(values(rendered(place, "wide.toml", { "--pixel-filter", "box" }), "G") == values(square, "G"));
    CHECK(values(rendered(place, "plain.toml", { "--antialias", "--pixel-filter", "gaussian" }), "G")
        == values(wide, "G"));
    CHECK(values(wide, "G") != values(square, "G"));
    CHECK(values(rendered(place, "wide.toml", { "--pixel-filter", "blackman-harris" }), "G") != values(wide, "G"));
    checkRenderRefused(place, "plain.toml", { "--pixel-filter", "box" }, wrongCall,
        "option has no effect without antialiasing: --pixel-filter: leave it out, or add --antialias");
    checkRenderRefused(place, "plain.toml", { "--antialias", "--pixel-filter", "mitchell" }, wrongCall,
        "--pixel-filter: mitchell: choose box, gaussian, blackman-harris");
}

TEST_CASE("counts of frames through a lens, and options that have no effect on them")
{
    const Workplace place;
    writeScene(place, "lens.toml", lens);
    const auto setting = [&](const Arguments& more, const std::string& name) {
        Arguments arguments = { "--size", "8x6" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return textOf(render(place, "lens.toml", arguments), "method." + name);
    };
    CHECK(setting({}, "distributedMaxSpp") == "512");
    CHECK(setting({ "--max-spp", "50" }, "distributedMaxSpp") == "50");
    CHECK(setting({ "--spp", "100" }, "distributedMaxSpp") == "1828");
    CHECK(setting({ "--spp", "300" }, "distributedMaxSpp") == "5485");
    CHECK(setting({ "--as-published" }, "distributedMu") == "1");
    CHECK(setting({ "--as-published", "--mu", "1.5" }, "distributedMu") == "1.5");
    CHECK(setting({ "--as-published" }, "distributedCounts") == "spectrum");
    const std::vector<Arguments> idle = { { "--falloff", "ratio" }, { "--sampling", "uniform" },
        { "--counts", "variance" }, { "--sampler", "sobol" } };
    for (const Arguments& option : idle) {
        checkRenderRefused(place, "lens.toml", option, wrongCall,
            "option has no effect with method aaf through a lens or shutter, or with antialiasing: " + option[0]);
    }
    checkRenderRefused(place, "lens.toml", { "--method", "maaf", "--falloff", "ratio" }, wrongCall,
        "option has no effect with method maaf through a lens or shutter, or with antialiasing: --falloff");
    CHECK(setting({ "--method", "mc", "--sampler", "stratified" }, "sampler") == "stratified");
}

TEST_CASE("counts that frames through a lens cannot have are refused, and how to have them said")
{
    const Workplace place;
    writeScene(place, "lens.toml", lens);
    writeScene(place, "plain.toml");
    writeCounted(place, "open.toml", "");
    const auto refused = [&](const Arguments& more, const std::string& said) {
        checkRenderRefused(place, "lens.toml", more, wrongCall, said);
    };
    const std::string few = "samples a pixel are too few for method aaf: ";
    const std::string many =
        "samples a pixel are too many for method aaf through a lens or shutter, or with antialiasing: ";
    const std::string ways = ": give 2048 or less, or add --progressive or --method mc";
    refused({ "--spp", "2049" }, many + "--spp 2049" + ways);
    refused({ "--spp", "5000", "--max-spp", "3000" }, many + "--spp 5000" + ways);
    refused({ "--max-spp", "16385" }, many + "--max-spp 16385: give 16384 or less");
    refused({ "--max-spp", "16385", "--as-published" }, many + "--max-spp 16385");
    checkRenderRefused(
        place, "open.toml", { "--mu", "40" }, wrongCall, many + "--mu 40: lower it, or give --spp, 2048 or less");
    checkRenderRefused(place, "plain.toml", { "--antialias", "--spp", "2049" }, wrongCall, many + "--spp 2049" + ways);
    refused({ "--method", "maaf", "--spp", "2049" },
        "samples a pixel are too many for method maaf through a lens or shutter, or with antialiasing: --spp 2049");
    refused({ "--spp", "7" }, few + "--spp 7: give 8 or more");
    refused({ "--spp", "7", "--bounces", "1" }, few + "--spp 7: give 8 or more");
    checkRenderRefused(place, "open.toml", { "--max-spp", "7" }, wrongCall, few + "--max-spp 7: give 8 or more");
    refused({ "--max-spp", "15", "--as-published" }, "16 or more");
    refused({ "--as-published", "--spp", "20" },
        "option has no effect where counts follow from the spectrum: --spp 20: set --mu, or leave out --as-published");
    checkRenderRefused(place, "plain.toml", { "--progressive", "--falloff", "ratio" }, wrongCall,
        "option has no effect with method aaf and --progressive: --falloff");
    checkRenderRefused(place, "plain.toml", { "--progressive", "--max-spp", "100" }, wrongCall,
        "option does not go with --progressive, whose counts grow from step to step: --max-spp");
    const auto samples = [&](const Arguments& more) {
        Arguments arguments = { "--size", "1x1" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return numberOf(render(place, "lens.toml", arguments), "samplesPerPixel");
    };
    // A mean of all kinds of samples: one pixel shares them out as it likes.
    CHECK(samples({ "--spp", "2048" }) > 500);
    CHECK(samples({ "--spp", "2048", "--max-spp", "2048" }) == 2048);
    CHECK(samples({ "--spp", "2049", "--method", "mc" }) == 2049);
    CHECK(samples({ "--spp", "8", "--bounces", "1" }) == 8);
    CHECK(samples({ "--as-published", "--max-spp", "16" }) == 16);
}

TEST_CASE("counts of a scene file that frames through a lens cannot have, and those that have no effect")
{
    const Workplace place;
    writeCounted(place, "mean.toml", "spp = 2049");
    writeCounted(place, "most.toml", "max_spp = 16385");
    writeCounted(place, "mu.toml", "mu = 40");
    writeCounted(place, "few.toml", "spp = 7");
    writeCounted(place, "eight.toml", "spp = 8", "bounces = 1\n");
    writeCounted(place, "capped.toml", "max_spp = 20");
    const std::string lensed = " is too high for method aaf through a lens or shutter, or with antialiasing: ";
    for (const char* command : { "render", "info" }) {
        checkRefused(
            place, { command, "mean.toml" }, failure, "scene file mean.toml: spp" + lensed + "2049: give 2048 or less");
        checkRefused(place, { command, "most.toml" }, failure,
            "scene file most.toml: max_spp" + lensed + "16385: give there, or");
        checkRefused(
            place, { command, "mu.toml" }, failure, "scene file mu.toml: mu" + lensed + "40: lower it, or give --spp");
        checkRefused(
            place, { command, "few.toml" }, failure, "spp is too low for method aaf: 7: give 8 or more, or method mc");
    }
    const std::vector<Arguments> fine = { { "mean.toml", "--spp", "20" }, { "mean.toml", "--aperture", "0" },
        { "mean.toml", "--as-published" }, { "most.toml", "--max-spp", "30" }, { "most.toml", "--aperture", "0" },
        { "mu.toml", "--spp", "20" }, { "few.toml", "--spp", "8" }, { "eight.toml" }, { "capped.toml", "--spp", "20" },
        { "capped.toml", "--progressive", "--spp", "32" }, { "few.toml", "--progressive", "--spp", "2050" },
        { "eight.toml", "--max-spp", "2048" }, { "few.toml", "--as-published", "--mu", "0.5" } };
    for (const Arguments& call : fine) {
        CAPTURE(call[0]);
        Arguments arguments = { "render", "--quiet", "-o", "a.exr", "--size", "1x1" };
        arguments.insert(arguments.end(), call.begin(), call.end());
        const Outcome outcome = place.run(arguments);
        CHECK_MESSAGE(outcome.status == 0, outcome.err);
    }
}

} // namespace wedge::app::test
