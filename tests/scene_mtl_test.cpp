// Material libraries: what the file says, and a word about what is left out.

#include <doctest/doctest.h>

#include <algorithm>

#include "host/scene/mtl_reader.h"
#include "scene_support.h"

using namespace scene_test;
using wedge::scene::Material;
using wedge::scene::parseMtl;
using wedge::scene::TextureSet;
using wedge::scene::Warnings;

namespace {

struct Library {
    std::vector<Material> materials;
    std::vector<std::string> warnings;
};

Library parse(const std::string& text)
{
    TextureSet textures(std::int64_t { 1 } << 20);
    Warnings warnings;
    const std::vector<Material> materials = parseMtl(text, "m.mtl", textures, warnings);
    return { materials, warnings.lines() };
}

std::string errorOfLibrary(const std::string& text)
{
    try {
        parse(text);
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_CASE("what a material does not say")
{
    const Library bare = parse("newmtl a\n");
    REQUIRE(bare.materials.size() == 1);
    CHECK(bare.materials[0].diffuse == glm::vec3(0.0f));
    CHECK(bare.materials[0].specular == glm::vec3(0.0f));
    CHECK(bare.materials[0].exponent == 1.0f);
    CHECK(bare.warnings.empty());
    // One number is a grey; a texture without a colour of its own gets 0.6.
    CHECK(parse("newmtl a\nKd 0.25\n").materials[0].diffuse == glm::vec3(0.25f));
    CHECK(parse("newmtl a\nmap_Kd none.png\n").materials[0].diffuse == glm::vec3(0.6f));
    CHECK(parse("newmtl a\nKd 0.1 0.2 0.3 # dark\nmap_Kd none.png\n").materials[0].diffuse
        == glm::vec3(0.1f, 0.2f, 0.3f));
}

TEST_CASE("names, line ends, and statements outside of materials")
{
    const Library ends = parse("Kd 1 0 0\nnewmtl  two words \r\n\tKd 0 1 0\rnewmtl\nKd 9 9 9\nnewmtl b\nKd 0 \\\n0 1");
    REQUIRE(ends.materials.size() == 2);
    CHECK(ends.materials[0].name == "two words");
    CHECK(ends.materials[0].diffuse == glm::vec3(0, 1, 0));
    CHECK(ends.materials[1].diffuse == glm::vec3(0, 0, 1));
    REQUIRE(ends.warnings.size() == 1);
    CHECK(contains(
        ends.warnings[0], "m.mtl:1: a statement before any newmtl with a name has no effect; it is the first of 2"));
    // A comment ends with its line, even where it looks as if it went on.
    CHECK(parse("newmtl a\n# C:\\textures\\\nKd 1 0 0\n").materials[0].diffuse == glm::vec3(1, 0, 0));
}

TEST_CASE("keywords of any case, and names in quotation marks")
{
    const Library l = parse("NEWMTL \"a b\"\nKD 0.1 0.2 0.3\nks 0\nke 1 2 3\nNS 7\ntr 0.25\nNi 2\nPM 0\n");
    REQUIRE(l.materials.size() == 1);
    CHECK(l.materials[0].name == "a b");
    CHECK(l.materials[0].emission == glm::vec3(1, 2, 3));
    CHECK(l.materials[0].exponent == 7.0f);
    CHECK(l.materials[0].opacity == 0.75f);
    CHECK(l.materials[0].specularModel == wedge::scene::SpecularModel::Ggx);
    CHECK(l.warnings.empty());
    for (const char* name :
        { "\"my file.png\"", "'my file.png'", "\"my file.png\" # a note", "-s 1 1 1 \"my file.png\"", "my file.png" }) {
        const Library named = parse(std::string("newmtl a\nmap_kd ") + name + "\n");
        REQUIRE(named.warnings.size() == 1);
        CHECK(contains(named.warnings[0], "texture file not found: my file.png:"));
    }
    CHECK(parse("newmtl \"a\" b\"\n").materials[0].name == "\"a\" b\""); // no pair around a name
    CHECK(parse("newmtl \"\n").materials[0].name == "\"");
}

TEST_CASE("textures without a colour of their own are seen, beside a black one they are told")
{
    const TemporaryFolder folder;
    std::filesystem::copy_file(dataFolder() + "/scenes/textures/tiles.png", folder.path("t.png"));
    const auto read = [&](const std::string& text) {
        TextureSet textures(std::int64_t { 1 } << 20);
        Warnings warnings;
        const std::vector<Material> materials = parseMtl("newmtl a\n" + text, folder.path("m.mtl"), textures, warnings);
        return Library { materials, warnings.lines() };
    };
    const Library glow = read("Kd 0.5\nmap_Ke t.png\n");
    CHECK(glow.materials[0].emission == glm::vec3(1.0f));
    CHECK(glow.materials[0].emissionTexture == 0);
    CHECK(glow.warnings.empty());
    CHECK(parse("newmtl a\nmap_Ke none.png\n").materials[0].emission == glm::vec3(0.0f)); // nothing glows by mistake
    const Library shine = read("Kd 0.25 0.5 0\nNs 20\nmap_Ks t.png\n");
    CHECK(shine.materials[0].specular == glm::vec3(0.5f)); // as much as the diffuse part leaves
    CHECK(shine.materials[0].specularTexture == 0);
    CHECK(shine.warnings.empty());
    const auto told = [&](const std::string& text, const std::string& what) {
        const Library l = read(text);
        return l.warnings.size() == 1 && contains(l.warnings[0], what + " has no effect here");
    };
    CHECK(told("Kd 1\nmap_Ks t.png\n", "a map_Ks beside a white Kd"));
    CHECK(told("Kd 0.5\nKs 0 0 0\nmap_Ks t.png\n", "a map_Ks beside a black Ks"));
    CHECK(told("Kd 0.5\nKe 0 0 0\nmap_Ke t.png\n", "a map_Ke beside a black Ke"));
    CHECK(told("Kd 0.5\nmap_Ns t.png\n", "a map_Ns without Ks"));
    CHECK(told("Kd 0.5\nPr 0.5\nKs 0\nmap_Ks t.png\n", "Ks and its textures beside Pr, Pm or map_Pr"));
    CHECK(told("Kd 0.5\nPr 0.5\nKs 0.5\nNs 20\n", "Ks and its textures beside Pr, Pm or map_Pr"));
    CHECK(read("Kd 0.5\nPr 0.5\nKs 0\nNs 20\n").warnings.empty());
    CHECK(read("Kd 0.5\nKs 0.2\nmap_Ks t.png\nmap_Ns t.png\n").warnings.empty());
}

TEST_CASE("colours as CIE XYZ, and as spectra")
{
    const Library white = parse("newmtl a\nKd xyz 0.9505 1 1.089\nKs XYZ 0.4124 0.2126 0.0193\nKe xyz 0 0 1\n");
    for (int i = 0; i < 3; ++i)
        CHECK(white.materials[0].diffuse[i] == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(white.materials[0].specular.x == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(white.materials[0].specular.y == doctest::Approx(0.0).epsilon(1e-3));
    CHECK(parse("newmtl a\nKd xyz 0.9505 1 1.089\n").warnings.empty());
    CHECK(parse("newmtl a\nKd rgb 0.1 0.2 0.3\n").materials[0].diffuse == glm::vec3(0.1f, 0.2f, 0.3f));
    CHECK(contains(parse("newmtl a\nKd rgb 0.1 0.2 0.3\n").warnings[0], "Kd has the word rgb, which is not read"));
    CHECK(contains(parse("newmtl a\nillum abc\n").warnings[0], "illum has the value abc, 2 is used"));
    CHECK(white.materials[0].emission.x == 0.0f); // negative in Rec.709
    CHECK(white.materials[0].emission.z == doctest::Approx(1.057).epsilon(1e-3));
    CHECK(parse("newmtl a\nKd xyz 0.5\n").materials[0].diffuse.y > 0.4f); // one number stands for three
    const Library spectral = parse("newmtl a\nKd spectral f.rfl 1\nKs Spectral f.rfl\nKe spectral f.rfl\n");
    CHECK(spectral.materials[0].diffuse == glm::vec3(0.5f));
    CHECK(spectral.materials[0].specular == glm::vec3(0.0f));
    REQUIRE(spectral.warnings.size() == 3);
    CHECK(contains(spectral.warnings[0], "a spectrum (Kd spectral), in whose place is 0.5, has no effect here"));
}

TEST_CASE("values that make no sense")
{
    const Library wrong = parse("newmtl a\nKd 1 x 0\nKs nan inf -1\nNs\nKe 1e99\n");
    CHECK(wrong.materials[0].diffuse == glm::vec3(1, 0, 0));
    CHECK(wrong.materials[0].specular == glm::vec3(0));
    CHECK(wrong.materials[0].emission == glm::vec3(0));
    CHECK(wrong.materials[0].exponent == 1.0f);
    REQUIRE(wrong.warnings.size() == 6);
    CHECK(wrong.warnings[0] == "material file m.mtl: material 'a': Kd has the value x, 0 is used");
    CHECK(wrong.warnings[4] == "material file m.mtl: material 'a': Ns has no value, 1 is used");
}

TEST_CASE("what would change the look is named once a library")
{
    const Library left = parse("newmtl a\nKd 0.5\nd -halo 0.5\nillum 7\nTf 1 1 1\n"
                               "newmtl b\nTr 0.5\ndisp d.png\nrefl e.png\nPs 0.5\nPc 1\nTf 0.5 1 1\nd 0.1\n"
                               "newmtl c\nd 1\nTr 0\nillum 2\nNi 1.5\nKa 1 1 1\nmap_Ka f.png\n");
    CHECK(left.warnings.size() == 7);
    const auto says = [&](const std::string& what, int materials, const std::string& first) {
        const std::string line = "material file m.mtl: " + what + " has no effect here; " + std::to_string(materials)
            + " material(s) have it, '" + first + "' is the first";
        return std::count(left.warnings.begin(), left.warnings.end(), line);
    };
    CHECK(says("transparency by the angle of view (d -halo)", 1, "a") == 1);
    CHECK(says("displacement (disp)", 1, "b") == 1);
    CHECK(says("a reflection map (refl)", 1, "b") == 1);
    CHECK(says("sheen or clear coat (Ps, Pc)", 1, "b") == 1);
    CHECK(says("a transmission filter (Tf)", 1, "b") == 1);
    CHECK(says("an illumination model other than diffuse and highlight (illum)", 1, "a") == 1);
    CHECK(says("a map_Ka without map_Kd", 1, "c") == 1);
    // Each once, whatever it is; not what stands for light that is worked out here.
    CHECK(parse("newmtl a\nKa 0.1\nfoo 1\nFOO 2\nbar\nnewmtl b\nfoo 1\nmap_Kd a.png\nmap_Ka a.png\n").warnings.size()
        == 3);
    CHECK(contains(parse("newmtl a\nPcr 1\n").warnings[0], "statement 'pcr' has no effect here; 1 material(s)"));
    // Without a highlight 1 is the same as 2.
    CHECK(parse("newmtl a\nillum 1\nKd 0.5\n").warnings.empty());
    CHECK(parse("newmtl a\nillum 1\nKd 0.5\nKs 0.5\n").warnings.size() == 1);
    CHECK(parse("newmtl a\nillum 0\n").warnings.size() == 1);
}

TEST_CASE("illum makes mirrors and glass of materials that are otherwise such, and nothing of others")
{
    using wedge::scene::SpecularModel;
    for (const char* illum : { "3", "5" }) {
        const Library l = parse(std::string("newmtl a\nKd 0.01 0.01 0.01\nKs 0.9 0.8 0.7\nNs 1000\nillum ") + illum);
        CHECK(l.materials[0].specularModel == SpecularModel::Mirror);
        CHECK(l.materials[0].specular == glm::vec3(0.9f, 0.8f, 0.7f));
        CHECK(l.materials[0].diffuse == glm::vec3(0));
        CHECK(l.warnings.empty());
    }
    for (const char* illum : { "4", "6", "7", "9" }) {
        const Library l =
            parse(std::string("newmtl a\nKd 0.01\nKs 0.3\nTf 0.25 0.5 1\nNs 200\nNi 1.33\nillum ") + illum);
        CHECK(l.materials[0].specularModel == SpecularModel::Glass);
        CHECK(l.materials[0].index == 1.33f);
        CHECK(l.materials[0].specular == glm::vec3(1));
        CHECK(glm::length(l.materials[0].transmission - glm::vec3(0.5f, 0.70710678f, 1)) < 1e-6f);
        CHECK(l.warnings.empty());
    }
    // No word of a mirror's colour, colour below it, a texture there; no index, transparency by d, roughness.
    for (const char* other : { "illum 5\n", "Ks 1\nKd 0.5\nillum 3\n", "Ks 1\nmap_Kd a.png\nillum 3\n",
             "Ks 1\nillum 7\n", "Ks 1\nNi 1\nillum 4\n", "Ks 1\nNi 1.45\nd 0.5\nillum 9\n",
             "Kd 0.8\nKs 0.5\nNi 1.45\nillum 6\n", "Ks 1\nillum 8\n", "Ks 1\nNi 1.5\nillum 2\n" }) {
        CAPTURE(other);
        const Library l = parse(std::string("newmtl a\n") + other);
        CHECK(l.materials[0].specularModel == SpecularModel::BlinnPhong);
        CHECK(l.warnings.empty() == (std::string(other).find("illum 2") != std::string::npos));
    }
    CHECK(parse("newmtl a\nKs 1\nPr 0.1\nillum 3\n").materials[0].specularModel == SpecularModel::Ggx);
}

TEST_CASE("roughness and metal make GGX of a base colour")
{
    const auto material = [](const std::string& statements) { return parse("newmtl a\n" + statements).materials[0]; };
    CHECK(material("Kd 0.5\nKs 0.3\nNs 20\n").specularModel == wedge::scene::SpecularModel::BlinnPhong);
    const Material plastic = material("Kd 0.5 0.25 1\nKs 0.9\nPr 0.3\n");
    CHECK(plastic.specularModel == wedge::scene::SpecularModel::Ggx);
    CHECK(plastic.roughness == 0.3f);
    CHECK(plastic.specular.x == doctest::Approx(0.04));
    CHECK(plastic.specular.z == doctest::Approx(0.04));
    CHECK(plastic.diffuse.y == doctest::Approx(0.24));
    const Material gold = material("Pm 1\nKd 1 0.7 0.3\nNi 3\n");
    CHECK(gold.specular == glm::vec3(1, 0.7f, 0.3f));
    CHECK(gold.diffuse == glm::vec3(0));
    CHECK(gold.roughness == 0.5f);
    const Material half = material("Pm 0.5\nPr 0\nKd 0.8\nNi 3\n");
    CHECK(half.specular.x == doctest::Approx(0.5 * 0.25 + 0.5 * 0.8));
    CHECK(half.diffuse.x == doctest::Approx(0.8 * 0.5 * 0.75));
    CHECK(half.roughness == 0);
    const Library dense = parse("newmtl a\nKd 1\nPr 0.2\nNi 1e30\n");
    CHECK(dense.materials[0].specular == material("Kd 1\nPr 0.2\nNi 1.5\n").specular);
    CHECK(dense.warnings.size() == 1);
    CHECK(material("Kd 1\nmap_Pr none.png\n").roughness == 1);
    // Nothing reflects more than it gets.
    CHECK(parse("newmtl a\nKd 1\nPr 0.5\n").warnings.empty());
    const Library wrong = parse("newmtl a\nPr -1\nPm 1.5\nNi x\n");
    CHECK(wrong.materials[0].roughness == 0.5f);
    CHECK(wrong.materials[0].specular.x == doctest::Approx(0.04));
    REQUIRE(wrong.warnings.size() == 3);
    CHECK(wrong.warnings[0] == "material file m.mtl: material 'a': Pr has the value -1, 0.5 is used");
}

TEST_CASE("opacity: d, Tr where there is no d, and values that are none")
{
    const auto opacity = [](const std::string& statements) {
        return parse("newmtl a\nKd 0.5\n" + statements).materials[0].opacity;
    };
    CHECK(opacity("") == 1.0f);
    CHECK(opacity("d 0.25\n") == 0.25f);
    CHECK(opacity("d 0\n") == 0.0f);
    CHECK(opacity("Tr 0.25\n") == 0.75f);
    CHECK(opacity("d 0.5\nTr 1\n") == 0.5f);
    CHECK(opacity("Tr 1\nd 0.5\n") == 0.5f);
    CHECK(opacity("d -halo 0.5\n") == 1.0f);
    for (const char* wrong : { "d 2\n", "d -1\n", "d nan\n", "d\n", "Tr 1.5\n", "Tr x\n" }) {
        CAPTURE(wrong);
        CHECK(opacity(wrong) == 1.0f);
        CHECK(parse(std::string("newmtl a\nKd 0.5\n") + wrong).warnings.size() == 1);
    }
    const Library missing = parse("newmtl a\nKd 0.5\nmap_d none.png\n");
    CHECK(missing.materials[0].opacityTexture == -1);
    REQUIRE(missing.warnings.size() == 1);
    CHECK(missing.warnings[0].find("none.png") != std::string::npos);
    CHECK(missing.warnings[0].find("the plain colour is used") != std::string::npos);
}

TEST_CASE("normal maps, heights, and normal maps that are called heights")
{
    const auto bmp = [](const std::string& blueGreenRed) { // one texel
        return std::string("BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0", 30)
            + std::string(24, '\0') + blueGreenRed + '\0';
    };
    const TemporaryFolder folder;
    folder.write("grey.bmp", bmp("\x80\x80\x80"));
    folder.write("normal.bmp", bmp("\xf5\xa0\x90"));
    folder.write("blue.bmp", bmp("\xff\xff\x20")); // too long a vector
    const auto read = [&](const std::string& statements) {
        TextureSet textures(std::int64_t { 1 } << 20);
        Warnings warnings;
        const std::vector<Material> materials =
            parseMtl("newmtl a\nKd 0.5\n" + statements, folder.path("m.mtl"), textures, warnings);
        return Library { materials, warnings.lines() };
    };
    for (const std::string keyword : { "bump", "map_bump", "map_Bump" }) {
        const Library heights = read(keyword + " -bm 0.3 grey.bmp\n");
        CHECK(heights.materials[0].normalTexture == 0);
        CHECK(heights.materials[0].normalIsHeight);
        CHECK(heights.materials[0].normalStrength == 0.3f);
        CHECK(heights.warnings.empty());
        CHECK_FALSE(read(keyword + " normal.bmp\n").materials[0].normalIsHeight);
        CHECK(read(keyword + " blue.bmp\n").materials[0].normalIsHeight);
    }
    for (const std::string keyword : { "norm", "map_Kn" }) {
        const Library normals = read(keyword + " -bm -2 grey.bmp\n");
        CHECK(normals.materials[0].normalTexture == 0);
        CHECK_FALSE(normals.materials[0].normalIsHeight);
        CHECK(normals.materials[0].normalStrength == -2);
        CHECK(normals.warnings.empty());
    }
    const Library both = read("map_Kd grey.bmp\nmap_bump -bm 3 grey.bmp\nnorm normal.bmp\n");
    CHECK(both.materials[0].normalTexture == 1);
    CHECK_FALSE(both.materials[0].normalIsHeight);
    CHECK(both.materials[0].normalStrength == 1);
    REQUIRE(both.warnings.size() == 1);
    CHECK(contains(both.warnings[0], "a bump map beside a normal map (bump, map_bump) has no effect here"));
    const Library missing = read("norm none.png\n");
    CHECK(missing.materials[0].normalTexture == -1);
    REQUIRE(missing.warnings.size() == 1);
    CHECK(contains(missing.warnings[0], "the surface stays smooth"));
    for (const std::string word : { "1e9", "-1e9", "nan", "inf" }) {
        CAPTURE(word);
        const Library wrong = read("bump -bm " + word + " grey.bmp\n");
        CHECK(wrong.materials[0].normalTexture == 0);
        CHECK(wrong.materials[0].normalStrength == 1);
        REQUIRE(wrong.warnings.size() == 1);
        CHECK(contains(wrong.warnings[0], "-bm has the value " + word + ", 1 is used"));
    }
}

TEST_CASE("options of textures")
{
    const auto warned = [](const std::string& statement) {
        const Library library = parse("newmtl a\nKd 0.5\nmap_Ks " + statement + "\n");
        REQUIRE(!library.warnings.empty()); // there is no such file
        CHECK(contains(library.warnings.back(), "texture file not found: my file.png"));
        return library.warnings.size() == 2;
    };
    CHECK(!warned("my file.png"));
    CHECK(!warned("-s 1 1 1 -o 0 0 0 my file.png"));
    CHECK(!warned("-blendu on -mm 0 1 -bm 1 -clamp off -texres 64 -imfchan m -type sphere -boost 2 my file.png"));
    CHECK(!warned("-colorspace sRGB -cc off -t 0 0 0 my file.png"));
    CHECK(warned("-imfchan r my file.png"));
    CHECK(warned("-mm 0.2 1 my file.png"));
    CHECK(warned("-colorspace linear my file.png"));
    CHECK(warned("-cc on my file.png"));
    CHECK(warned("-s 2 my file.png"));
    CHECK(warned("-s 1 1 2 my file.png"));
    CHECK(warned("-o 0.5 0 my file.png"));
    CHECK(warned("-clamp on my file.png"));
    CHECK(!warned("-CLAMP off -S 1 my file.png"));
    const Library nameless = parse("newmtl a\nmap_Kd\nmap_Ks -s 1\nbump \"\"\n");
    CHECK(nameless.warnings.size() == 3);
    CHECK(contains(nameless.warnings[1], "a map_kd without a file has no effect here"));
}

TEST_CASE("files that are no libraries")
{
    const std::string none = "material file m.mtl has no materials: no line begins with newmtl and a name: name a "
                             "Wavefront material library";
    CHECK(errorOfLibrary("") == none);
    CHECK(errorOfLibrary("root:x:0:0:root:/root:/bin/bash\n") == none);
    CHECK(errorOfLibrary("newmtl\n") == none);
    const TemporaryFolder folder;
    folder.write("passwd", "root:x:0:0:root:/root:/bin/bash\n");
    folder.write("m.obj", "mtllib passwd\n" + std::string(triangleObj));
    CHECK(contains(
        errorOf(folder.write("s.toml", mesh + "mtl = \"passwd\"\n")), "material file passwd has no materials"));
    CHECK(warns(wedge::scene::loadScene(folder.write("t.toml", mesh)), "passwd has no materials"));
}
