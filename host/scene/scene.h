#pragma once

#include <any>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/shadow_style.h"

/// What is to be rendered, as plain data in world space. Units: metres, radiance in W/(m^2 sr), linear Rec.709.
namespace wedge::scene {

/// An 8-bit image. Its colour multiplies the material's constant of the same name.
struct Texture {
    std::string path;
    int width = 0, height = 0;
    std::vector<std::uint32_t> rgba; ///< width x height, colours by the sRGB curve, R low, row 0 = bottom (v = 0)
    bool hasAlpha = false; ///< some texel is not opaque, and as an opacity the alphas count; else luminance
};

enum class SpecularModel {
    Phong,
    BlinnPhong,
    Ggx,
    Mirror, ///< reflects specular of the mirrored view, and nothing else
    Glass, ///< a smooth dielectric: reflects specular and transmits transmission of Fresnel's shares
};

struct Material {
    std::string name;
    glm::vec3 diffuse { 0.5f }, specular { 0.0f }, emission { 0.0f };
    float exponent = 1.0f; ///< of the specular lobe, at least 0; Ggx has none
    float roughness = 0.5f; ///< of Ggx, 0 to 1; exponentTexture multiplies it. specular is what faces reflect head-on
    glm::vec3 transmission { 1.0f }; ///< of Glass, each time that light passes through the surface
    float index = 1.5f; ///< refractive index of Glass, above 0
    int priority = 0; ///< of Glass: where bodies overlap the one of the highest counts; within +-mostPriority
    SpecularModel specularModel = SpecularModel::BlinnPhong;
    float opacity = 1.0f; ///< 0 to 1: the share of rays that do not pass through
    /// Indices into Scene::textures; -1 = none.
    int diffuseTexture = -1, specularTexture = -1, exponentTexture = -1, emissionTexture = -1, opacityTexture = -1;
    int normalTexture = -1; ///< a normal map, or heights
    bool normalIsHeight = false;
    float normalStrength = 1.0f; ///< its slopes are multiplied by this; within +-mostNormalStrength
};

enum class LightProfile { Uniform, Gaussian };

/// A parallelogram of corners centre +- halfU +- halfV that emits towards cross(halfU, halfV).
struct AreaLight {
    std::string name;
    glm::vec3 centre { 0.0f }, halfU { 1.0f, 0.0f, 0.0f }, halfV { 0.0f, 0.0f, 1.0f };
    glm::vec3 radiance { 1.0f }; ///< at the centre; a Gaussian falls off from there, to exp(-cut^2/2) at an edge
    LightProfile profile = LightProfile::Gaussian;
    float cut = 2.0f; ///< half extent in standard deviations; a uniform light ignores it
    bool twoSided = false, visible = true;
    std::vector<ShadowStyle> styles = {}; ///< of its soft shadows, as of PointLight
};

struct PointLight {
    glm::vec3 position { 0.0f }, intensity { 1.0f }; ///< W/sr
    std::string name = {};
    std::vector<ShadowStyle> styles = {}; ///< none: its shadows are as they are
};

struct DirectionalLight {
    glm::vec3 direction { 0.0f, -1.0f, 0.0f }; ///< the way the light travels, unit length
    glm::vec3 irradiance { 1.0f }; ///< W/m^2 on a surface that faces the light
    std::string name = {};
    std::vector<ShadowStyle> styles = {}; ///< as of PointLight
};

/// How a lens transmits over its aperture.
enum class ApertureProfile {
    Uniform,
    Gaussian, ///< the aperture's radius is two standard deviations, and it ends there
};

/// How a shutter transmits over the time that it is open.
enum class ShutterProfile {
    Box,
    Gaussian, ///< half of the time is two standard deviations, and it ends there
};

/// A thin lens, or with apertureRadius 0 a pinhole.
struct Camera {
    glm::vec3 eye { 0.0f, 0.0f, 5.0f }, lookAt { 0.0f }, up { 0.0f, 1.0f, 0.0f };
    float verticalFov = 45.0f; ///< degrees
    float apertureRadius = 0.0f; ///< metres
    float focusDistance = 0.0f; ///< metres along the view axis to the plane in focus; 0: as far as lookAt
    ApertureProfile apertureProfile = ApertureProfile::Uniform;
};

/// All triangles of all instances. Counter-clockwise seen from the side the geometric normal points to.
struct Geometry {
    std::vector<float> positions; ///< 3 a vertex, world space, finite
    std::vector<float> normals; ///< 3 a vertex, unit length; the zero vector = use the geometric normal
    std::vector<float> texcoords; ///< 2 a vertex; v = 0 is the bottom of the image
    std::vector<std::uint32_t> indices; ///< 3 a triangle
    std::vector<std::uint32_t> materialIds, objectIds; ///< 1 a triangle; an object id is at least 1, 0 = background
    std::vector<std::string> objectNames; ///< of object id i at [i - 1]
    /// Positions and normals when the shutter closes, of as many vertices: between, they move in straight lines. Both
    /// are empty where nothing moves.
    std::vector<float> positionsAtClose, normalsAtClose;
};

/// What a scene file may set and the command line may override.
struct Settings {
    int width = 640, height = 480;
    std::uint32_t seed = 0;
    std::optional<std::string> method; ///< mc or aaf
    std::optional<int> spp, maxSpp; ///< 1 to maxSamples
    std::optional<float> mu; ///< leastMu to mostMu
    std::optional<std::string> integrator; ///< path or ao
    std::optional<int> bounces; ///< 0 to maxBounces; not with ao
    std::optional<float> ambientDistance; ///< metres, leastAmbientDistance to mostAmbientDistance; with ao only
    std::optional<std::string> lightSampling; ///< both, lights or directions; not with ao
    bool antialias = false;
    std::optional<std::string> pixelFilter; ///< box, gaussian or blackman-harris
};

struct Scene {
    std::string path;
    Geometry geometry;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<AreaLight> areaLights;
    std::vector<PointLight> pointLights;
    std::vector<DirectionalLight> directionalLights;
    glm::vec3 background { 0.0f }; ///< radiance where a camera ray hits nothing; it lights nothing
    Camera camera; ///< when the shutter opens
    std::optional<Camera> cameraAtClose; ///< when it closes, if it moves; lens and field of view are those of camera
    ShutterProfile shutterProfile = ShutterProfile::Box;
    double shutterOpen = 0.0, shutterClose = 0.0; ///< in the time of the scene file's keys; all above is as of these
    bool onlyStylesChange = false; ///< over time: styles of shadows have keys, and nothing else of the scene has
    double framesPerUnit = 24.0; ///< of sequences: frames in one unit of the keys' time, leastFps to mostFps
    Settings settings;
    std::map<std::string, std::any> extensions; ///< of the tables of sections.h, by their keys
    std::vector<std::string> warnings; ///< one line each, for the user
};

/// An axis-aligned box; empty when lo > hi.
struct Bounds {
    glm::vec3 lo { 1e30f }, hi { -1e30f };
    bool empty() const { return lo.x > hi.x; }
};

/// Counts for `wedge info`.
struct Summary {
    std::size_t triangles = 0, vertices = 0, objects = 0, materials = 0, textures = 0;
    std::size_t areaLights = 0, pointLights = 0, directionalLights = 0;
    std::size_t movingTriangles = 0; ///< with a corner that is elsewhere when the shutter closes
    std::size_t geometryBytes = 0, textureBytes = 0;
    Bounds bounds;
};

/// Image sides go from 1 to this, samples a pixel too, bounces from 0, and mu and the distance in metres within which
/// surfaces occlude from least to most: what the renderer accepts.
constexpr int maxImageSide = 32768;
constexpr int maxSamples = 1 << 20;
constexpr double leastMu = 0.01, mostMu = 1000.0;
constexpr int maxBounces = 1024;
constexpr int mostSurfaces = 1 << 16;
constexpr double mostNormalStrength = 1000.0;
constexpr int mostPriority = 100;
constexpr double leastIndex = 0.1, mostIndex = 10.0; ///< of refraction
constexpr double leastAmbientDistance = 1e-12, mostAmbientDistance = 1e12;
/// Frames of a sequence in one unit of the keys' time.
constexpr double leastFps = 1e-6, mostFps = 1e6;
/// Metres: a lens has a radius of at most this, and a distance in focus from least to most.
constexpr double mostAperture = 1e12, leastFocus = 1e-12, mostFocus = 1e12;

struct LoadOptions {
    /// Pixels that one texture may have, at least 1 and at most mostTexturePixels; all together may have 16 times as
    /// many.
    std::int64_t maxTexturePixels = std::int64_t { 1 } << 26;
};
constexpr std::int64_t mostTexturePixels = std::int64_t { 1 } << 30;

/// Reads a scene file (.toml, docs/scene-format.md) or a bare mesh (.obj), which gets a camera that frames it, an
/// area light above and a floor. Throws Error naming file, line and value for anything that cannot be rendered.
Scene loadScene(const std::string& path, const LoadOptions& options = {});

/// Whether anything that can be hit moves while the shutter is open.
inline bool geometryMoves(const Scene& scene) { return !scene.geometry.positionsAtClose.empty(); }

inline bool cameraMoves(const Scene& scene) { return scene.cameraAtClose.has_value(); }

/// Metres along the view from the eye to the plane in focus.
float distanceInFocus(const Camera& camera);

/// The camera in the middle between shutter open and close.
Camera middleCamera(const Scene& scene);

/// "uniform" and "gaussian", "box" and "gaussian".
const char* profileName(ApertureProfile profile);
const char* profileName(ShutterProfile profile);

/// The box around all triangles, from when the shutter opens until it closes; lights do not count.
Bounds sceneBounds(const Scene& scene);

Summary summary(const Scene& scene);

} // namespace wedge::scene
