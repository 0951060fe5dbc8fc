#pragma once

#include "host/scene/scene.h"
#include "kernels/shared/cutout.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wedge::render {

/// Whether rays may pass through what is made of a material.
bool isCutout(const scene::Material& m);

/// What rays pass through, of materials and behind lights in the plane of a triangle (coversOf()), in the layout of
/// kernels/shared/cutout.h; empty without any: programs are else built with WEDGE_CUTOUTS. Throws Error where it does
/// not fit into 32-bit offsets.
std::vector<std::uint32_t> cutoutTable(const scene::Scene& scene);

/// Opacity of a texel, 0 to 255: its alpha where the texture has any that is not opaque, else its luminance, whose
/// bytes are taken as plain numbers.
std::uint8_t opacityOf(const scene::Texture& texture, std::size_t texel);

} // namespace wedge::render
