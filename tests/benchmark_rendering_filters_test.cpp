// The benchmark of filters of samples and of images, of shadows by lights and of shadows in a style, run as its users
// do but tiny: the form of what it writes, and what holds of its numbers whatever a machine is like; never a time.
#include "tests/benchmark_testing.h"

#include <cmath>

namespace wedge::app::test {
namespace {

std::vector<std::string> tiny(const std::vector<std::string>& more)
{
    std::vector<std::string> out = { "--size", "24x18", "--spp", "4,8", "--aaf-spp", "16", "--reference-spp", "64",
        "--reference-dir", "references", "--json", "results.json", "--python", "no-such-python" };
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

void checkErrors(const Json& errors, bool plain)
{
    CHECK(keys(errors)
        == std::set<std::string> { "colour", "display", "display_vs_mean", "energy", "flip", "flip_vs_mean", "rmse",
            "rmse_corrected", "rmse_vs_mean" });
    for (const auto& entry : errors.items()) {
        const std::string& key = entry.key();
        const Json& value = entry.value();
        INFO(key);
        REQUIRE(value.is_number());
        CHECK(std::isfinite(value.get<double>()));
        CHECK((key == "energy" || value.get<double>() >= 0));
        if (plain && key.ends_with("_vs_mean")) {
            CHECK(value == 1.0);
        }
    }
    CHECK(errors["rmse"].get<double>() > 0);
    CHECK(errors["rmse_corrected"].get<double>() < errors["rmse"].get<double>());
    CHECK(errors["flip"].get<double>() <= 1);
    CHECK(errors["colour"].get<double>() > 0);
    CHECK(std::abs(errors["energy"].get<double>()) < 1); // of an image twice as bright or black
}

const Json& pointOf(const Json& scene, const std::string& method, int spp, const std::string& variant)
{
    const auto found = std::ranges::find_if(scene["points"],
        [&](const Json& p) { return p["method"] == method && p["spp"] == spp && p["variant"] == variant; });
    REQUIRE_MESSAGE(found != scene["points"].end(), variant);
    return *found;
}

TEST_CASE("results have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Outcome outcome = place.run(tiny({ "--scene", "two_lamps", "--variant", "path-density", "--variant", "median",
        "--variant", "path-density:low=4,high=4" }));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "two_lamps"));
    CHECK(contains(outcome.out, "skipped denoising: no-such-python has no pyoidn"));
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["benchmark"] == "rendering_filters");
    CHECK(all["variants"] == Json({ "mean", "path-density", "median", "path-density:low=4,high=4" }));
    CHECK(all["skipped"].empty());
    CHECK(all["plan"]["spp"] == Json({ 4, 8 }));
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["name"] == "two_lamps");
    CHECK(scene["reference_noise"]["beauty"].get<double>() > 0);
    CHECK(scene["reference_noise"]["indirect"].get<double>() > 0);
    CHECK(scene["exposure"].get<double>() > 0);
    REQUIRE(scene["points"].size() == 2 * 4 + 2);
    for (const Json& point : scene["points"]) {
        CAPTURE(point["variant"]);
        const bool plain = point["variant"] == "mean";
        checkErrors(point["beauty"], plain);
        checkErrors(point["indirect"], plain);
        CHECK(point["tracing_ms"].get<double>() > 0);
        CHECK(point["total_ms"].get<double>() > point["tracing_ms"].get<double>());
        CHECK(point["memory_bytes"].get<double>() > 0);
        CHECK(point["denoise_ms"] == 0);
        CHECK((point["filter_ms"].get<double>() > 0) == (point["variant"] == "path-density"));
    }
    for (const int spp : { 4, 8 }) {
        CAPTURE(spp);
        const Json& plain = pointOf(scene, "mc", spp, "mean");
        // Filters of images leave layers alone, and a filter that keeps all samples leaves the mean.
        CHECK(pointOf(scene, "mc", spp, "median")["indirect"] == plain["indirect"]);
        CHECK(pointOf(scene, "mc", spp, "median")["beauty"] != plain["beauty"]);
        CHECK(pointOf(scene, "mc", spp, "path-density:low=4,high=4")["beauty"] == plain["beauty"]);
        CHECK(pointOf(scene, "mc", spp, "path-density")["indirect"] != plain["indirect"]);
        CHECK(pointOf(scene, "mc", spp, "path-density")["memory_bytes"] > plain["memory_bytes"]);
    }
    CHECK(pointOf(scene, "mc", 8, "mean")["beauty"]["rmse"] < pointOf(scene, "mc", 4, "mean")["beauty"]["rmse"]);
    pointOf(scene, "aaf", 16, "path-density");
    checkClaims(all["claims"], "rendering_filters.path_density_two_lamps.",
        { "error_vs_unfiltered", "display_vs_unfiltered", "energy_error", "time_vs_tracing" });
    const Json& ratio = claim(all["claims"], "rendering_filters.path_density_two_lamps.error_vs_unfiltered");
    CHECK(ratio["value"] == pointOf(scene, "mc", 8, "path-density")["beauty"]["rmse_vs_mean"]);
    CHECK(place.has("references"));
}

