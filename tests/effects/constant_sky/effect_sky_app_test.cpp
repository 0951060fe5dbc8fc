// The sky from the command line and a scene file, by a program that has it.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

namespace wedge::app::test {
namespace {

constexpr const char* scene = R"([camera]
eye = [0, 2, 4]
look_at = [0, 0, 0]

[[mesh]]
file = "floor.obj"
)";

/// A scene file with this after its camera and mesh.
void writeScene(Workplace& place, const std::string& more)
{
    place.write("floor.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    place.write("s.toml", scene + more);
}

float largest(const image::LayeredImage& image, const std::string& channel)
{
    float most = 0;
    for (const image::Channel& c : image.channels)
        if (c.name == channel)
            for (const float v : c.values)
                most = std::max(most, v);
    return most;
}

} // namespace

TEST_CASE("a scene file's sky, the option that changes it, and its layer")
{
    Workplace place;
    writeScene(place, "[sky]\nradiance = [0.25, 0.5, 1]\n");
    const auto render = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments { "render", "s.toml", "--quiet", "--size", "24x16", "--layers",
            "sky,emission", "-o", "a.exr" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = place.run(arguments);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        return image::readExr((place.path() / "a.exr").string());
    };
    const image::LayeredImage ofFile = render({});
    CHECK(largest(ofFile, "emission.R") == 0.25f);
    CHECK(largest(ofFile, "emission.B") == 1.0f);
    CHECK(largest(ofFile, "sky.B") > 0.3f); // grey of 0.5 reflects half of it
    const image::LayeredImage changed = render({ "--sky", "3", "--sky", "2", "--antialias" });
    CHECK(largest(changed, "emission.R") == 2.0f);
    CHECK(largest(changed, "sky.R") > 0.6f);
    CHECK(contains(place.run({ "render", "--help" }).out, "--sky RADIANCE"));
}

TEST_CASE("what is wrong with a sky is told")
{
    Workplace place;
    const auto refused = [&](const std::string& section, const std::vector<std::string>& more, int status,
                             const std::string& what) {
        writeScene(place, section);
        std::vector<std::string> arguments { "render", "s.toml", "--quiet", "-o", "a.exr" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = place.run(arguments);
        CHECK(outcome.status == status);
        CHECK_MESSAGE(contains(outcome.err, what), outcome.err);
    };
    refused("[sky]\n", {}, 1, "lacks a key: radiance");
    refused("[sky]\nradiance = -1\n", {}, 1, "is negative");
    refused("[sky]\nradiance = 1\ncolour = 2\n", {}, 1, "unknown key in sky");
    refused("[skies]\nradiance = 1\n", {}, 1, "shutter, sky");
    refused("", { "--sky", "blue" }, 2, "--sky blue");
    refused("", { "--layers", "sky" }, 2, "the frame has no constant sky");
}

} // namespace wedge::app::test
