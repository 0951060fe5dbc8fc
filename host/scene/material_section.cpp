#include "host/scene/material_section.h"

#include <set>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mtl_reader.h"

namespace wedge::scene {
namespace {

constexpr double maxExponent = 1e6;

using decode::TextureUse;

int readTextureKey(
    TableReader& table, const std::string& key, TextureSet& textures, TextureUse use = TextureUse::Colours)
{
    const auto path = table.path(key);
    if (!path)
        return -1;
    try {
        return textures.add(*path, use);
    } catch (const Error& error) {
        throw Error(table.where(key) + ": texture of the material", path->string(), error.what());
    }
}

/// A map of normals, or heights.
void readNormals(TableReader& table, TextureSet& textures, Material& m)
{
    const int normals = readTextureKey(table, "normal_texture", textures, TextureUse::Numbers);
    const int heights = readTextureKey(table, "bump_texture", textures, TextureUse::Numbers);
    const auto strength = table.number("normal_strength", -mostNormalStrength, mostNormalStrength);
    if (normals >= 0 && heights >= 0)
        table.fail("bump_texture", "stands beside a", "normal_texture", "give one of them");
    if (strength && normals < 0 && heights < 0)
        table.fail("normal_strength", "does nothing without a texture", fmt::format("{:g}", *strength),
            "give a normal_texture or a bump_texture");
    m.normalIsHeight = heights >= 0;
    m.normalTexture = m.normalIsHeight ? heights : normals;
    m.normalStrength = static_cast<float>(strength.value_or(m.normalStrength));
}

/// A mirror or glass has colours and an index, and nothing else of what reflects.
void readMirror(TableReader& table, const std::string& model, Material& m)
{
    const bool isGlass = model == "glass";
    const auto refuse = [&](const char* key) {
        table.fail(key, "does nothing beside the model", fmt::format("'{}'", model),
            isGlass ? "colour it by specular and transmission" : "colour it by specular");
    };
    for (const char* key : { "exponent", "roughness" })
        if (table.number(key, 0.0, maxExponent))
            refuse(key);
    if (table.colour("diffuse"))
        refuse("diffuse");
    for (const char* key : { "diffuse_texture", "specular_texture", "exponent_texture", "roughness_texture" })
        if (table.path(key))
            refuse(key);
    m.specularModel = isGlass ? SpecularModel::Glass : SpecularModel::Mirror;
    m.diffuse = glm::vec3(0.0f);
    m.specular = table.colour("specular").value_or(glm::vec3(1.0f));
}

/// What is glass' own.
void readGlass(TableReader& table, const std::string& model, Material& m)
{
    const auto index = table.number("ior", leastIndex, mostIndex);
    const auto transmission = table.colour("transmission");
    const auto priority = table.integer("priority", -mostPriority, mostPriority);
    if (model != "glass" && (index || transmission || priority))
        table.fail(index       ? "ior"
                : transmission ? "transmission"
                               : "priority",
            "does nothing beside the model", fmt::format("'{}'", model), "add model = \"glass\"");
    m.index = static_cast<float>(index.value_or(m.index));
    m.transmission = transmission.value_or(m.transmission);
    m.priority = static_cast<int>(priority.value_or(m.priority));
}

/// The lobe's model and what is its own; a number of another model would do nothing, which is an error.
void readModel(TableReader& table, TextureSet& textures, const std::string& model, Material& m)
{
    const bool isGgx = model == "ggx";
    m.specularModel = isGgx ? SpecularModel::Ggx : model == "phong" ? SpecularModel::Phong : SpecularModel::BlinnPhong;
    const auto exponent = table.number("exponent", 0.0, maxExponent);
    const auto roughness = table.number("roughness", 0.0, 1.0);
    const int exponentTexture = readTextureKey(table, "exponent_texture", textures, TextureUse::Numbers);
    const int roughnessTexture = readTextureKey(table, "roughness_texture", textures, TextureUse::Numbers);
    if (isGgx && (exponent || exponentTexture >= 0))
        table.fail(exponent ? "exponent" : "exponent_texture", "does nothing beside the model", "'ggx'",
            "give a roughness, or another model");
    if (!isGgx && (roughness || roughnessTexture >= 0))
        table.fail(roughness ? "roughness" : "roughness_texture", "does nothing beside the model",
            fmt::format("'{}'", model), "add model = \"ggx\", or give an exponent");
    m.exponent = static_cast<float>(exponent.value_or(m.exponent));
    // A texture multiplies the number, so it is seen as it is where none is given.
    m.roughness = static_cast<float>(roughness.value_or(roughnessTexture >= 0 ? 1.0 : m.roughness));
    m.exponentTexture = isGgx ? roughnessTexture : exponentTexture;
}

Material readMaterial(TableReader& table, TextureSet& textures, Warnings& warnings)
{
    Material m;
    m.name = table.require("name", table.text("name"));
    const std::string model =
        table.choice("model", { "phong", "blinn_phong", "ggx", "mirror", "glass" }).value_or("blinn_phong");
    m.emissionTexture = readTextureKey(table, "emission_texture", textures);
    m.opacityTexture = readTextureKey(table, "opacity_texture", textures, TextureUse::Numbers);
    m.opacity = static_cast<float>(table.number("opacity", 0.0, 1.0).value_or(m.opacity));
    // A texture multiplies its colour, so it is seen as it is where no colour is given.
    m.emission = table.colour("emission").value_or(m.emissionTexture >= 0 ? glm::vec3(1.0f) : m.emission);
    readGlass(table, model, m);
    if (model == "mirror" || model == "glass") {
        readMirror(table, model, m);
    } else {
        m.diffuseTexture = readTextureKey(table, "diffuse_texture", textures);
        m.specularTexture = readTextureKey(table, "specular_texture", textures);
        m.diffuse = table.colour("diffuse").value_or(m.diffuseTexture >= 0 ? glm::vec3(1.0f) : m.diffuse);
        m.specular = table.colour("specular").value_or(m.specularTexture >= 0 ? glm::vec3(1.0f) : m.specular);
        readModel(table, textures, model, m);
    }
    readNormals(table, textures, m);
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