/// An interpreter whose denoiser leaves the image as it is.
constexpr const char* stillImage = R"sh(#!/bin/sh
[ $# -eq 1 ] && exit 0
cp "$4" "$7" && echo 1.5
)sh";

TEST_CASE("the plain mean and path-density are denoised where there is a denoiser")
{
    const Workplace place;
    place.write("still.sh", stillImage);
    std::filesystem::permissions(place.path() / "still.sh", std::filesystem::perms::owner_all);
    const Outcome outcome = place.run({ "--scene", box, "--size", "16x12", "--spp", "4", "--aaf-spp", "16",
        "--reference-spp", "16", "--variant", "path-density", "--variant", "median", "--reference-dir", "references",
        "--json", "results.json", "--python", (place.path() / "still.sh").string() });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["denoiser"] == "Open Image Denoise");
    const Json& scene = all["scenes"][0];
    REQUIRE(scene["points"].size() == 5 + 4);
    for (const char* method : { "mc", "aaf" }) {
        for (const std::string variant : { "mean", "path-density" }) {
            const int spp = std::string(method) == "mc" ? 4 : 16;
            const Json& denoised = pointOf(scene, method, spp, variant + ", denoised");
            const Json& before = pointOf(scene, method, spp, variant);
            CHECK(denoised["beauty"] == before["beauty"]);
            CHECK(denoised["indirect"] == before["indirect"]);
            CHECK(denoised["denoise_ms"] == 1.5);
            CHECK(before["denoise_ms"] == 0);
        }
    }
}

TEST_CASE("all variants are measured of a scene file, and there are filters for all")
{
    const Workplace place;
    const Outcome outcome = place.run(
        { "--scene", box, "--size", "16x12", "--spp", "4", "--aaf-spp", "0", "--reference-spp", "16", "--repeats", "2",
            "--reference-dir", "references", "--json", "results.json", "--python", "no-such-python" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["variants"][0] == "mean");
    CHECK(all["variants"].size() == 17);
    CHECK(all["skipped"].empty());
    const Json& points = all["scenes"][0]["points"];
    REQUIRE(points.size() == all["variants"].size());
    for (const Json& point : points) {
        CHECK(point["method"] == "mc");
        CHECK(contains(outcome.out, point["variant"].get<std::string>()));
    }
}

TEST_CASE("antialiased, filters that need samples themselves are left out by name")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--scene", box, "--size", "16x12", "--spp", "4", "--aaf-spp", "16", "--reference-spp", "16",
            "--antialias", "--reference-dir", "references", "--json", "results.json", "--python", "no-such-python" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["plan"]["antialias"] == true);
    CHECK(all["skipped"]
        == Json({ "path-density:k=50,low=2,high=3,spread=0,rgb=1", "trim:share=0.01", "trim:share=0.1",
            "trim:share=0.5", "gmon" }));
    const Json& scene = all["scenes"][0];
    CHECK(pointOf(scene, "mc", 4, "path-density")["indirect"] != pointOf(scene, "mc", 4, "mean")["indirect"]);
    CHECK(pointOf(scene, "aaf", 16, "path-density")["filter_ms"] > 0);
}

