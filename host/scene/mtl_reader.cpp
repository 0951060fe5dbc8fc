#include "host/scene/mtl_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "host/error.h"
#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxMtlFile = std::uintmax_t { 256 } << 20;

bool isNumber(const std::string& token)
{
    double value = 0.0;
    const char* begin = token.data() + (token.starts_with('+') ? 1 : 0);
    const char* end = token.data() + token.size();
    return std::from_chars(begin, end, value).ptr == end && begin != end;
}

/// Writes all three numbers behind the options -o, -s and -t of a texture line: tinyobjloader always takes three
/// tokens there, the file's name too where numbers were left out.
std::string completeTextureOptions(const std::string& line)
{
    std::istringstream in(line);
    std::string out, token;
    while (in >> token) {
        out += token + ' ';
        if (token != "-o" && token != "-s" && token != "-t")
            continue;
        const char* fill = token == "-s" ? "1 " : "0 ";
        int count = 0;
        std::streampos mark = in.tellg();
        for (std::string number; count < 3 && in >> number && isNumber(number); ++count) {
            out += number + ' ';
            mark = in.tellg();
        }
        in.clear();
        in.seekg(mark);
        for (; count < 3; ++count)
            out += fill;
    }
    return out;
}

bool isTextureLineWithOptions(const std::string& line)
{
    const std::size_t begin = line.find_first_not_of(" \t");
    return begin != std::string::npos && line.compare(begin, 4, "map_") == 0 && line.find(" -") != std::string::npos;
}

std::string repaired(const std::string& text)
{
    std::istringstream in(text);
    std::string out, line;
    while (std::getline(in, line))
        out += (isTextureLineWithOptions(line) ? completeTextureOptions(line) : line) + '\n';
    return out;
}

/// One library being read: where messages point to and where textures go.
struct Library {
    const std::filesystem::path& path;
    TextureSet& textures;
    std::vector<std::string>& warnings;

    void warn(const std::string& material, const std::string& text) const
    {
        warnings.push_back(fmt::format("material file {}: material '{}': {}", path.string(), material, text));
    }

    glm::vec3 colour(const tinyobj::real_t* rgb, const char* key, const std::string& material) const
    {
        glm::vec3 value(rgb[0], rgb[1], rgb[2]);
        for (int i = 0; i < 3; ++i) {
            if (!std::isfinite(value[i]) || value[i] < 0.0f) {
                warn(material, fmt::format("{} has the value {}, 0 is used", key, value[i]));
                value[i] = 0.0f;
            }
        }
        return value;
    }

    int texture(const std::string& name, const tinyobj::texture_option_t& option, const std::string& material) const
    {
        if (name.empty())
            return -1;
        const auto& s = option.scale;
        const auto& o = option.origin_offset;
        if (s[0] != 1 || s[1] != 1 || o[0] != 0 || o[1] != 0 || option.clamp)
            warn(material, fmt::format("the options -s, -o and -clamp of texture '{}' are not supported", name));
        try {
            return textures.add(resolvePath(name, path.parent_path(), "material file " + path.string()));
        } catch (const Error& error) {
            warn(material, fmt::format("{}; the plain colour is used", error.what()));
            return -1;
        }
    }

    Material convert(const tinyobj::material_t& m) const
    {
        Material out;
        out.name = m.name;
        out.diffuse = colour(m.diffuse, "Kd", m.name);
        out.specular = colour(m.specular, "Ks", m.name);
        out.emission = colour(m.emission, "Ke", m.name);
        out.exponent = m.shininess;
        if (!std::isfinite(out.exponent) || out.exponent < 0.0f) {
            warn(m.name, fmt::format("Ns has the value {}, 1 is used", out.exponent));
            out.exponent = 1.0f;
        }
        out.diffuseTexture = texture(m.diffuse_texname, m.diffuse_texopt, m.name);
        out.specularTexture = texture(m.specular_texname, m.specular_texopt, m.name);
        out.exponentTexture = texture(m.specular_highlight_texname, m.specular_highlight_texopt, m.name);
        out.emissionTexture = texture(m.emissive_texname, m.emissive_texopt, m.name);
        if (out.diffuseTexture >= 0 && out.diffuse == glm::vec3(0.0f)) {
            warn(m.name, "Kd is black and would hide its texture, white is used");
            out.diffuse = glm::vec3(1.0f);
        }
        if (m.dissolve < 1.0f)
            warn(m.name, "transparency (d, Tr) is not supported, it is opaque");
        return out;
    }
};

} // namespace

std::vector<Material> readMtl(
    const std::filesystem::path& path, TextureSet& textures, std::vector<std::string>& warnings)
{
    std::istringstream stream(repaired(readFile(path, "material file", maxMtlFile)));
    std::map<std::string, int> names;
    std::vector<tinyobj::material_t> read;
    std::string warning, error;
    tinyobj::LoadMtl(&names, &read, &stream, &warning, &error);
    const Library library { path, textures, warnings };
    std::vector<Material> materials;
    for (const tinyobj::material_t& material : read) {
        if (!material.name.empty()) // the loader ends every library with a nameless material
            materials.push_back(library.convert(material));
    }
    const std::string energy = energyWarning(materials, "material file " + path.string());
    if (!energy.empty())
        warnings.push_back(energy);
    return materials;
}

std::string energyWarning(const std::vector<Material>& materials, const std::string& where)
{
    const auto reflected = [](const Material& m) {
        const glm::vec3 sum = m.diffuse + m.specular;
        return std::max({ sum.x, sum.y, sum.z });
    };
    const auto tooMuch = [&](const Material& m) { return reflected(m) > 1.0f + 1e-5f; };
    const auto count = std::count_if(materials.begin(), materials.end(), tooMuch);
    if (count == 0)
        return {};
    const auto worst = std::max_element(materials.begin(), materials.end(),
        [&](const Material& a, const Material& b) { return reflected(a) < reflected(b); });
    return fmt::format("{}: {} material(s) reflect more light than they get; diffuse + specular of '{}' reaches {:.3g}",
        where, count, worst->name, reflected(*worst));
}

} // namespace wedge::scene
