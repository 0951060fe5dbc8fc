// The bench that tests run single passes with: it says so where a test asks for what there is not, or a kernel writes
// where it must not.
#include "tests/pass_bench.h"

using namespace wedge;
using namespace wedge::test;

namespace {

render::Settings antialiased()
{
    render::Settings settings = sized(render::axisAligned(16), 19, 11);
    settings.antialias = true;
    settings.bounces = 1;
    return settings;
}

PassBench onFirst(const std::string& kernel)
{
    static DeclaredFrame frame(usableDevices().front(), smallScene(), antialiased());
    return PassBench(frame, kernel);
}

} // namespace

TEST_CASE("a plane holds what it is filled with, as exactly as its format does")
{
    std::mt19937 random(1);
    for (const char* name : { "texture", "value", "shares", "filtered" }) {
        CAPTURE(name);
        PassBench bench = onFirst("addFilteredTerm");
        const std::size_t parts = bench.read<float>(name).size() / bench.elements(name);
        const std::vector<float> values = someNumbers(random, parts * bench.elements(name), 0, 1);
        bench.plane(name, values);
        const std::vector<float> found = bench.read<float>(name);
        REQUIRE(found.size() == values.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            REQUIRE(std::fabs(found[i] - values[i]) < 1.0 / 256);
        // What it holds is then exact.
        bench.plane(name, found);
        CHECK(bench.read<float>(name) == found);
    }
}

TEST_CASE("a value is the pass's own, or the test's")
{
    PassBench bench = onFirst("addFilteredTerm");
    CHECK(bench.own<shared::DistributedParams>("p").width == 19);
    bench.window({ 16, 2, 19, 7 });
    CHECK(bench.own<shared::DistributedParams>("p").y1 == 7);
}

TEST_CASE("what a test asks for and there is not, and what a kernel writes beside its planes, is an error that says it")
{
    const auto refused = [](const auto& ask) {
        try {
            PassBench bench = onFirst("termVariance");
            ask(bench);
        } catch (const std::logic_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(refused([](PassBench&) { onFirst("termVariances"); })
        == "of kernel termVariances the frame has 0 passes \"\", not 1");
    CHECK(refused([](PassBench& b) { b.plane("variances", std::vector<float>()); })
        == "kernel termVariance is not handed \"variances\", but p deviation variance");
    CHECK(refused([](PassBench& b) { b.plane("p", std::vector<float>()); })
        == "\"p\" of kernel termVariance is no plane, and no list");
    CHECK(refused([](PassBench& b) { b.read<std::uint32_t>("variance"); })
        == "plane \"variance\" has the format float1, of other numbers than the test's");
    CHECK(contains(refused([](PassBench& b) { b.plane("variance", std::vector<float>(3)); }), "not 3 in all"));
    CHECK(refused([](PassBench& b) { b.value("p", shared::TemporalParams {}); })
        == "\"p\" of kernel termVariance is AnalysisParams, not a value TemporalParams");
    CHECK(refused([](PassBench& b) { b.own<std::uint32_t>("variance"); })
        == "\"variance\" of kernel termVariance is a plane, not a value uint");
    CHECK(refused([](PassBench& b) { b.run(); }).empty());
    CHECK(refused([](PassBench&) {
        PassBench b = onFirst("fallbackDifferences");
        b.plane("deviation", std::vector<float>(b.elements("deviation"), 1.0f));
        b.plane("texture", std::vector<float>(3 * b.elements("texture"), 1.0f));
        b.value("p", b.own<shared::AnalysisParams>("p")); // of the whole image
        b.window({ 3, 2, 9, 5 });
        b.run();
    }).starts_with("kernel fallbackDifferences has written to \"differences\" beside its window"));
    CHECK(refused([](PassBench& b) {
        auto p = b.own<shared::AnalysisParams>("p");
        p.stride = (p.planeSize - WEDGE_ROW_PADDING) / (p.height - 1) + 1; // the last row is behind the plane
        b.value("p", p);
        b.run();
    }) == "kernel termVariance has written beside \"variance\"");
}