std::vector<std::string> tinyShadows(const std::vector<std::string>& more)
{
    std::vector<std::string> out = { "shadow-lights", "--quick", "--size", "24x18", "--lights", "15,40",
        "--reference-spp", "32", "--reference-dir", "references", "--json", "results.json" };
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

/// The point of a way and a count that the plan has.
const Json& shadowPoint(const Json& scene, const std::string& way, int count)
{
    const auto found = std::ranges::find_if(scene["points"],
        [&](const Json& p) { return p["way"] == way && p["count"] == count && p["time_of"].is_null(); });
    REQUIRE_MESSAGE(found != scene["points"].end(), way);
    return *found;
}

void checkShadowPoint(const Json& point)
{
    CHECK(keys(point)
        == std::set<std::string> {
            "clamped_pixels", "count", "errors", "ms", "rays_per_pixel", "rmse_from_lights", "time_of", "way" });
    CHECK(keys(point["errors"])
        == std::set<std::string> { "colour", "display", "energy", "flip", "rmse", "rmse_corrected" });
    CHECK(point["errors"]["rmse"].get<double>() > 0);
    CHECK(std::abs(point["errors"]["energy"].get<double>()) < 1);
    CHECK(point["rmse_from_lights"].get<double>() > 0);
    CHECK(point["rays_per_pixel"].get<double>() > 1);
    CHECK(keys(point["ms"]) == std::set<std::string> { "max", "median", "min", "q1", "q3" });
    CHECK(point["ms"]["median"].get<double>() > 0);
    CHECK(point["clamped_pixels"].is_number()
        == (point["way"] == "subtractive" || point["way"] == "subtractive, 8 a pixel"));
}

TEST_CASE("shadows by lights: every way and count, and what takes as long")
{
    const Workplace place;
    // All but a thousandth of the pixels, of which an image as small has none.
    const Json ways { "additive", "subtractive", "subtractive, not clamped", "ratio", "subtractive, 8 a pixel",
        "ratio, 8 a pixel", "ratio, table of normals", "ratio, 1/4 of pixels", "ratio, 1/16 of pixels" };
    Arguments call { "--scene", "sky_phong500" };
    for (const Json& way : ways) {
        call.insert(call.end(), { "--way", way.get<std::string>() });
    }
    const Outcome outcome = place.run(tinyShadows(call));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["benchmark"] == "rendering_filters");
    CHECK(all["subject"] == "shadow-lights");
    CHECK(all["plan"]["lights"] == Json({ 15, 40 }));
    CHECK(all["skipped"].empty());
    CHECK(all["ways"] == ways);
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["name"] == "sky_phong500");
    CHECK(scene["reference"] == "aaf");
    CHECK(scene["reference_noise"].get<double>() > 0);
    REQUIRE(scene["points"].size() == 1 + 9 * 2 + 2);
    for (const Json& point : scene["points"]) {
        CAPTURE(point["way"]);
        checkShadowPoint(point);
        CHECK(contains(outcome.out, point["way"].get<std::string>()));
    }
    CHECK(scene["points"][19]["way"] == "mc");
    CHECK(scene["points"][19]["time_of"] == "aaf");
    CHECK(scene["points"][20]["way"] == "additive");
    CHECK(scene["points"][20]["time_of"] == "subtractive");
    const auto error = [&](const char* way, int count) {
        return shadowPoint(scene, way, count)["errors"]["rmse"].get<double>();
    };
    CHECK(error("additive", 40) < error("additive", 15));
    CHECK(error("subtractive", 40) < error("subtractive, not clamped", 40));
    CHECK(shadowPoint(scene, "ratio", 40)["rays_per_pixel"] == shadowPoint(scene, "additive", 40)["rays_per_pixel"]);
    const std::string name = "rendering_filters.subtractive_sky_phong500.";
    CHECK(claim(all["claims"], name + "error_vs_additive")["goal"].is_null());
    CHECK(claim(all["claims"], name + "lights_of_equal_time")["value"] == scene["points"][20]["count"]);
    CHECK(claim(all["claims"], name + "error_vs_additive_of_equal_lights")["value"]
        == error("subtractive", 40) / error("additive", 40));
    CHECK(claim(all["claims"], "rendering_filters.ratio_sky_phong500.error_vs_subtractive")["value"]
        == error("ratio", 40) / error("subtractive", 40));
}

