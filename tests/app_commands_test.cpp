// The program's commands end to end: what they print and report, precedence, and renders that are stopped.
#include "tests/app_testing.h"

#include "host/image/png.h"
#include "host/image/read_image.h"

#include <cmath>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

TEST_CASE("a frame that is explained is not rendered")
{
    const Workplace place;
    for (const std::vector<std::string>& more :
        { std::vector<std::string> {}, { "--progressive", "--spp", "32" }, { "--antialias", "--layers", "all" } }) {
        std::vector<std::string> arguments { "render", box, "--bounces", "1", "--explain", "frame.svg" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = place.run(arguments);
        CHECK(outcome.status == 0);
        CHECK(outcome.err.empty());
        for (const char* part :
            { "passes\n", "samplePaths", "\nresources\n", "filter width", "memory of the planes: " }) {
            CAPTURE(part);
            CHECK(contains(outcome.out, part));
        }
        const std::string drawing = place.text("frame.svg");
        CHECK(drawing.starts_with("<svg"));
        CHECK(contains(drawing, ">filter width</text>"));
        CHECK(drawing.ends_with("</svg>\n"));
        CHECK(place.files() == std::vector<std::string> { "frame.svg" });
    }
    const Outcome png = place.run({ "render", box, "--explain", "frame.png" });
    CHECK(png.status == 2);
    CHECK(contains(png.err, "frame.png"));
    CHECK(place.run({ "render", box, "--explain", "none/frame.svg" }).status == 1);
    for (const char* option : { "-o", "--report", "--reference" }) {
        const Outcome both = place.run({ "render", box, "--explain", "frame.svg", option, "a.exr" });
        CHECK(both.status == 2);
        CHECK(contains(both.err, option));
    }
}

TEST_CASE("the programs of a frame that is explained are files that stand alone")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "render", box, "--antialias", "--explain", "frame.svg", "--programs", "programs/of/box" });
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.out, " files to programs/of/box\n"));
    const std::string text = place.text("programs/of/box/light.area_light.cl");
    for (const char* part : { "__kernel void sampleShadows(PARAMETERS)", "#define PARAMETERS const FrameParams frame, ",
             "WEDGE_SINK_PARAMETERS", "beginReceivers(" }) {
        CAPTURE(part);
        CHECK(contains(text, part));
    }
    CHECK_FALSE(contains(text, "#include \"")); // there is nothing beside it that it needs
    CHECK(
        contains(place.text("programs/of/box/light.area_light/pass/sampleShadows.h"), "#define PASS_sampleShadows 1"));
    CHECK(contains(place.text("programs/of/box/filter.filter.cl"), "#define WEDGE_GATHER_CHANNELS 1"));

    const Outcome alone = place.run({ "render", box, "--programs", "programs" });
    CHECK(alone.status == 2);
    CHECK(contains(alone.err, "--explain"));
    const Outcome file = place.run({ "render", box, "--explain", "frame.svg", "--programs", "frame.svg/x" });
    CHECK(file.status == 1);
    CHECK(contains(file.err, "--programs"));
}

