#pragma once

#include <string>
#include <vector>

namespace wedge::scene {

/// Whether an object goes by that name: its own, or what its own begins with up to a slash, as that of a mesh or of an
/// instance.
bool isCalled(const std::string& object, const std::string& name);

/// All names that some of these objects go by, each once.
std::vector<std::string> allNames(const std::vector<std::string>& objects);

} // namespace wedge::scene
