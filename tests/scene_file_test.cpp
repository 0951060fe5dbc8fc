// Scene files: every section, good and bad.

#include <cmath>

#include <doctest/doctest.h>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::LightProfile;
using wedge::scene::loadScene;
using wedge::scene::Scene;
using wedge::scene::SpecularModel;

namespace {

glm::vec3 normalOf(const Scene& scene, std::size_t triangle)
{
    const auto& g = scene.geometry;
    const glm::vec3 a = corner(g, triangle, 0);
    return glm::normalize(glm::cross(corner(g, triangle, 1) - a, corner(g, triangle, 2) - a));
}

} // namespace

TEST_CASE("lights without extent in a scene with glass are warned of, by their places and the materials' names")
{
    const TemporaryFolder folder;
    folder.write("pane.obj", triangleObj);
    const std::string mesh = "[[mesh]]\nname='m'\nmaterial='pane'\nfile='pane.obj'\n";
    const std::string point = "[[light]]\ntype='point'\nposition=[1, 2, 3]\nintensity=7\n";
    const std::string sun = "[[light]]\ntype='directional'\ndirection=[0, -2, 0]\nirradiance=1\n";
    const std::string glass = "[[material]]\nname='pane'\nmodel='glass'\n",
                      mirror = "[[material]]\nname='pane'\nmodel='mirror'\n";
    const auto warnings = [&](const std::string& text) { return loadScene(folder.write("s.toml", text)).warnings; };
    REQUIRE(warnings(glass + mesh + point + sun).size() == 1);
    const std::string told = warnings(glass + mesh + point + sun)[0];
    CHECK(
        contains(told, "light of the point light at [1, 2, 3], the directional light along [0, -1, 0] does not pass"));
    CHECK(contains(told, "of material 'pane'"));
    CHECK(warnings(mirror + mesh + point + sun).empty());
    CHECK(warnings(glass + point).size() == 1); // of the mesh that there is not
    CHECK(contains(warnings(glass + point)[0], "no mesh"));
}

