#include "data/generator/scene_writer.h"

#include <fmt/format.h>

#include "host/error.h"
#include "host/image/exr.h"
#include "host/image/png.h"

namespace wedge::generator {
namespace {

std::string list(const glm::vec3& v) { return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", v.x, v.y, v.z); }

std::string textureFile(const GeneratedScene& scene, std::size_t texture)
{
    return fmt::format("{}_{}.png", scene.name, scene.textures[texture].name);
}

std::string mtlText(const GeneratedScene& scene)
{
    std::string text;
    for (const scene::Material& m : scene.materials) {
        text += fmt::format("newmtl {}\nKd {:.6g} {:.6g} {:.6g}\nKs {:.6g} {:.6g} {:.6g}\nNs {:.6g}\n", m.name,
            m.diffuse.x, m.diffuse.y, m.diffuse.z, m.specular.x, m.specular.y, m.specular.z, m.exponent);
        if (m.emission != glm::vec3(0.0f))
            text += fmt::format("Ke {:.6g} {:.6g} {:.6g}\n", m.emission.x, m.emission.y, m.emission.z);
        if (m.diffuseTexture >= 0)
            text += fmt::format("map_Kd {}\n", textureFile(scene, static_cast<std::size_t>(m.diffuseTexture)));
        if (m.emissionTexture >= 0)
            text += fmt::format("map_Ke {}\n", textureFile(scene, static_cast<std::size_t>(m.emissionTexture)));
        if (m.opacityTexture >= 0)
            text += fmt::format("map_d {}\n", textureFile(scene, static_cast<std::size_t>(m.opacityTexture)));
        if (m.normalTexture >= 0)
            text += fmt::format("{} -bm {:g} {}\n", m.normalIsHeight ? "map_bump" : "norm", m.normalStrength,
                textureFile(scene, static_cast<std::size_t>(m.normalTexture)));
        text += '\n';
    }
    return text;
}

std::string cameraText(const scene::Camera& camera)
{
    std::string text = fmt::format(
        "[camera]\neye = {}\nlook_at = {}\nfov = {:g}\n", list(camera.eye), list(camera.lookAt), camera.verticalFov);
    if (camera.apertureRadius > 0.0f)
        text += fmt::format("aperture = {:g}\nfocus = {:g}\n", camera.apertureRadius, camera.focusDistance);
    return text + '\n';
}

std::string shapeFile(const GeneratedScene& scene, const MovingPart& part, std::size_t shape)
{
    return fmt::format("{}_{}{}.obj", scene.name, part.name, shape);
}

std::string partFile(const GeneratedScene& scene, const MovingPart& part)
{
    return part.shapes.empty() ? fmt::format("{}_{}.obj", scene.name, part.name) : shapeFile(scene, part, 0);
}

std::string partText(const GeneratedScene& scene, const MovingPart& part)
{
    std::string text = fmt::format("[[mesh]]\nfile = \"{}\"\n", partFile(scene, part));
    for (const PartKey& key : part.keys)
        text += fmt::format("[[mesh.key]]\ntime = {:g}\nrotate = [{:g}, {:g}, {:g}, {:g}]\ntranslate = {}\n", key.time,
            key.rotate.x, key.rotate.y, key.rotate.z, key.rotate.w, list(key.translate));
    for (std::size_t i = 0; i < part.shapes.size(); ++i)
        text +=
            fmt::format("[[mesh.shape]]\ntime = {:g}\nfile = \"{}\"\n", part.shapes[i].time, shapeFile(scene, part, i));
    return text + '\n';
}

std::string skyFile(const GeneratedScene& scene) { return scene.name + "_sky.exr"; }

/// What is beyond the scene.
std::string beyondText(const GeneratedScene& scene)
{
    if (scene.sky.rgb.empty())
        return fmt::format("[background]\nradiance = {}\n\n", list(scene.background));
    if (scene.sky.rgb.size() == 3)
        return fmt::format(
            "[environment]\nradiance = {}\n\n", list({ scene.sky.rgb[0], scene.sky.rgb[1], scene.sky.rgb[2] }));
    return fmt::format("[environment]\nmap = \"{}\"\n\n", skyFile(scene));
}

void writeSky(const GeneratedScene& scene, const std::filesystem::path& folder)
{
    if (scene.sky.rgb.size() <= 3)
        return;
    image::LayeredImage map;
    map.width = scene.sky.width;
    map.height = scene.sky.height;
    map.window = { 0, 0, map.width, map.height };
    for (const std::size_t c : { 0, 1, 2 }) {
        image::Channel channel { std::string(1, "RGB"[c]), {} };
        for (std::size_t i = c; i < scene.sky.rgb.size(); i += 3)
            channel.values.push_back(scene.sky.rgb[i]);
        map.channels.push_back(std::move(channel));
    }
    image::writeExr((folder / skyFile(scene)).string(), map);
}

std::string lightText(const scene::AreaLight& light)
{
    std::string text = fmt::format("[[light]]\ntype = \"quad\"\ncentre = {}\nhalf_u = {}\nhalf_v = {}\n",
        list(light.centre), list(light.halfU), list(light.halfV));
    text += fmt::format("radiance = {}\n", list(light.radiance));
    if (light.profile == scene::LightProfile::Uniform)
        text += "profile = \"uniform\"\n";
    else
        text += fmt::format("profile = \"gaussian\"\ncut = {:g}\n", light.cut);
    if (light.twoSided)
        text += "two_sided = true\n";
    if (!light.visible)
        text += "visible = false\n";
    return text;
}

std::string tomlText(const GeneratedScene& scene)
{
    std::string text =
        fmt::format("# {}\n# {} triangles, written by wedge_scenes.\n\n", scene.comment, triangles(scene));
    text += cameraText(scene.camera);
    if (scene.shutterClose > 0.0)
        text += fmt::format("[shutter]\nopen = 0\nclose = {:g}\n\n", scene.shutterClose);
    text += "[image]\nwidth = 640\nheight = 480\n\n" + beyondText(scene);
    if (scene.bounces > 0 || scene.antialias)
        text +=
            fmt::format("[integrator]\n{}{}\n", scene.bounces > 0 ? fmt::format("bounces = {}\n", scene.bounces) : "",
                scene.antialias ? "antialias = true\n" : "");
    text += fmt::format("[[mesh]]\nfile = \"{}.obj\"\n\n", scene.name);
    for (const MovingPart& part : scene.parts)
        text += partText(scene, part);
    if (!scene.hasLight)
        return text;
    text += lightText(scene.light);
    for (const scene::AreaLight& light : scene.furtherLights)
        text += '\n' + lightText(light);
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

scene::Material textured(GeneratedScene& scene, const std::string& name, image::RgbImage image, const glm::vec3& tint,
    float specular, float exponent)
{
    scene::Material material = glossy(name, tint, specular, exponent);
    material.diffuseTexture = static_cast<int>(scene.textures.size());
    scene.textures.push_back({ name, std::move(image) });
    return material;
}

std::size_t triangles(const GeneratedScene& scene)
{
    std::size_t count = scene.mesh.triangles();
    for (const MovingPart& part : scene.parts)
        count += part.shapes.empty() ? part.mesh.triangles() : part.shapes.front().mesh.triangles();
    return count;
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
    for (const MovingPart& part : scene.parts) {
        if (part.shapes.empty())
            writeText(folder / partFile(scene, part), head + part.mesh.text());
        for (std::size_t i = 0; i < part.shapes.size(); ++i)
            writeText(folder / shapeFile(scene, part, i), head + part.shapes[i].mesh.text());
    }
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        image::writePng((folder / textureFile(scene, i)).string(), scene.textures[i].image);
    writeSky(scene, folder);
    writeText(folder / (scene.name + ".mtl"), mtlText(scene));
    writeText(folder / (scene.name + ".toml"), tomlText(scene));
}

} // namespace wedge::generator
