// Indirect light and ambient occlusion from the command line and the scene file: precedence, options that have no
// effect, what reaches the settings, and what is seen.
#include "tests/app_testing.h"

#include <numeric>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

/// A small scene of a lit square; the text goes to its [integrator].
void writeScene(const Workplace& place, const std::string& name, const std::string& integrator)
{
    place.write(name,
        "[image]\nwidth = 8\nheight = 6\n" + camera + quad + "material = \"m\"\n" + light
            + "[[material]]\nname = \"m\"\n[integrator]\n" + integrator);
}

/// The integrator that the report names, with what belongs to it.
std::string described(const Workplace& place, const std::string& scene, const Arguments& more)
{
    Arguments arguments = { "render", scene, "--quiet", "-o", "a.exr", "--report", "r.json" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const nlohmann::json method = nlohmann::json::parse(place.text("r.json")).at("method");
    const std::string integrator = method.at("integrator");
    return integrator == "ao"
        ? "ao " + method.at("ambientDistance").dump()
        : integrator + " " + method.at("bounces").dump() + " " + method.at("lightSampling").get<std::string>();
}

TEST_CASE("the command line goes before the scene file")
{
    const Workplace place;
    writeScene(place, "none.toml", "");
    writeScene(place, "path.toml", "bounces = 2\nlight_sampling = \"lights\"\n");
    writeScene(place, "ao.toml", "type = \"ao\"\nao_distance = 0.5\n");
    CHECK(described(place, "none.toml", {}) == "path 0 both");
    CHECK(described(place, "none.toml", { "--bounces", "1024", "--method", "mc", "--spp", "1" }) == "path 1024 both");
    CHECK(described(place, "path.toml", {}) == "path 2 lights");
    CHECK(described(place, "path.toml", { "--bounces", "1", "--light-sampling", "directions" }) == "path 1 directions");
    CHECK(described(place, "path.toml", { "--bounces", "0" }) == "path 0 lights");
    CHECK(described(place, "path.toml", { "--integrator", "ao" }) == "ao 0"); // any distance
    CHECK(described(place, "path.toml", { "--integrator", "ao", "--ao-distance", "2" }) == "ao 2");
    CHECK(described(place, "ao.toml", {}) == "ao 0.5");
    CHECK(described(place, "ao.toml", { "--ao-distance", "0.25" }) == "ao 0.25");
    CHECK(described(place, "ao.toml", { "--integrator", "path", "--bounces", "3" }) == "path 3 both");
}

TEST_CASE("options for the other integrator are wrong calls, whichever place it was chosen at")
{
    const Workplace place;
    writeScene(place, "none.toml", "");
    writeScene(place, "path.toml", "type = \"path\"\nbounces = 2\n");
    writeScene(place, "ao.toml", "type = \"ao\"\n");
    const auto refused = [&](const std::string& scene, const Arguments& more, const std::string& message) {
        checkRenderRefused(place, scene, more, wrongCall,
            "wedge: error: option has no effect " + message + "; see wedge render --help\n");
    };
    const std::string bounces = "with integrator ao: --bounces 2: leave it out, or add --integrator path";
    refused("none.toml", { "--integrator", "ao", "--bounces", "2" }, bounces);
    refused("ao.toml", { "--bounces", "2" }, bounces);
    refused("path.toml", { "--integrator", "ao", "--bounces", "2", "--method", "mc" }, bounces);
    refused("ao.toml", { "--bounces", "0" }, "with integrator ao: --bounces 0: leave it out, or add --integrator path");
    const std::string distance = "with integrator path: --ao-distance 0.5: leave it out, or add --integrator ao";
    refused("none.toml", { "--ao-distance", "0.5" }, distance);
    refused("path.toml", { "--ao-distance", "0.5" }, distance);
    refused("ao.toml", { "--integrator", "path", "--ao-distance", "0.5" }, distance);
    refused("ao.toml", { "--light-sampling", "both" },
        "with integrator ao: --light-sampling: leave it out, or add --integrator path");
    refused(
        "ao.toml", { "--falloff", "ratio" }, "with integrator ao: --falloff: leave it out, or add --integrator path");
    const std::string direct = "without bounces: --light-sampling: leave it out, or add --bounces 1";
    refused("none.toml", { "--light-sampling", "directions" }, direct);
    refused("path.toml", { "--light-sampling", "directions", "--bounces", "0" }, direct);
}

TEST_CASE("options for all terms reach indirect light")
{
    const Workplace place;
    const auto setting = [&](Arguments more, const std::string& name) {
        more.insert(more.end(), { "--size", "16x12", "--bounces", "1" });
        return textOf(render(place, box, more), "method." + name);
    };
    CHECK(setting({ "--mu", "1.5" }, "indirectMu") == "1.5");
    CHECK(setting({ "--mu", "1.5" }, "mu") == "1.5");
    CHECK(setting({ "--as-published" }, "indirectMu") == "0.9");
    CHECK(setting({ "--as-published" }, "mu") == "3"); // the box has a uniform light
    CHECK(setting({ "--as-published", "--mu", "1.5" }, "indirectMu") == "1.5");
    CHECK(setting({ "--as-published" }, "indirectCounts") == "spectrum");
    CHECK(setting({ "--as-published", "--sampling", "uniform" }, "indirectCounts") == "uniform");
    CHECK(setting({ "--as-published", "--counts", "variance" }, "indirectCounts") == "variance");
    CHECK(setting({ "--counts", "spectrum" }, "indirectCounts") == "spectrum");
    CHECK(setting({ "--sampling", "uniform" }, "indirectCounts") == "uniform");
    CHECK(setting({ "--sampling", "adaptive" }, "indirectCounts") == "variance");
    CHECK(setting({ "--max-spp", "50" }, "indirectMaxSpp") == "50");
}

double mean(const image::LayeredImage& image, const std::string& channel)
{
    const std::vector<float>& v = values(image, channel);
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

TEST_CASE("bounces add light, and a distance opens what ambient occlusion shows")
{
    const Workplace place;
    writeScene(place, "lone.toml", "type = \"ao\"\n");
    for (const Arguments& method : { Arguments { "--method", "mc", "--spp", "16" }, { "--method", "aaf" } }) {
        CAPTURE(method[1]);
        const auto brightness = [&](Arguments more) {
            more.insert(more.end(), method.begin(), method.end());
            return mean(render(place, box, more), "G");
        };
        const double direct = brightness({}), one = brightness({ "--bounces", "1" });
        CHECK(brightness({ "--bounces", "0" }) == direct);
        CHECK(one > 1.1 * direct);
        CHECK(brightness({ "--bounces", "3" }) > 1.02 * one);
        const double open = brightness({ "--integrator", "ao" });
        CHECK(brightness({ "--integrator", "ao", "--ao-distance", "100" }) == open); // farther than the box is wide
        CHECK(brightness({ "--integrator", "ao", "--ao-distance", "0.2" }) > 1.2 * open);
        // Nothing is near a plane that is alone.
        const image::LayeredImage lone = render(place, "lone.toml", method);
        for (const float v : values(lone, "G")) {
            CHECK((v == 1.0f || v == 0.0f));
        }
        CHECK(mean(lone, "G") > 0.02); // it covers about a thirtieth of the image
    }
}

TEST_CASE("layers of indirect light")
{
    const Workplace place;
    for (const std::string method : { "mc", "aaf" }) {
        CAPTURE(method);
        const image::LayeredImage image =
            render(place, materials, { "--bounces", "1", "--method", method, "--spp", "16", "--layers", "all" });
        for (const std::string channel : { "R", "G", "B" }) {
            const auto &sum = values(image, channel), &emission = values(image, "emission." + channel);
            const auto &direct = values(image, "direct." + channel), &indirect = values(image, "indirect." + channel);
            std::size_t different = 0;
            for (std::size_t i = 0; i < sum.size(); ++i) {
                different += sum[i] != emission[i] + (direct[i] + indirect[i]);
            }
            CHECK(different == 0);
        }
        CHECK(mean(image, "indirect.G") > 0);
        const double noisy = mean(image, "indirectNoisy.G");
        CHECK(mean(image, "indirect.G") == doctest::Approx(noisy).epsilon(method == "mc" ? 1e-6 : 0.1));
        for (const char* width : { "filterWidth1.pixels", "filterWidthIndirect.pixels", "filterWidthGlossy.pixels" }) {
            CHECK((image.find(width) != nullptr) == (method == "aaf"));
        }
    }
    checkRenderRefused(place, box, { "--layers", "indirect" }, wrongCall, "indirect");
    const image::LayeredImage ambient = render(place, box, { "--integrator", "ao", "--layers", "filterWidth" });
    CHECK(mean(ambient, "filterWidthAmbient.world") > 0);
    CHECK(ambient.find("filterWidth.world") == nullptr);
}

} // namespace
} // namespace wedge::app::test
