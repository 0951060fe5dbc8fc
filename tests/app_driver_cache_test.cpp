// A damaged file in the cache that PoCL keeps costs one start, not all of them.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

using namespace wedge::app::test;
namespace fs = std::filesystem;

namespace {

/// Damages all that the driver keeps, and returns how many files that were.
std::size_t truncateAll(const fs::path& folder)
{
    std::size_t count = 0;
    std::error_code none;
    for (fs::recursive_directory_iterator it(folder, none), end; !none && it != end; it.increment(none)) {
        if (it->is_regular_file()) {
            fs::resize_file(it->path(), fs::file_size(it->path()) / 3);
            ++count;
        }
    }
    return count;
}

} // namespace

TEST_CASE("a damaged cache of the driver is emptied by the start after the one that it ended")
{
    const Workplace place;
    const fs::path cache = place.temporary() / "cache";
    ::setenv("WEDGE_CACHE_DIR", cache.c_str(), 1);
    ::unsetenv("POCL_CACHE_DIR");
    const Arguments call = { "render", box, "--size", "8x8", "--method", "mc", "--spp", "1", "-o", "a.exr" };
    REQUIRE(place.run(call).status == 0);
    if (truncateAll(cache / "driver") == 0) {
        MESSAGE("skipped: this system has no driver that keeps its cache where it is told to");
        return;
    }
    const Outcome damaged = place.run(call);
    if (damaged.status == 0) {
        MESSAGE("this driver notices what is damaged by itself");
        return;
    }
    const Outcome next = place.run(call);
    CHECK(next.status == 0);
    CHECK(contains(next.err, "was emptied: " + (cache / "driver").string()));
    CHECK(std::ranges::count(next.err, '\n') == 1);
    CHECK(place.run(call).err == "");
}
