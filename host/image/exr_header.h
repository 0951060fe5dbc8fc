#pragma once

#include "host/decode/limits.h"

#include <OpenEXR/ImfIO.h>
#include <cstdint>

namespace wedge::image {

/// Walks the headers of an EXR file before OpenEXR does, which takes memory for whatever they claim: attributes have
/// their size and fit into the file, the table of chunks too, pictures and chunks are of a size that the file can
/// hold and the limits allow, and there are no deep data. Leaves the stream at its beginning. Throws decode::Failure.
void checkExrHeaders(Imf::IStream& in, std::uint64_t fileBytes, const decode::Limits& limits);

} // namespace wedge::image