TEST_CASE("a scene file with every section")
{
    const Scene s = load(R"(
[camera]
eye = [1, 2, 3]
look_at = [0, 0.5, 0]
up = [0, 0, 1]
fov = 30
[image]
width = 320
height = 200
[background]
radiance = [0.1, 0.2, 0.3]
[integrator]
type = "path"
bounces = 1024
light_sampling = "directions"
antialias = true
method = "aaf"
spp = 16
max_spp = 64
mu = 1.5
seed = 4294967295
[[material]]
name = "shiny"
model = "phong"
diffuse = 0.25
specular = [0.1, 0.2, 0.3]
emission = 1
exponent = 80
[[mesh]]
file = "m.obj"
material = "shiny"
[[light]]
type = "quad"
name = "key"
corner = [-1, 4, -2]
edge1 = [2, 0, 0]
edge2 = [0, 0, 4]
radiance = [1, 2, 3]
cut = 3
two_sided = true
visible = false
[[light]]
type = "quad"
centre = [0, 4, 0]
half_u = [1, 0, 0]
half_v = [0, 0, 2]
flip = true
radiance = 5
profile = "uniform"
[[light]]
type = "point"
position = [1, 2, 3]
intensity = 7
[[light]]
type = "directional"
direction = [0, -2, 0]
irradiance = [1, 1, 0.5]
)");
    CHECK(s.warnings.empty());
    CHECK(s.camera.eye == glm::vec3(1, 2, 3));
    CHECK(s.camera.lookAt == glm::vec3(0, 0.5f, 0));
    CHECK(s.camera.up == glm::vec3(0, 0, 1));
    CHECK(s.camera.verticalFov == 30.0f);
    CHECK(s.settings.width == 320);
    CHECK(s.settings.height == 200);
    CHECK(s.background == glm::vec3(0.1f, 0.2f, 0.3f));
    CHECK(s.settings.integrator == "path");
    CHECK(s.settings.bounces == 1024);
    CHECK(s.settings.lightSampling == "directions");
    CHECK(s.settings.antialias);
    CHECK_FALSE(s.settings.ambientDistance.has_value());
    CHECK(*s.settings.method == "aaf");
    CHECK(*s.settings.spp == 16);
    CHECK(*s.settings.maxSpp == 64);
    CHECK(*s.settings.mu == 1.5f);
    CHECK(s.settings.seed == 4294967295u);
    const auto& m = s.materials.at(s.geometry.materialIds.at(0));
    CHECK(m.name == "shiny");
    CHECK(m.specularModel == SpecularModel::Phong);
    CHECK(m.diffuse == glm::vec3(0.25f));
    CHECK(m.specular == glm::vec3(0.1f, 0.2f, 0.3f));
    CHECK(m.emission == glm::vec3(1.0f));
    CHECK(m.exponent == 80.0f);
    REQUIRE(s.areaLights.size() == 2);
    const auto& key = s.areaLights[0];
    CHECK(key.name == "key");
    CHECK(key.centre == glm::vec3(0, 4, 0));
    CHECK(key.halfU == glm::vec3(1, 0, 0));
    CHECK(key.halfV == glm::vec3(0, 0, 2));
    CHECK(key.radiance == glm::vec3(1, 2, 3));
    CHECK(key.profile == LightProfile::Gaussian);
    CHECK(key.cut == 3.0f);
    CHECK(key.twoSided);
    CHECK_FALSE(key.visible);
    const auto& other = s.areaLights[1];
    CHECK(other.profile == LightProfile::Uniform);
    CHECK(glm::cross(other.halfU, other.halfV).y > 0.0f); // flipped
    CHECK(glm::cross(key.halfU, key.halfV).y < 0.0f);
    REQUIRE(s.pointLights.size() == 1);
    CHECK(s.pointLights[0].position == glm::vec3(1, 2, 3));
    CHECK(s.pointLights[0].intensity == glm::vec3(7.0f));
    REQUIRE(s.directionalLights.size() == 1);
    CHECK(s.directionalLights[0].direction == glm::vec3(0, -1, 0));
    CHECK(s.directionalLights[0].irradiance == glm::vec3(1, 1, 0.5f));
}

TEST_CASE("defaults: settings unset, camera frames the mesh, warnings for what is missing")
{
    const Scene s = load(mesh);
    CHECK_FALSE(s.settings.method.has_value());
    CHECK_FALSE(s.settings.integrator.has_value());
    CHECK_FALSE(s.settings.bounces.has_value());
    CHECK_FALSE(s.settings.lightSampling.has_value());
    CHECK_FALSE(s.settings.antialias);
    CHECK_FALSE(s.settings.spp.has_value());
    CHECK(s.settings.width == 640);
    CHECK(s.settings.height == 480);
    CHECK(glm::length(s.camera.lookAt - glm::vec3(0.5f, 0, -0.5f)) < 1e-6f);
    CHECK(warns(s, "no light"));
    const Scene empty = load("");
    CHECK(warns(empty, "no mesh"));
    CHECK(wedge::scene::sceneBounds(empty).empty());
}

TEST_CASE("unknown keys are told with their place and the nearest known key")
{
    CHECK(error("[camera]\neye = [0, 0, 1]\nlookat = [0, 0, 0]\nlook_at = [0, 0, 0]\n")
        == "scene file s.toml:3:1: unknown key in camera: 'lookat': did you mean 'look_at'?");
    CHECK(error("[image]\nwidth = 3\n  widht = 4\n")
        == "scene file s.toml:3:3: unknown key in image: 'widht': did you mean 'width'?");
    CHECK(contains(error("[cameras]\n"), "s.toml:1:2: unknown key in the scene: 'cameras': did you mean 'camera'?"));
    CHECK(contains(error("[[light]]\ntype='point'\nposition=[0,0,0]\nintensity=1\nprofile='uniform'\n"),
        "s.toml:5:1: unknown key in light: 'profile': use one of: intensity, key, name, position, style, type"));
    CHECK(contains(error(mesh + "colour = 1\n"), "unknown key in mesh: 'colour'"));
    CHECK(contains(error(mesh + "instances = [{ translate = [1, 0, 0] }]\n"), "unknown key in mesh.instances"));
    CHECK(contains(error("[[material]]\nname='a'\ndifuse=1\n"), "did you mean 'diffuse'?"));
    CHECK(contains(error("[integrator]\nSpp = 3\n"), "did you mean 'spp'?"));
    CHECK(contains(error("[background]\nradiance=0\nqqqqqq=0\n"), "use one of: radiance"));
}

