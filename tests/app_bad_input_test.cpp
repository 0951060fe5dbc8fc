// Wrong calls and broken input: one clear line that names the value, the right exit status, no file left behind.
#include "tests/app_testing.h"

#include <cmath>

namespace wedge::app::test {
namespace {

TEST_CASE("wrong calls")
{
    const Workplace place;
    checkRefused(place, {}, wrongCall, "render, compare, devices, info");
    checkRefused(place, { "paint" }, wrongCall, "paint");
    checkRefused(place, { "--bogus" }, wrongCall, "--bogus");
    checkRefused(place, { "render" }, wrongCall, "SCENE");
    checkRefused(place, { "compare", "a.exr" }, wrongCall, "REFERENCE");
    checkRefused(place, { "compare", "a.exr", "b.exr", "--metric", "beauty" }, wrongCall, "beauty");
    checkRefused(place, { "devices", "all" }, wrongCall, "all");
    checkRefused(place, { "info" }, wrongCall, "SCENE");
    checkRenderRefused(place, box, { "--bogus", "3" }, wrongCall, "--bogus");
    checkRenderRefused(place, box, { "other.toml" }, wrongCall, "other.toml");
    checkRenderRefused(place, box, { "--quiet", "--verbose" }, wrongCall, "--verbose");
    checkRenderRefused(place, box, { "--device", "cpu", "--device", "gpu" }, wrongCall, "gpu");
    checkRenderRefused(place, box, { "-o", "a.exr" }, wrongCall, "a.exr");
    checkRenderRefused(place, box, { "--report", "a.exr" }, wrongCall, "a.exr");
    checkRenderRefused(place, box, { "--spp" }, wrongCall, "--spp");
}

TEST_CASE("options that take no value are not given one")
{
    const Workplace place;
    for (const std::string flag : { "--antialias", "--no-antialias", "--as-published", "--progressive",
             "--check-launches", "--fast-math", "--quiet", "--verbose", "--help" }) {
        for (const std::string value : { "no", "yes", "false", "true", "0", "1", "" }) {
            std::string given = flag, told = "option takes no value: ";
            given.append("=").append(value);
            told.append(given).append(": give ").append(flag).append(" alone");
            checkRenderRefused(place, box, { given }, wrongCall, told);
        }
    }
    checkRefused(place, { "compare", "a.exr", "b.exr", "--json=no" }, wrongCall, "--json=no");
    checkRefused(place, { "info", box, "--json=no" }, wrongCall, "--json=no");
    checkRefused(place, { "devices", "--json=1" }, wrongCall, "--json=1");
    checkRefused(place, { "--version=no" }, wrongCall, "--version=no");
    checkRefused(place, { "render", "--", "--quiet=no" }, failure, "--quiet=no: "); // a scene of that name
    CHECK(place.run({ "render", box, "--quiet", "--size=8x6", "--spp=9", "-o", "a.exr" }).status == 0);
}

TEST_CASE("values out of range")
{
    const Workplace place;
    for (const char* size : { "0x0", "100000x100000", "640", "640x", "x", "640x480x3", "-4x4", "6 4x4", "1e2x4", "" }) {
        checkRenderRefused(place, box, { "--size", size }, wrongCall, *size == 0 ? "(empty)" : size);
    }
    for (const char* crop : { "0,0,0,0", "5,5,4,6", "-1,0,4,4", "0,0,4", "0,0,4,4,4", "a,0,4,4", "0,0,9999,4" }) {
        checkRenderRefused(place, box, { "--crop", crop }, wrongCall, crop);
    }
    for (const char* spp : { "0", "-3", "many", "1.5", "99999999999999999999" }) {
        checkRenderRefused(place, box, { "--spp", spp }, wrongCall, spp);
        checkRenderRefused(place, box, { "--max-spp", spp }, wrongCall, spp);
    }
    for (const char* mu : { "0", "-1", "nan", "inf", "x" }) {
        checkRenderRefused(place, box, { "--mu", mu }, wrongCall, mu);
        checkRenderRefused(place, box, { "--time-limit", mu }, wrongCall, mu);
    }
    for (const char* bounces : { "-1", "1025", "1.5", "many", "4294967297" }) {
        checkRenderRefused(place, box, { "--bounces", bounces }, wrongCall, bounces);
    }
    for (const char* surfaces : { "0", "-1", "65537", "1.5", "all" }) {
        checkRenderRefused(place, box, { "--max-surfaces", surfaces }, wrongCall, surfaces);
    }
    checkRenderRefused(place, box, { "--max-surfaces", "64" }, wrongCall, "without mirrors and glass");
    for (const char* distance : { "0", "-1", "nan", "inf", "1e13", "1e-13", "near" }) {
        checkRenderRefused(place, box, { "--integrator", "ao", "--ao-distance", distance }, wrongCall, distance);
    }
    checkRenderRefused(place, box, { "--integrator", "ambient" }, wrongCall, "ambient");
    checkRenderRefused(place, box, { "--bounces", "1", "--light-sampling", "mis" }, wrongCall, "mis");
    checkRenderRefused(place, box, { "--seed", "4294967296" }, wrongCall, "4294967296");
    checkRenderRefused(place, box, { "--method", "saaf" }, wrongCall, "saaf");
    checkRenderRefused(place, box, { "--filter", "soft" }, wrongCall, "soft");
    checkRenderRefused(place, box, { "--traversal", "narrow" }, wrongCall, "narrow");
    checkRenderRefused(place, box, { "--bvh", "best" }, wrongCall, "best");
    checkRenderRefused(place, box, { "--layers", "albedo,colour" }, wrongCall, "colour");
    checkRenderRefused(place, box, { "--layers", "albedo,," }, wrongCall, "unknown layer");
}

TEST_CASE("options that contradict each other")
{
    const Workplace place;
    checkRenderRefused(place, box, { "--method", "mc", "--mu", "2" }, wrongCall, "--mu");
    checkRenderRefused(place, box, { "--method", "mc", "--as-published" }, wrongCall, "--as-published");
    checkRenderRefused(place, box, { "--method", "mc", "--layers", "filterWidth" }, wrongCall, "filterWidth");
    checkRenderRefused(place, box, { "--layers", "components" }, wrongCall, "not filtered by components");
    checkRenderRefused(place, box, { "--method", "maaf", "--layers", "components" }, wrongCall, "components");
    checkRenderRefused(place, box, { "--filter-width", "3" }, wrongCall, "--filter-width");
    checkRenderRefused(place, box, { "--as-published", "--spp", "20" }, wrongCall, "--spp 20");
    checkRenderRefused(place, box, { "--spp", "4" }, wrongCall, "4"); // the first pass alone takes 9
    const std::string alone = "option has no effect with method aaf: ";
    checkRenderRefused(place, box, { "--maaf", "printed" }, wrongCall, alone + "--maaf: leave it out, or choose");
    checkRenderRefused(place, box, { "--components", "3" }, wrongCall, alone + "--components: leave it out, or choose");
    checkRenderRefused(place, box, { "--method", "mc", "--maaf", "printed" }, wrongCall, "with method mc: --maaf");
    const auto several = [&](const Arguments& more, const std::string& said) {
        Arguments all { "--method", "maaf" };
        all.insert(all.end(), more.begin(), more.end());
        checkRenderRefused(place, box, all, wrongCall, said);
    };
    several({ "--components", "5" }, "with --maaf two-slope, whose filter is one: --components 5: leave it out, or");
    several({ "--maaf", "two-slope", "--components", "3" }, "--components 3: leave it out, or choose --maaf refitted");
    several({ "--maaf", "refitted", "--components", "4" }, "4");
    several({ "--maaf", "three-slope" }, "three-slope");
    for (const char* option : { "--as-published", "--filter none", "--filter fixed", "--falloff inside" }) {
        const std::string text = option;
        const std::size_t space = text.find(' ');
        several(space == std::string::npos ? Arguments { text }
                                           : Arguments { text.substr(0, space), text.substr(space + 1) },
            "option does not go with method maaf: " + text + ": leave it out, or choose --method aaf");
    }
    checkRefused(place, { "render", box, "-o", "a.png", "--layers", "albedo" }, wrongCall, "albedo");
    checkRefused(place, { "render", box, "-o", "a.jpeg" }, wrongCall, "a.jpeg");
}

TEST_CASE("filters of maaf that no light of a frame has are refused where they are named")
{
    const Workplace place;
    const auto scene = [&](const std::string& name, const std::string& lights, const std::string& more = "") {
        place.write(name,
            "[image]\nwidth = 8\nheight = 6\n" + camera + more + quad + "material = \"m\"\n" + lights
                + "[[material]]\nname = \"m\"\n");
    };
    scene("lamp.toml", light);
    scene("point.toml", "[[light]]\ntype = \"point\"\nposition = [0, 3, 0]\nintensity = 1\n");
    scene("narrow.toml", light + "cut = 1\n");
    scene("wide.toml", light + "cut = 3\n");
    scene("lens.toml", light, "aperture = 0.1\n");
    const auto refused = [&](const std::string& file, const Arguments& more, const std::string& said) {
        Arguments all { "--method", "maaf" };
        all.insert(all.end(), more.begin(), more.end());
        checkRenderRefused(place, file, all, wrongCall, "option has no effect " + said);
        // Without naming any, the frame is one of method aaf.
        all = { "render", file, "--quiet", "--method", "maaf", "--size", "8x6", "-o", "a.exr" };
        const auto isOption = [](const std::string& text) { return text == "--maaf" || text == "--components"; };
        for (std::size_t i = 0; i < more.size(); ++i) {
            if (isOption(more[i])) {
                ++i;
            } else {
                all.push_back(more[i]);
            }
        }
        const Outcome outcome = place.run(all);
        CHECK_MESSAGE(outcome.status == 0, outcome.err);
    };
    const std::string distributed = "with method maaf through a lens or shutter, or with antialiasing: --maaf ",
                      gaussian = "without a Gaussian area light that is cut at 1.5 ";
    refused("lamp.toml", { "--maaf", "two-slope", "--antialias" },
        distributed + "two-slope: leave it out, or render through a pinhole");
    refused("lamp.toml", { "--maaf", "refitted", "--components", "3", "--aperture", "0.1" }, distributed + "refitted");
    refused("lens.toml", { "--maaf", "printed" }, distributed + "printed");
    refused("lamp.toml", { "--maaf", "two-slope", "--progressive", "--spp", "32" },
        "with --progressive: --maaf two-slope: leave it out, or render in one step");
    refused("lamp.toml", { "--maaf", "two-slope", "--integrator", "ao" },
        "with integrator ao: --maaf two-slope: leave it out, or add --integrator path");
    refused(box, { "--maaf", "two-slope" },
        gaussian + "deviations or beyond: --maaf two-slope: leave it out, or give the scene such a light");
    refused(
        "point.toml", { "--maaf", "printed" }, gaussian + "to 2.5 deviations: --maaf printed: leave it out, or give");
    refused("narrow.toml", { "--maaf", "two-slope" }, gaussian + "deviations or beyond: --maaf two-slope");
    refused("wide.toml", { "--maaf", "refitted", "--components", "7" },
        gaussian + "to 2.5 deviations: --maaf refitted: leave it out, or choose --maaf two-slope");
    for (const Arguments& fine : { Arguments { "lamp.toml", "--maaf", "printed", "--components", "3" },
             Arguments { "wide.toml", "--maaf", "two-slope" } }) {
        Arguments all { "render", "--quiet", "--method", "maaf", "--size", "8x6", "-o", "a.exr" };
        all.insert(all.end(), fine.begin(), fine.end());
        const Outcome outcome = place.run(all);
        CHECK_MESSAGE(outcome.status == 0, outcome.err);
    }
}

TEST_CASE("sample counts that contradict each other, and those of a scene file")
{
    const Workplace place;
    const auto file = [&](const std::string& name, const std::string& integrator) {
        place.write(name,
            "[image]\nwidth = 8\nheight = 6\n" + camera + quad + "material = \"m\"\n" + light
                + "[[material]]\nname = \"m\"\n[integrator]\n" + integrator);
    };
    file("many.toml", "spp = 1048577\n");
    file("mu.toml", "mu = 0.001\n");
    file("few.toml", "spp = 8\n");
    file("fewest.toml", "max_spp = 8\n");
    file("crossed.toml", "spp = 30\nmax_spp = 20\n");
    file("mean.toml", "spp = 30\n");
    file("most.toml", "max_spp = 20\n");
    file("direct.toml", "spp = 12\n");
    file("bounce.toml", "spp = 12\nbounces = 1\n");
    file("open.toml", "max_spp = 12\ntype = \"ao\"\n");
    checkRenderRefused(place, box, { "--spp", "40", "--max-spp", "20" }, wrongCall, "--max-spp 20 and --spp 40");
    checkRenderRefused(place, box, { "--max-spp", "4" }, wrongCall, "4");
    for (const char* command : { "render", "info" }) {
        checkRefused(place, { command, "many.toml" }, failure, "many.toml:19:7");
        checkRefused(place, { command, "mu.toml" }, failure, "mu.toml:19:6");
        checkRefused(place, { command, "crossed.toml" }, failure, "crossed.toml:20:11");
        checkRefused(place, { command, "few.toml" }, failure, "scene file few.toml: spp is too low for method aaf: 8");
        checkRefused(place, { command, "fewest.toml" }, failure, "scene file fewest.toml: max_spp is too low");
        checkRefused(place, { command, "bounce.toml" }, failure,
            "spp is too low for method aaf: 12: give 16 or more, or method mc");
        checkRefused(place, { command, "open.toml" }, failure, "max_spp is too low for method aaf: 12: give 16");
    }
    checkRenderRefused(
        place, "mean.toml", { "--max-spp", "20" }, wrongCall, "--max-spp 20 and the scene file's spp 30");
    checkRenderRefused(place, "most.toml", { "--spp", "30" }, wrongCall, "the scene file's max_spp 20 and --spp 30");
    checkRenderRefused(place, "direct.toml", { "--bounces", "1" }, failure, "direct.toml: spp is too low");
    checkRenderRefused(place, box, { "--bounces", "1", "--spp", "12" }, wrongCall, "16 or more");
    checkRenderRefused(place, box, { "--method", "maaf", "--spp", "8" }, wrongCall, "too few for method maaf: --spp 8");
    checkRenderRefused(place, "few.toml", { "--method", "maaf" }, failure, "spp is too low for method maaf: 8");
    checkRenderRefused(place, "few.toml", { "--as-published", "--sampling", "uniform" }, failure, "few.toml");
    // What is overridden or has no effect is not refused.
    const std::vector<Arguments> fine = { { "few.toml", "--as-published" }, { "few.toml", "--spp", "9" },
        { "few.toml", "--method", "mc" }, { "fewest.toml", "--method", "mc" }, { "fewest.toml", "--max-spp", "50" },
        { "mean.toml", "--as-published", "--max-spp", "20" }, { "most.toml", "--spp", "20" }, { "direct.toml" },
        { "bounce.toml", "--bounces", "0" }, { "bounce.toml", "--method", "mc" },
        { "open.toml", "--integrator", "path" }, { "bounce.toml", "--spp", "16" } };
    for (const Arguments& call : fine) {
        CAPTURE(call[0]);
        Arguments arguments = { "render", "--quiet", "-o", "a.exr" };
        arguments.insert(arguments.end(), call.begin(), call.end());
        const Outcome outcome = place.run(arguments);
        CHECK_MESSAGE(outcome.status == 0, outcome.err);
    }
}

TEST_CASE("scenes that cannot be read")
{
    const Workplace place;
    std::string binary("\x7f"
                       "ELF\0\1\2\3",
        8);
    binary += std::string(3000, '\xfe');
    place.write("binary.toml", binary);
    place.write("binary.obj", binary);
    place.write("key.toml", camera + "[sky]\ncolour = 1\n");
    place.write("nested.toml", "[camera]\neye = [0, 1, 3]\nlook_at = [0, 0, 0]\nzoom = 4\n");
    place.write("cut.toml", "[camera]\neye = [0, 1,");
    place.write("nomesh.toml", camera + "[[mesh]]\nfile = \"gone.obj\"\n" + light);
    place.write("flat.toml",
        camera + quad
            + "[[light]]\ntype = \"quad\"\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [2, 0, 0]\nradiance = 1\n");
    place.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    place.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    place.write("scene.txt", "a scene");
    for (const char* command : { "render", "info" }) {
        checkRefused(place, { command, "missing.toml" }, failure, "missing.toml");
        checkRefused(place, { command, "missing.obj" }, failure, "missing.obj");
        checkRefused(place, { command, "." }, failure, ".");
        checkRefused(place, { command, "scene.txt" }, failure, "scene.txt");
        checkRefused(place, { command, "binary.toml" }, failure, "binary.toml");
        checkRefused(place, { command, "binary.obj" }, failure, "binary.obj");
        checkRefused(place, { command, "key.toml" }, failure, "sky");
        checkRefused(place, { command, "key.toml" }, failure, "key.toml:4:");
        checkRefused(place, { command, "nested.toml" }, failure, "nested.toml:4:1");
        checkRefused(place, { command, "cut.toml" }, failure, "cut.toml:2:");
        checkRefused(place, { command, "nomesh.toml" }, failure, "gone.obj");
        checkRefused(place, { command, "flat.toml" }, failure, "[2, 0, 0]");
        checkRefused(place, { command, "index.obj" }, failure, "index.obj:4");
        checkRefused(place, { command, "nan.obj" }, failure, "nan.obj:2");
    }
}

TEST_CASE("outputs that cannot be written are refused before the scene is read")
{
    const Workplace place;
    std::filesystem::create_directory(place.path() / "folder.exr");
    const std::string scene = "missing.toml";
    checkRefused(place, { "render", scene, "-o", "gone/a.exr" }, failure, "gone/a.exr");
    checkRefused(place, { "render", scene, "-o", "folder.exr" }, failure, "folder.exr");
    checkRefused(place, { "render", scene, "-o", "" }, wrongCall, "empty");
    checkRefused(place, { "render", scene, "--report", "gone/r.json" }, failure, "gone/r.json");
    checkRefused(place, { "compare", "a.exr", "b.exr", "--error-map", "gone/m.png" }, failure, "gone/m.png");
    // The superuser may write anywhere except where there is no file system to write to.
    checkRefused(place, { "render", scene, "-o", "/proc/a.exr" }, failure, "/proc/a.exr");
    if (geteuid() != 0) {
        std::filesystem::permissions(
            place.path(), std::filesystem::perms::owner_write, std::filesystem::perm_options::remove);
        checkRefused(place, { "render", scene, "-o", "a.exr" }, failure, "a.exr");
    }
}

TEST_CASE("devices and memory")
{
    const Workplace place;
    checkRenderRefused(place, box, { "--device", "abacus" }, failure, "abacus");
    checkRenderRefused(place, box, { "--device", "999" }, failure, "999");
    checkRenderRefused(place, box, { "--memory-limit", "1" }, failure, "1.0 MiB");
    checkRenderRefused(place, box, { "--size", "32768x32768" }, failure, "MiB");
    checkRenderRefused(place, box, { "--kernel-dir", "gone" }, failure, "gone");
    setenv("OCL_ICD_VENDORS", "/nowhere", 1);
    checkRenderRefused(place, box, {}, failure, "none found");
    checkRefused(place, { "devices" }, failure, "none found");
    unsetenv("OCL_ICD_VENDORS");
}

TEST_CASE("references that do not fit")
{
    const Workplace place;
    const Outcome made =
        place.run({ "render", box, "--quiet", "--size", "16x12", "--method", "mc", "--spp", "1", "-o", "ref.exr" });
    REQUIRE_MESSAGE(made.status == 0, made.err);
    place.write("broken.exr", "\x76\x2f\x31\x01 and no more");
    place.write("ref.txt", "an image");
    checkRenderRefused(place, box, { "--size", "20x12", "--reference", "ref.exr" }, failure, "16x12 and 20x12");
    checkRenderRefused(place, box, { "--reference", "gone.exr" }, failure, "gone.exr");
    checkRenderRefused(place, box, { "--reference", "broken.exr" }, failure, "broken.exr");
    checkRenderRefused(place, box, { "--reference", "ref.txt" }, failure, "ref.txt");
    checkRefused(place, { "compare", "ref.exr", "gone.exr" }, failure, "gone.exr");
    const Outcome small =
        place.run({ "render", box, "--quiet", "--size", "8x8", "--method", "mc", "--spp", "1", "-o", "small.exr" });
    REQUIRE(small.status == 0);
    checkRefused(place, { "compare", "ref.exr", "small.exr" }, failure, "16x12 and 8x8");
    // A crop is compared with its part of a full reference, or with a reference of its own size.
    for (const char* reference : { "ref.exr", "small.exr" }) {
        const Outcome crop = place.run({ "render", box, "--quiet", "--size", "16x12", "--crop", "4,2,12,10", "--method",
            "mc", "--spp", "1", "--reference", reference, "-o", "crop.exr" });
        CHECK_MESSAGE(crop.status == 0, crop.err);
    }
}

TEST_CASE("a kernel that does not compile is one line of ours, whatever the driver says itself")
{
    const Workplace place;
    std::filesystem::create_directory(place.path() / "frame");
    place.write("frame/primary.cl", "__kernel void primary(int a) { return nonsense; }\n");
    const Outcome outcome = place.run({ "render", box, "--kernel-dir", ".", "-o", "a.exr" });
    CHECK(outcome.status == failure);
    const std::size_t line = outcome.err.rfind("wedge: error: ");
    REQUIRE(line != std::string::npos);
    CHECK(contains(outcome.err.substr(line), "frame/primary.cl"));
    CHECK(outcome.err.find('\n', line) == outcome.err.size() - 1);
    CHECK_FALSE(place.has("a.exr"));
}

TEST_CASE("unusual scenes render")
{
    const Workplace place;
    place.write("wall.toml", "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\n" + quad + light); // eye on the surface
    place.write("empty.toml", camera + "[background]\nradiance = 2\n");
    place.write("dark.toml", camera + quad);
    place.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const std::string scene : { "wall.toml", "empty.toml", "dark.toml", "mesh.obj" }) {
        for (const Arguments& method :
            { Arguments { "--method", "mc", "--spp", "2" }, { "--method", "aaf" }, { "--as-published" } }) {
            CAPTURE(scene);
            Arguments arguments = { "render", scene, "--quiet", "--size", "17x5", "--layers", "all", "-o", "u.exr" };
            arguments.insert(arguments.end(), method.begin(), method.end());
            const Outcome outcome = place.run(arguments);
            REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
            const image::LayeredImage image = place.exr("u.exr");
            for (const char* channel : { "R", "G", "B" }) {
                CHECK(std::ranges::all_of(values(image, channel), [](float v) { return std::isfinite(v) && v >= 0; }));
            }
        }
    }
    const Outcome one = place.run({ "render", box, "--quiet", "--size", "1x1", "-o", "one.exr" });
    CHECK_MESSAGE(one.status == 0, one.err);
    const Outcome warned = place.run({ "render", "empty.toml", "--size", "4x4", "-o", "e.exr" });
    CHECK(contains(warned.err, "wedge: warning: "));
    CHECK(values(place.exr("e.exr"), "G").front() == 2.0f);
}

} // namespace
} // namespace wedge::app::test
