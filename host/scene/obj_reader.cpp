#include "host/scene/obj_reader.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mtl_reader.h"
#include "host/scene/obj_parser.h"
#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxObjFile = std::uintmax_t { 8 } << 30;
constexpr std::size_t maxLibraries = 1000; // each is looked for among the files

bool isFile(const std::string& name, const std::filesystem::path& besides, const std::string& where)
{
    try {
        std::error_code code;
        return std::filesystem::exists(resolvePath(name, besides.parent_path(), where), code);
    } catch (const Error&) { // a variable that is not set: told when it is read
        return false;
    }
}

/// The files an mtllib line names: all of it where there is a file of that name, spaces and all, else each word, in
/// which a backslash or quotation marks keep spaces.
std::vector<std::string> libraryNames(
    const std::string& line, const std::filesystem::path& path, const std::string& where)
{
    if (isFile(line, path, where))
        return { line };
    std::vector<std::string> names(1);
    char quote = 0; // that the name is in
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (quote == 0 && names.back().empty() && line[i] == '#' && i > 0) // a comment
            break;
        const bool opens = names.back().empty() && (line[i] == '"' || line[i] == '\'');
        if (quote == 0 && opens && line.find(line[i], i + 1) != std::string::npos)
            quote = line[i];
        else if (quote != 0 && line[i] == quote)
            quote = 0;
        else if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == ' ')
            names.back() += line[++i];
        else if (quote != 0 || (line[i] != ' ' && line[i] != '\t'))
            names.back() += line[i];
        else if (!names.back().empty())
            names.emplace_back();
    }
    std::erase(names, "");
    return names;
}

/// The materials of all libraries, by the names that faces may call them.
class MaterialsByName {
public:
    /// Of materials of one name the first counts.
    void add(std::vector<Material>&& library)
    {
        for (Material& material : library) {
            const std::string name = material.name;
            const auto [known, isNew] = exact_.try_emplace(name, std::move(material));
            if (isNew)
                anyCase_.try_emplace(lowerCase(name), &known->second);
        }
    }

    /// As it is named, else whatever the case of its letters, else grey.
    Material find(const std::string& name, const std::string& where, Warnings& warnings) const
    {
        if (const auto same = exact_.find(name); same != exact_.end())
            return same->second;
        if (const auto near = anyCase_.find(lowerCase(name)); near != anyCase_.end()) {
            warnings.add("materials whose names differ in case",
                fmt::format("{}: material '{}' is taken for '{}'", where, name, near->second->name));
            return *near->second;
        }
        warnings.add(
            "materials that are not found", fmt::format("{}: material '{}' not found, grey is used", where, name));
        Material grey;
        grey.name = name;
        return grey;
    }

private:
    std::map<std::string, Material> exact_;
    std::map<std::string, const Material*> anyCase_;
};

/// Reads each library of a mesh file once; those that cannot be read leave a warning.
MaterialsByName readLibraries(
    const std::vector<std::string>& lines, const std::filesystem::path& path, TextureSet& textures, Warnings& warnings)
{
    const std::string where = "mesh file " + path.string();
    MaterialsByName materials;
    std::set<std::filesystem::path> known;
    for (const std::string& line : lines) {
        for (const std::string& name : libraryNames(line, path, where)) {
            if (known.size() == maxLibraries)
                throw Error(where + " names too many material libraries", fmt::format("more than {}", maxLibraries),
                    "merge them");
            try {
                const std::filesystem::path library = resolvePath(name, path.parent_path(), where);
                if (known.insert(library).second)
                    materials.add(readMtl(library, textures, warnings));
            } catch (const Error& error) {
                warnings.add("material files", fmt::format("{}: {}; its materials become grey", where, error.what()));
            }
        }
    }
    return materials;
}

void addGrey(Mesh& mesh)
{
    if (std::find(mesh.materials.begin(), mesh.materials.end(), mesh.palette.size()) == mesh.materials.end())
        return;
    mesh.hasNameless = true;
    mesh.palette.emplace_back();
    mesh.palette.back().name = "grey";
}

} // namespace

Mesh readObj(
    const std::filesystem::path& path, TextureSet& textures, Warnings& warnings, const std::filesystem::path& library)
{
    ObjText text = parseObj(readFile(path, "mesh file", maxObjFile), path.string(), warnings);
    MaterialsByName materials;
    if (library.empty())
        materials = readLibraries(text.libraries, path, textures, warnings);
    else
        materials.add(readMtl(library, textures, warnings));
    for (const std::string& name : text.materialNames)
        text.mesh.palette.push_back(materials.find(name, "mesh file " + path.string(), warnings));
    addGrey(text.mesh);
    return std::move(text.mesh);
}

Mesh readObjShape(const std::filesystem::path& path)
{
    Warnings untold;
    return parseObj(readFile(path, "mesh file", maxObjFile), path.string(), untold).mesh;
}

} // namespace wedge::scene
