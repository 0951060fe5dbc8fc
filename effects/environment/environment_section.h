#pragma once

#include <any>

namespace wedge::scene {
class TableReader;
class Warnings;
} // namespace wedge::scene

namespace wedge::render {

/// The table [environment] of a scene file, docs/scene-format.md: a std::shared_ptr<const EnvironmentPicture>. Throws
/// Error for what is wrong in it, and for a map that cannot be read; warns of numbers that are not used as they are.
std::any readEnvironment(scene::TableReader& table, scene::Warnings& warnings);

} // namespace wedge::render