TEST_CASE("textures of opacity, normals and heights, and their factors")
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj);
    // One white texel of a TGA file.
    folder.write("a.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\xff\xff\xff", 21));
    const auto material = [&](const std::string& keys) {
        return wedge::scene::loadScene(
            folder.write("s.toml", mesh + "material = 'a'\n[[material]]\nname = 'a'\n" + keys))
            .materials[0];
    };
    CHECK(material("").opacity == 1);
    CHECK(material("").opacityTexture == -1);
    CHECK(material("").normalTexture == -1);
    CHECK(material("opacity = 0.25").opacity == 0.25f);
    CHECK(material("opacity_texture = 'a.tga'").opacityTexture == 0);
    CHECK(material("opacity_texture = 'a.tga'").opacity == 1);
    const auto normals = material("normal_texture = 'a.tga'\nnormal_strength = -0.5");
    CHECK(normals.normalTexture == 0);
    CHECK_FALSE(normals.normalIsHeight);
    CHECK(normals.normalStrength == -0.5f);
    const auto heights = material("bump_texture = 'a.tga'");
    CHECK(heights.normalTexture == 0);
    CHECK(heights.normalIsHeight);
    CHECK(heights.normalStrength == 1);
    const std::string both =
        folder.write("t.toml", mesh + "[[material]]\nname = 'a'\nnormal_texture = 'a.tga'\nbump_texture = 'a.tga'\n");
    CHECK(contains(errorOf(both), "stands beside a: normal_texture: give one of them"));
    CHECK(contains(error("[[material]]\nname='a'\nopacity=1.5\n"), "opacity of material is out of range"));
}

