#include "host/scene/material_section.h"

#include <set>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mtl_reader.h"

namespace wedge::scene {
namespace {

constexpr double maxExponent = 1e6;

int readTextureKey(TableReader& table, const std::string& key, TextureSet& textures)
{
    const auto path = table.path(key);
    if (!path)
        return -1;
    try {
        return textures.add(*path);
    } catch (const Error& error) {
        throw Error(table.where(key) + ": texture of the material", path->string(), error.what());
    }
}

Material readMaterial(TableReader& table, TextureSet& textures, Warnings& warnings)
{
    Material m;
    m.name = table.require("name", table.text("name"));
    m.diffuseTexture = readTextureKey(table, "diffuse_texture", textures);
    m.specularTexture = readTextureKey(table, "specular_texture", textures);
    m.exponentTexture = readTextureKey(table, "exponent_texture", textures);
    m.emissionTexture = readTextureKey(table, "emission_texture", textures);
    m.opacityTexture = readTextureKey(table, "opacity_texture", textures);
    m.opacity = static_cast<float>(table.number("opacity", 0.0, 1.0).value_or(m.opacity));
    // A texture multiplies its colour, so it is seen as it is where no colour is given.
    m.diffuse = table.colour("diffuse").value_or(m.diffuseTexture >= 0 ? glm::vec3(1.0f) : m.diffuse);
    m.specular = table.colour("specular").value_or(m.specularTexture >= 0 ? glm::vec3(1.0f) : m.specular);
    m.emission = table.colour("emission").value_or(m.emissionTexture >= 0 ? glm::vec3(1.0f) : m.emission);
    m.exponent = static_cast<float>(table.number("exponent", 0.0, maxExponent).value_or(m.exponent));
    if (table.choice("model", { "phong", "blinn_phong" }).value_or("blinn_phong") == "phong")
        m.specularModel = SpecularModel::Phong;
    table.finish();
    warnOfEnergy({ m }, table.where("diffuse"), warnings);
    return m;
}

} // namespace

std::vector<Material> readMaterials(TableReader& root, TextureSet& textures, Warnings& warnings)
{
    std::vector<Material> materials;
    std::set<std::string> names;
    for (TableReader& table : root.tables("material")) {
        Material material = readMaterial(table, textures, warnings);
        if (!names.insert(material.name).second)
            table.fail("name", "is taken", fmt::format("'{}'", material.name), "give every material its own name");
        materials.push_back(std::move(material));
    }
    return materials;
}

} // namespace wedge::scene
