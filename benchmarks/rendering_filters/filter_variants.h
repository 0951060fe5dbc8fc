#pragma once

#include "host/render/settings.h"

#include <limits>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// One way to make an image of samples: a filter, written as --add-filter takes it, or none.
struct FilterVariant {
    std::string text;
    std::vector<render::ChosenFilter> filters; ///< none or one
    int mostSpp = std::numeric_limits<int>::max(); ///< it is not measured at more samples
};

/// The plain mean, which all others are compared with.
inline constexpr const char* plainMean = "mean";
/// The filter that claims are about, as it comes.
inline constexpr const char* densityVariant = "path-density";
/// Path density as published, and by RGB, which its authors advise against (DeCoro 2009, Fig. 5.9).
inline constexpr const char* publishedVariant = "path-density:k=50,low=2,high=3,spread=0";
inline constexpr const char* publishedRgbVariant = "path-density:k=50,low=2,high=3,spread=0,rgb=1";
/// What densityVariant is held against.
inline constexpr const char* reweightVariant = "reweight";
inline constexpr const char* gmonVariant = "gmon";

/// Follows the text of a variant whose image is denoised.
inline constexpr const char* denoisedSuffix = ", denoised";

/// What is measured where nobody chooses: of filters that are registered and that such frames may have. The others'
/// texts go to `skipped`.
std::vector<FilterVariant> allVariants(bool antialiased, std::vector<std::string>& skipped);

/// From a filter as --add-filter takes it, or of plainMean. Throws UsageError as filterCall() does.
FilterVariant variantOf(const std::string& text);

} // namespace wedge::benchmark
