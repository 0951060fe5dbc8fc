#include "effects/shadow_lights/shadow_lights.h"

#include "effects/shadow_lights/light_sums.h"
#include "effects/shadow_lights/whole_light.h"
#include "kernels/shared/shadow_lights.h"

#include <cstdint>
#include <memory>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/shadow_combination.cl";

/// WEDGE_COMPLETE_*: what is looked up lies where sums over the map would.
std::uint32_t completeOf(WholeLight kind)
{
    return static_cast<std::uint32_t>(kind == WholeLight::Cache ? WholeLight::Map : kind);
}

/// How the map's whole light and lights are put together.
Arguments combination(const FrameBuilder& f)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    const std::uint32_t ways[] = { 0u, WEDGE_SHADOWS_ADDITIVE, WEDGE_SHADOWS_SUBTRACTIVE, WEDGE_SHADOWS_RATIO };
    const glm::vec3 most(f.scene != nullptr ? f.description.lights().beyond->mostIrradiance : glm::dvec3(0.0));
    return graph::together("combination",
        { value("shadows", ways[static_cast<int>(s.shadows)]), value("complete", completeOf(wholeLight(s))),
            value("clamps", s.shadows == Shadows::Subtractive && s.clamp ? 1u : 0u),
            value("wide", widensLobes(s) ? 1u : 0u), value("mostRed", most.r), value("mostGreen", most.g),
            value("mostBlue", most.b) });
}

graph::Argument orAbsent(const char* name, graph::Handle<Radiance> plane)
{
    return plane.graph != 0 ? reads(name, plane) : graph::absent(name, graph::vectors);
}

void sample(FrameBuilder& f, ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    // Before lights: a frame that is stopped then has as much of it as there are lights.
    const WholeLights whole = wholeLights(f, at);
    const LightSums sums = lightSums(f, at);
    const ShadowSettings& s = f.settings.environment.shadows;
    const Surfaces& seen = f.surfaces;
    auto clamped = f.graph.plane<Count>("clamped", graph::counts);
    f.pixels("composite", PassKind::Composite, { program, "combineShadowLights" },
        joined({ f.rectangle(f.analysisParams()) }, combination(f), f.beyond(),
            graph::together("surfaces",
                { reads("normal", seen.normal), reads("diffuse", seen.diffuse), reads("specular", seen.specular) }),
            Arguments { reads("mattSums", sums.matt), readsLobes("lobeSums", f, sums),
                orAbsent("wholeMatt", whole.matt), orAbsent("whole", whole.lobes), reads("taken", sums.taken),
                updates("lit", radiance), writes("clamped", clamped) }));
    if (s.shadows == Shadows::Subtractive && s.clamp) {
        graph::Handle<Tally>& tally = f.totals.tallies.clamped;
        tally = f.graph.list<Tally>("tally of clamped pixels", tallySums, WEDGE_TALLY_STRIPES);
        f.zero(tally);
        f.count(clamped, false, tally);
    }
}

class ShadowLights : public Effect {
public:
    std::string name() const override { return "shadow lights"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        const ShadowSettings& s = settings.environment.shadows;
        if (settings.integrator != Integrator::Path || scene.picture() == nullptr || s.shadows == Shadows::Sampled) {
            return std::nullopt;
        }
        return Unfiltered {
            .name = "shadow lights", .workUnits = lightUnits(s) + wholeLightUnits(s), .sample = sample
        };
    }
};

} // namespace

std::unique_ptr<const Effect> shadowLights() { return std::make_unique<ShadowLights>(); }

} // namespace wedge::render
