// A damaged file in the cache that PoCL keeps costs one start, not all of them.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>

using namespace wedge::app::test;
namespace fs = std::filesystem;

namespace {

enum class Damage { Truncated, ZeroedPage };

void damage(const fs::path& path, Damage how)
{
    const auto bytes = fs::file_size(path);
    if (how == Damage::Truncated) {
        fs::resize_file(path, bytes / 3);
        return;
    }
    // Of such files as these the middle is code: one that is damaged there is loaded, and ends the process when it
    // runs.
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const auto zeroed = std::min<std::uintmax_t>(4096, bytes / 2);
    file.seekp(static_cast<std::streamoff>((bytes - zeroed) / 2));
    file << std::string(zeroed, '\0');
}

/// Damages all that the driver loads, and returns how many files that were.
std::size_t damageAll(const fs::path& folder, Damage how)
{
    std::size_t count = 0;
    std::error_code none;
    for (fs::recursive_directory_iterator it(folder, none), end; !none && it != end; it.increment(none)) {
        if (it->is_regular_file() && (it->path().extension() == ".so" || it->path().extension() == ".bc")) {
            damage(it->path(), how);
            ++count;
        }
    }
    return count;
}

/// An own cache in which this call has been made.
struct Used {
    Used()
    {
        ::setenv("WEDGE_CACHE_DIR", cache.c_str(), 1);
        ::unsetenv("POCL_CACHE_DIR");
        REQUIRE(place.run(call).status == 0);
    }

    const Workplace place;
    const fs::path cache = place.temporary() / "cache", driver = cache / "wedge-pocl";
    const std::vector<std::string> call = { "render", box, "--size", "8x8", "--method", "mc", "--spp", "1", "-o",
        "a.exr" };
};

} // namespace

TEST_CASE("files that were damaged in the cache of the driver are compiled again, before they end the process")
{
    for (const Damage how : { Damage::Truncated, Damage::ZeroedPage }) {
        const Used used;
        if (damageAll(used.driver, how) == 0) {
            MESSAGE("skipped: this system has no driver that keeps its cache where it is told to");
            return;
        }
        const Outcome next = used.place.run(used.call);
        CHECK(next.status == 0);
        CHECK(contains(next.err, "was damaged: files removed, to be compiled again: "));
        CHECK(contains(next.err, used.driver.string()));
        CHECK(std::ranges::count(next.err, '\n') == 1);
        CHECK(used.place.run(used.call).err == "");
    }
}

TEST_CASE("what was compiled for frames of a kind is remembered where it is kept")
{
    const Used used;
    const auto marks = [&] {
        std::size_t count = 0;
        for (const fs::directory_entry& entry : fs::directory_iterator(used.driver))
            count += entry.path().filename().string().starts_with("known-") ? 1 : 0;
        return count;
    };
    if (marks() == 0) {
        MESSAGE("skipped: this system has no driver that keeps its cache where it is told to");
        return;
    }
    CHECK(marks() == 1);
    CHECK(used.place.run(used.call).status == 0);
    CHECK(marks() == 1);
    std::vector<std::string> other = used.call;
    other.emplace_back("--antialias");
    CHECK(used.place.run(other).status == 0);
    CHECK(marks() == 2);
    // Where the cache is emptied nothing is known of it.
    damageAll(used.driver, Damage::Truncated);
    std::ofstream(used.driver / "record") << "no record";
    CHECK(used.place.run({ "devices" }).status == 0);
    CHECK(marks() == 0);
}

TEST_CASE("a damaged cache of which nothing is recorded is emptied by the start after the one that it ended")
{
    const Used used;
    damageAll(used.driver, Damage::Truncated);
    std::ofstream(used.driver / "record") << "wedge record 1\nend\n";
    if (used.place.run(used.call).status == 0) {
        MESSAGE("skipped: this driver notices what is damaged by itself, or keeps nothing");
        return;
    }
    const Outcome next = used.place.run(used.call);
    CHECK(next.status == 0);
    CHECK(contains(next.err, "was emptied: " + used.driver.string()));
    CHECK(std::ranges::count(next.err, '\n') == 1);
    CHECK(used.place.run(used.call).err == "");
}

TEST_CASE("a cache folder that is in use for something else keeps what is in it")
{
    const Workplace place;
    const fs::path folder = place.path() / "docs";
    fs::create_directories(folder / "driver");
    fs::create_directories(folder / "wedge-pocl");
    for (const char* name : { "docs/notes.mark", "docs/driver/thesis.txt", "docs/wedge-pocl/thesis.txt" }) {
        place.write(name, "precious");
    }
    ::setenv("WEDGE_CACHE_DIR", folder.c_str(), 1);
    ::unsetenv("POCL_CACHE_DIR");
    const std::string said = place.run({ "devices" }).err;
    CHECK(contains(said, "docs (its folder wedge-pocl: it is not of wedge's making)"));
    CHECK(std::ranges::count(said, '\n') == 1);
    for (const char* name : { "docs/notes.mark", "docs/driver/thesis.txt", "docs/wedge-pocl/thesis.txt" }) {
        CHECK(place.has(name));
    }
}
