// Broken images, each where it can be named: as an image to compare, as a texture of a scene file, which are failures,
// and as a texture of a material library, which is a warning.
#include "tests/hostile/bytes.h"
#include "tests/hostile/row.h"

namespace wedge::hostile {
namespace {

using Images = std::vector<std::pair<std::string, std::string>>; ///< what is wrong, and the bytes

Images brokenPngs()
{
    const std::string grey = pngHead(8, 8, 8, 0), rows = deflated(std::string(8 * 9, '\0'));
    const std::string end = pngChunk("IEND", "");
    std::string damaged = grey + pngChunk("IDAT", rows) + end;
    damaged[20] = 1; // of the width: the checksum no longer fits
    std::string wide = grey + "\x7f\xff\xff\xff" + "IDAT" + rows;
    return { { "empty", "" }, { "text", "a picture of a cat" }, { "signature alone", "\x89PNG\r\n\x1a\n" },
        { "header alone", grey }, { "no pixels", grey + end }, { "zero wide", pngHead(0, 8, 8, 0) + end },
        { "2^31-1 wide", pngHead(0x7fffffff, 0x7fffffff, 16, 6) + pngChunk("IDAT", rows) + end },
        { "2^32-1 wide", pngHead(0xffffffff, 1, 8, 0) + pngChunk("IDAT", rows) + end },
        { "bomb of 1 bit",
            pngHead(32768, 16383, 1, 0) + pngChunk("IDAT", deflated(std::string(std::size_t { 4097 } * 16383, '\0')))
                + end },
        { "large and empty", pngHead(32768, 32768, 16, 6) + pngChunk("IDAT", rows) + end },
        { "3 bits", pngHead(8, 8, 3, 0) + pngChunk("IDAT", rows) + end },
        { "colour type 5", pngHead(8, 8, 8, 5) + pngChunk("IDAT", rows) + end },
        { "palette missing", pngHead(8, 8, 8, 3) + pngChunk("IDAT", rows) + end }, { "wrong checksum", damaged },
        { "chunk of 2^31-1", wide }, { "pixels cut", grey + pngChunk("IDAT", rows.substr(0, 6)) + end },
        { "rows missing", grey + pngChunk("IDAT", deflated(std::string(9, '\0'))) + end },
        { "no deflate", grey + pngChunk("IDAT", "not deflated at all") + end },
        { "interlaced and cut", pngHead(8, 8, 8, 0, 1) + pngChunk("IDAT", deflated("\0")) + end },
        { "filter 9", grey + pngChunk("IDAT", deflated(std::string(8 * 9, '\x09'))) + end } };
}

Images brokenHdrs()
{
    const std::string rle = "\2\2";
    return { { "signature alone", "#?RADIANCE" }, { "no resolution", "#?RADIANCE\n\n" },
        { "no end of the header", "#?RADIANCE\n" + std::string(1 << 20, 'x') }, { "no data", hdr("-Y 8 +X 8", "") },
        { "RLE without data", hdr("-Y 3000 +X 3000", rle + "\x0b\xb8") },
        { "RLE over the end of the row", hdr("-Y 8 +X 8", rle + std::string("\0\x08\xff\xff\xff\xff", 6)) },
        { "RLE of another width", hdr("-Y 8 +X 8", rle + std::string("\0\x09\x89\x01", 4)) },
        { "runs of nothing", hdr("-Y 8 +X 8", rle + std::string("\0\x08", 2) + std::string(4096, '\0')) },
        { "cut", hdr("-Y 8 +X 7", std::string(20, 'a')) }, { "large and empty", hdr("-Y 30000 +X 30000", "") },
        { "2^31 wide", hdr("-Y 2147483648 +X 2147483648", "abcd") }, { "negative", hdr("-Y -8 +X -8", "abcd") },
        { "zero", hdr("-Y 0 +X 0", "") }, { "no numbers", hdr("-Y tall +X wide", "abcd") },
        { "10^20 wide", hdr("-Y 1 +X 100000000000000000000", "abcd") },
        { "old runs without end", hdr("-Y 4 +X 4", repeated("\x01\x01\x01\xff", 1000)) } };
}

Images brokenExrs()
{
    const auto with = [](const std::function<void(ExrParts&)>& change) {
        ExrParts parts;
        parts.body = std::string(16, '\0') + repeated("\1", 100);
        change(parts);
        return exr(parts);
    };
    const std::string whole = with([](ExrParts&) {});
    Images images = {
        { "magic alone", "\x76\x2f\x31\x01" },
        { "magic and text", "\x76\x2f\x31\x01 and no more" },
        { "version 99", with([](ExrParts& p) { p.version = 99; }) },
        { "unknown flags", with([](ExrParts& p) { p.version = 0x00ff0002; }) },
        { "attribute of 2^31-1",
            with([](ExrParts& p) { p.more = exrAttribute("comment", "string", "", 0x7fffffff); }) },
        { "unknown attribute of 2^31-1",
            with([](ExrParts& p) { p.more = exrAttribute("x", "mystery", "", 0x7fffffff); }) },
        { "attribute of -1", with([](ExrParts& p) { p.more = exrAttribute("comment", "string", "", 0xffffffff); }) },
        { "channels of 2^31-1",
            "\x76\x2f\x31\x01" + little32(2) + exrAttribute("channels", "chlist", "R", 0x7fffffff) },
        { "preview of 2^31-1", with([](ExrParts& p) {
             p.more = exrAttribute("preview", "preview", little32(0x7fff) + little32(0x7fff));
         }) },
        { "deep", with([](ExrParts& p) {
             p.version = 2 | 0x800;
             p.dataWindow = p.displayWindow = { 0, 0, 63, 999'999 };
             p.more = exrAttribute("type", "string", "deepscanline") + exrAttribute("version", "int", little32(1))
                 + exrAttribute("maxSamplesPerPixel", "int", little32(0x7fffffff));
         }) },
        { "parts that are none", with([](ExrParts& p) { p.version = 2 | 0x1000; }) },
        { "tiles without sizes", with([](ExrParts& p) { p.version = 2 | 0x200; }) },
        { "tiles of 2^32-1", with([](ExrParts& p) {
             p.version = 2 | 0x200;
             p.more = exrAttribute("tiles", "tiledesc", little32(0xffffffff) + little32(0xffffffff) + "\2");
         }) },
        { "many levels of tiles of one pixel", with([](ExrParts& p) {
             p.version = 2 | 0x200;
             p.dataWindow = p.displayWindow = { 0, 0, 8191, 8191 };
             p.more = exrAttribute("tiles", "tiledesc", little32(1) + little32(1) + "\2");
         }) },
        { "window without end", with([](ExrParts& p) {
             p.dataWindow = { 0x80000000, 0x80000000, 0x7fffffff, 0x7fffffff };
         }) },
        { "window inside out", with([](ExrParts& p) {
             p.dataWindow = { 5, 5, 1, 1 };
         }) },
        { "large and empty", with([](ExrParts& p) {
             p.dataWindow = p.displayWindow = { 0, 0, 99'999, 99'999 };
         }) },
        { "one row, 2^31 wide", with([](ExrParts& p) {
             p.dataWindow = { 0, 0, 0x7ffffffe, 0 };
         }) },
        { "one column, 2^31 tall", with([](ExrParts& p) {
             p.dataWindow = { 0, 0, 0, 0x7ffffffe };
         }) },
        { "no channels", with([](ExrParts& p) { p.channels = ""; }) },
        { "no colours", with([](ExrParts& p) { p.channels = exrChannel("x"); }) },
        { "20,000 channels", with([](ExrParts& p) {
             p.channels = "";
             for (int i = 0; i < 20'000; ++i)
                 p.channels += exrChannel("c" + std::to_string(i));
         }) },
        { "subsampled",
            with([](ExrParts& p) { p.channels = exrChannel("R", 1, 2) + exrChannel("Y", 1, 0x7fffffff); }) },
        { "sampling 0", with([](ExrParts& p) { p.channels = exrChannel("R", 1, 0); }) },
        { "channels of no type", with([](ExrParts& p) { p.channels = exrChannel("R", 77); }) },
        { "compression 200", with([](ExrParts& p) { p.compression = 200; }) },
        { "no rows", with([](ExrParts& p) { p.body = ""; }) },
        { "a name of 100,000",
            with([](ExrParts& p) { p.more = exrAttribute(std::string(100'000, 'n'), "string", "x"); }) },
    };
    for (unsigned char compression = 1; compression <= 9; ++compression) {
        images.emplace_back("rows that are no rows, compression " + std::to_string(compression), with([&](ExrParts& p) {
            p.compression = compression;
            p.body = little32(400) + little32(0) + little32(0) + little32(8) + "nonsense" + std::string(64, '\xff');
        }));
    }
    for (const std::size_t size : { 5, 8, 20, 40, 100, 200, 300 }) {
        images.emplace_back("cut after " + std::to_string(size), whole.substr(0, size));
    }
    return images;
}

/// Formats of old textures, which may or may not be read.
Images brokenOthers()
{
    return { { "PGM of 20 bytes", "P5 3000 3000 65535 \n" }, { "small PGM", "P5 8 8 65535 \n" },
        { "cut PGM", "P5 8 8 255\nabc" }, { "PPM without numbers", "P6 # no end" },
        { "large PPM", "P6 32768 32768 255\nabc" }, { "TGA header", tga(2, 8, 8, 24, "") },
        { "cut TGA", tga(2, 8, 8, 24, "abcdef") }, { "cut RLE TGA", tga(10, 64, 64, 32, "\xff") },
        { "large TGA", tga(2, 32768, 32768, 32, "abcd") },
        { "TGA of 65535",
            tga(10, 65535, 65535, 32,
                "\xff"
                "abcd") },
        { "TGA without palette", tga(1, 8, 8, 8, "abc") }, { "BMP magic", "BM" },
        { "BMP header", bmp(8, 8, 24, 0, "") }, { "cut BMP", bmp(8, 8, 24, 0, "abcdef") },
        { "large BMP", bmp(32768, 32768, 24, 0, "abc") }, { "BMP of 2^31", bmp(0x7fffffff, 0x80000000, 32, 0, "abc") },
        { "BMP of 1 bit", bmp(1000, 1000, 1, 0, "a") }, { "RLE BMP", bmp(1000, 1000, 8, 1, "\1\1") },
        { "JPEG magic", "\xff\xd8\xff" }, { "JPEG of 65535", jpeg(65535, 65535, "\xff\xda") },
        { "JPEG without tables", jpeg(8, 8, std::string("\xff\xda\0\x08\1\1\0\0\x3f\0abc", 13)) },
        { "JPEG without end", jpeg(8, 8, std::string(1000, '\xff')) }, { "zero JPEG", jpeg(0, 0, "\xff\xd9") },
        { "GIF", "GIF89a\xff\xff\xff\xff\xf7" },
        { "PSD", std::string("8BPS\0\1\0\0\0\0\0\0\0\3\0\0\x75\x30\0\0\x75\x30\0\x08\0\3", 26) },
        { "PIC", "\x53\x80\xf6\x34" + std::string(84, 'a') + "PICT\xff\xff\xff\xff" } };
}

std::function<void(const Folder&)> scenesWith(const std::string& name, const std::string& bytes)
{
    return [=](const Folder& folder) {
        write(folder, name, bytes);
        write(folder, "m.obj", "mtllib m.mtl\nusemtl m\n" + triangle);
        write(folder, "m.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd " + name + "\n");
        write(folder, "plain.obj", triangle);
        write(folder, "s.toml",
            "[[material]]\nname = 'm'\ndiffuse_texture = '" + name
                + "'\n[[mesh]]\nfile = 'plain.obj'\nmaterial = 'm'\n");
    };
}

void addTextures(Rows& rows, const std::string& title, const std::string& name, const std::string& bytes)
{
    rows.push_back({ .name = title + ", a scene's texture",
        .call = { "info", "s.toml" },
        .prepare = scenesWith(name, bytes),
        .says = name });
    rows.push_back({ .name = title + ", a library's texture",
        .call = { "info", "m.obj" },
        .prepare = scenesWith(name, bytes),
        .ending = Ending::Done,
        .says = name });
}

void addCompared(Rows& rows, const std::string& title, const std::string& name, const std::string& bytes)
{
    rows.push_back({ .name = title + ", compared",
        .call = { "compare", name, name },
        .prepare = file(name, bytes),
        .says = name });
}

} // namespace

Rows imageRows()
{
    Rows rows;
    for (const auto& [what, bytes] : brokenPngs()) {
        addCompared(rows, "PNG: " + what, "a.png", bytes);
        addTextures(rows, "PNG: " + what, "a.png", bytes);
    }
    for (const auto& [what, bytes] : brokenHdrs()) {
        addCompared(rows, "HDR: " + what, "a.hdr", bytes);
        addTextures(rows, "HDR: " + what, "a.hdr", bytes);
    }
    for (const auto& [what, bytes] : brokenExrs()) {
        addCompared(rows, "EXR: " + what, "a.exr", bytes);
    }
    for (const auto& [what, bytes] : brokenOthers()) {
        const std::string format = what.find("TGA") != std::string::npos ? "a.tga" : "a.png";
        addTextures(rows, "image: " + what, format, bytes);
    }
    const std::string bomb = brokenHdrs()[4].second;
    rows.push_back({ .name = "HDR: RLE without data, a reference",
        .call = tiny({ "--reference", "a.hdr", "-o", "a.exr" }),
        .prepare = file("a.hdr", bomb),
        .says = "a.hdr" });
    return rows;
}

} // namespace wedge::hostile
