#pragma once

#include <functional>

#include <glm/glm.hpp>

#include "host/image/image.h"

namespace wedge::generator {

// Textures, as linear colours. Those without another note repeat without a seam.

/// An image of colour(u, v), u and v in [0, 1), v upwards, the mean of 2 x 2 points a pixel.
image::RgbImage paint(int width, int height, const std::function<glm::dvec3(double, double)>& colour);

/// Smooth noise in [0, 1] of one bump a unit, that repeats every `period` units, a whole number.
double noise(double x, double y, int period, unsigned seed);

/// 0 or 1, in turns of half a period each, `count` periods in [0, 1).
double stripes(double x, int count);

/// Planks along u with a fine grain.
image::RgbImage wood(const glm::dvec3& light, const glm::dvec3& dark, int planks, unsigned seed);

/// A cloth of crossing stripes, `count` of each, with its threads.
image::RgbImage checkedCloth(const glm::dvec3& ground, const glm::dvec3& colour, int count);

/// Tiles with joints, `count` a side, each a little different.
image::RgbImage tiles(const glm::dvec3& colour, const glm::dvec3& joint, int count, unsigned seed);

/// A small figure of petals, `count` a side, in turns of two colours.
image::RgbImage wallpaper(const glm::dvec3& ground, const glm::dvec3& first, const glm::dvec3& second, int count);

/// Speckles over a colour, as on the skin of a fruit.
image::RgbImage speckled(const glm::dvec3& colour, const glm::dvec3& specks, int count, unsigned seed);

/// One leaf, its rib along u: it does not repeat.
image::RgbImage veined(const glm::dvec3& blade, const glm::dvec3& vein);

/// Brushed metal: fine scratches along u.
image::RgbImage brushed(const glm::dvec3& colour, unsigned seed);

/// Backs of a book: bands, and lines of marks like letters.
image::RgbImage bookBack(const glm::dvec3& colour, const glm::dvec3& gilt, unsigned seed);

/// Tufts of wool in a pattern of rhombs, `count` a side.
image::RgbImage carpet(const glm::dvec3& ground, const glm::dvec3& first, const glm::dvec3& second, int count);

/// Rows of bricks in a running bond.
image::RgbImage bricks(const glm::dvec3& brick, const glm::dvec3& mortar, int rows, unsigned seed);

} // namespace wedge::generator
