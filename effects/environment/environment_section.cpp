#include "effects/environment/environment_section.h"

#include "effects/environment/angular_map.h"
#include "effects/environment/map_numbers.h"
#include "effects/environment/suns.h"
#include "host/decode/limits.h"
#include "host/error.h"
#include "host/image/read_image.h"
#include "host/render/environment_table.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace wedge::render {
namespace {

/// A map takes 20 bytes a texel of the device.
constexpr std::int64_t mostTexels = std::int64_t { 1 } << 25;
constexpr double mostIntensity = 1e9;

/// A map as a file has it, its radiance times the intensity.
image::RgbImage readMap(const std::string& path, float intensity, scene::Warnings& warnings)
{
    decode::Limits limits = decode::referenceLimits;
    limits.pixels = mostTexels;
    limits.remedy = "scale the map down";
    image::ImageFile file(path, limits);
    if (file.isCubeMap()) {
        throw Error("environment map is a cube map (its attribute envmap)", path,
            "convert it to latitude and longitude, as exrenvmap -latlong does");
    }
    image::RgbImage map = file.read();
    makeRadiances(map, intensity, path, warnings);
    return map;
}

/// The same in all directions, times the intensity.
std::vector<float> evenRadiance(
    const scene::TableReader& table, const glm::vec3& radiance, float intensity, scene::Warnings& warnings)
{
    const glm::vec3 even = radiance * intensity;
    const float largest = std::max({ even.r, even.g, even.b });
    if (largest > mostRadiance) {
        warnings.add("environments",
            fmt::format("{}: radiance times intensity is {:g} W/(sr m^2), {:g} is used", table.where("radiance"),
                largest, mostRadiance));
    }
    const glm::vec3 used = glm::min(even, glm::vec3(mostRadiance));
    return { used.r, used.g, used.b };
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

std::any readEnvironment(scene::TableReader& table, scene::Warnings& warnings)
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
        picture->radiance = evenRadiance(table, *radiance, factor, warnings);
    } else {
        image::RgbImage pixels = readMap(map->string(), factor, warnings);
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
