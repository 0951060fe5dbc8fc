#include "host/scene/mesh_shapes.h"

#include <map>

#include <fmt/format.h>

#include "host/scene/keyframes.h"

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

glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double weight, bool isSingle)
{
    return isSingle ? glm::dvec3(glm::mix(glm::vec3(a), glm::vec3(b), static_cast<float>(weight)))
                    : glm::mix(a, b, weight);
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

MeshShapes::MeshShapes(TableReader& table, const Mesh& mesh, MeshFiles& files, const std::function<void(Mesh&)>& finish)
{
    std::map<const Mesh*, std::shared_ptr<const Mesh>> finished;
    for (TableReader& shape : table.tables("shape")) {
        times_.push_back(readKeyTime(shape, times_));
        const std::filesystem::path path = readMeshPath(shape);
        shape.finish();
        const Mesh& read = files.shape(path);
        std::shared_ptr<const Mesh>& known = finished[&read];
        if (!known) {
            checkTriangles(shape, read, mesh);
            const auto own = std::make_shared<Mesh>(read);
            finish(*own);
            known = own;
        }
        shapes_.push_back(known);
    }
}

Mesh MeshShapes::at(double time, const Mesh& mesh) const
{
    Mesh out = mesh;
    if (empty())
        return out;
    const KeySpan span = spanAt(times_, time);
    const Mesh &a = *shapes_[span.from], &b = *shapes_[span.to];
    out.isSingle = a.isSingle && b.isSingle;
    for (std::size_t i = 0; i < out.positions.size(); ++i)
        out.positions[i] = between(a.positions[i], b.positions[i], span.weight, out.isSingle);
    blendNormals(a, b, static_cast<float>(span.weight), out);
    return out;
}

} // namespace wedge::scene
