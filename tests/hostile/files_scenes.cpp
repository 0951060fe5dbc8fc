// Scene files that are deep, long, or not what they should be.
#include "tests/hostile/row.h"

namespace wedge::hostile {
namespace {

constexpr std::size_t megabyte = 1 << 20;

/// A scene file of one mesh, which is there, and more.
Row scenes(
    const std::string& name, const std::string& text, const std::string& says = "", Ending ending = Ending::Failure)
{
    return { .name = "scene: " + name,
        .call = { "info", "s.toml" },
        .prepare =
            [=](const Folder& folder) {
                write(folder, "m.obj", triangle);
                write(folder, "passwords", "root:x:0:0:root:/root:/bin/bash\n");
                write(folder, "s.toml", text);
            },
        .ending = ending,
        .says = says };
}

Row fine(const std::string& name, const std::string& text, const std::string& says = "")
{
    return scenes(name, text, says, Ending::Done);
}

const std::string mesh = "[[mesh]]\nfile = 'm.obj'\n";

Rows depths()
{
    Rows rows;
    for (const std::size_t depth : { 1'000, 31'000, 400'000 }) {
        const std::string many = std::to_string(depth) + " deep";
        rows.push_back(scenes("dots, " + many, repeated("a.", depth) + "a = 1\n"));
        rows.push_back(scenes("dots with spaces, " + many, repeated("a . ", depth) + "a = 1\n"));
        rows.push_back(scenes("dots of a table, " + many, "[" + repeated("a.", depth) + "a]\n"));
        rows.push_back(scenes("dots of a list, " + many, "[[" + repeated("a.", depth) + "a]]\n"));
        rows.push_back(scenes("dots in a value, " + many, "a = { " + repeated("a.", depth) + "a = 1 }\n"));
        rows.push_back(scenes("lists, " + many, "a = " + repeated("[", depth)));
        rows.push_back(scenes("lists that end, " + many, "a = " + repeated("[", depth) + repeated("]", depth) + "\n"));
        rows.push_back(scenes("tables, " + many, "a = " + repeated("{ a = ", depth)));
        rows.push_back(scenes("both, " + many, "a = " + repeated("[{ a = ", depth)));
        rows.push_back(scenes("dots in a mesh, " + many, mesh + repeated("a.", depth) + "a = 1\n"));
    }
    return rows;
}

Rows lengths()
{
    const std::string hundredThousand(100'000, 'n');
    return { scenes("a key of 5 MB", std::string(5 * megabyte, 'k') + " = 1\n"),
        scenes("a key of 5 MB in a section", "[camera]\n" + std::string(5 * megabyte, 'k') + " = 1\n"),
        scenes("a section of 5 MB", "[" + std::string(5 * megabyte, 'k') + "]\n"),
        scenes("a text of 5 MB", "[[mesh]]\nfile = '" + std::string(5 * megabyte, 'f') + ".obj'\n"),
        scenes("a line of 5 MB that is nothing", std::string(5 * megabyte, '!')),
        scenes("a name of 5 MB", "[[mesh]]\nfile = 'm.obj'\nmaterial = '" + std::string(5 * megabyte, 'm') + "'\n"),
        scenes("two long names",
            "[[material]]\nname = '" + hundredThousand + "'\n[[mesh]]\nfile = 'm.obj'\nmaterial = '" + hundredThousand
                + "x'\n"),
        scenes("a long name and a long key", "[[material]]\nname = 'a'\n" + hundredThousand + " = 1\n"),
        scenes("many materials and one that is missing",
            [] {
                std::string text;
                for (int i = 0; i < 20'000; ++i)
                    text += "[[material]]\nname = 'material" + std::to_string(i) + "'\n";
                return text + "[[mesh]]\nfile = 'm.obj'\nmaterial = 'materiel'\n";
            }()),
        scenes("20,000 keys",
            [] {
                std::string text;
                for (int i = 0; i < 20'000; ++i)
                    text += "k" + std::to_string(i) + " = 1\n";
                return text;
            }()),
        scenes("20,000 sections",
            [] {
                std::string text;
                for (int i = 0; i < 20'000; ++i)
                    text += "[s" + std::to_string(i) + "]\n";
                return text;
            }()),
        fine("a comment of 5 MB", "#" + std::string(5 * megabyte, 'c') + "\n" + mesh),
        fine("a million empty lines", std::string(megabyte, '\n') + mesh),
        scenes("a number of 100,000 digits", "[image]\nwidth = " + std::string(100'000, '9') + "\n"),
        scenes("a fraction of 100,000 digits", "[camera]\nfov = 0." + std::string(100'000, '9') + "e99999\n"),
        fine("2,000 warnings",
            repeated(
                "[[light]]\ntype = 'quad'\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [1, 0, 1]\nradiance = 1\n",
                2'000)
                + mesh,
            "right angles"),
        scenes("meshes that are missing", repeated("[[mesh]]\nfile = 'gone.obj'\n", 20'000), "gone.obj"),
        fine("one mesh 2,000 times", repeated(mesh, 2'000)),
        scenes("a list of 100,000 numbers", "[camera]\neye = [" + repeated("1,", 100'000) + "1]\n") };
}

Rows escapes()
{
    return { scenes("a key with escapes", "\"\\u001b[31mred\" = 1\n", "\\x1b[31m"),
        scenes("a section with escapes", "[\"\\u001b]0;title\\u0007\"]\n", "\\x1b]0;title\\x07"),
        scenes("a key with a newline", "\"a\\nwedge: error: another\" = 1\n", "\\n"),
        scenes("a key of a section with escapes", "[image]\n\"\\u001b[2J\" = 1\n", "\\x1b[2J"),
        scenes("a key that turns the writing", "\"\\u202egnp.a\" = 1\n", "\\xe2\\x80\\xae"),
        scenes("a key of C1 controls", "\"\\u009b31m\" = 1\n", "\\xc2\\x9b"),
        scenes("a value with escapes", "[integrator]\nmethod = \"\\u001b[31m\"\n", "\\x1b[31m"),
        scenes("a file with escapes", "[[mesh]]\nfile = \"\\u001b[31m.obj\"\n", "\\x1b[31m"),
        scenes("a material with escapes", "[[mesh]]\nfile = 'm.obj'\nmaterial = \"\\u001b[31m\"\n", "\\x1b[31m"),
        fine("a mesh with escapes", mesh + "name = \"\\u001b[31m\"\n"),
        fine("a mesh named by two lines", mesh + "name = \"a\\nb\"\n"), scenes("a raw escape", "\x1b[31m = 1\n"),
        scenes("bytes that are no UTF-8", "\xff\xfe = 1\n"), scenes("a NUL", std::string("a\0b = 1\n", 8)),
        scenes("all NUL", std::string(100'000, '\0')), scenes("half a character", "name = '\xe2\x80"),
        scenes("a surrogate", "\"\\ud800\" = 1\n"), fine("a byte order mark", "\xef\xbb\xbf" + mesh),
        scenes("UTF-16", std::string("\xff\xfe[\0a\0]\0", 8)) };
}

Rows values()
{
    Rows rows = { scenes("an equals sign", "="), scenes("a bracket", "["), scenes("an open text", "a = \"abc"),
        scenes("an open long text", "a = \"\"\"abc"), scenes("the same key twice", "[image]\nwidth = 1\nwidth = 2\n"),
        scenes("the same section twice", "[camera]\n[camera]\n"), scenes("a section that is a value", "camera = 1\n"),
        scenes("a section that is a list", "camera = []\n"),
        fine("a list that is a section", "[mesh]\nfile = 'm.obj'\n"),
        scenes("a mesh that is a number", "mesh = [1, 2]\n"), scenes("no file", "[[mesh]]\n"),
        scenes("an empty file name", "[[mesh]]\nfile = ''\n"), scenes("the folder itself", "[[mesh]]\nfile = '.'\n"),
        scenes("a device as mesh", "[[mesh]]\nfile = '/dev/zero'\n"),
        scenes("a scene as mesh", "[[mesh]]\nfile = 's.toml'\n"),
        scenes("passwords as library", mesh + "mtl = 'passwords'\n", "", Ending::DoneOrFailure),
        scenes("a megabyte of quotes", "a = " + std::string(megabyte, '"')),
        scenes("a megabyte of triples of quotes", repeated("'\''", megabyte / 3)),
        scenes("a megabyte of empty strings", "a = [" + repeated("'',", megabyte / 3) + "]\n", "unknown key"),
        scenes("a variable that is not set", "[[mesh]]\nfile = '${WEDGE_NOT_SET}/m.obj'\n", "WEDGE_NOT_SET"),
        scenes("a variable without end", "[[mesh]]\nfile = '${WEDGE'\n"),
        scenes("a variable without name", "[[mesh]]\nfile = '${}'\n"),
        scenes("many variables", "[[mesh]]\nfile = '" + repeated("${PATH}", 140'000) + "'\n", "path is too long"),
        scenes("a path with a zero byte", "[[mesh]]\nfile = \"m.obj\\u0000.png\"\n", "path has a byte of value 0"),
        scenes("a shape of another mesh",
            "[shutter]\nclose = 1\n" + mesh
                + "shape = [{ time = 0, file = 'm.obj' }, { time = 1, file = 's.toml' }]\n"),
        scenes("keys that do not ascend", "[shutter]\nclose = 1\n" + mesh + "key = [{ time = 1 }, { time = 0 }]\n"),
        scenes("a shutter inside out", "[shutter]\nopen = 1\nclose = 0\n" + mesh) };
    for (const std::string width :
        { "0", "-1", "1000000000", "9223372036854775807", "1.5", "true", "'8'", "[8]", "1979-05-27", "nan" }) {
        rows.push_back(scenes("width = " + width, "[image]\nwidth = " + width + "\n" + mesh, "width"));
    }
    for (const std::string eye : { "[]", "[0, 1]", "[0, 1, 2, 3]", "[nan, 0, 0]", "[inf, 0, 0]", "[1e300, 0, 0]",
             "['a', 0, 0]", "1", "{ x = 1 }" }) {
        rows.push_back(scenes("eye = " + eye, "[camera]\neye = " + eye + "\nlook_at = [0, 0, 0]\n" + mesh, "eye"));
    }
    for (const std::string transform : { "{ scale = 0 }", "{ scale = nan }", "{ rotate = [0, 0, 0, 1] }",
             "{ matrix = [1] }", "{ translate = [1e300, 0, 0] }", "{ twist = 1 }", "{}", "1", "[[]]" }) {
        rows.push_back(scenes("transform = " + transform, mesh + "transform = " + transform + "\n", "",
            transform == "{}" ? Ending::DoneOrFailure : Ending::Failure));
    }
    return rows;
}

} // namespace

Rows sceneRows()
{
    Rows rows = depths();
    for (const Rows& more : { lengths(), escapes(), values() }) {
        rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
}

} // namespace wedge::hostile
