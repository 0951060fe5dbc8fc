// Sequences as users see them: frames are the same in any range, those that are there stay, and calls that are wrong.
#include "tests/app_testing.h"

namespace wedge::app::test {
namespace {

const std::string moving = scenes + "/motion.toml";

Outcome frames(const Workplace& place, const std::string& scene, const std::string& range, Arguments more = {})
{
    Arguments all = { "render", scene, "--size", "48x32", "--frames", range };
    all.insert(all.end(), more.begin(), more.end());
    return place.run(all);
}

TEST_CASE("a frame has the same bits in any range, and frame 0 those of a picture")
{
    const Workplace place;
    render(place, moving, { "--size", "48x32" });
    REQUIRE(frames(place, moving, "0:2", { "-o", "s.%02d.exr" }).status == 0);
    REQUIRE(frames(place, moving, "2", { "-o", "t.%d.exr" }).status == 0);
    REQUIRE(frames(place, moving, "2", { "-o", "c.%d.exr", "--crop", "8,8,9,9" }).status == 0);
    CHECK(values(place.exr("a.exr"), "R") == values(place.exr("s.00.exr"), "R"));
    CHECK(values(place.exr("s.02.exr"), "R") == values(place.exr("t.2.exr"), "R"));
    CHECK(values(place.exr("s.02.exr"), "R") != values(place.exr("s.01.exr"), "R"));
    CHECK(values(place.exr("c.2.exr"), "R").at(0) == values(place.exr("t.2.exr"), "R").at(8 * 48 + 8));
}

TEST_CASE("frames that are whole and of the same settings are left, all others rendered")
{
    const Workplace place;
    const Arguments names = { "-o", "s.%d.exr", "-o", "s.%d.png" };
    REQUIRE(frames(place, box, "0:2", names).status == 0);
    CHECK(contains(frames(place, box, "0:2", names).out, "3 of 3 frames are there"));
    const std::string whole = place.text("s.1.exr"), picture = place.text("s.2.png");
    place.write("s.1.exr", whole.substr(0, whole.size() / 2));
    place.write("s.2.png", picture.substr(0, picture.size() / 2));
    const Outcome again = frames(place, box, "0:2", names);
    CHECK(contains(again.out, "1 of 3 frames are there"));
    CHECK(place.exr("s.1.exr").find("R") != nullptr);
    CHECK(place.text("s.2.png") == picture);
    CHECK_FALSE(contains(frames(place, box, "0:2", { "-o", "s.%d.exr", "--seed", "1" }).out, "are there"));
}

TEST_CASE("the frame's number enters the random numbers")
{
    const Workplace place;
    REQUIRE(frames(place, box, "0:1", { "-o", "s.%d.exr" }).status == 0); // nothing moves
    CHECK(values(place.exr("s.0.exr"), "R") != values(place.exr("s.1.exr"), "R"));
}

TEST_CASE("an interrupt or a time limit leaves whole frames alone, and the next call goes on")
{
    const Workplace place;
    const Arguments call = { "render", box, "--size", "160x120", "--spp", "2048", "--method", "mc", "--verbose",
        "--frames", "0:999", "-o", "s.%d.exr" };
    const Outcome stopped = place.run(call, [&](pid_t process) {
        waitUntilRendering(place, process);
        kill(process, SIGTERM);
    });
    CHECK(stopped.status == 130);
    CHECK(contains(stopped.err, "interrupted in frame"));
    for (const std::string& name : place.files()) {
        CHECK(std::get<int>(place.exr(name).metadata.at("complete")) == 1);
    }
    CHECK(place.files().size() < 1000);
    Arguments limited = call;
    limited.insert(limited.end(), { "--time-limit", "0.001" });
    const std::vector<std::string> before = place.files();
    const Outcome late = place.run(limited);
    CHECK(late.status == 0);
    CHECK(contains(late.err, "time limit reached in frame"));
    CHECK(place.files() == before);
}

TEST_CASE("calls of sequences that are wrong are refused in one line")
{
    const Workplace place;
    const auto refused = [&](const std::string& range, const std::string& name, const std::string& said) {
        checkRefused(place, { "render", box, "--frames", range, "-o", name }, wrongCall, said);
    };
    for (const std::string bad : { "3:1", "a", "1:", ":2", "-1:2", "1:2:3", "99999999999999999999", "0:999999" }) {
        refused(bad, "a.%d.exr", bad);
    }
    for (const std::string bad :
        { "a.exr", "a.%s.exr", "a%d.%d.exr", "a.%.exr", "a.%00d.exr", "a.%12d.exr", "a%%.exr" }) {
        refused("0:1", bad, bad);
    }
    checkRefused(place, { "render", box, "--frames", "2:12", "-o", "a%d.exr", "-o", "a1%d.exr" }, wrongCall, "a12.exr");
    checkRefused(place, { "render", box, "--frames", "0:1" }, wrongCall, "-o name.%04d.exr");
    checkRefused(place, { "render", box, "--fps", "2", "-o", "a.exr" }, wrongCall, "--fps");
    checkRefused(
        place, { "render", box, "--frames", "0", "--progressive", "-o", "a%d.exr" }, wrongCall, "--progressive");
}

TEST_CASE("a light's keys move it from frame to frame")
{
    const Workplace place;
    place.write("s.toml", camera + quad + light + "key = [{ time = 0 }, { time = 1, translate = [0.8, 0, 0] }]\n");
    place.write("t.toml",
        camera + quad
            + "[[light]]\ntype = \"quad\"\ncentre = [0.8, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = "
              "1\n");
    REQUIRE(frames(place, "s.toml", "1", { "--fps", "1", "-o", "s%d.exr" }).status == 0);
    REQUIRE(frames(place, "t.toml", "1", { "-o", "t%d.exr" }).status == 0);
    CHECK(values(place.exr("s1.exr"), "R") == values(place.exr("t1.exr"), "R"));
}

} // namespace
} // namespace wedge::app::test
