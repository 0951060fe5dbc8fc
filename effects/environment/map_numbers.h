#pragma once

#include "host/image/image.h"
#include "host/scene/warnings.h"

#include <string>

namespace wedge::render {

/// Most radiance of a direction, W/(sr m^2): squares and sums of what it lights stay numbers.
constexpr float mostRadiance = 1e12f;

/// Makes a map's numbers, times the intensity, radiances from 0 to mostRadiance. Infinite ones count as the map's
/// largest finite one, and those beyond mostRadiance as that; either is warned of. Negative ones count as 0: a few
/// small ones are what resampling leaves beside suns, more are warned of. Throws Error, which names the file, where
/// numbers are NaN or minus infinity, or nothing finite is above 0 beside infinite ones.
void makeRadiances(image::RgbImage& map, float intensity, const std::string& path, scene::Warnings& warnings);

} // namespace wedge::render
