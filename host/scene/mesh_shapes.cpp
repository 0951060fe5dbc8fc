#include "host/scene/mesh_shapes.h"

#include <map>

#include <fmt/format.h>

#include "host/scene/keyframes.h"
#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

void checkTriangles(TableReader& table, const Mesh& shape, const Mesh& mesh)
{
    const auto counts = [](const Mesh& m) {
        return fmt::format("{} vertices and {} triangles", m.positions.size(), m.corners.size() / 3);
    };
    const std::string remedy = "give shapes that differ in their vertices' places and normals alone";
    if (shape.positions.size() != mesh.positions.size() || shape.corners.size() != mesh.corners.size())
        table.fail("file", "has not the triangles of the mesh",
            fmt::format("{}, the mesh has {}", counts(shape), counts(mesh)), remedy);
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
        if (shape.corners[c].position != mesh.corners[c].position)
            table.fail("file", "has not the triangles of the mesh",
                fmt::format("triangle {} of {} has other corners", c / 3 + 1, mesh.corners.size() / 3),
                remedy + "; polygons of more than 3 corners may be split otherwise");
    }
}

Mesh readShape(TableReader& table, const Mesh& mesh, const std::function<void(Mesh&)>& finish)
{
    const std::filesystem::path path = table.require("file", table.path("file"));
    table.finish();
    if (lowerExtension(path) != ".obj")
        table.fail("file", "has an unknown format", path.string(), "name a Wavefront .obj file");
    // Of a shape only the places count, so what is wrong with its materials is not told.
    TextureSet textures = TextureSet::none();
    std::vector<std::string> warnings;
    Mesh shape = readObj(path, textures, warnings);
    checkTriangles(table, shape, mesh);
    finish(shape);
    return shape;
}

/// Normals may be shared otherwise in each shape, so that a normal stands for a pair of theirs.
void blendNormals(const Mesh& a, const Mesh& b, float weight, Mesh& out)
{
    std::map<std::pair<int, int>, int> pairs;
    out.normals.clear();
    for (std::size_t c = 0; c < out.corners.size(); ++c) {
        const int first = a.corners[c].normal, second = b.corners[c].normal;
        out.corners[c].normal = -1;
        if (first < 0 || second < 0)
            continue;
        const auto [pair, isNew] = pairs.emplace(std::pair(first, second), static_cast<int>(out.normals.size()));
        if (isNew)
            out.normals.push_back(glm::mix(
                a.normals[static_cast<std::size_t>(first)], b.normals[static_cast<std::size_t>(second)], weight));
        out.corners[c].normal = pair->second;
    }
}

} // namespace

MeshShapes::MeshShapes(TableReader& table, const Mesh& mesh, const std::function<void(Mesh&)>& finish)
{
    for (TableReader& shape : table.tables("shape")) {
        times_.push_back(readKeyTime(shape, times_));
        shapes_.push_back(readShape(shape, mesh, finish));
    }
}

Mesh MeshShapes::at(double time, const Mesh& mesh) const
{
    Mesh out = mesh;
    if (empty())
        return out;
    const KeySpan span = spanAt(times_, time);
    const Mesh &a = shapes_[span.from], &b = shapes_[span.to];
    const auto weight = static_cast<float>(span.weight);
    for (std::size_t i = 0; i < out.positions.size(); ++i)
        out.positions[i] = glm::mix(a.positions[i], b.positions[i], weight);
    blendNormals(a, b, weight, out);
    return out;
}

} // namespace wedge::scene
