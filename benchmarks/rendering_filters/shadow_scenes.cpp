#include "benchmarks/rendering_filters/shadow_scenes.h"

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

struct Map {
    const char *name, *meaning;
    const char* file; ///< below WEDGE_DATA; "" for data/scenes' own
    bool hasGoals;
};

struct Look {
    const char *name, *meaning;
    const char* lines; ///< of the material
    bool hasGoals;
};

constexpr Map maps[] = {
    { "grace", "Grace Cathedral", "hdr/small_grace.hdr", true },
    { "pisa", "Pisa", "hdr/small_pisa.hdr", true },
    { "ennis", "Ennis House", "hdr/small_ennis.hdr", false },
    { "wells", "Wells Cathedral", "hdr/small_wells.hdr", false },
    { "uffizi", "the Uffizi", "hdr/small_uffizi.hdr", false },
    { "sky", "data/scenes' sky", "", false },
};

constexpr Look looks[] = {
    { "matt", "matt", "diffuse = 0.7", false },
    { "phong40", "Phong 40", "model = \"phong\"\ndiffuse = 0\nspecular = 0.7\nexponent = 40", true },
    { "phong500", "Phong 500", "model = \"phong\"\ndiffuse = 0\nspecular = 0.7\nexponent = 500", true },
    { "ggx", "GGX of roughness 0.3", "model = \"ggx\"\ndiffuse = 0\nspecular = 0.7\nroughness = 0.3", false },
};

/// Of the material's lines, the map and the folder data/scenes. Suns stay in the map, which all ways are to light by.
constexpr const char* sceneText = R"(# {3}
[camera]
eye = [0, 1.6, 5.2]
look_at = [0, 0.55, 0]
fov = 36

[environment]
map = '{1}'
suns = false
visible = false

[[material]]
name = "all"
{0}

[[mesh]]
name = "plane"
file = '{2}/meshes/quad.obj'
material = "all"
transform = {{ scale = 40 }}

[[mesh]]
name = "spheres"
file = '{2}/meshes/sphere.obj'
smooth = true
instances = [
    {{ name = "a", material = "all", transform = [{{ scale = 0.6 }}, {{ translate = [-1.5, 0.6, 0.1] }}] }},
    {{ name = "b", material = "all", transform = [{{ scale = 0.75 }}, {{ translate = [0.2, 0.75, -0.3] }}] }},
    {{ name = "c", material = "all", transform = [{{ scale = 0.35 }}, {{ translate = [0.6, 0.35, 1.1] }}] }},
    {{ name = "d", material = "all", transform = [{{ scale = 0.5 }}, {{ translate = [1.6, 0.5, 0.1] }}] }},
]
)";

ShadowScene sceneOf(const Map& map, const Look& look)
{
    const std::string origin = fmt::format("{} spheres on a plane under {}", look.meaning, map.meaning);
    const std::string file = map.file;
    const auto text = [lines = std::string(look.lines), file, origin](const std::string& scenes) {
        const std::string path = file.empty() ? scenes + "/textures/sky.hdr" : "${WEDGE_DATA}/" + file;
        return fmt::format(sceneText, lines, path, scenes, origin);
    };
    ShadowScene out;
    static_cast<SceneSource&>(out) = writtenScene(fmt::format("{}_{}", map.name, look.name), origin, text, file);
    return out;
}

} // namespace

std::vector<ShadowScene> shadowScenes()
{
    std::vector<ShadowScene> out;
    out.reserve(std::size(maps) * std::size(looks));
    for (const Map& map : maps) {
        for (const Look& look : looks) {
            ShadowScene& scene = out.emplace_back(sceneOf(map, look));
            scene.hasGoals = map.hasGoals && look.hasGoals;
            scene.plainReference = scene.name == "pisa_phong500";
        }
    }
    return out;
}

} // namespace wedge::benchmark
