#pragma once

#include "bvh/bvh.h"

#include <string>

namespace wedge::bvh {

/// Checks a hierarchy against the mesh it was built over: every triangle of finite vertices lies in a leaf and with its
/// own vertices, the boxes of its leaves contain all of it, every box contains those below it, every node and block is
/// reached exactly once, and the traversal's stack suffices. Returns one line a problem (at most 20), none if all is
/// well.
std::vector<std::string> validate(const Bvh& bvh, const Mesh& mesh);

} // namespace wedge::bvh
