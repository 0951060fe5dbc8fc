#pragma once

#include <set>
#include <string>

namespace wedge::scene {

/// The candidate nearest to a word when it is near enough for a slip of the fingers, or an empty string. Words of more
/// than 64 letters are near nothing.
std::string nearest(const std::string& word, const std::set<std::string>& candidates);

} // namespace wedge::scene
