#include "data/generator/scene_writer.h"

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::generator {
namespace {

std::string list(const glm::vec3& v) { return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", v.x, v.y, v.z); }

std::string mtlText(const GeneratedScene& scene)
{
    std::string text;
    for (const scene::Material& m : scene.materials)
        text += fmt::format("newmtl {}\nKd {:.6g} {:.6g} {:.6g}\nKs {:.6g} {:.6g} {:.6g}\nNs {:.6g}\n\n", m.name,
            m.diffuse.x, m.diffuse.y, m.diffuse.z, m.specular.x, m.specular.y, m.specular.z, m.exponent);
    return text;
}

std::string tomlText(const GeneratedScene& scene)
{
    const scene::AreaLight& light = scene.light;
    std::string text =
        fmt::format("# {}\n# {} triangles, written by wedge_scenes.\n\n", scene.comment, scene.mesh.triangles());
    text += fmt::format("[camera]\neye = {}\nlook_at = {}\nfov = {:g}\n\n", list(scene.camera.eye),
        list(scene.camera.lookAt), scene.camera.verticalFov);
    text +=
        fmt::format("[image]\nwidth = 640\nheight = 480\n\n[background]\nradiance = {}\n\n", list(scene.background));
    text += fmt::format("[[mesh]]\nfile = \"{}.obj\"\n\n", scene.name);
    text += fmt::format("[[light]]\ntype = \"quad\"\ncentre = {}\nhalf_u = {}\nhalf_v = {}\n", list(light.centre),
        list(light.halfU), list(light.halfV));
    text += fmt::format("radiance = {}\n", list(light.radiance));
    if (light.profile == scene::LightProfile::Uniform)
        text += "profile = \"uniform\"\n";
    else
        text += fmt::format("profile = \"gaussian\"\ncut = {:g}\n", light.cut);
    return text;
}

} // namespace

scene::Material matt(const std::string& name, const glm::vec3& diffuse)
{
    scene::Material material;
    material.name = name;
    material.diffuse = diffuse;
    return material;
}

scene::Material glossy(const std::string& name, const glm::vec3& diffuse, float specular, float exponent)
{
    scene::Material material = matt(name, diffuse);
    material.specular = glm::vec3(specular);
    material.exponent = exponent;
    return material;
}

void writeScene(const GeneratedScene& scene, const std::filesystem::path& folder)
{
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code)
        throw Error("folder cannot be made", fmt::format("{} ({})", folder.string(), code.message()),
            "choose a folder that can be written");
    const std::string head = fmt::format("# {}\nmtllib {}.mtl\n", scene.comment, scene.name);
    writeText(folder / (scene.name + ".obj"), head + scene.mesh.text());
    writeText(folder / (scene.name + ".mtl"), mtlText(scene));
    writeText(folder / (scene.name + ".toml"), tomlText(scene));
}

} // namespace wedge::generator
