#pragma once

#include <any>

namespace wedge::scene {
class TableReader;
}

namespace wedge::render {

/// The table [environment] of a scene file, docs/scene-format.md: a std::shared_ptr<const EnvironmentPicture>. Throws
/// Error for what is wrong in it, and for a map that cannot be read.
std::any readEnvironment(scene::TableReader& table);

} // namespace wedge::render
