#include "tests/hostile/row.h"

namespace wedge::hostile {
namespace {

Row wrong(const std::string& name, const Arguments& call, const std::string& says = "")
{
    return { .name = "call: " + name, .call = call, .ending = Ending::WrongCall, .says = says };
}

void add(Rows& rows, const Rows& more) { rows.insert(rows.end(), more.begin(), more.end()); }

const std::string escape = "\x1b[31mred\x1b[0m";
const std::string rightToLeft = "\xe2\x80\xae";
const std::string longName(100'000, 'n'); // of one argument Linux takes up to 128 KiB

const std::vector<std::string> renderOptions = { "--output", "-o", "--size", "--crop", "--layers", "--exposure",
    "--view", "--reference", "--report", "--integrator", "--bounces", "--ao-distance", "--aperture", "--focus",
    "--method", "--spp", "--max-spp", "--mu", "--seed", "--device", "--traversal", "--bvh", "--time-limit",
    "--memory-limit", "--kernel-dir", "--target-error", "--sampling", "--filter", "--filter-width", "--falloff",
    "--sampler", "--counts", "--light-sampling", "--environment-sampling", "--environment-widths", "--shadows",
    "--shadow-lights", "--shadow-complete", "--shadow-clamp" };

/// Options without a value, or with the next option in its place.
Rows missingValues()
{
    Rows rows;
    for (const std::string& option : renderOptions) {
        const std::string says = "option has no value";
        rows.push_back(wrong(option + " ''", { "render", scene, option, "" }, says));
        rows.push_back(wrong(option + " --quiet", { "render", scene, option, "--quiet" }, says));
        rows.push_back(wrong(option + " last", { "render", scene, option }, says));
        if (option.starts_with("--")) {
            rows.push_back(wrong(option + "= --quiet", { "render", scene, option + "=", "--quiet" }, says));
            rows.push_back(wrong(option + "=--quiet", { "render", scene, option + "=--quiet" }, says));
        }
    }
    add(rows,
        { wrong("--error-map=", { "compare", "a.exr", "b.exr", "--error-map=" }, "no value"),
            wrong("--metric= --json", { "compare", "a.exr", "b.exr", "--metric=", "--json" }, "no value"),
            wrong("--metric --json", { "compare", "a.exr", "b.exr", "--metric", "--json" }, "no value"),
            wrong("--bvh= --json", { "info", scene, "--bvh=", "--json" }, "no value"),
            wrong("--report --", { "render", "--report", "--", scene }, "no value"),
            wrong("no scene", { "render", "" }, "(empty)"), wrong("no image", { "compare", "", "" }, "(empty)"),
            wrong("no scene to tell of", { "info", "" }, "(empty)"),
            wrong("no scene after --", { "render", "--", "" }, "(empty)") });
    return rows;
}

Rows oddNumbers()
{
    Rows rows;
    const std::vector<std::string> numbers = { "1e999", "-1e999", "nan", "inf", "0x10", "\xef\xbc\x91", "1 ", " 1",
        "+1", "1,5", "1e", "--1", "-", "1\n", escape, longName, std::string(5000, '9') };
    for (const std::string option : { "--spp", "--mu", "--time-limit", "--bounces" }) {
        for (const std::string& number : numbers) {
            rows.push_back(wrong(option + " " + number.substr(0, 20), { "render", scene, option, number }, option));
        }
    }
    for (const std::string size :
        { "1x", "x1", "1x1x1", "0x0", "-1x1", "1X1", "99999999999x1", "1e1x1", "\xef\xbc\x91x1" }) {
        rows.push_back(wrong("--size " + size, { "render", scene, "--size", size }, "--size"));
    }
    for (const std::string crop : { ",,,", "0,0,1", "0,0,1,1,1", "1,1,0,0", "0,0,2147483648,1", "a,b,c,d" }) {
        rows.push_back(wrong("--crop " + crop, { "render", scene, "--crop", crop }, "--crop"));
    }
    return rows;
}

Rows names()
{
    Rows rows = { wrong("nothing", {}), wrong("an empty command", { "" }), wrong("-", { "-" }), wrong("--", { "--" }),
        wrong("---", { "---" }), wrong("a command that is none", { "paint" }),
        wrong("escapes", { escape }, "\\x1b[31m"), wrong("an option with escapes", { "--" + escape }, "\\x1b[31m"),
        wrong("a newline", { "render", scene, "a\nb" }, "a\\nb"),
        wrong("the direction of writing", { "render", scene, rightToLeft + "gnp" }, "\\xe2\\x80\\xae"),
        wrong("no UTF-8", { "render", scene, "\xff\xfe" }, "\\xff\\xfe"), wrong("a long command", { longName }),
        wrong("a long option", { "render", scene, "--" + longName }),
        wrong("a long second scene", { "render", scene, longName }), wrong("two scenes", { "render", scene, scene }),
        wrong("two commands", { "render", scene, "info", scene }),
        wrong("an option before", { "--quiet", "render", scene }),
        wrong("a flag's value", { "render", scene, "--quiet=" + longName }, "takes no value"),
        wrong("version with a value", { "--version=" }, "takes no value"), wrong("all devices", { "devices", "all" }),
        wrong("one image", { "compare", "a.exr" }, "REFERENCE"),
        wrong("three", { "compare", "a.exr", "b.exr", "c.exr" }),
        wrong("-o=", { "render", scene, "-o=a.exr" }, "-o=a.exr"), wrong("a text", { "render", scene, "-o", "a.txt" }),
        wrong("an extension alone", { "render", scene, "-o", ".exr" }),
        wrong("a mistyped option as report", { "render", scene, "--report", "--quite" }, "--quite"),
        wrong("a short option as report", { "render", scene, "--report", "-h" }, "-h"),
        wrong("- as output", { "render", scene, "-o", "-" }),
        wrong("- as report", { "render", scene, "--report", "-" }, "--report"),
        wrong("a map of text", { "compare", "a.exr", "b.exr", "--error-map", "foo.txt" }, ".png"),
        wrong("a map of EXR", { "compare", "a.exr", "b.exr", "--error-map", "map.exr" }, ".png"),
        wrong("many layers", { "render", scene, "--layers", repeated("albedo,", 10'000) }) };
    const auto failing = [&rows](const std::string& name, const Arguments& call, const std::string& says) {
        rows.push_back({ .name = "call: " + name, .call = call, .says = says });
    };
    failing("a scene named like an option", { "render", "--", "--quiet=no" }, "--quiet=no: ");
    failing("another", { "info", "--", "--json" }, "--json: ");
    failing("a long scene", { "info", longName + ".toml" }, "nnn...nnn");
    failing("a long mesh", { "info", longName + ".obj" }, "nnn...nnn");
    failing("a long image", { "compare", longName + ".png", "b.exr" }, "nnn...nnn");
    failing("a long output", { "render", scene, "-o", longName + ".exr" }, "use a shorter name");
    failing("a long report", { "render", scene, "--report", longName }, "use a shorter name");
    failing("a long kernel folder", { "render", scene, "--kernel-dir", longName }, "kernel folder");
    failing("a scene with escapes", { "info", escape + ".toml" }, "\\x1b[31mred");
    failing("a file as kernel folder", { "render", scene, "--kernel-dir", scene }, "kernel folder");
    failing("an image as scene", { "info", "a.png" }, "a.png");
    for (const std::string& device :
        { longName, escape, std::string("99999999999999999999"), std::string(" "), std::string(" ") + rightToLeft }) {
        rows.push_back({ .name = "call: --device " + device.substr(0, 30),
            .call = tiny({ "--device", device }),
            .says = "no such OpenCL device",
            .start = { .device = true } });
    }
    return rows;
}

Rows rightCalls()
{
    const auto right = [](const std::string& name, const Arguments& call, const std::string& made) {
        return Row { .name = "call: " + name,
            .call = call,
            .prepare = file("-x.obj", triangle),
            .ending = Ending::Done,
            .start = { .device = true },
            .makes = { made } };
    };
    return { right("a mesh named like an option", { "info", "--", "-x.obj" }, "-x.obj"),
        right("an output named like an option", tiny({ "-o", "./--odd.exr" }), "--odd.exr"),
        right("a short option with its value", tiny({ "-oa.exr" }), "a.exr"),
        right("a negative number", tiny({ "--exposure", "-1", "-o", "a.png" }), "a.png"),
        right("the last of many", tiny({ "--seed", "1", "--seed", "2", "-o", "a.exr" }), "a.exr"),
        right("a name with escapes", tiny({ "-o", escape + ".exr" }), escape + ".exr"),
        right("a report in spite of a flag", tiny({ "--report", "./--quiet", "-o", "a.exr" }), "--quiet") };
}

} // namespace

Rows callRows()
{
    Rows rows = missingValues();
    add(rows, oddNumbers());
    add(rows, names());
    add(rows, rightCalls());
    return rows;
}

} // namespace wedge::hostile
