#pragma once

#include "host/image/image.h"

namespace wedge::render {

/// A light probe in Debevec's angular map, a square: the angle from its middle, which is what lies ahead, grows evenly
/// to 180 degrees on the circle that it has in it. Returns the same as latitude and longitude, twice as wide as high,
/// what lies ahead in its middle.
image::RgbImage latLongOfAngular(const image::RgbImage& angular);

} // namespace wedge::render