TEST_CASE("wrong types and values are told with their place")
{
    CHECK(error("[image]\nwidth = 3.5\n")
        == "scene file s.toml:2:9: width of image must be a whole number: 3.5: give width as a whole number");
    CHECK(error("[image]\nwidth = 0\n") == "scene file s.toml:2:9: width of image is out of range: 0: use 1 to 32768");
    CHECK(contains(error("[image]\nheight = 100000\n"), "s.toml:2:10: height of image is out of range: 100000"));
    CHECK(contains(error("[image]\nheight = -4\n"), "out of range: -4"));
    CHECK(contains(error("image = 3\n"), "s.toml:1:9: image of the scene must be one table, [image]: 3"));
    CHECK(contains(error("mesh = [3]\n"), "s.toml:1:9: entry of mesh is not a table: 3"));
    CHECK(contains(error("[background]\nradiance = [1, 2]\n"), "radiance of background must have 3 numbers: [ 1, 2 ]"));
    CHECK(contains(error("[background]\nradiance = [1, 2, 'x']\n"), "must be a number: 'x'"));
    CHECK(contains(error("[background]\nradiance = [1, nan, 2]\n"), "radiance of background is not finite: nan"));
    CHECK(contains(error("[background]\nradiance = inf\n"), "is not finite: inf"));
    CHECK(contains(error("[background]\nradiance = [0, -1, 0]\n"), "radiance of background is negative"));
    CHECK(contains(error("[background]\n"), "s.toml:1:1: background lacks a key: radiance: add 'radiance = ...'"));
    CHECK(contains(error("[integrator]\nmethod = 'magic'\n"), "method of integrator is unknown: 'magic': use one of"));
    CHECK(contains(error("[integrator]\nmu = 0\n"), "mu of integrator is out of range"));
    CHECK(contains(error("[integrator]\nmethod = 'saaf'\n"), "s.toml:2:10: method of integrator is unknown: 'saaf'"));
    CHECK(contains(error("[integrator]\nseed = -1\n"), "seed of integrator is out of range"));
    CHECK(contains(error("[[material]]\nname='a'\nexponent=-1\n"), "exponent of material is out of range"));
    CHECK(
        contains(error("[[material]]\nname='a'\nroughness=2\nmodel='ggx'\n"), "roughness of material is out of range"));
    CHECK(contains(error("[[material]]\nname='a'\nroughness=0.2\n"), "does nothing beside the model: 'blinn_phong'"));
    CHECK(contains(error("[[material]]\nname='a'\nexponent=2\nmodel='ggx'\n"), "does nothing beside the model: 'ggx'"));
    CHECK(contains(error("[[material]]\nname='a'\nnormal_strength=2\n"), "does nothing without a texture: 2"));
    CHECK(contains(error("[[material]]\nname='a'\nnormal_strength=2000\n"), "normal_strength of material is out of"));
    CHECK(contains(error("[[material]]\nname='a'\nior=1.3\n"), "ior of material does nothing beside the model"));
    CHECK(contains(error("[[material]]\nname='a'\nior=1.3\nmodel='mirror'\n"), "the model: 'mirror': add model ="));
    CHECK(
        contains(error("[[material]]\nname='a'\npriority=1\n"), "priority of material does nothing beside the model"));
    CHECK(contains(
        error("[[material]]\nname='a'\npriority=101\nmodel='glass'\n"), "priority of material is out of range"));
    CHECK(contains(error("[[material]]\nname='a'\nior=0.01\nmodel='glass'\n"), "ior of material is out of range"));
    CHECK(contains(error("[[material]]\nname='a'\ndiffuse=0.1\nmodel='mirror'\n"),
        "diffuse of material does nothing beside the model: 'mirror': colour it by specular"));
    CHECK(contains(error("[[material]]\nname='a'\nroughness_texture='b.png'\nmodel='glass'\n"),
        "roughness_texture of material does nothing beside the model: 'glass'"));
    CHECK(contains(error("[[material]]\nname='a'\n[[material]]\nname='a'\n"), "s.toml:4:6: name of material is taken"));
    CHECK(contains(error("[[material]]\ndiffuse=1\n"), "material lacks a key: name"));
    CHECK(
        contains(error("[[material]]\nname='a'\ndiffuse_texture='no.png'\n"), "s.toml:3:17: texture of the material"));
    CHECK(contains(error("x = \n"), "s.toml:1:5: not valid TOML"));
    CHECK(contains(error("a = 1\na = 2\n"), "s.toml:2"));
    CHECK(contains(error(std::string("\0\1\2\3", 4)), "s.toml:1:1: not valid TOML"));
}

