#include "tests/hostile/bytes.h"
#include "tests/hostile/row.h"

#include <algorithm>
#include <sys/stat.h>

namespace wedge::hostile {
namespace {

using Prepare = std::function<void(const Folder&)>;

Prepare link(const std::string& name, const std::string& target)
{
    return [=](const Folder& folder) { std::filesystem::create_symlink(target, folder / name); };
}

Prepare both(const Prepare& first, const Prepare& second)
{
    return [=](const Folder& folder) {
        first(folder);
        second(folder);
    };
}

Prepare folder(const std::string& name, int permissions = 0777)
{
    return [=](const Folder& parent) {
        std::filesystem::create_directory(parent / name);
        std::filesystem::permissions(parent / name, std::filesystem::perms(permissions));
    };
}

/// A pipe that nobody reads.
Prepare pipe(const std::string& name)
{
    return [=](const Folder& parent) { mkfifo((parent / name).c_str(), 0666); };
}

const Prepare fullExr = link("full.exr", "/dev/full");
const Prepare fullPng = link("full.png", "/dev/full");

/// Outputs that fail when all is rendered.
Rows lateFailures()
{
    const auto late = [](const std::string& name, const Prepare& prepare, const Arguments& more, int errors,
                          const std::string& says, const std::vector<std::string>& makes) {
        return Row { .name = "output: " + name,
            .call = tiny(more),
            .prepare = prepare,
            .says = says,
            .errors = errors,
            .start = { .device = true },
            .makes = makes };
    };
    const std::string keptExr = "kept as ./full-rescued.exr";
    Rows rows = {
        late("full disk", fullExr, { "-o", "full.exr" }, 1, keptExr, { "full-rescued.exr" }),
        late("full disk, and a PNG", fullExr, { "-o", "full.exr", "-o", "b.png" }, 1, keptExr,
            { "full-rescued.exr", "b.png" }),
        late("full disk, and an EXR", fullExr, { "-o", "full.exr", "-o", "b.exr" }, 1, keptExr,
            { "full-rescued.exr", "b.exr" }),
        late("full disk for a PNG", fullPng, { "-o", "full.png" }, 1, "kept as ./full-rescued.png",
            { "full-rescued.png" }),
        late("full disk for a PNG beside an EXR", fullPng, { "-o", "full.png", "-o", "b.exr" }, 1, "full.png",
            { "b.exr" }),
        late("full disk for all", both(fullExr, fullPng),
            { "-o", "full.exr", "-o", "full.png", "--report", "/dev/full" }, 3, keptExr, { "full-rescued.exr" }),
        late("full disk for the report", {}, { "-o", "a.exr", "--report", "/dev/full" }, 1, "/dev/full", { "a.exr" }),
        late("full disk, a report", fullExr, { "-o", "full.exr", "--report", "r.json" }, 1, keptExr,
            { "full-rescued.exr", "r.json" }),
        late("the rescue's name is taken", both(fullExr, file("full-rescued.exr", "\x76\x2f\x31\x01kept")),
            { "-o", "full.exr" }, 1, "kept as ./full-rescued-2.exr", { "full-rescued.exr", "full-rescued-2.exr" }),
        late("the rescue's name is a link", both(fullExr, link("full-rescued.exr", "b.exr")), { "-o", "full.exr" }, 1,
            "kept as ./full-rescued-2.exr", { "full-rescued-2.exr" }),
        late("a long name", link(std::string(200, 'n') + ".exr", "/dev/full"), { "-o", std::string(200, 'n') + ".exr" },
            1, "kept as ./wedge-rescued.exr", { "wedge-rescued.exr" }),
        late("a name with escapes", link("\x1b[31m.exr", "/dev/full"), { "-o", "\x1b[31m.exr" }, 1,
            "kept as ./wedge-rescued.exr", { "wedge-rescued.exr" }),
        late("a pipe that nobody reads", pipe("a.exr"), { "-o", "a.exr" }, 1, "kept as ./a-rescued.exr",
            { "a-rescued.exr" }),
        late("a pipe that nobody reads, as report", pipe("r"), { "-o", "a.exr", "--report", "r" }, 1, "pipe",
            { "a.exr" }),
        late("progressive, on a full disk", fullExr, { "-o", "full.exr", "--progressive", "--spp", "64", "--quiet" }, 1,
            keptExr, { "full-rescued.exr" }),
        late("stopped by time, on a full disk", fullExr,
            { "-o", "full.exr", "--spp", "1000000", "--time-limit", "0.05", "--quiet" }, 1, keptExr,
            { "full-rescued.exr" }),
    };
    // Images are large and limits more than what PoCL writes before it finds a program in its cache: 1.5 MB. A PNG of
    // 1700x1275 has 2.5 MB; larger ones take nearly all memory that a call may, more with Debian 13's LLVM.
    const auto large = [](Row row, const std::string& size) {
        std::ranges::replace(row.call, std::string("16x16"), size);
        return row;
    };
    Row small =
        large(late("a file size limit", {}, { "-o", "a.exr", "-o", "b.png" }, 2, "nor could it be kept elsewhere", {}),
            "1700x1275");
    small.start.fileSizeLimit = 2'000'000;
    Row medium = large(late("a file size limit that a PNG fits in", {}, { "-o", "a.exr" }, 1, "kept as ./a-rescued.png",
                           { "a-rescued.png" }),
        "1200x900");
    medium.start.fileSizeLimit = 4'000'000;
    rows.push_back(small);
    rows.push_back(medium);
    return rows;
}

/// Outputs that are refused before the scene, which is not even there, is read.
Rows earlyFailures()
{
    const auto early = [](const std::string& name, const Prepare& prepare, const Arguments& more, int errors,
                           const std::string& says) {
        Arguments call = { "render", "missing.toml" };
        call.insert(call.end(), more.begin(), more.end());
        return Row { .name = "output: " + name, .call = call, .prepare = prepare, .says = says, .errors = errors };
    };
    Rows rows = {
        early("no such folder, three times", {}, { "-o", "no/a.exr", "-o", "no/b.png", "--report", "no/r" }, 3, "no/r"),
        early("a folder", folder("a.exr"), { "-o", "a.exr" }, 1, "Is a directory"),
        early("a folder to be", {}, { "--report", "r/" }, 1, "Is a directory"),
        early("below a file", file("f", "x"), { "-o", "f/a.exr" }, 1, "f/a.exr"),
        early("where nothing can be made", {}, { "-o", "/proc/a.exr" }, 1, "/proc/a.exr"),
        early("a link in a circle", link("a.exr", "a.exr"), { "-o", "a.exr" }, 1, "a.exr"),
        early("a link to nowhere", link("a.exr", "no/b.exr"), { "-o", "a.exr" }, 1, "a.exr"),
    };
    for (const auto& [name, prepare] :
        { std::pair { "a closed folder", folder("d", 0555) }, { "a hidden folder", folder("d", 0) } }) {
        rows.push_back(early(name, prepare, { "-o", "d/a.exr", "--report", "d/r" }, 2, "check the permissions"));
        rows.back().start.ordinaryUser = true;
    }
    return rows;
}

/// One file under two names, and files that are read.
Rows sameFiles()
{
    const auto same = [](const std::string& name, const Prepare& prepare, const Arguments& call,
                          const std::string& says) {
        return Row {
            .name = "output: " + name, .call = call, .prepare = prepare, .ending = Ending::WrongCall, .says = says
        };
    };
    const Arguments render = { "render", "s.toml" };
    const auto with = [&render](const Arguments& more) {
        Arguments call = render;
        call.insert(call.end(), more.begin(), more.end());
        return call;
    };
    const std::string twice = "output is named twice", read = "output is a file that is read";
    return { same("./a.exr and a.exr", {}, with({ "-o", "a.exr", "-o", "./a.exr" }), twice),
        same("d/../a.exr and a.exr", folder("d"), with({ "-o", "a.exr", "-o", "d/../a.exr" }), twice),
        same("a link to the other", link("b.exr", "a.exr"), with({ "-o", "a.exr", "-o", "b.exr" }), twice),
        same("a link of folders", both(folder("d"), link("e", "d")), with({ "-o", "d/a.exr", "-o", "e/a.exr" }), twice),
        same("in a folder that is not there", {}, with({ "-o", "no/a.exr", "-o", "no//a.exr" }), twice),
        same("the report and an image", {}, with({ "-o", "a.exr", "--report", "./a.exr" }), twice),
        same("the report and the default", {}, with({ "--report", "s.exr" }), twice),
        same("the report and the scene", file("s.toml", ""), with({ "--report", "./s.toml" }), read),
        same("an image that is a link to the scene", both(file("s.toml", ""), link("a.exr", "s.toml")),
            with({ "-o", "a.exr" }), read),
        same("an image and the reference", {}, with({ "-o", "a.exr", "--reference", "./a.exr" }), read),
        same("the error map and the image", {}, { "compare", "a.png", "b.png", "--error-map", "./a.png" }, read),
        same("the error map and the reference", {}, { "compare", "a.png", "b.png", "--error-map", "b.png" }, read) };
}

/// An EXR of one pixel that is not a number, of which compare warns amid its result.
std::string exrOfNan()
{
    ExrParts parts;
    parts.dataWindow = parts.displayWindow = { 0, 0, 0, 0 };
    const auto chunk = static_cast<std::uint32_t>(exr(parts).size() + 8);
    parts.body = little32(chunk) + little32(0) + little32(0) + little32(6) + repeated(std::string("\0\x7e", 2), 3);
    return exr(parts);
}

/// Standard streams that are closed or full.
Rows streams()
{
    const auto closed = std::optional<std::string> {};
    const std::string full = "/dev/full";
    const auto result = [](const std::string& name, const Arguments& call, const std::optional<std::string>& out) {
        return Row { .name = "stdout: " + name,
            .call = call,
            .says = "cannot write to standard output",
            .start = { .out = out, .device = true } };
    };
    const auto rendered = [](const std::string& name, Start start) {
        start.device = true;
        return Row { .name = "streams: " + name,
            .call = tiny({ "-o", "a.exr", "-o", "b.png", "--report", "r.json", "--verbose" }),
            .ending = Ending::Done,
            .start = start,
            .makes = { "a.exr", "b.png", "r.json" } };
    };
    Row compared = result("compare, with a warning, full", { "compare", "a.exr", "a.exr" }, full);
    compared.prepare = file("a.exr", exrOfNan());
    return { compared, result("info, full", { "info", scene }, full), result("info, closed", { "info", scene }, closed),
        result("info as JSON, full", { "info", scene, "--json" }, full), result("devices, full", { "devices" }, full),
        result("devices as JSON, full", { "devices", "--json" }, full), result("help, full", { "--help" }, full),
        result("help of a command, full", { "render", "--help" }, full), result("version, full", { "--version" }, full),
        result("version, closed", { "--version" }, closed), rendered("stdout closed", { .out = closed }),
        rendered("stdout full", { .out = full }), rendered("stderr closed", { .err = closed }),
        rendered("stderr full", { .err = full }), rendered("stdin closed", { .in = closed }),
        rendered("all closed", { .in = closed, .out = closed, .err = closed }) };
}

} // namespace

Rows outputRows()
{
    Rows rows = lateFailures();
    for (const Rows& more : { earlyFailures(), sameFiles(), streams() }) {
        rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
}

} // namespace wedge::hostile
