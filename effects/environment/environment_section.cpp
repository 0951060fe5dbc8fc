#include "effects/environment/environment_section.h"

#include "effects/environment/angular_map.h"
#include "effects/environment/suns.h"
#include "host/decode/limits.h"
#include "host/error.h"
#include "host/image/read_image.h"
#include "host/render/environment_table.h"
#include "host/scene/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace wedge::render {
namespace {

/// A map takes 20 bytes a texel of the device.
constexpr std::int64_t mostTexels = std::int64_t { 1 } << 25;
constexpr double mostIntensity = 1e9;
/// Of texels, W/(sr m^2): squares and sums of what they light stay numbers.
constexpr float mostRadiance = 1e12f;

/// A map as a file has it, its radiance times the intensity.
image::RgbImage readMap(const std::string& path, float intensity)
{
    decode::Limits limits = decode::referenceLimits;
    limits.pixels = mostTexels;
    limits.remedy = "scale the map down";
    image::ImageFile file(path, limits);
    image::RgbImage map = file.read();
    std::size_t wrong = 0;
    for (float& c : map.rgb) {
        c *= intensity;
        wrong += std::isnan(c) ? 1 : 0;
        c = std::clamp(c, 0.0f, mostRadiance); // resampling leaves small negative numbers beside suns
    }
    if (wrong > 0) {
        throw Error("environment map has numbers that are no radiance", fmt::format("{} in {}", wrong, path),
            "repair the map, or write it anew");
    }
    return map;
}

/// The map's axes in the world, turned about `up` by degrees, counter-clockwise as seen from above.
void orient(EnvironmentPicture& picture, bool zIsUp, double degrees)
{
    const glm::dvec3 up = zIsUp ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), right(1, 0, 0);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), up));
    picture.right = glm::vec3(turn * right);
    picture.up = glm::vec3(up);
    picture.back = glm::vec3(turn * glm::cross(right, up));
}

} // namespace

std::any readEnvironment(scene::TableReader& table)
{
    auto picture = std::make_shared<EnvironmentPicture>();
    const auto radiance = table.colour("radiance");
    const auto map = table.path("map");
    if (radiance.has_value() == map.has_value()) {
        table.failHere(radiance ? "has both a radiance and a map" : "has neither a radiance nor a map", "environment",
            "give one of the two");
    }
    const auto layout = table.choice("layout", { "lat-long", "angular" });
    const auto intensity = table.number("intensity", 0.0, mostIntensity);
    const auto rotation = table.number("rotation", -1e6, 1e6);
    const auto up = table.choice("up", { "y", "z" });
    const auto suns = table.boolean("suns");
    for (const auto& [name, given] :
        { std::pair("layout", layout.has_value()), std::pair("rotation", rotation.has_value()),
            std::pair("up", up.has_value()), std::pair("suns", suns.has_value()) }) {
        if (given && !map) {
            table.fail(name, "has no effect without a map", "radiance", "leave it out or name a map");
        }
    }
    const auto factor = static_cast<float>(intensity.value_or(1.0));
    if (radiance) {
        const glm::vec3 even = glm::min(*radiance * factor, glm::vec3(mostRadiance));
        picture->radiance = { even.r, even.g, even.b };
    } else {
        image::RgbImage pixels = readMap(map->string(), factor);
        if (layout == "angular") {
            if (pixels.width != pixels.height) {
                table.fail("map", "is no square, as angular maps are",
                    fmt::format("{}x{}", pixels.width, pixels.height), "crop it, or leave layout out");
            }
            pixels = latLongOfAngular(pixels);
        }
        picture->width = pixels.width;
        picture->height = pixels.height;
        picture->radiance = std::move(pixels.rgb);
    }
    orient(*picture, up == "z", rotation.value_or(0.0));
    if (map && suns.value_or(true)) {
        separateSuns(*picture);
    }
    picture->seen = table.boolean("visible").value_or(true);
    return std::shared_ptr<const EnvironmentPicture>(std::move(picture));
}

} // namespace wedge::render