TEST_CASE("the integrator: paths or ambient occlusion, and the keys of one that the other has no use for")
{
    const auto integrator = [](const std::string& keys) { return load("[integrator]\n" + keys).settings; };
    const auto refused = [](const std::string& keys) { return error("[integrator]\n" + keys); };
    CHECK(integrator("bounces = 0\n").bounces == 0); // given, and not the same as left out
    CHECK(integrator("type = 'ao'\n").integrator == "ao");
    CHECK_FALSE(integrator("type = 'ao'\n").ambientDistance.has_value());
    CHECK(integrator("ao_distance = 0.25\ntype = 'ao'\n").ambientDistance == 0.25f);
    CHECK(integrator("light_sampling = 'lights'\n").lightSampling == "lights");
    CHECK(integrator("pixel_filter = 'blackman-harris'\n").pixelFilter == "blackman-harris");
    CHECK(contains(refused("pixel_filter = 'sinc'\n"), "pixel_filter of integrator is unknown: 'sinc'"));

    CHECK(refused("type = 'ao'\nbounces = 0\n")
        == "scene file s.toml:3:11: bounces of integrator has no effect with type ao, which follows no paths: 0: leave "
           "it out or choose type path");
    CHECK(refused("type = 'ao'\nlight_sampling = 'both'\n")
        == "scene file s.toml:3:18: light_sampling of integrator has no effect with type ao, which knows no lights: "
           "'both': leave it out or choose type path");
    const std::string noAmbient = "ao_distance of integrator has no effect with type path: 2.5: leave it out or choose "
                                  "type ao";
    CHECK(refused("ao_distance = 2.5\n") == "scene file s.toml:2:15: " + noAmbient);
    CHECK(refused("type = 'path'\nao_distance = 2.5\n") == "scene file s.toml:3:15: " + noAmbient);
    CHECK(refused("type = 'ambient'\n")
        == "scene file s.toml:2:8: type of integrator is unknown: 'ambient': use one of: path, ao");
    CHECK(refused("light_sampling = 'mis'\n")
        == "scene file s.toml:2:18: light_sampling of integrator is unknown: 'mis': use one of: both, lights, "
           "directions");
    CHECK(refused("bounces = 1025\n")
        == "scene file s.toml:2:11: bounces of integrator is out of range: 1025: use 0 to 1024");
    CHECK(contains(refused("antialias = 1\n"), "s.toml:2:13: antialias of integrator must be true or false"));
    CHECK(contains(refused("bounces = -1\n"), "bounces of integrator is out of range: -1"));
    CHECK(contains(refused("bounces = 1.5\n"), "bounces of integrator must be a whole number: 1.5"));
    for (const std::string distance : { "0", "-1", "1e13", "1e-13" }) {
        CHECK(contains(refused("type = 'ao'\nao_distance = " + distance + "\n"),
            "s.toml:3:15: ao_distance of integrator is out of range"));
    }
    CHECK(contains(refused("type = 'ao'\nao_distance = nan\n"), "ao_distance of integrator is not finite: nan"));
    CHECK(contains(refused("bounce = 1\n"), "unknown key in integrator: 'bounce': did you mean 'bounces'?"));
}

TEST_CASE("meshes that cannot be found or chosen")
{
    CHECK(contains(error("[[mesh]]\nfile = 'none.obj'\n"), "mesh file not found: none.obj"));
    CHECK(contains(error("[[mesh]]\nfile = 'a.fbx'\n"), "s.toml:2:8: file of mesh has an unknown format"));
    CHECK(contains(error("[[mesh]]\nfile = ''\n"), "file of mesh is empty"));
    CHECK(contains(error("[[mesh]]\nsmooth = true\n"), "mesh lacks a key: file"));
    CHECK(contains(error(mesh + "material = 'red'\n[[material]]\nname = 'rad'\n"),
        "s.toml:3:12: material of mesh is unknown: 'red': did you mean 'rad'?"));
    CHECK(contains(error(mesh + "smooth = 200\n"), "smooth of mesh is out of range"));
    CHECK(contains(error(mesh + "smooth = 'yes'\n"), "smooth of mesh must be a number"));
    CHECK(contains(errorOf("/nowhere/s.toml"), "scene file not found"));
}

TEST_CASE("environment variables in paths")
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj);
    ::setenv("WEDGE_SCENE_TEST_FOLDER", folder.path("").c_str(), 1);
    ::unsetenv("WEDGE_SCENE_TEST_UNSET");
    const TemporaryFolder elsewhere;
    const auto withPath = [&](const std::string& path) {
        return elsewhere.write("s.toml", "[[mesh]]\nfile = '" + path + "'\n");
    };
    CHECK(loadScene(withPath("${WEDGE_SCENE_TEST_FOLDER}/m.obj")).geometry.indices.size() == 3);
    CHECK(errorOf(withPath("${WEDGE_SCENE_TEST_UNSET}/m.obj"))
        == "scene file s.toml:2:8: environment variable is not set: WEDGE_SCENE_TEST_UNSET: set it to the folder that "
           "'${WEDGE_SCENE_TEST_UNSET}' stands for");
    CHECK(contains(errorOf(withPath("${WEDGE/m.obj")), "path has '${' without '}'"));
}

