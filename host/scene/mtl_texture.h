#pragma once

#include <string>

#include "host/scene/statements.h"

namespace wedge::scene {

/// What a texture statement of an MTL file says.
struct MtlTexture {
    std::string name; ///< to the end of the line, spaces and all; empty: none
    std::string unsupported; ///< the first option that would change it and is not read; empty: none
    std::string multiplier; ///< the word behind -bm; empty: none
};

/// Reads what follows the keyword: options and a file name.
MtlTexture parseMtlTexture(StatementReader& statement);

} // namespace wedge::scene
