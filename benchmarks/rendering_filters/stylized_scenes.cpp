#include "benchmarks/rendering_filters/stylized_scenes.h"

#include "data/generator/obj_writer.h"

#include <filesystem>
#include <random>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// Of the comment, the light with its style, what throws its shadow, and the folder data/scenes.
constexpr const char* sceneText = R"(# {0}
[camera]
eye = [0, 4.2, 5]
look_at = [0, 0.1, 0.1]
fov = 40

[background]
radiance = [0.5, 0.6, 0.8]

[[material]]
name = "floor"
diffuse = 0.7

[[material]]
name = "thing"
diffuse = [0.5, 0.3, 0.2]

[[mesh]]
name = "floor"
file = '{3}/meshes/quad.obj'
material = "floor"
transform = {{ scale = 40 }}

{2}
{1}
)";

constexpr const char* sunText = R"([[light]]
type = "directional"
name = "sun"
direction = [0.35, -1, 0.2]
irradiance = [2.6, 2.4, 2.1]

[[light.style]]
)";

/// About as much light from where that sun is.
constexpr const char* quadText = R"([[light]]
type = "quad"
name = "lamp"
centre = [-3.5, 10, -2]
half_u = [0.4, 0, 0]
half_v = [0, 0, 0.4]
radiance = [540, 500, 440]
two_sided = true
visible = false

[[light.style]]
)";

constexpr double jitter = 0.1; ///< metres that a ball may be beside its place
constexpr int ballsAcross = 14, ballsAlong = 10;
constexpr int squares = 30000;
constexpr double squareSide = 0.015; ///< metres

/// From 0 to 1, the same everywhere.
double uniform(std::mt19937& random) { return (static_cast<double>(random()) + 0.5) / 4294967296.0; }

std::string balls(const std::string& scenes)
{
    std::mt19937 random(1);
    std::string out = fmt::format("[[mesh]]\nname = \"ball\"\nfile = '{}/meshes/sphere.obj'\nmaterial = "
                                  "\"thing\"\nsmooth = true\ninstances = [\n",
        scenes);
    for (int k = 0; k < ballsAcross * ballsAlong; ++k) {
        const int column = k % ballsAcross, row = k / ballsAcross;
        const double x = 0.3 * column - 1.95 + jitter * (2 * uniform(random) - 1);
        const double z = 0.3 * row - 1.35 + jitter * (2 * uniform(random) - 1);
        out +=
            fmt::format("    {{ transform = [{{ scale = 0.09 }}, {{ translate = [{:.4f}, 0.6, {:.4f}] }}] }},\n", x, z);
    }
    return out + "]\n";
}

constexpr const char* squareFile = "squares.obj";

std::string squareMesh()
{
    std::mt19937 random(2);
    generator::ObjWriter mesh;
    mesh.object("squares", "thing");
    for (int k = 0; k < squares; ++k) {
        const glm::dvec3 at(6 * uniform(random) - 3, 0.4, 5 * uniform(random) - 2.5);
        const glm::dvec3 u(squareSide, 0, 0), v(0, 0, squareSide);
        mesh.quad(mesh.vertex(at), mesh.vertex(at + v), mesh.vertex(at + u + v), mesh.vertex(at + u));
    }
    return mesh.text();
}

/// light: up to its style
StylizedScene ofBalls(
    const std::string& name, const std::string& style, const std::string& meaning, const std::string& light = sunText)
{
    const std::string origin = fmt::format("140 balls of radius 0.09 m, 0.6 m over a floor: {}", meaning);
    const auto text = [=](const std::string& scenes) {
        return fmt::format(sceneText, origin, light + style, balls(scenes), scenes);
    };
    return { writtenScene(name, origin, text), true };
}

StylizedScene ofSquares()
{
    const std::string origin = fmt::format("{} squares over a floor: a shadow of noise, inflated by 1 m", squares);
    const auto text = [origin](const std::string& scenes) {
        const std::string mesh =
            fmt::format("[[mesh]]\nname = \"squares\"\nfile = '{}'\nmaterial = \"thing\"\n", squareFile);
        return fmt::format(sceneText, origin, sunText + std::string("inflation = 1"), mesh, scenes);
    };
    StylizedScene out { writtenScene("squares", origin, text), false };
    out.file = [scene = out.file] {
        const std::filesystem::path path = scene();
        generator::writeText(path.parent_path() / squareFile, squareMesh());
        return path.string();
    };
    return out;
}

} // namespace

std::vector<StylizedScene> stylizedScenes()
{
    return { { shippedScene("styled", "a tree and a fence, all knobs"), true },
        ofBalls("balls", "inflation = 0.02", "inflation"),
        ofBalls("balls_smooth", "inflation = 0.02\nsoftness = 0.05\nabstraction = 0.03\nbrightness = [0.1, 0.14, 0.24]",
            "all knobs"),
        ofBalls("balls_wide", "inflation = 0.3\nsoftness = 0.3", "distances as far as the balls are apart"),
        ofBalls("balls_soft",
            "penumbra = 0.5\ninflation = 0.02\nsoftness = 0.05\nabstraction = 0.03\nbrightness = [0.1, 0.14, 0.24]",
            "all knobs of a quad's soft shadows", quadText),
        ofSquares() };
}

} // namespace wedge::benchmark