TEST_CASE("paths are bounded, before and after their variables, and no byte of them is 0")
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj);
    ::setenv("WEDGE_SCENE_TEST_LONG", std::string(1000, '/').c_str(), 1);
    const std::string variable = "${WEDGE_SCENE_TEST_LONG}", tooLong = ": path is too long, more than 4095 bytes";
    const auto error = [&](const std::string& path) {
        return errorOf(folder.write("s.toml", "[[mesh]]\nfile = \"" + path + "\"\n"));
    };
    const std::string most = folder.path("m.obj");
    CHECK(error(std::string(4095 - most.size(), '/') + most) == "");
    CHECK(contains(error(std::string(4096 - most.size(), '/') + most), "scene file s.toml:2:8" + tooLong));
    std::string five;
    for (int i = 0; i < 5; ++i)
        five += variable;
    CHECK(error(five.substr(0, 4 * variable.size()) + most) == "");
    CHECK(contains(error(five + most), "scene file s.toml:2:8" + tooLong));
    CHECK(contains(
        error("m.obj\\u0000.png"), "scene file s.toml:2:8: path has a byte of value 0: m.obj\\x00.png: leave it out"));
    folder.write("s.obj", "mtllib " + five + "m.mtl\n" + triangleObj);
    CHECK(warns(wedge::scene::loadScene(folder.path("s.obj")), "path is too long"));
    folder.write("m.mtl", "newmtl a\nmap_Kd " + five + "a.png\n");
    folder.write("s.obj", std::string("mtllib m.mtl\n") + triangleObj);
    CHECK(warns(wedge::scene::loadScene(folder.path("s.obj")), "path is too long"));
    folder.write("m.mtl", std::string("newmtl a\nmap_Kd a\0.png\n", 22));
    CHECK(warns(wedge::scene::loadScene(folder.path("s.obj")), "m.mtl holds binary data"));
}

TEST_CASE("transforms: steps in order, matrices row by row, mirrors keep the outside out")
{
    const auto first = [](const std::string& keys) {
        const Scene s = load(mesh + keys);
        return corner(s.geometry, 0, 1); // (1, 0, 0) before
    };
    const auto near = [](const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b) < 1e-5f; };
    CHECK(near(first("transform = { translate = [1, 2, 3] }\n"), { 2, 2, 3 }));
    CHECK(near(first("transform = { rotate = [0, 0, 2, 90] }\n"), { 0, 1, 0 }));
    CHECK(near(first("transform = { rotate = [0, 1, 0, 90] }\n"), { 0, 0, -1 }));
    CHECK(near(first("transform = { scale = 3 }\n"), { 3, 0, 0 }));
    CHECK(near(first("transform = { scale = [2, 3, 4] }\n"), { 2, 0, 0 }));
    CHECK(near(first("transform = [{ translate = [1, 0, 0] }, { scale = 3 }]\n"), { 6, 0, 0 }));
    CHECK(near(first("transform = [{ scale = 3 }, { translate = [1, 0, 0] }]\n"), { 4, 0, 0 }));
    CHECK(near(first("transform = { matrix = [0,-1,0,5, 1,0,0,6, 0,0,1,7, 0,0,0,1] }\n"), { 5, 7, 7 }));
    CHECK(near(first("transform = { matrix = [[0,-1,0,5], [1,0,0,6], [0,0,1,7], [0,0,0,1]] }\n"), { 5, 7, 7 }));

    const Scene mirrored = load(mesh + "transform = { scale = [-1, 1, 1] }\n");
    CHECK(near(normalOf(mirrored, 0), { 0, 1, 0 }));
    CHECK(near(vectorAt(mirrored.geometry.normals, 0), { 0, 1, 0 }));
    // Normals go by the inverse transpose: under a shear y += x the plane y = 0 tilts to y = x.
    const Scene sheared = load(mesh + "transform = { matrix = [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1] }\n");
    CHECK(near(vectorAt(sheared.geometry.normals, 0), glm::normalize(glm::vec3(-1, 1, 0))));
    CHECK(near(normalOf(sheared, 0), glm::normalize(glm::vec3(-1, 1, 0))));

    CHECK(contains(error(mesh + "transform = { scale = 0 }\n"), "mesh.transform squeezes the mesh flat"));
    CHECK(contains(error(mesh + "transform = { rotate = [0, 0, 0, 3] }\n"), "has no axis"));
    CHECK(
        contains(error(mesh + "transform = { rotate = [0, 0, 3] }\n"), "rotate of mesh.transform must have 4 numbers"));
    CHECK(contains(error(mesh + "transform = { matrix = [1, 2, 3] }\n"), "must have 16 numbers"));
    CHECK(contains(error(mesh + "transform = { matrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1] }\n"), "is projective"));
    CHECK(contains(error(mesh + "transform = { scale = 2, translate = [1, 0, 0] }\n"), "must have one key"));
    CHECK(contains(error(mesh + "transform = {}\n"), "must have one key"));
    CHECK(contains(error(mesh + "transform = { scale = 1e13 }\n"), "s.toml:2:8: a coordinate is beyond 1e12: 1e+13"));
}

