// The benchmark of motion, run as its users do but tiny; benchmark_multiple_effects_test has what it shares with that.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("times of a box with moving objects, beside the thesis', and maps of its filters")
{
    const Workplace place;
    const Json all = tinyResults(place, "moving_cornell", { "--timing-only", "--maps", "maps" });
    checkHead(all, "motion");
    CHECK_FALSE(place.has("references"));
    CHECK(claim(all["claims"], "motion.moving_cornell.rays_per_pixel")["paper"] == 155);
    CHECK(claim(all["claims"], "motion.moving_cornell.total_ms")["paper"] == 15000);
    CHECK(claim(all["claims"], "motion.moving_cornell.memory_bytes")["goal"] == 150e6);
    const Json& scene = all["scenes"][0];
    CHECK(scene["rays_saved_goal"] == 4);
    CHECK(scene["rays_saved_aim"] == 8);
    CHECK(scene["curves"].empty());
    for (const Json& setting : scene["settings"]) {
        checkTiming(setting);
        CHECK_FALSE(setting.contains("method"));
    }
    CHECK(place.has("maps/moving_cornell_width_motion.png"));
    CHECK(place.has("maps/moving_cornell_primary.png"));
}

TEST_CASE("the scenes that move are listed")
{
    const Workplace place;
    const Outcome list = place.run({ "--list" });
    CHECK(list.status == 0);
    CHECK(contains(list.out, "moving_cornell "));
    CHECK(contains(list.out, "moving_lens "));
}

} // namespace
} // namespace wedge::app::test
