#pragma once

#include <set>
#include <string>
#include <vector>

namespace wedge::scene {

/// Whether an object goes by one of these names: its own, or what its own begins with up to a slash, as that of a mesh
/// or of an instance.
bool isCalledOneOf(const std::string& object, const std::set<std::string>& names);

/// All names that some of these objects go by.
std::set<std::string> allNames(const std::vector<std::string>& objects);

} // namespace wedge::scene