TEST_CASE("instances: copies with ids, names and materials of their own")
{
    const Scene s = load(R"([[material]]
name = "a"
[[material]]
name = "b"
[[mesh]]
name = "first"
file = "m.obj"
material = "a"
transform = { scale = 2 }
instances = [{ transform = { translate = [10, 0, 0] } }, { name = "own", material = "b" }]
[[mesh]]
file = "m.obj"
[[mesh.instance]]
[[mesh.instance]]
transform = { translate = [0, 5, 0] }
)");
    const auto& g = s.geometry;
    REQUIRE(g.indices.size() == 12);
    CHECK(g.objectIds == std::vector<std::uint32_t> { 1, 2, 3, 4 });
    CHECK(g.objectNames == std::vector<std::string> { "first/0/tri", "first/own/tri", "0/tri", "1/tri" });
    CHECK(corner(g, 0, 1) == glm::vec3(12, 0, 0)); // the mesh's transform, then the instance's
    CHECK(corner(g, 1, 1) == glm::vec3(2, 0, 0));
    CHECK(corner(g, 2, 1) == glm::vec3(1, 0, 0));
    CHECK(corner(g, 3, 1) == glm::vec3(1, 5, 0));
    CHECK(s.materials[g.materialIds[0]].name == "a");
    CHECK(s.materials[g.materialIds[1]].name == "b");
    CHECK(s.materials[g.materialIds[2]].name == "grey");
    CHECK(load(mesh + "instances = []\n").geometry.indices.empty());
}

TEST_CASE("bounds and summary")
{
    const Scene s =
        load(mesh + "transform = { translate = [1, 2, 3] }\n[[light]]\ntype='point'\nposition=[0,9,0]\nintensity=1\n");
    const wedge::scene::Summary sum = wedge::scene::summary(s);
    CHECK(sum.bounds.lo == glm::vec3(1, 2, 2));
    CHECK(sum.bounds.hi == glm::vec3(2, 2, 3));
    CHECK(sum.triangles == 1);
    CHECK(sum.vertices == 3);
    CHECK(sum.objects == 1);
    CHECK(sum.materials == 1);
    CHECK(sum.pointLights == 1);
    CHECK(sum.areaLights == 0);
    CHECK(sum.geometryBytes == 3 * (3 + 3 + 2) * 4 + 5 * 4);
}
