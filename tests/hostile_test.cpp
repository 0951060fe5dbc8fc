// Files and calls that strangers send: each ends in one clear line or a right result, within 500 MB, and none hangs.
// scripts/measure_hostile.sh says how long each takes.
#include "tests/hostile/row.h"

#include <doctest/doctest.h>

namespace wedge::hostile {
namespace {

void runAll(const Rows& rows)
{
    for (const Row& row : rows) {
        run(row);
    }
}

TEST_CASE("kernels are compiled before, which takes more memory")
{
    for (const Arguments& more : { Arguments {}, { "--progressive", "--spp", "64" } }) {
        Row row { .name = "a render", .call = tiny({ "-o", "a.exr" }), .ending = Ending::Done };
        row.call.insert(row.call.end(), more.begin(), more.end());
        row.start.limited = false;
        run(row);
    }
}

TEST_CASE("calls") { runAll(callRows()); }
TEST_CASE("outputs") { runAll(outputRows()); }
TEST_CASE("kinds of files") { runAll(fileKindRows()); }
TEST_CASE("images") { runAll(imageRows()); }
TEST_CASE("scene files") { runAll(sceneRows()); }
TEST_CASE("meshes and materials") { runAll(meshRows()); }

TEST_CASE("the list is long")
{
    std::size_t rows = 0;
    for (const auto& part : { callRows(), outputRows(), fileKindRows(), imageRows(), sceneRows(), meshRows() }) {
        rows += part.size();
    }
    MESSAGE(rows, " files and calls");
    CHECK(rows >= 200);
}

} // namespace
} // namespace wedge::hostile
