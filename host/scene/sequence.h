#pragma once

#include "host/scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wedge::scene {

/// What of a scene may differ from one time to another.
struct Moment {
    double shutterOpen = 0.0, shutterClose = 0.0;
    Camera camera;
    std::optional<Camera> cameraAtClose;
    std::vector<AreaLight> areaLights;
    std::vector<PointLight> pointLights;
    std::vector<DirectionalLight> directionalLights;
    std::optional<Geometry> geometry; ///< none: no mesh has keys, and all of them are as ever
};

/// Which parts of a scene a change alters. Its camera and its shutter may change in any case.
struct Change {
    bool lights = false; ///< those of Scene's lists
    bool geometry = false;
    /// Knobs of shadows' styles and nothing else, its camera neither: what frames have but for these can be kept.
    bool onlyKnobs = false;
};

/// What takes a scene from where it is to another moment. Equal geometry is none: it is dropped from the moment.
Change changeTo(Moment& moment, const Scene& scene);

/// Puts a scene at another moment. change: changeTo() of both; what it does not name keeps its memory.
void apply(Moment&& moment, const Change& change, Scene& scene);

/// A scene file that is read once, and the moments of its frames: frame n is the scene with its shutter n /
/// framesPerUnit later, so that frame 0 is the scene itself.
class Sequence {
public:
    /// As loadScene().
    explicit Sequence(const std::string& path, const LoadOptions& options = {});
    ~Sequence();
    Sequence(Sequence&&) noexcept;
    Sequence& operator=(Sequence&&) noexcept;

    /// The scene at frame 0, to be taken once.
    Scene takeScene();

    /// later: of the shutter, in the time of the keys. A camera that the file does not have is that of frame 0. Throws
    /// Error for what cannot be rendered at that time.
    Moment at(double later);

    /// A hash of the bytes of all files that were read. Throws Error for one that cannot be read any more.
    std::uint64_t contents() const;

private:
    struct File;
    std::unique_ptr<File> file_;
};

} // namespace wedge::scene
