#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

namespace wedge::decode {

/// Decodes a PNG, JPEG, BMP, TGA or Radiance HDR image, told by its content. TGA has no signature: it is what nothing
/// else fits and has a header that does not contradict itself. Throws Failure.
Picture decodeTextureFor(TextureUse use, Bytes bytes, const Limits& limits);

/// The same for colours.
Picture decodeTexture(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
