#include "host/scene/sequence.h"

#include "host/file.h"
#include "host/files_opened.h"
#include "host/hash.h"
#include "host/scene/load_scene.h"
#include "host/scene/scene_file.h"

#include <tuple>
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
    return a.centre == b.centre && a.halfU == b.halfU && a.halfV == b.halfV && a.styles.empty() == b.styles.empty();
}
bool equal(const PointLight& a, const PointLight& b)
{
    return a.position == b.position && a.styles.empty() == b.styles.empty();
}
bool equal(const DirectionalLight& a, const DirectionalLight& b)
{
    return a.direction == b.direction && a.styles.empty() == b.styles.empty();
}
bool equal(const Camera& a, const Camera& b)
{
    const auto all = [](const Camera& c) {
        return std::tie(c.eye, c.lookAt, c.up, c.verticalFov, c.apertureRadius, c.focusDistance, c.apertureProfile);
    };
    return all(a) == all(b);
}
bool equal(const std::optional<Camera>& a, const std::optional<Camera>& b) { return a && b ? equal(*a, *b) : !a && !b; }

/// Whether two styles are drawn by the same passes, but for numbers: they differ in knobs alone, which have keys.
bool differInKnobs(const ShadowStyle& a, const ShadowStyle& b)
{
    ShadowStyle other = a;
    other.inflation = b.inflation;
    other.softness = b.softness;
    other.brightness = b.brightness;
    const auto passes = [](const ShadowStyle& s) {
        return std::tuple(s.abstraction.constant > 0.0f, s.inflation.varies(), s.softness.varies(),
            s.abstraction.varies(), s.brightness.varies());
    };
    // One that goes by what throws the shadow may be none at all, which is not known here.
    other.abstraction = a.abstraction.varies() ? a.abstraction : b.abstraction;
    return a == b || (other == b && !a.keys.empty() && passes(a) == passes(b));
}

template <class Light>
bool allDifferInKnobs(const std::vector<Light>& a, const std::vector<Light>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Light& x, const Light& y) {
        return std::equal(x.styles.begin(), x.styles.end(), y.styles.begin(), y.styles.end(), differInKnobs);
    });
}

/// Lights that are equal may have styles that are not.
template <class Light>
void moveStyles(std::vector<Light>& from, std::vector<Light>& to)
{
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i].styles = std::move(from.at(i).styles);
}

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
    Change change { .lights = !allEqual(moment.areaLights, scene.areaLights)
            || !allEqual(moment.pointLights, scene.pointLights)
            || !allEqual(moment.directionalLights, scene.directionalLights),
        .geometry = moment.geometry.has_value() };
    change.onlyKnobs = !change.lights && !change.geometry && equal(moment.camera, scene.camera)
        && equal(moment.cameraAtClose, scene.cameraAtClose) && allDifferInKnobs(moment.areaLights, scene.areaLights)
        && allDifferInKnobs(moment.pointLights, scene.pointLights)
        && allDifferInKnobs(moment.directionalLights, scene.directionalLights);
    return change;
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
    } else {
        moveStyles(moment.areaLights, scene.areaLights);
        moveStyles(moment.pointLights, scene.pointLights);
        moveStyles(moment.directionalLights, scene.directionalLights);
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
