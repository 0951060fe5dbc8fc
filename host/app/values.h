#pragma once

#include "host/image/image.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Values of options from their text. All throw UsageError, which names the option, the text and what is allowed.
namespace wedge::app {

/// A whole number in decimal digits, from least to most.
std::int64_t wholeNumber(const std::string& option, const std::string& text, std::int64_t least, std::int64_t most);

/// A number above 0 and at most `most`.
double positiveNumber(const std::string& option, const std::string& text, double most);
/// A number from least to most.
double finiteNumber(const std::string& option, const std::string& text, double least, double most);

/// "640x480": sides from 1 to scene::maxImageSide.
std::pair<int, int> imageSize(const std::string& option, const std::string& text);

/// "x0,y0,x1,y1" with 0 <= x0 < x1 and 0 <= y0 < y1; whether it lies inside the image is not known here.
image::Window cropWindow(const std::string& option, const std::string& text);

/// The name of a file to write, and not "-", which elsewhere stands for the standard output.
std::string fileName(const std::string& option, const std::string& text);

/// Pixels of a texture, 1 to scene::mostTexturePixels.
std::int64_t texturePixels(const std::string& option, const std::string& text);

/// The names of bvh::Mode, in the order of its values.
inline const std::vector<std::string> bvhModes = { "fast", "default", "quality" };

/// The names of methods.
inline const std::vector<std::string> methods = { "mc", "aaf", "maaf" };
/// And how many components filters of maaf may have.
inline const std::vector<std::string> componentCounts = { "3", "5", "7" };

/// The names of render::Maaf, render::Integrator, render::PixelFilter, render::LightSampling, render::Temporal,
/// render::EnvironmentWidths, render::Shadows and render::WholeLight, in the order of their values.
inline const std::vector<std::string> maafs = { "printed", "refitted", "two-slope" };
inline const std::vector<std::string> integrators = { "path", "ao" };
inline const std::vector<std::string> pixelFilters = { "box", "gaussian", "blackman-harris" };
inline const std::vector<std::string> lightSamplings = { "both", "lights", "directions" };
inline const std::vector<std::string> temporals = { "off", "on", "published" };
inline const std::vector<std::string> environmentWidths = { "penumbrae", "curvature", "flt", "corrected" };
inline const std::vector<std::string> shadows = { "sampled", "additive", "subtractive", "ratio" };
inline const std::vector<std::string> wholeLights = { "map", "prefiltered", "lights", "cache" };

/// Throws UsageError of an option, if it is given, as a mistake: for what it has no effect with, and how it would have
/// one.
void refuse(bool given, const std::string& with, const std::string& option, const std::string& remedy);

/// The index of text among choices.
std::size_t choice(const std::string& option, const std::string& text, const std::vector<std::string>& choices);

} // namespace wedge::app
