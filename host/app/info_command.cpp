#include "filters/image/filter_section.h"
#include "host/app/commands.h"
#include "host/app/console.h"
#include "host/app/render_options.h"
#include "host/app/render_settings.h"
#include "host/app/values.h"
#include "host/device/memory_plan.h"
#include "host/render/effect.h"
#include "host/render/filter_chain.h"
#include "host/render/renderer.h"
#include "host/render/report.h"
#include "host/scene/scene.h"
#include "host/text.h"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace wedge::app {
namespace {

using Json = nlohmann::ordered_json;

struct Facts {
    render::PreparedScene scene;
    scene::Summary summary;
    bvh::Mode mode = bvh::Mode::Default;
    bvh::Statistics bvh;
    render::Settings settings;
    device::MemoryPlan memory;
};

/// What a frame of the scene's own settings would take, asked without a device.
Facts gather(const std::string& path, bvh::Mode mode, const scene::LoadOptions& load)
{
    Facts facts { render::PreparedScene(scene::loadScene(path, load)), {}, {}, {}, {}, {} };
    facts.summary = scene::summary(facts.scene);
    facts.mode = mode;
    const render::Hierarchy hierarchy = render::buildHierarchy(facts.scene, mode);
    facts.bvh = hierarchy.bvh.statistics;
    facts.settings = resolveSettings(RenderOptions(), facts.scene);
    facts.memory = render::Renderer::plan(facts.scene, hierarchy, facts.settings);
    return facts;
}

void addCamera(const Facts& f, Json& json) { json.update(render::cameraReport(f.scene)); }

void printCamera(const Facts& f)
{
    const scene::Camera& camera = f.scene.camera;
    if (camera.apertureRadius > 0.0f)
        say("lens       {} aperture of radius {:g} m, in focus at {:g} m\n", scene::profileName(camera.apertureProfile),
            camera.apertureRadius, scene::distanceInFocus(camera));
    else
        say("lens       pinhole\n");
    if (!scene::geometryMoves(f.scene) && !scene::cameraMoves(f.scene))
        say("shutter    nothing moves\n");
    else
        say("shutter    {}, from {:g} to {:g}: {} moving triangles, camera {}\n",
            scene::profileName(f.scene.shutterProfile), f.scene.shutterOpen, f.scene.shutterClose,
            f.summary.movingTriangles, scene::cameraMoves(f.scene) ? "moves" : "at rest");
}

void printJson(const Facts& f)
{
    const scene::Summary& s = f.summary;
    const bvh::Statistics& b = f.bvh;
    Json json = { { "path", f.scene.path }, { "triangles", s.triangles }, { "vertices", s.vertices },
        { "objects", s.objects }, { "materials", s.materials }, { "textures", s.textures },
        { "area_lights", s.areaLights }, { "point_lights", s.pointLights },
        { "directional_lights", s.directionalLights }, { "geometry_bytes", s.geometryBytes },
        { "texture_bytes", s.textureBytes } };
    if (!s.bounds.empty()) {
        json["bounds"] = { { s.bounds.lo.x, s.bounds.lo.y, s.bounds.lo.z },
            { s.bounds.hi.x, s.bounds.hi.y, s.bounds.hi.z } };
    }
    if (const auto picture = f.scene.picture()) {
        json["environment"] = render::environmentReport(*picture);
    }
    if (const auto filters = filters::filtersOf(f.scene); !filters.empty()) {
        json["filters"] = render::describe(filters);
    }
    addCamera(f, json);
    json["width"] = f.settings.width;
    json["height"] = f.settings.height;
    json["memory_bytes"] = f.memory.total();
    json["bvh"] = { { "mode", bvh::modeName(f.mode) }, { "nodes", b.nodes }, { "blocks", b.blocks },
        { "triangles", b.triangles }, { "degenerate", b.degenerate }, { "skipped", b.skipped }, { "depth", b.depth },
        { "sah_cost", b.sahCost }, { "bytes", b.bytes }, { "build_ms", 1e3 * b.buildSeconds } };
    json["warnings"] = f.scene.warnings;
    say("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void printText(const Facts& f)
{
    constexpr std::size_t longestName = 200; // JSON has names of any length whole
    const scene::Summary& s = f.summary;
    const bvh::Statistics& b = f.bvh;
    say("scene      {}\n", printable(f.scene.path));
    say("triangles  {} ({} vertices, {})\n", s.triangles, s.vertices, device::mebibytes(s.geometryBytes));
    say("objects    {}\n", s.objects);
    for (std::size_t i = 0; i < f.scene.geometry.objectNames.size(); ++i) {
        say("           {} {}\n", i + 1, printable(shortened(f.scene.geometry.objectNames[i], longestName)));
    }
    say("materials  {}, textures {} ({})\n", s.materials, s.textures, device::mebibytes(s.textureBytes));
    say("lights     {} area, {} point, {} directional\n", s.areaLights, s.pointLights, s.directionalLights);
    if (const auto picture = f.scene.picture()) {
        say("           environment, a map of {}x{}\n", picture->width, picture->height);
        for (const render::Sun& sun : picture->suns) {
            say("           a sun of it is an area light: {:.1f} % of its light, towards [{:.3f}, {:.3f}, {:.3f}], "
                "{:.2f} by {:.2f} degrees\n",
                100.0 * sun.share, sun.towards.x, sun.towards.y, sun.towards.z, render::degreesAcross(sun.halfU),
                render::degreesAcross(sun.halfV));
        }
    }
    if (const auto filters = filters::filtersOf(f.scene); !filters.empty()) {
        say("filters    {}\n", render::describe(filters));
    }
    printCamera(f);
    if (!s.bounds.empty()) {
        say("bounds     [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}] m\n", s.bounds.lo.x, s.bounds.lo.y, s.bounds.lo.z,
            s.bounds.hi.x, s.bounds.hi.y, s.bounds.hi.z);
    }
    say("bvh        {}: {} nodes, {} blocks, {}, depth {}, SAH cost {:.2f}, built in {:.1f} ms\n",
        bvh::modeName(f.mode), b.nodes, b.blocks, device::mebibytes(b.bytes), b.depth, b.sahCost, 1e3 * b.buildSeconds);
    say("           {} triangles without area, {} left out\n", b.degenerate, b.skipped);
    say("memory on the device at {}x{}\n{}", f.settings.width, f.settings.height, f.memory.table());
}

int info(const std::string& path, bool json, bvh::Mode mode, const scene::LoadOptions& load)
{
    const Facts facts = gather(path, mode, load);
    warnOf(facts.scene.warnings);
    json ? printJson(facts) : printText(facts);
    requireSaid();
    return 0;
}

} // namespace

void addInfoCommand(CLI::App& parser, Action& action)
{
    CLI::App* command = parser.add_subcommand("info", "Say what is in a scene and what it takes");
    const auto path = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    command->add_option("SCENE", *path, "Scene file (.toml) or mesh (.obj)")->type_name("")->required();
    command->add_flag("--json", *json, "Print JSON");
    const auto mode = std::make_shared<bvh::Mode>(bvh::Mode::Default);
    const auto setMode = [mode](const std::string& text) {
        *mode = static_cast<bvh::Mode>(choice("--bvh", text, bvhModes));
    };
    command->add_option_function<std::string>("--bvh", setMode, "How the hierarchy is built")
        ->type_name("fast|default|quality")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    const auto load = std::make_shared<scene::LoadOptions>();
    const auto setPixels = [load](const std::string& text) {
        load->maxTexturePixels = texturePixels("--max-texture-pixels", text);
    };
    command->add_option_function<std::string>("--max-texture-pixels", setPixels, "Refuse textures of more pixels")
        ->type_name("N")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->callback([=, &action] { action = [=] { return info(*path, *json, *mode, *load); }; });
}

} // namespace wedge::app
