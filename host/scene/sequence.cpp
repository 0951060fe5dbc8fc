#include "host/scene/sequence.h"

#include "host/file.h"
#include "host/files_opened.h"
#include "host/hash.h"
#include "host/scene/load_scene.h"
#include "host/scene/scene_file.h"

#include <utility>

namespace wedge::scene {
namespace {

/// Of the bytes and of how many they are.
void addFile(Hash& hash, const std::filesystem::path& path)
{
    const OpenFile file = openFile(path, "scene's file");
    std::string part(std::size_t { 1 } << 16, '\0');
    std::uint64_t total = 0;
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), file.stream.get())) {
        hash.addBytes(part.data(), count);
        total += count;
    }
    hash.add(total);
}

bool equal(const Geometry& a, const Geometry& b)
{
    return a.positions == b.positions && a.normals == b.normals && a.indices == b.indices && a.texcoords == b.texcoords
        && a.positionsAtClose == b.positionsAtClose && a.normalsAtClose == b.normalsAtClose;
}

bool equal(const AreaLight& a, const AreaLight& b)
{
    return a.centre == b.centre && a.halfU == b.halfU && a.halfV == b.halfV;
}
bool equal(const PointLight& a, const PointLight& b) { return a.position == b.position; }
bool equal(const DirectionalLight& a, const DirectionalLight& b) { return a.direction == b.direction; }

template <class Light>
bool allEqual(const std::vector<Light>& a, const std::vector<Light>& b)
{
    return std::equal(
        a.begin(), a.end(), b.begin(), b.end(), [](const Light& x, const Light& y) { return equal(x, y); });
}

} // namespace

Change changeTo(Moment& moment, const Scene& scene)
{
    if (moment.geometry && equal(*moment.geometry, scene.geometry))
        moment.geometry.reset();
    return { .lights = !allEqual(moment.areaLights, scene.areaLights)
            || !allEqual(moment.pointLights, scene.pointLights)
            || !allEqual(moment.directionalLights, scene.directionalLights),
        .geometry = moment.geometry.has_value() };
}

void apply(Moment&& moment, const Change& change, Scene& scene)
{
    scene.shutterOpen = moment.shutterOpen;
    scene.shutterClose = moment.shutterClose;
    scene.camera = moment.camera;
    scene.cameraAtClose = moment.cameraAtClose;
    if (change.lights) {
        scene.areaLights = std::move(moment.areaLights);
        scene.pointLights = std::move(moment.pointLights);
        scene.directionalLights = std::move(moment.directionalLights);
    }
    if (change.geometry)
        scene.geometry = std::move(*moment.geometry);
}

struct Sequence::File {
    Scene scene; ///< at frame 0, until it is taken
    Warnings warnings;
    std::unique_ptr<SceneFile> text; ///< null: a bare mesh, of which nothing moves
    std::vector<std::filesystem::path> paths;
    Moment start;
};

Sequence::Sequence(const std::string& path, const LoadOptions& options)
    : file_(std::make_unique<File>())
{
    const FilesOpened opened;
    file_->text = readScene(path, options, file_->scene, file_->warnings);
    file_->paths = opened.paths();
    file_->start.camera = file_->scene.camera;
    file_->start.areaLights = file_->scene.areaLights;
}

Sequence::~Sequence() = default;
Sequence::Sequence(Sequence&&) noexcept = default;
Sequence& Sequence::operator=(Sequence&&) noexcept = default;

Scene Sequence::takeScene() { return std::move(file_->scene); }

Moment Sequence::at(double later)
{
    if (file_->text)
        return file_->text->at(later);
    Moment moment = file_->start;
    moment.shutterOpen = moment.shutterClose = later;
    return moment;
}

std::uint64_t Sequence::contents() const
{
    Hash hash;
    for (const std::filesystem::path& path : file_->paths)
        addFile(hash, path);
    return hash.value();
}

} // namespace wedge::scene
