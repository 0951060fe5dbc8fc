// The textures of a scene: each file once, all together within bounds, and what is wrong with one.
#include "host/scene/textures.h"
#include "tests/scene_support.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

using namespace scene_test;
using wedge::scene::TextureSet;

namespace {

/// A grey TGA of runs: two bytes for 128 pixels.
std::string tga(int width, int height)
{
    std::string bytes { 0, 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0 };
    for (const int side : { width, height }) {
        bytes += static_cast<char>(side % 256);
        bytes += static_cast<char>(side / 256);
    }
    bytes += { 8, 0 };
    for (int left = width * height; left > 0; left -= 128)
        bytes += { static_cast<char>(127 + std::min(left, 128)), 77 };
    return bytes;
}

std::string addError(TextureSet& textures, const std::string& path)
{
    try {
        textures.add(path);
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_CASE("a file is read once, however it is spelled, and row 0 is at the bottom")
{
    const TemporaryFolder folder;
    std::string bytes = tga(1, 2);
    bytes.resize(18);
    bytes[2] = 3;
    const std::string file = folder.write("a.jpg", bytes + "\x01\x02"); // the name says nothing
    std::filesystem::create_symlink(file, folder.path("link.tga"));
    std::filesystem::create_directory(folder.path("sub"));
    TextureSet textures(1 << 20);
    CHECK(textures.add(file) == 0);
    CHECK(textures.add(folder.path("link.tga")) == 0);
    CHECK(textures.add(folder.path("sub/../a.jpg")) == 0);
    const std::vector<wedge::scene::Texture> read = textures.take();
    REQUIRE(read.size() == 1);
    CHECK(read[0].path == file);
    CHECK(read[0].rgba == std::vector<std::uint32_t> { 0xff010101, 0xff020202 });
}

TEST_CASE("a file of linear values is read for colours and for numbers, others once for both")
{
    using wedge::decode::TextureUse;
    const TemporaryFolder folder;
    const std::string linear =
        folder.write("a.hdr", "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81");
    const std::string plain = folder.write("b.tga", tga(1, 1));
    TextureSet textures(1 << 20);
    CHECK(textures.add(linear) == 0);
    CHECK(textures.add(linear, TextureUse::Numbers) == 1);
    CHECK(textures.add(linear, TextureUse::Colours) == 0);
    CHECK(textures.add(plain, TextureUse::Numbers) == 2);
    CHECK(textures.add(plain) == 2);
    CHECK(textures.at(0).rgba == std::vector<std::uint32_t> { 0xffbcbcbc });
    CHECK(textures.at(1).rgba == std::vector<std::uint32_t> { 0xff808080 });

    // A scene's keys and a library's statements say which.
    folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nusemtl a\nf 1 2 3\n");
    folder.write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.hdr\nmap_Ns a.hdr\nmap_Ke a.hdr\nmap_d a.hdr\nnorm a.hdr\n");
    const auto check = [](const wedge::scene::Scene& scene) {
        const wedge::scene::Material& m = scene.materials.at(0);
        const auto texel = [&](int index) { return scene.textures.at(static_cast<std::size_t>(index)).rgba.at(0); };
        for (const int colour : { m.diffuseTexture, m.emissionTexture })
            CHECK(texel(colour) == 0xffbcbcbc);
        for (const int number : { m.exponentTexture, m.opacityTexture, m.normalTexture })
            CHECK(texel(number) == 0xff808080);
    };
    check(wedge::scene::loadScene(folder.path("m.obj")));
    folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n");
    check(wedge::scene::loadScene(folder.write("s.toml",
        "[camera]\neye = [0, 2, 4]\nlook_at = [0, 0, 0]\n[[mesh]]\nfile = \"n.obj\"\nmaterial = \"a\"\n"
        "[[material]]\nname = \"a\"\ndiffuse_texture = \"a.hdr\"\nemission_texture = \"a.hdr\"\n"
        "exponent_texture = \"a.hdr\"\nopacity_texture = \"a.hdr\"\nbump_texture = \"a.hdr\"\n")));
}

TEST_CASE("the limit on the pixels of a texture names the option")
{
    const TemporaryFolder folder;
    const std::string file = folder.write("a.tga", tga(100, 10));
    TextureSet enough(1000), less(999);
    CHECK(enough.add(file) == 0);
    CHECK(addError(less, file)
        == "texture file cannot be decoded (it has 100x10 pixels, at most 999 are read): " + file
            + ": scale the image down, or raise --max-texture-pixels");
}

TEST_CASE("many small files of many pixels do not add up")
{
    const TemporaryFolder folder;
    TextureSet textures(1 << 12);
    int read = 0;
    std::string message;
    for (int i = 0; i < 400 && message.empty(); ++i) {
        // Runs of 128 in two bytes are 64 pixels a byte: only the header lets a file have more.
        message = addError(textures, folder.write(std::to_string(i) + ".tga", tga(64, 64)));
        read += message.empty();
    }
    CHECK(read == 16); // times the limit of one
    CHECK(contains(message, "it has 64x64 pixels, of the textures of all the scene only 0 more are read"));
    CHECK(contains(message, "raise --max-texture-pixels"));

    // Packed more tightly than any usual picture: what one may have, and no more.
    TextureSet tight(1 << 12);
    const std::string bmp("BM\0\0\0\0\0\0\0\0\x3a\0\0\0(\0\0\0@\0\0\0@"
                          "\0\0\0\1\0\x08\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0abc\0\0\1",
        60);
    CHECK(addError(tight, folder.write("a.bmp", bmp)) == "");
    CHECK(contains(addError(tight, folder.write("b.bmp", bmp)), // 64 pixels for each of two times 60 bytes
        "of the textures of all the scene only 3584 more are read"));
}

TEST_CASE("files that fail after their size was let through count as well")
{
    const TemporaryFolder folder;
    TextureSet textures(1 << 12);
    for (const char* name : { "a.tga", "b.tga", "c.tga", "d.tga" }) {
        const std::string bytes = tga(32, 32);
        CHECK(contains(addError(textures, folder.write(name, bytes.substr(0, bytes.size() - 1))),
            "it ends before the picture does"));
    }
    CHECK(contains(
        addError(textures, folder.write("e.tga", tga(32, 32))), "of the textures of all the scene only 0 more"));
}

TEST_CASE("what is wrong with a texture is said again without reading it again")
{
    const TemporaryFolder folder;
    const std::string file = folder.write("a.png", "P5 3000 3000 65535");
    TextureSet textures(1 << 20);
    const std::string first = addError(textures, file);
    CHECK(first
        == "texture file cannot be decoded (PBM, PGM or PPM is no format that is read): " + file
            + ": save it as PNG or JPEG");
    folder.write("a.png", tga(1, 1));
    CHECK(addError(textures, file) == first);
}

TEST_CASE("only regular files are images")
{
    const TemporaryFolder folder;
    REQUIRE(mkfifo(folder.path("pipe.png").c_str(), 0600) == 0);
    TextureSet textures(1 << 20);
    CHECK(contains(addError(textures, folder.path("pipe.png")), "texture file is not a regular file"));
    CHECK(contains(addError(textures, "/dev/zero"), "texture file is not a regular file"));
    CHECK(contains(addError(textures, folder.path("")), "texture file is a folder"));
    CHECK(contains(addError(textures, folder.path("none.png")), "texture file not found"));
    CHECK(contains(addError(textures, folder.write("empty.png", "")), "(it is empty)"));
}

TEST_CASE("a texture that a scene file names ends the call, one that a library names is a warning")
{
    const TemporaryFolder folder;
    folder.write("bad.tga", tga(8, 8).substr(0, 19));
    folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nusemtl a\nf 1 2 3\n");
    folder.write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd bad.tga\n");
    CHECK(warns(wedge::scene::loadScene(folder.path("m.obj")), "it ends before the picture does"));
    const std::string scene =
        folder.write("s.toml", mesh + "[[material]]\nname = \"a\"\ndiffuse_texture = \"bad.tga\"\n");
    CHECK(contains(errorOf(scene), "it ends before the picture does"));
    folder.write("bad.tga", tga(8, 8));
    CHECK(errorOf(scene) == "");
    CHECK_THROWS_AS(wedge::scene::loadScene(scene, { .maxTexturePixels = 63 }), wedge::Error);
}
