// Meshes and material libraries that are long, deep, or not what they should be.
#include "tests/hostile/row.h"

#include <cmath>

namespace wedge::hostile {
namespace {

constexpr std::size_t megabyte = 1 << 20;

Row meshes(
    const std::string& name, const std::string& text, const std::string& says = "", Ending ending = Ending::Failure)
{
    return { .name = "mesh: " + name,
        .call = { "info", "m.obj" },
        .prepare = file("m.obj", text),
        .ending = ending,
        .says = says };
}

Row fine(const std::string& name, const std::string& text, const std::string& says = "")
{
    return meshes(name, text, says, Ending::Done);
}

/// A triangle whose material is in a library.
Row libraries(
    const std::string& name, const std::string& text, const std::string& says = "", Ending ending = Ending::Done)
{
    return { .name = "library: " + name,
        .call = { "info", "m.obj" },
        .prepare =
            [=](const Folder& folder) {
                write(folder, "m.obj", "mtllib m.mtl\nusemtl m\n" + triangle);
                write(folder, "m.mtl", text);
            },
        .ending = ending,
        .says = says };
}

std::string circle(std::size_t corners)
{
    constexpr double turn = 6.283185307179586;
    std::string text;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = turn * static_cast<double>(i) / static_cast<double>(corners);
        text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    }
    return text;
}

std::string polygon(std::size_t corners)
{
    std::string text = "f";
    for (std::size_t i = 1; i <= corners; ++i) {
        text += " " + std::to_string(i);
    }
    return text + "\n";
}

/// Names with a number each.
std::string numbered(const std::string& before, std::size_t times, const std::string& after)
{
    std::string text;
    for (std::size_t i = 0; i < times; ++i) {
        text += before + std::to_string(i) + after;
    }
    return text;
}

Rows lengths()
{
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    return { fine("one face of 9,999 corners", circle(9'999) + polygon(9'999)),
        fine("faces of 9,999 corners", circle(9'999) + repeated(polygon(9'999), 15)),
        meshes("a face of 100,000 corners on a line",
            "v 0 0 0\nv 1 0 0\nv 2 0 0\nf" + repeated(" 1 2 3", 33'333) + "\nf 1 2 3\n", "", Ending::DoneOrFailure),
        meshes("a face of one corner, 100,000 times", "v 0 0 0\nf" + repeated(" 1", 100'000) + "\n", "",
            Ending::DoneOrFailure),
        fine("20,000 materials that are missing", three + numbered("usemtl m", 20'000, "\nf 1 2 3\n"), "not found"),
        fine(
            "one material that is missing, 20,000 times", three + repeated("usemtl m\nf 1 2 3\n", 20'000), "not found"),
        fine("a byte order mark", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        fine("a tiny number in full", "v 0." + std::string(400, '0') + "1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        fine("900 libraries that are missing", numbered("mtllib m", 900, ".mtl\n") + triangle, "more"),
        fine("20,000 groups", three + numbered("g g", 20'000, "\nf 1 2 3\n")),
        fine("20,000 objects", three + numbered("o o", 20'000, "\nf 1 2 3\n")),
        fine("20,000 faces of two corners", three + repeated("f 1 2\n", 20'000) + "f 1 2 3\n"),
        fine("20,000 lines and points", three + repeated("l 1 2\np 1\n", 20'000) + "f 1 2 3\n"),
        fine("a comment of 5 MB", "#" + std::string(5 * megabyte, 'c') + "\n" + triangle),
        fine("an object's name of 5 MB", "o " + std::string(5 * megabyte, 'n') + "\n" + triangle),
        fine("a material's name of 5 MB", "usemtl " + std::string(5 * megabyte, 'n') + "\n" + triangle),
        fine("a library's name of 5 MB", "mtllib " + std::string(5 * megabyte, 'n') + "\n" + triangle),
        fine("a library's name of many variables", "mtllib " + repeated("${PATH}", 140'000) + "\n" + triangle,
            "path is too long"),
        fine("a library's name of a million words", "mtllib" + repeated(" a", megabyte / 2) + "\n" + triangle),
        fine("a group of a million names", "g" + repeated(" a", megabyte / 2) + "\n" + triangle),
        fine("two long names of materials",
            "usemtl " + std::string(100'000, 'a') + "\nusemtl " + std::string(100'000, 'b') + "\n" + triangle),
        meshes("a million vertices and no face", repeated("v 0 0 0\n", megabyte)),
        fine("a million empty lines", std::string(megabyte, '\n') + triangle),
        fine("spaces of 5 MB", "v 0 0 0" + std::string(5 * megabyte, ' ') + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        meshes("a number of 100,000 digits", "v " + std::string(100'000, '9') + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "m.obj"),
        meshes("an index of 100,000 digits", three + "f 1 2 " + std::string(100'000, '9') + "\n", "m.obj") };
}

Rows wholeLibraries()
{
    const auto used = [](const std::string& name, const std::string& mesh, const std::string& library,
                          const std::string& says = "") {
        return Row { .name = "library: " + name,
            .call = { "info", "m.obj" },
            .prepare =
                [=](const Folder& folder) {
                    write(folder, "m.obj", mesh);
                    write(folder, "m.mtl", library);
                },
            .ending = Ending::Done,
            .says = says };
    };
    const std::string many = numbered("newmtl m", 5'000, "\nKd 0.5 0.5 0.5\n");
    return {
        used("the same 5,000 times in a line", "mtllib" + repeated(" m.mtl", 5'000) + "\nusemtl m1\n" + triangle, many),
        used("the same 5,000 times", repeated("mtllib m.mtl\n", 5'000) + "usemtl m1\n" + triangle, many),
        used("a texture that is missing, 5,000 times", "mtllib m.mtl\nusemtl m1\n" + triangle,
            numbered("newmtl m", 5'000, "\nmap_Kd gone.png\n")),
        used("5,000 textures that are missing", "mtllib m.mtl\nusemtl m1\n" + triangle,
            numbered("newmtl n\nmap_Kd gone", 5'000, ".png\n")),
        used("names that differ in case, 5,000", "mtllib m.mtl\n" + numbered("usemtl M", 5'000, "\n") + triangle, many)
    };
}

Rows oddLibraries()
{
    const std::string m = "newmtl m\n";
    return { libraries("empty", ""), libraries("text", "root:x:0:0:root:/root:/bin/bash\n"),
        libraries("binary",
            std::string("\x7f"
                        "ELF\0\1\2\3",
                8)
                + std::string(3000, '\xfe')),
        libraries("a long name with 100,000 faults",
            "newmtl " + std::string(450'000, 'n') + "\n" + repeated("Ns x\n", 100'000)),
        libraries("no name", "newmtl\nKd 1 1 1\n"), libraries("Kd without material", "Kd 1 1 1\n"),
        libraries("Kd nan", m + "Kd nan nan nan\n"), libraries("Kd of words", m + "Kd a b c\n"),
        libraries("Kd of a spectrum", m + "Kd spectral file.rfl 1\n"), libraries("Ns inf", m + "Ns inf\n"),
        libraries("Ns 1e999", m + "Ns 1e999\n"), libraries("map without file", m + "map_Kd\n"),
        libraries("map of options alone", m + "map_Kd -s 1 1 1\n"),
        libraries("map of 10,000 options", m + "map_Kd" + repeated(" -clamp on", 10'000) + " gone.png\n"),
        libraries("map with escapes", m + "map_Kd \x1b[31mred.png\n", "\\x1b[31m"),
        libraries("map of a device", m + "map_Kd /dev/zero\n", "/dev/zero"),
        libraries("map of the library", m + "map_Kd m.mtl\n", "m.mtl"),
        libraries("name with escapes", m + "newmtl \x1b[31mred\nKd -1 -1 -1\n", "\\x1b[31m"),
        libraries("name of 5 MB", m + "newmtl " + std::string(5 * megabyte, 'n') + "\nKd -1 -1 -1\n"),
        libraries("map of 5 MB", m + "map_Kd " + std::string(5 * megabyte, 'n') + ".png\n"),
        libraries("line of 5 MB", m + std::string(5 * megabyte, 'x') + "\n"),
        libraries("NULs", m + std::string(100'000, '\0')),
        libraries("one name 20,000 times", repeated("newmtl m\nKd 1 1 1\n", 20'000)),
        libraries(
            "two long names", "newmtl " + std::string(100'000, 'a') + "\nnewmtl " + std::string(100'000, 'b') + "\n") };
}

Rows oddMeshes()
{
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    Rows rows = { meshes("a comment alone", "# nothing\n"), meshes("text", "a mesh of a cat\n"),
        meshes("binary",
            std::string("\x7f"
                        "ELF\0\1\2\3",
                8)
                + std::string(3000, '\xfe')),
        meshes("NULs", std::string(100'000, '\0')),
        meshes("a vertex of one number", "v 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj"),
        meshes("a vertex of words", "v a b c\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj"),
        meshes("a vertex of 1e999", "v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj"),
        meshes("a vertex of nan", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj"),
        meshes("far away", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        meshes("faces without vertices", "f 1 2 3\n", "m.obj"),
        meshes("faces before vertices", "f 1 2 3\n" + three, "m.obj"),
        meshes("faces of two corners alone", three + "f 1 2\n"),
        fine("Windows' lines", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"),
        fine("no last newline", three + "f 1 2 3"),
        fine("names with escapes", "o \x1b[31mred\ng \x1b]0;title\x07\nusemtl \x1b[2J\n" + triangle, "\\x1b[2J"),
        fine("names that are no UTF-8", "o \xff\xfe\nusemtl \xff\n" + triangle),
        fine("a library that is the mesh", "mtllib m.obj\nusemtl m\n" + triangle),
        fine("a library that is a device", "mtllib /dev/zero\nusemtl m\n" + triangle),
        fine("a library that is the folder", "mtllib .\nusemtl m\n" + triangle),
        fine("a triangle without area", "v 0 0 0\nf 1 1 1\n" + three + "f 2 3 4\n"),
        fine("a normal of nan", three + "vn nan 0 0\nf 1//1 2//1 3//1\n"),
        meshes("curves alone", three + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3\nend\n") };
    for (const std::string face : { "0 1 2", "1 2 4", "1 2 -4", "1 2 99999999999", "1 2 -99999999999", "1 2 2147483648",
             "1/5 2/5 3/5", "1//5 2//5 3//5" }) {
        rows.push_back(meshes("f " + face, three + "f " + face + "\n", "m.obj"));
    }
    for (const std::string face : { "a b c", "1.5 2 3", "1/ 2/ 3/", "1// 2// 3//", "1/1/1/1 2 3", "/1 /2 /3" }) {
        rows.push_back(meshes("f " + face, three + "f " + face + "\n", "", Ending::DoneOrFailure));
    }
    return rows;
}

} // namespace

Rows meshRows()
{
    Rows rows = lengths();
    for (const Rows& more : { wholeLibraries(), oddLibraries(), oddMeshes() }) {
        rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
}

} // namespace wedge::hostile