TEST_CASE("the report has what scripts read")
{
    const Workplace place;
    render(place, box, { "--method", "mc", "--spp", "64" });
    std::filesystem::rename(place.path() / "a.exr", place.path() / "ref.exr");
    const image::LayeredImage image =
        render(place, box, { "--spp", "16", "--reference", "ref.exr", "--report", "r.json" });
    const nlohmann::json report = nlohmann::json::parse(place.text("r.json"));
    CHECK(report.at("wedge") == WEDGE_TEST_VERSION);
    CHECK(report.at("device").at("name") == textOf(image, "device"));
    CHECK(report.at("device").at("build_options") == textOf(image, "buildOptions"));
    CHECK(report.at("device").at("traversal") == textOf(image, "traversal"));
    CHECK(report.at("scene").at("triangles") == 34);
    CHECK(report.at("scene").at("area_lights") == 1);
    CHECK(report.at("scene").at("bvh").at("triangles") == 34);
    CHECK(report.at("scene").at("memory_bytes") > 64 * 48 * 30 * 4);
    CHECK(report.at("method").at("method") == "aaf");
    CHECK(report.at("method").at("spp") == 16);
    CHECK(report.at("method").at("oblique").is_boolean());
    CHECK(report.at("setup").at("kernels_ms") > 0);
    CHECK(report.at("setup").at("plan_ms") > 0);
    REQUIRE(report.at("frames").size() == 1);
    const nlohmann::json& frame = report.at("frames").at(0);
    CHECK(frame.at("complete") == true);
    CHECK(frame.at("spp_mean").get<double>() == doctest::Approx(16).epsilon(0.1));
    CHECK(frame.at("rays").at("primary") == 64 * 48);
    CHECK(frame.at("rays_per_pixel").get<double>()
        == doctest::Approx((64.0 * 48 + frame.at("rays").at("shadow").get<double>()) / (64 * 48)));
    double total = 0, overhead = 0;
    for (const nlohmann::json& pass : frame.at("passes")) {
        const std::string kind = pass.at("kind");
        CHECK(std::set<std::string> { "trace", "analysis", "filter", "composite", "transfer" }.count(kind) == 1);
        CHECK(pass.at("bytes").is_number());
        total += pass.at("ms").get<double>();
        overhead += kind != "trace" && kind != "transfer" ? pass.at("ms").get<double>() : 0.0;
    }
    CHECK(frame.at("total_ms").get<double>() == doctest::Approx(total));
    CHECK(frame.at("overhead_fraction").get<double>() == doctest::Approx(overhead / total));
    CHECK(frame.at("wall_ms") > 0);
    CHECK(frame.at("memory_bytes") == report.at("scene").at("memory_bytes"));

    // The same numbers as `wedge compare` gives.
    const Outcome compared = place.run({ "compare", "a.exr", "ref.exr", "--json" });
    REQUIRE(compared.status == 0);
    const nlohmann::json numbers = nlohmann::json::parse(compared.out);
    for (const char* metric : { "rmse", "relmse", "psnr", "ssim", "flip" }) {
        CHECK(report.at("error").at(metric).get<double>() == numbers.at(metric).get<double>());
    }
    CHECK(report.at("error").at("invalid_pixels") == numbers.at("invalid_pixels"));
    CHECK(report.at("error").at("rmse") > 0);
}

TEST_CASE("the pass table and the error are printed, and nothing goes to stderr without a terminal")
{
    const Workplace place;
    const std::string scene = scenes + "/penumbra.toml";
    REQUIRE(
        place.run({ "render", scene, "--size", "64x48", "--method", "mc", "--spp", "9", "-o", "r.exr" }).status == 0);
    const Outcome outcome = place.run({ "render", scene, "--size", "64x48", "--reference", "r.exr" });
    CHECK(outcome.status == 0);
    CHECK(outcome.err == "");
    for (const std::string part : { "primary rays", "first pass", "second pass", "filter", "composite", "device time",
             "wall clock", "overhead", "Mrays/s", "rmse", "flip", "wrote penumbra.exr", "wrote penumbra.png" }) {
        CAPTURE(part);
        CHECK(contains(outcome.out, part));
    }
    CHECK(place.files() == std::vector<std::string> { "penumbra.exr", "penumbra.png", "r.exr" });
}