TEST_CASE("shadows by lights: maps that are not there are skipped by name, and one way alone has no claims")
{
    const Workplace place;
    ::unsetenv("WEDGE_DATA");
    const Outcome outcome = place.run(tinyShadows({ "--way", "additive" }));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "skipped, since their maps are not below WEDGE_DATA: grace_matt grace_phong40"));
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["skipped"].size() == 5 * 4);
    REQUIRE(all["scenes"].size() == 4);
    for (const Json& scene : all["scenes"]) {
        CHECK(scene["points"].size() == 1 + 2 + 1);
    }
    CHECK(all["claims"].empty());
    // Read back, all numbers but the times are the same.
    const Outcome again = place.run(tinyShadows({ "--way", "additive", "--scene", "sky_ggx" }));
    REQUIRE_MESSAGE(again.status == 0, again.err);
    CHECK(contains(again.err, "sky_ggx: reference of beauty read"));
    const Json second = Json::parse(place.text("results.json"));
    CHECK(shadowPoint(second["scenes"][0], "additive", 40)["errors"]
        == shadowPoint(all["scenes"][3], "additive", 40)["errors"]);
}

/// The style's own pieces of edge count, so that the device's distances are those of the host.
void checkStylized(const Json& scene)
{
    CHECK(keys(scene)
        == std::set<std::string> {
            "edge_pieces", "errors", "ms", "name", "origin", "restyle_abstraction_ms", "restyle_ms" });
    CHECK(scene["edge_pieces"].get<int>() > 50);
    CHECK(keys(scene["ms"])
        == std::set<std::string> { "blur", "distance", "edges", "frame", "matte", "no_style", "style", "transfer" });
    const bool blurs = !scene["restyle_abstraction_ms"].is_null();
    for (const auto& entry : scene["ms"].items()) {
        INFO(entry.key());
        CHECK((entry.value()["median"].get<double>() > 0) == (blurs || entry.key() != "blur"));
    }
    CHECK(scene["restyle_ms"]["median"].get<double>() > 0);
    const Json& errors = scene["errors"];
    CHECK(errors["pixels"].get<int>() > 100);
    CHECK(errors["device"].get<double>() < 0.01);
    REQUIRE(errors["sampled"].size() == 2);
    CHECK(errors["sampled"][0]["pieces"] == 8);
    // Fewer pieces are worse, and all of them far better.
    const double few = errors["sampled"][0]["rms"].get<double>(), many = errors["sampled"][1]["rms"].get<double>();
    CHECK(few >= many);
    CHECK(many > 2 * errors["device"].get<double>());
}

