#pragma once

#include "host/device/source.h"
#include "host/render/environment_table.h"
#include "host/render/frame_builder.h"
#include "host/render/pixel_term.h"
#include "host/render/prepared_scene.h"
#include "host/render/receiver_set.h"
#include "host/render/wave_term.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wedge::render {

/// Which of a frame's sums something is part of.
enum class Part { Direct, Indirect };

/// Something that is sampled, filtered by itself, and added to the image: a light, a component of indirect light.
struct Term {
    std::string name; ///< what the name of its filter widths' layer ends in
    std::string target = {}; ///< by what filters can be on it (filter_chain.h); "" where none can
    Part part = Part::Direct;
    double workUnits = 0; ///< of a pixel, about as many as it has rays
    bool gathersVariance = false; ///< it adds to Sum::variance of its part
    bool changed = false; ///< what is seen of its light is, Effect::changeVisibility()
    bool ofLobes = false; ///< where the pixels are the receivers, those that reflect nothing specularly have none of it
    /// What it is where the pixels are the receivers, and where pixels have several.
    std::function<std::unique_ptr<PixelTerm>(FrameBuilder&)> inPixels;
    std::function<std::unique_ptr<WaveTerm>(FrameBuilder&, const SampleShape&)> inWaves;
};

/// A layer that wedge can write: what a frame shows by its name (outputs.h).
struct LayerInfo {
    std::string name;
    std::vector<std::string> channels; ///< what those of its planes are called
    std::string meaning; ///< one line, units
    std::string absence = {}; ///< why frames of these settings have none of it; "" where they do
    /// What all pixels have where a frame has no such output; none: then that is a fault.
    std::optional<float> otherwise = {};
};

/// Direct light that is added as it is sampled.
struct Unfiltered {
    std::string name; ///< of its planes
    std::string layer = {}; ///< one of its effect's; "" where it has none
    double workUnits = 0;
    bool changes = false; ///< some of its passes' values are changing() (host/graph/graph.h)
    /// Declares its passes, which add to the radiance that the receivers reflect, 0 before. They tally their rays as
    /// the receivers say.
    std::function<void(FrameBuilder&, ReceiverSet&, graph::Handle<Radiance>&)> sample;
};

/// What rays see that leave the scene, the camera's and those of paths: OpenCL C.
struct Environment {
    std::string function; ///< the name of one from a unit direction to radiance, both of type Vec3
    std::string source; ///< its definition, and what it needs
};

using SceneChange = std::function<void(scene::Scene&)>;

/// An option of `wedge render`, of one value.
struct EffectOption {
    std::string name, type, help; ///< "--sky", "RADIANCE"
    /// What a value does. Throws UsageError.
    std::function<SceneChange(const std::string&)> parse;
};

/// What is seen of an area light from the receivers, pixels, once that is filtered.
struct LightVisibility {
    shared::AreaLight light {};
    std::uint32_t quad = 0; ///< its number among the scene's area lights
    graph::Handle<Value> value; ///< of matt surfaces and, in frames that have such, of lobes: 0 to 1
};

/// Something that light does: what it brings to a frame of given settings. Frames know effects by this alone.
class Effect {
public:
    virtual ~Effect() = default;

    virtual std::string name() const = 0; ///< no other effect's
    virtual std::vector<Term> terms(const Settings&, const PreparedScene&) const { return {}; }
    virtual std::optional<Unfiltered> unfiltered(const Settings&, const PreparedScene&) const { return std::nullopt; }
    /// Whether it draws other shadows than there are of an area light.
    virtual bool changesVisibility(const Settings&, const scene::AreaLight&) const { return false; }
    /// Declares the passes that do: planes to be added to what is seen, R, G and B of matt surfaces and then of lobes.
    virtual graph::Handle<Value> changeVisibility(FrameBuilder&, const LightVisibility&) const { return {}; }
    /// Adds to FrameBuilder::layers, which are read, what it shows of that; of frames where the condition is false it
    /// is not known what is seen.
    virtual void showVisibility(
        FrameBuilder&, const LightVisibility&, const std::function<bool(const graph::Run&)>&) const
    {
    }

    /// How many pixels beyond the image's border it has to know of what there is, at least 0; where pixels have one
    /// receiver. All else of the frame is as it is in the image.
    virtual int margin(const Settings&, const PreparedScene&) const { return 0; }

    /// Why a frame has no terms of this part, of an effect that could have some; "" of others.
    virtual std::string absence(Part) const { return ""; }
    /// Terms that it could have, as far as filters can be on them.
    virtual std::vector<Target> targets() const { return {}; }
    /// How its terms' layers of filter widths are called, for people; "" without terms.
    virtual std::string widthLayers() const { return ""; }
    /// Those of its own, whether or not frames have them: of unfiltered light, and what passes add to
    /// FrameBuilder::layers, in frames of one receiver a pixel. scene: null where it is not known.
    virtual std::vector<LayerInfo> layers(const Settings&, const PreparedScene*) const { return {}; }

    /// Kernels of its own and what they include, by the paths that passes and includes name.
    virtual device::GeneratedSources sources() const { return {}; }
    virtual std::optional<Environment> environment(const scene::Scene&) const { return std::nullopt; }
    /// A picture around the scene, which lights it and is seen in it; null without. One effect may have one.
    virtual std::shared_ptr<const EnvironmentPicture> picture(const scene::Scene&) const { return nullptr; }
    /// Its table in scene files is registered with host/scene/sections.h.
    virtual std::vector<EffectOption> options() const { return {}; }
};

/// All effects that there are, in the order in which frames have them.
const std::vector<std::unique_ptr<const Effect>>& effects();

/// The effect that changes what is seen of this light; null where none does.
const Effect* changerOfVisibility(const Settings& settings, const scene::AreaLight& light);

/// Adds one. Not while anybody renders.
void registerEffect(std::unique_ptr<const Effect> effect);

/// Adds an effect before the program starts.
struct Registration {
    explicit Registration(std::unique_ptr<const Effect> effect) { registerEffect(std::move(effect)); }
};

/// The terms of a frame: those of direct light, then those of indirect light, each by effects.
std::vector<Term> frameTerms(const Settings& settings, const PreparedScene& scene);
std::size_t countOf(Part part, const std::vector<Term>& terms);

/// Unfiltered light of a frame, by effects.
std::vector<Unfiltered> frameUnfiltered(const Settings& settings, const PreparedScene& scene);

/// How a frame's planes lie, with the margin that its effects need.
PlaneLayout frameLayout(const Settings& settings, const PreparedScene& scene);

/// What effects have programs made of.
device::GeneratedSources programSources(const scene::Scene& scene);

/// The picture around a scene, by its effects; null without. PreparedScene has it.
std::shared_ptr<const EnvironmentPicture> pictureOf(const scene::Scene& scene);

/// Why a frame has no terms of this part.
std::string absenceOf(Part part);

} // namespace wedge::render
