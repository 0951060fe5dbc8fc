#include "host/scene/obj_reader.h"

#include <algorithm>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "host/error.h"
#include "host/scene/mtl_reader.h"
#include "host/scene/obj_scan.h"
#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxObjFile = std::uintmax_t { 8 } << 30;

/// Hands tinyobjloader the materials that were already resolved, under the names it will ask for.
class ResolvedMaterials : public tinyobj::MaterialReader {
public:
    explicit ResolvedMaterials(std::map<std::string, int> indices)
        : indices_(std::move(indices))
    {
    }

    bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>* map,
        std::string*, std::string*) override
    {
        *map = indices_;
        return true;
    }

private:
    std::map<std::string, int> indices_;
};

/// The files an mtllib line names: all of it where there is a file of that name, spaces and all, else each word, in
/// which a backslash keeps a space.
std::vector<std::string> libraryNames(
    const std::string& line, const std::filesystem::path& path, const std::string& where)
{
    std::error_code code;
    if (std::filesystem::exists(resolvePath(line, path.parent_path(), where), code))
        return { line };
    std::vector<std::string> names(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == ' ')
            names.back() += line[++i];
        else if (line[i] != ' ' && line[i] != '\t')
            names.back() += line[i];
        else if (!names.back().empty())
            names.emplace_back();
    }
    return names;
}

std::vector<Material> readLibraries(
    const ObjScan& scan, const std::filesystem::path& path, TextureSet& textures, std::vector<std::string>& warnings)
{
    const std::string where = "mesh file " + path.string();
    std::vector<Material> all;
    for (const std::string& line : scan.libraries) {
        for (const std::string& name : libraryNames(line, path, where)) {
            try {
                const auto more = readMtl(resolvePath(name, path.parent_path(), where), textures, warnings);
                all.insert(all.end(), more.begin(), more.end());
            } catch (const Error& error) {
                warnings.push_back(fmt::format("{}: {}; its materials become grey", where, error.what()));
            }
        }
    }
    return all;
}

/// Finds the material of a usemtl name: first as it is, then whatever the case of its letters, else grey.
Material findMaterial(const std::string& name, const std::vector<Material>& library, const std::string& where,
    std::vector<std::string>& warnings)
{
    for (const Material& material : library) {
        if (material.name == name)
            return material;
    }
    for (const Material& material : library) {
        if (lowerCase(material.name) == lowerCase(name)) {
            warnings.push_back(fmt::format("{}: material '{}' is taken for '{}'", where, name, material.name));
            return material;
        }
    }
    warnings.push_back(fmt::format("{}: material '{}' not found, grey is used", where, name));
    Material grey;
    grey.name = name;
    return grey;
}

void warnOfScan(const ObjScan& scan, const std::string& where, std::vector<std::string>& warnings)
{
    if (scan.droppedFaces > 0)
        warnings.push_back(fmt::format(
            "{}:{}: {} face(s) of fewer than 3 corners left out", where, scan.firstDroppedLine, scan.droppedFaces));
    if (scan.badNormals > 0)
        warnings.push_back(fmt::format(
            "{}: {} normal(s) are no finite numbers, geometric normals are used there", where, scan.badNormals));
    if (scan.badTexcoords > 0)
        warnings.push_back(
            fmt::format("{}: {} texture coordinate(s) are no finite numbers, 0 is used", where, scan.badTexcoords));
}

void copyAttributes(const tinyobj::attrib_t& from, Mesh& mesh)
{
    for (std::size_t i = 0; i + 2 < from.vertices.size(); i += 3)
        mesh.positions.emplace_back(from.vertices[i], from.vertices[i + 1], from.vertices[i + 2]);
    for (std::size_t i = 0; i + 2 < from.normals.size(); i += 3)
        mesh.normals.emplace_back(from.normals[i], from.normals[i + 1], from.normals[i + 2]);
    for (std::size_t i = 0; i + 1 < from.texcoords.size(); i += 2)
        mesh.texcoords.emplace_back(from.texcoords[i], from.texcoords[i + 1]);
}

void copyTriangles(const std::vector<tinyobj::shape_t>& shapes, std::uint32_t grey, Mesh& mesh)
{
    std::map<std::string, std::uint32_t> objects;
    for (const tinyobj::shape_t& shape : shapes) {
        if (shape.mesh.indices.empty())
            continue;
        const auto [object, isNew] = objects.emplace(shape.name, static_cast<std::uint32_t>(mesh.objectNames.size()));
        if (isNew)
            mesh.objectNames.push_back(shape.name.empty() ? "unnamed" : shape.name);
        for (const tinyobj::index_t& index : shape.mesh.indices)
            mesh.corners.push_back({ index.vertex_index, index.texcoord_index, index.normal_index });
        for (const int material : shape.mesh.material_ids) {
            mesh.materials.push_back(material < 0 ? grey : static_cast<std::uint32_t>(material));
            mesh.objects.push_back(object->second);
        }
    }
}

} // namespace

Mesh readObj(const std::filesystem::path& path, TextureSet& textures, std::vector<std::string>& warnings,
    const std::filesystem::path& library)
{
    const std::string where = "mesh file " + path.string();
    std::string text = readFile(path, "mesh file", maxObjFile);
    const ObjScan scan = scanObj(text, path.string());
    warnOfScan(scan, where, warnings);

    Mesh mesh;
    const std::vector<Material> materials =
        library.empty() ? readLibraries(scan, path, textures, warnings) : readMtl(library, textures, warnings);
    std::map<std::string, int> indices;
    for (const std::string& name : scan.materials) {
        std::string key = name;
        std::replace_if(
            key.begin(), key.end(), [](char c) { return c == ' ' || c == '\t'; }, objNameSpace);
        indices.emplace(key, static_cast<int>(mesh.palette.size()));
        mesh.palette.push_back(findMaterial(name, materials, where, warnings));
    }

    // The scan blanked the file's own mtllib lines; this one makes the loader ask for the resolved materials.
    text.insert(0, "mtllib resolved\n");
    std::istringstream stream(std::move(text));
    ResolvedMaterials resolved(std::move(indices));
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> unused;
    std::string warning, error;
    if (!tinyobj::LoadObj(&attributes, &shapes, &unused, &warning, &error, &stream, &resolved, true, false))
        throw Error(where + " cannot be read", error.substr(0, error.find('\n')), "export the mesh again");

    copyAttributes(attributes, mesh);
    copyTriangles(shapes, static_cast<std::uint32_t>(mesh.palette.size()), mesh);
    if (std::find(mesh.materials.begin(), mesh.materials.end(), mesh.palette.size()) != mesh.materials.end()) {
        mesh.hasNameless = true;
        mesh.palette.emplace_back();
        mesh.palette.back().name = "grey";
    }
    return mesh;
}

} // namespace wedge::scene