TEST_CASE("shadows in a style: pieces of edge, times of their passes, distances against those of the host")
{
    const Workplace place;
    const Outcome outcome = place.run({ "stylized", "--quick", "--scene", "styled", "--scene", "balls", "--samples",
        "8,128", "--json", "results.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["benchmark"] == "rendering_filters");
    CHECK(all["subject"] == "stylized");
    CHECK(all["plan"]["width"] == 160);
    CHECK(all["plan"]["samples"] == Json({ 8, 128 }));
    REQUIRE(all["scenes"].size() == 2);
    for (const Json& scene : all["scenes"]) {
        CAPTURE(scene["name"]);
        checkStylized(scene);
        CHECK(contains(outcome.out, scene["name"].get<std::string>()));
    }
    CHECK(all["scenes"][0]["name"] == "styled");
    CHECK(all["scenes"][1]["restyle_abstraction_ms"].is_null());
    const std::string name = "rendering_filters.stylized_styled.";
    CHECK(claim(all["claims"], name + "edge_pieces")["value"] == all["scenes"][0]["edge_pieces"]);
    CHECK(claim(all["claims"], name + "distance_ms")["value"] == all["scenes"][0]["ms"]["distance"]["median"]);
    CHECK(claim(all["claims"], name + "distance_ms")["goal"].is_null()); // of other sizes
    CHECK(claim(all["claims"], name + "restyle_ms")["value"] == all["scenes"][0]["restyle_ms"]["median"]);
    CHECK(claim(all["claims"], name + "distance_error")["value"] == all["scenes"][0]["errors"]["device"]);
    // All numbers but the times are the same again.
    const Outcome again = place.run({ "stylized", "--quick", "--scene", "balls", "--scene", "balls_soft", "--samples",
        "8,128", "--json", "again.json" });
    REQUIRE(again.status == 0);
    const Json second = Json::parse(place.text("again.json"));
    // Soft shadows are drawn by passes of the same names, of many edges each.
    const Json& soft = second["scenes"][1];
    CHECK(soft["name"] == "balls_soft");
    CHECK(soft["edge_pieces"].is_null());
    CHECK(soft["errors"].is_null());
    for (const char* part : { "matte", "edges", "distance", "blur", "transfer" }) {
        CAPTURE(part);
        CHECK(soft["ms"][part]["median"].get<double>() > 0);
        CHECK(soft["ms"][part]["median"].get<double>() < soft["ms"]["style"]["median"].get<double>());
    }
    CHECK(claim(second["claims"], "rendering_filters.stylized_balls_soft.style_ms")["value"]
        == soft["ms"]["style"]["median"]);
    CHECK(second["scenes"][0]["errors"] == all["scenes"][1]["errors"]);
    CHECK(second["scenes"][0]["edge_pieces"] == all["scenes"][1]["edge_pieces"]);
}

TEST_CASE("wrong calls end in one line")
{
    const Workplace place;
    checkWrongCalls(place, "rendering_filters",
        {
            { { "--scene", "atlantis" }, 2, "mirrors, materials, room_small_lamp, two_lamps, cornell, grid_floor" },
            { { "--variant", "magic" }, 2, "unknown filter: --variant magic: choose among: bilateral" },
            { { "--variant", "path-density:size=3" }, 2,
                "path-density:size=3: choose among: approximate, exposure, high, k, low" },
            { { "--variant", "path-density:k" }, 2, "write path-density:k=10" },
            { { "--variant", "path-density:k=0.5" }, 2, "give a whole number from 1" },
            { { "--variant", "path-density:low=-1" }, 2, "give a number from 0" },
            { { "--variant", "path-density:" }, 2, "filter parameter has no name" },
            { { "--size", "24" }, 2, "--size" },
            { { "--bounces", "0" }, 2, "--bounces" },
            { { "--scene", box, "--json", "gone/r.json" }, 1, "gone/r.json" },
            { { "--spp", "8", "shadow-lights" }, 2, "shadow-lights excludes --spp" },
            { { "shadow-lights", "--variant", "path-density" }, 2, "--variant" },
            { { "shadow-lights", "--way", "magic" }, 2,
                "way of shadows: --way magic: choose among: additive; subtractive" },
            { { "shadow-lights", "--lights", "0" }, 2, "--lights" },
            { { "shadow-lights", "--scene", "atlantis" }, 2, "grace_matt, grace_phong40" },
            { { "stylized", "--scene", "atlantis" }, 2,
                "styled, balls, balls_smooth, balls_wide, balls_soft, squares" },
            { { "stylized", "--samples", "0" }, 2, "--samples" },
            { { "stylized", "--variant", "path-density" }, 2, "--variant" },
            { { "stylized", "--reference-spp", "8" }, 2, "--reference-spp" },
            { { "stylized", "--scene", box }, 1, "give a point light, a directional one or a quad a [[light.style]]" },
            { { "shadow-lights", "--scene", box }, 1, "give it an [environment]" },
        });
}

} // namespace
} // namespace wedge::app::test