TEST_CASE("the command line goes before the scene file")
{
    const Workplace place;
    place.write("s.toml",
        "[image]\nwidth = 24\nheight = 16\n[integrator]\nmethod = \"mc\"\nspp = 3\nseed = 7\n"
        "[camera]\neye = [0, 1, 3]\nlook_at = [0, 0, 0]\n"
        "[[mesh]]\nfile = \""
            + scenes
            + "/meshes/quad.obj\"\n"
              "[[light]]\ntype = \"quad\"\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = 1\n");
    const auto described = [&](const Arguments& more) {
        Arguments arguments = { "render", "s.toml", "--quiet", "-o", "a.exr" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = place.run(arguments);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        const image::LayeredImage image = place.exr("a.exr");
        return std::to_string(image.width) + "x" + std::to_string(image.height) + " " + textOf(image, "method") + " "
            + textOf(image, "method.spp") + " " + textOf(image, "seed");
    };
    CHECK(described({}) == "24x16 mc 3 7");
    CHECK(described({ "--size", "20x10", "--spp", "5", "--seed", "8" }) == "20x10 mc 5 8");
    CHECK(described({ "--method", "aaf", "--spp", "4", "--spp", "11" }) == "24x16 aaf 11 7"); // the last one counts
}

/// Renders that are stopped may be given so little time that no light is seen yet. Tries with more and more, in
/// milliseconds, until it is.
constexpr int patience[] = { 500, 2000, 8000, 32000, 128000 };

bool seesLight(const image::LayeredImage& image)
{
    return std::ranges::any_of(values(image, "G"), [](float v) { return v > 0.01f; });
}

void checkStopped(const image::LayeredImage& image)
{
    CHECK(image.width == 256);
    CHECK(std::get<int>(image.metadata.at("complete")) == 0);
    CHECK(std::ranges::all_of(values(image, "G"), [](float v) { return std::isfinite(v) && v >= 0; }));
}

/// Gives the program time for some samples and interrupts it.
void interruptRendering(const Workplace& place, pid_t process, int milliseconds)
{
    waitUntilRendering(place, process);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
}

TEST_CASE("an interrupt writes what is there")
{
    const Workplace place;
    const Arguments endless = { "render", box, "--method", "mc", "--spp", "1000000", "--size", "256x256", "--verbose",
        "-o", "i.exr" };
    bool light = false;
    for (const int wait : patience) {
        const Outcome outcome = place.run(endless, [&](pid_t process) { interruptRendering(place, process, wait); });
        CHECK(outcome.status == 130);
        CHECK(contains(outcome.err, "wedge: interrupted at"));
        CHECK(contains(outcome.err, "writing what is there"));
        CHECK(place.files() == std::vector<std::string> { "i.exr" });
        const image::LayeredImage image = place.exr("i.exr");
        checkStopped(image);
        if (light = seesLight(image); light) {
            break;
        }
    }
    CHECK(light);
}

TEST_CASE("a time limit writes what is there and succeeds")
{
    const Workplace place;
    for (const std::string method : { "mc", "aaf" }) {
        CAPTURE(method);
        bool light = false;
        for (const int limit : patience) {
            const Outcome outcome = place.run({ "render", box, "--method", method, "--spp", "1000000", "--size",
                "256x256", "--time-limit", std::to_string(1e-3 * limit), "--quiet", "-o", "t.exr" });
            CHECK(outcome.status == 0);
            CHECK(contains(outcome.err, "wedge: time limit reached at"));
            const image::LayeredImage image = place.exr("t.exr");
            checkStopped(image);
            if (light = seesLight(image); light) {
                break;
            }
        }
        CHECK(light);
    }
}

TEST_CASE("as published, mu is what the thesis has for the light and the cosine")
{
    const Workplace place;
    const std::string gaussian = scenes + "/penumbra.toml"; // the box has a uniform light
    const auto mu = [&](const std::string& scene, Arguments more) {
        more.insert(more.end(), { "--size", "16x12" });
        return textOf(render(place, scene, more), "method.mu");
    };
    CHECK(mu(gaussian, { "--as-published" }) == "2");
    CHECK(mu(box, { "--as-published" }) == "3");
    CHECK(mu(gaussian, { "--as-published", "--falloff", "inside" }) == "3");
    CHECK(mu(box, { "--as-published", "--mu", "1.5" }) == "1.5");
    CHECK(mu(box, { "--spp", "28" }) == "1.5"); // not as published
}

/// An image of 8x6 pixels of 0.5, some of them not finite.
void writeGrey(const Workplace& place, const std::string& name, const std::vector<std::size_t>& invalid)
{
    image::RgbImage grey { 8, 6, std::vector<float>(8 * 6 * 3, 0.5f) };
    for (const std::size_t pixel : invalid) {
        grey.rgb[3 * pixel + pixel % 3] = pixel % 2 ? std::nanf("") : INFINITY;
    }
    image::LayeredImage file;
    file.width = grey.width;
    file.height = grey.height;
    file.window = { 0, 0, 8, 6 };
    for (std::size_t c = 0; c < 3; ++c) {
        image::Channel channel;
        channel.name = std::string(1, "RGB"[c]);
        for (std::size_t i = c; i < grey.rgb.size(); i += 3) {
            channel.values.push_back(grey.rgb[i]);
        }
        file.channels.push_back(channel);
    }
    image::writeExr((place.path() / name).string(), file);
}

TEST_CASE("pixels that are not finite are counted and warned of")
{
    const Workplace place;
    writeGrey(place, "good.exr", {});
    writeGrey(place, "bad.exr", { 3, 10, 47 });
    const std::string warning = "wedge: warning: pixels that are not finite in the image or the reference: 3 of 48: ";
    const Outcome good = place.run({ "compare", "good.exr", "good.exr" });
    CHECK(contains(good.out, "\ninvalid pixels 0\n"));
    CHECK(good.err == "");
    for (const Arguments& images : { Arguments { "bad.exr", "good.exr" }, { "good.exr", "bad.exr" } }) {
        const Outcome all = place.run({ "compare", images[0], images[1] });
        CHECK(all.status == 0);
        CHECK(contains(all.out, "\ninvalid pixels 3\n"));
        CHECK(all.err.rfind(warning, 0) == 0);
        CHECK(std::ranges::count(all.err, '\n') == 1);
        const Outcome json = place.run({ "compare", images[0], images[1], "--json" });
        CHECK(nlohmann::json::parse(json.out).at("invalid_pixels") == 3);
        CHECK(json.err == all.err);
        const Outcome one = place.run({ "compare", images[0], images[1], "--metric", "rmse" });
        CHECK(one.out == "0\n");
        CHECK(one.err == all.err);
    }
    const Outcome rendered = place.run({ "render", box, "--size", "8x6", "--method", "mc", "--spp", "1", "--reference",
        "bad.exr", "--report", "r.json", "-o", "a.exr" });
    CHECK(rendered.status == 0);
    CHECK(rendered.err.rfind(warning, 0) == 0);
    CHECK(contains(rendered.out, "invalid pixels 3"));
    CHECK(nlohmann::json::parse(place.text("r.json")).at("error").at("invalid_pixels") == 3);
}

TEST_CASE("all layers that the help names are in the table of docs/command-line.md, with their channels")
{
    const Workplace place;
    const std::string help = place.run({ "render", "--help" }).out;
    std::ifstream page(WEDGE_SOURCE_DATA "/../docs/command-line.md");
    const std::string table { std::istreambuf_iterator<char>(page), {} };
    REQUIRE(contains(table, "## Layers of an EXR"));
    std::istringstream lines(help.substr(help.find("Layers of an EXR")));
    std::string line;
    std::getline(lines, line);
    int layers = 0;
    while (std::getline(lines, line) && !line.empty()) {
        CAPTURE(line);
        std::istringstream words(line);
        std::string name, channel;
        words >> name >> channel;
        if (channel.ends_with(':'))
            channel.pop_back();
        std::string entry = "`";
        entry.append(name).append(".").append(channel);
        CHECK(contains(table, entry));
        ++layers;
    }
    CHECK(layers > 10);
}

TEST_CASE("devices, info, version and help")
{
    const Workplace place;
    CHECK(place.run({ "--version" }).out == std::string("wedge ") + WEDGE_TEST_VERSION + "\n");
    const Outcome help = place.run({ "render", "--help" });
    CHECK(help.status == 0);
    CHECK(contains(help.out, "--as-published"));
    CHECK(contains(help.out, "filterWidth"));

    const Outcome devices = place.run({ "devices", "--json" });
    CHECK(devices.status == 0);
    const nlohmann::json list = nlohmann::json::parse(devices.out);
    REQUIRE(list.size() >= 1);
    CHECK(list[0].at("index") == 0);
    CHECK(contains(place.run({ "devices" }).out, list[0].at("name")));

    const Outcome info = place.run({ "info", box, "--json" });
    CHECK(info.status == 0);
    const nlohmann::json facts = nlohmann::json::parse(info.out);
    CHECK(facts.at("triangles") == 34);
    CHECK(facts.at("area_lights") == 1);
    CHECK(facts.at("width") == 512);
    CHECK(facts.at("bvh").at("triangles") == 34);
    CHECK(contains(place.run({ "info", box }).out, "SAH cost"));
    // What `info` foretells is what a render takes with the samples that are usual.
    render(place, box, { "--size", "512x512", "--crop", "0,0,8,8", "--report", "r.json" });
    CHECK(
        nlohmann::json::parse(place.text("r.json")).at("frames").at(0).at("memory_bytes") == facts.at("memory_bytes"));
}

TEST_CASE("info says what lens and shutter there are, and how much moves")
{
    const Workplace place;
    const nlohmann::json still = nlohmann::json::parse(place.run({ "info", box, "--json" }).out);
    CHECK(still.at("lens").at("aperture") == 0.0);
    CHECK(still.at("lens").at("focus").get<double>() == doctest::Approx(3.9)); // as far as look_at
    CHECK(still.at("moving_triangles") == 0);
    CHECK(still.at("camera_moves") == false);
    const std::string plain = place.run({ "info", box }).out;
    CHECK(contains(plain, "lens       pinhole\nshutter    nothing moves\n"));

    place.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.write("s.toml",
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\naperture = 0.25\nfocus = 3\n[shutter]\nopen = 0.5\nclose = 1\n"
        "profile = 'gaussian'\n[[mesh]]\nfile = 'm.obj'\n[[mesh]]\nfile = 'm.obj'\n"
        "key = [{ time = 0 }, { time = 1, translate = [1, 0, 0] }]\n");
    const nlohmann::json moving = nlohmann::json::parse(place.run({ "info", "s.toml", "--json" }).out);
    CHECK(moving.at("triangles") == 2);
    CHECK(moving.at("moving_triangles") == 1);
    CHECK(moving.at("lens").at("aperture") == 0.25);
    CHECK(moving.at("lens").at("focus") == 3.0);
    CHECK(moving.at("lens").at("aperture_profile") == "uniform");
    CHECK(moving.at("shutter").at("open") == 0.5);
    CHECK(moving.at("shutter").at("close") == 1.0);
    CHECK(moving.at("shutter").at("profile") == "gaussian");
    const std::string text = place.run({ "info", "s.toml" }).out;
    CHECK(contains(text, "lens       uniform aperture of radius 0.25 m, in focus at 3 m\n"));
    CHECK(contains(text, "shutter    gaussian, from 0.5 to 1: 1 moving triangles, camera at rest\n"));
}

TEST_CASE("compare prints one number, all, or a map")
{
    const Workplace place;
    render(place, box, { "--method", "mc", "--spp", "4" });
    const Outcome same = place.run({ "compare", "a.exr", "a.exr", "--metric", "rmse" });
    CHECK(same.status == 0);
    CHECK(same.out == "0\n");
    CHECK(nlohmann::json::parse(place.run({ "compare", "a.exr", "a.exr", "--json" }).out).at("psnr").is_null());
    std::filesystem::rename(place.path() / "a.exr", place.path() / "b.exr");
    render(place, box, { "--method", "mc", "--spp", "4", "--seed", "1" });
    const Outcome other = place.run({ "compare", "a.exr", "b.exr", "--error-map", "map.png" });
    CHECK(other.status == 0);
    for (const char* metric : { "rmse", "relmse", "psnr", "ssim", "flip" }) {
        CHECK(contains(other.out, metric));
    }
    const image::RgbImage map = image::readImage(place.path() / "map.png");
    CHECK(map.width == 64);
    CHECK(*std::ranges::max_element(map.rgb) > 0);
}

/// A picture of one colour, as large as one that a render of next to nothing writes, in few bytes.
void writePlain(const Workplace& place, int width, int height)
{
    const std::vector<float> plane(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.5f);
    image::writeExr((place.path() / "plain.exr").string(),
        { width, height, { 0, 0, width, height },
            { { "R", plane, false }, { "G", plane, false }, { "B", plane, false } }, {} });
    image::writePng(
        (place.path() / "plain.png").string(), { width, height, std::vector<float>(3 * plane.size(), 0.5f) });
}

TEST_CASE("large pictures in few bytes are read by who allows as many pixels, or renders as many")
{
    const Workplace place;
    writePlain(place, 2600, 1640);
    for (const char* name : { "plain.exr", "plain.png" }) {
        const Outcome refused = place.run({ "compare", name, name, "--metric", "rmse" });
        CHECK(refused.status == 1);
        CHECK(contains(
            refused.err, std::string(name) + ": use a smaller image, or allow as many pixels with --max-pixels"));
        CHECK(place.run({ "compare", name, name, "--metric", "rmse", "--max-pixels", "4264000" }).out == "0\n");
        CHECK(place.run({ "compare", name, name, "--metric", "rmse", "--max-pixels", "4263999" }).status == 1);
    }
    CHECK(place.run({ "compare", "plain.exr", "plain.exr", "--max-pixels", "0" }).status == 2);
    const std::vector<std::string> call = { "render", box, "--method", "mc", "--spp", "1", "--crop", "0,0,16,16",
        "--reference", "plain.exr", "-o", "b.exr", "--size" };
    const auto sized = [&](const std::string& size) {
        std::vector<std::string> all = call;
        all.push_back(size);
        return place.run(all);
    };
    CHECK(sized("2600x1640").status == 0);
    const Outcome other = sized("64x64");
    CHECK(other.status == 1);
    CHECK(contains(other.err, "plain.exr: give one of the frame's size"));
}

} // namespace
} // namespace wedge::app::test
