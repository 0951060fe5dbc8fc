#pragma once

#include "host/render/frame_builder.h"
#include "host/render/settings.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

/// A number that a filter takes.
struct FilterParameter {
    std::string name;
    double least = 0, most = 0; ///< its range
    float standard = 0; ///< what it is where nobody says
    std::string meaning; ///< one line, units
    bool whole = false; ///< whole numbers alone
};

// A chosen filter may have fewer values than its filter has parameters: the last ones are standard then.

/// Where in a frame a filter acts, in the order in which frames come there.
enum class Stage {
    Samples, ///< of a term, before anything is made of them
    Terms, ///< what arrives, filtered by what the analysis says, before surfaces reflect it
    Frame, ///< direct or indirect light, reflected
    Image, ///< finished
};

/// What users say by it: a list of names.
inline constexpr const char* filterTargets = "on";
/// What filters may be on, besides terms (Effect::targets()).
namespace targets {
inline constexpr const char* image = "image";
inline constexpr const char* direct = "direct";
inline constexpr const char* indirect = "indirect"; ///< of filters of samples, each of its terms
} // namespace targets

/// A term that filters can be on, by its name.
struct Target {
    std::string name; ///< "": none can be
    bool ofSamples = false; ///< filters of samples are of it, too
};

/// What users choose by name, of any stage.
class Filter {
public:
    Filter() = default;
    virtual ~Filter() = default;
    Filter(const Filter&) = delete;
    Filter& operator=(const Filter&) = delete;

    virtual Stage stage() const = 0; ///< where nobody says what it is on
    virtual std::string name() const = 0; ///< no other filter's
    virtual std::string meaning() const = 0; ///< one line
    virtual std::vector<FilterParameter> parameters() const = 0;
};

/// Something that is done to an image, linear radiance, whatever it shows: the finished one, or a part of it. It traces
/// nothing, and knows neither samples nor what came before.
class ImageFilter : public Filter {
public:
    Stage stage() const final { return Stage::Image; }
    /// Declares its passes over `image` and returns what they make of it; of values that change nothing the image
    /// itself. values: of the parameters, in their order and ranges.
    virtual graph::Handle<Radiance> declare(
        FrameBuilder& frame, const std::vector<float>& values, const graph::Handle<Radiance>& image) const = 0;
};

/// Something that says what of a pixel's samples of indirect light is kept, before means, variances and counts are made
/// of them: a kernel over stored samples (kernels/filter/kept.h, stored_samples.h). It traces nothing.
class SampleFilter : public Filter {
public:
    Stage stage() const final { return Stage::Samples; }
    /// Whether these values keep all samples: then none is stored.
    virtual bool keepsAll(const std::vector<float>& values) const = 0;
    /// The kernel, and what it is handed besides samples and sums. filtered: whether the image is filtered afterwards,
    /// by what the analysis says (method aaf).
    virtual graph::KernelName kernel() const = 0;
    virtual std::vector<graph::Argument> arguments(const std::vector<float>& values, bool filtered) const = 0;
    /// The kernel over samples that are known by their brightness alone (kernels/sinks/sample_bins.h), which is handed
    /// the same; none: in frames that know no more it cannot be.
    virtual std::optional<graph::KernelName> kernelOfBins() const { return std::nullopt; }
    /// Whether what is left out is missing; else the rest makes up for it.
    virtual bool losesLight() const { return false; }
    /// Standard deviation, pixels, of the Gaussian by which what is left out is spread over its surface; 0: it is lost.
    virtual float spread(const std::vector<float>& values) const = 0;
    /// The width that it grows to by doubling where much is left out, pixels; less than twice spread(): it does not.
    virtual float widest(const std::vector<float>& values) const = 0;
    /// Whether its kernel tells the mean isolation of pixels' samples, `density`.
    virtual bool measuresDensity() const { return false; }
    /// What colours are multiplied by before they are compared; 0: as the frame's median says.
    virtual float exposure(const std::vector<float>& values) const = 0;
    /// Whether its samples' colours are exposed RGB in place of CIELAB: of stored samples alone.
    virtual bool comparesRgb(const std::vector<float>& values) const
    {
        (void)values;
        return false;
    }
};

/// All that there are, by what they are registered as: those of samples first.
const std::vector<std::unique_ptr<const Filter>>& registeredFilters();
/// Of that name; null where there is none.
const Filter* filterNamed(const std::string& name);
/// What it may be on.
std::vector<std::string> targetsOf(const Filter& filter);
/// What is wrong with what a filter is on, for people: twice the same, or a part of another, or of several stages; ""
/// where nothing is. on: of targetsOf()
std::string wrongTargets(const Filter& filter, const std::vector<std::string>& on);

/// Adds one. Not while anybody renders.
void registerFilter(std::unique_ptr<const Filter> filter);
/// Adds filters of these types before the program starts: the initial value of a constant, true.
template <class... Filters>
bool registerFilters()
{
    (registerFilter(std::make_unique<Filters>()), ...);
    return true;
}

/// "path-density:k=10 colour:density=0.5", as --add-filter takes them, of registered filters.
std::string describe(const std::vector<ChosenFilter>& filters);

/// A list in the order of stages: those of `more` come after those of `first` in each. Throws UsageError for two
/// filters of samples, which frames have one of.
std::vector<ChosenFilter> inStages(std::vector<ChosenFilter> first, const std::vector<ChosenFilter>& more);
/// What is wrong with a list where a filter comes after one of a later stage, and names both: what, the value, the way
/// out. call: how a user writes a filter.
struct WrongOrder {
    std::string what, value, remedy;
};
std::optional<WrongOrder> wrongOrder(const std::vector<ChosenFilter>& filters, const std::string& call);

/// Where it acts.
Stage stageOf(const ChosenFilter& chosen);
/// Whether a list has filters of that stage.
bool hasStage(const std::vector<ChosenFilter>& filters, Stage stage);

/// The settings' filter of samples and its values; a null filter where there is none, or it keeps all.
struct ChosenSampleFilter {
    const SampleFilter* filter = nullptr;
    std::vector<float> values;
};
ChosenSampleFilter sampleFilterOf(const Settings& settings);
/// The same of a term; a null filter, too, where it is on others alone.
ChosenSampleFilter sampleFilterOf(const Settings& settings, const Target& term);

/// Whether filters of images are on that.
bool isFiltered(const Settings& settings, const std::string& target);
/// Declares the settings' filters of images that are on `target` over its image, one after the other. Throws
/// std::logic_error for a filter that is not registered.
graph::Handle<Radiance> filteredImage(FrameBuilder& frame, const std::string& target, graph::Handle<Radiance> image);

} // namespace wedge::render
