#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "host/scene/mesh.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// The mesh files of a scene, each read once with each material library, and where their materials are in the scene.
class MeshFiles {
public:
    struct Entry {
        Mesh mesh;
        std::uint32_t materialBase = 0;
    };

    MeshFiles(Scene& scene, TextureSet& textures, Warnings& warnings)
        : scene_(scene)
        , textures_(textures)
        , warnings_(warnings)
    {
    }

    /// An empty `library` stands for those that the mesh file names.
    const Entry& get(const std::filesystem::path& path, const std::filesystem::path& library);

    /// The triangles alone.
    const Mesh& shape(const std::filesystem::path& path);

private:
    Scene& scene_;
    TextureSet& textures_;
    Warnings& warnings_;
    std::map<std::pair<std::filesystem::path, std::filesystem::path>, Entry> entries_;
    std::map<std::filesystem::path, Mesh> shapes_;
};

/// The key `file` of a [[mesh]] or of one of its shapes. Error for a format that is not known.
std::filesystem::path readMeshPath(TableReader& table);

} // namespace wedge::scene
