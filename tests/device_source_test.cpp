#include "device_testing.h"

#include "host/device/source.h"
#include "kernels/embedded_kernels.hpp"

using wedge::device::FlatSource;
using wedge::device::flattenKernel;
using wedge::device::namePlaces;
using wedge::test::contains;
using wedge::test::errorOf;

namespace {

const std::string includes = WEDGE_TEST_KERNELS "/includes";

std::size_t occurrences(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

} // namespace

TEST_CASE("includes are put in place, once a file, relative to the including file")
{
    const FlatSource flat = flattenKernel(includes, "diamond.cl");
    CAPTURE(flat.text);
    CHECK(flat.files
        == std::vector<std::string> { includes + "/diamond.cl", includes + "/left.h", includes + "/deeper/bottom.h",
            includes + "/deeper/beside.h", includes + "/right.h" });
    CHECK(occurrences(flat.text, "int bottom(void)") == 1);
    CHECK(occurrences(flat.text, "#define BESIDE 1\n") == 1);
    CHECK(contains(flat.text, "#include \"nowhere.h\"")); // only in a comment
    CHECK(occurrences(flat.text, "#include") == 1);
    CHECK(flat.text.find("int bottom") < flat.text.find("#define LEFT"));
    CHECK(flat.text.starts_with("#line 1 \"" + includes + "/diamond.cl\"\n#line 1 \"" + includes + "/left.h\"\n"));
    CHECK(contains(flat.text, "#define LEFT 10\n#line 2 \"" + includes + "/diamond.cl\"\n"));
}

TEST_CASE("embedded sources: every kernel file flattens to text without includes of ours")
{
    REQUIRE_FALSE(wedge::embeddedKernels().empty());
    const FlatSource flat = flattenKernel("", "shared/vec.h");
    CHECK(flat.files == std::vector<std::string> { "kernels/shared/vec.h", "kernels/shared/compat.h" });
    CHECK_FALSE(contains(flat.text, "#include \""));
}

TEST_CASE("a kernel folder overrides the embedded sources file by file")
{
    const FlatSource flat = flattenKernel(WEDGE_TEST_KERNELS, "device_basic.cl");
    CHECK(flat.files == std::vector<std::string> { WEDGE_TEST_KERNELS "/device_basic.cl", "kernels/shared/compat.h" });
}

TEST_CASE("messages that count the lines of the flattened source name files all the same")
{
    const std::string flat = "#line 1 \"a.cl\"\n#line 1 \"b.h\"\nint b;\nwrong;\n#line 2 \"a.cl\"\nint a;\nbad;\n";
    CHECK(namePlaces("<kernel>:4:1: error: wrong\n<kernel>:7:2: error: bad", flat)
        == "b.h:2:1: error: wrong\na.cl:3:2: error: bad");
    CHECK(namePlaces("<kernel>:99:1: error", flat) == "<kernel>:99:1: error");
    CHECK(namePlaces("kernels/a.cl:4:1: error", flat) == "kernels/a.cl:4:1: error");
    CHECK(namePlaces("", flat).empty());
}

TEST_CASE("missing files, missing folders and cycles are errors that say where")
{
    std::string message = errorOf([] { flattenKernel(includes, "missing.cl"); });
    CHECK(contains(message, includes + "/deeper/incomplete.h:2: include not found: absent.h"));

    message = errorOf([] { flattenKernel(includes, "cycle.cl"); });
    CHECK(contains(message, includes + "/cycle_b.h:2: files include each other: cycle_a.h -> cycle_b.h -> cycle_a.h"));

    message = errorOf([] { flattenKernel(includes, "no_such_pass.cl"); });
    CHECK(contains(message, "no_such_pass.cl"));
    message = errorOf([] { flattenKernel("", "no_such_pass.cl"); });
    CHECK(contains(message, "no_such_pass.cl"));
    message = errorOf([] { flattenKernel("", ""); });
    CHECK(contains(message, "no such kernel file"));
    message = errorOf([] { flattenKernel(includes + "/nowhere", "cycle.cl"); });
    CHECK(contains(message, includes + "/nowhere"));
}
