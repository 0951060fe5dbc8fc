#pragma once

#include "host/render/frame_builder.h"
#include "host/render/settings.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

/// A number that a filter of images takes.
struct FilterParameter {
    std::string name;
    double least = 0, most = 0; ///< its range
    float standard = 0; ///< what it is where nobody says
    std::string meaning; ///< one line, units
    bool whole = false; ///< whole numbers alone
};

/// Something that is done to the finished image, linear radiance, whatever it shows: passes over the beauty alone,
/// after all others of the frame. It traces nothing, and knows neither samples nor what came before.
class ImageFilter {
public:
    ImageFilter() = default;
    virtual ~ImageFilter() = default;
    ImageFilter(const ImageFilter&) = delete;
    ImageFilter& operator=(const ImageFilter&) = delete;

    virtual std::string name() const = 0; ///< no other filter's
    virtual std::string meaning() const = 0; ///< one line
    virtual std::vector<FilterParameter> parameters() const = 0;
    /// Declares its passes over `image` and returns what they make of it; of values that change nothing the image
    /// itself. values: of the parameters, in their order and ranges.
    virtual graph::Handle<Radiance> declare(
        FrameBuilder& frame, const std::vector<float>& values, const graph::Handle<Radiance>& image) const = 0;
};

/// All that there are, by what they are registered as.
const std::vector<std::unique_ptr<const ImageFilter>>& imageFilters();
/// Of that name; null where there is none.
const ImageFilter* imageFilter(const std::string& name);

/// Adds one. Not while anybody renders.
void registerImageFilter(std::unique_ptr<const ImageFilter> filter);
/// Adds filters of these types before the program starts: the initial value of a constant, true.
template <class... Filters>
bool registerImageFilters()
{
    (registerImageFilter(std::make_unique<Filters>()), ...);
    return true;
}

/// "bilateral:sigma=2,tolerance=1 colour:density=0.5", as --add-filter takes them, of registered filters.
std::string describe(const std::vector<ChosenFilter>& filters);

/// Declares the settings' filters over a frame's image, one after the other. Throws std::logic_error for a filter that
/// is not registered.
graph::Handle<Radiance> filteredImage(FrameBuilder& frame, graph::Handle<Radiance> image);

} // namespace wedge::render
