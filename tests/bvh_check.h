#pragma once

#include "bvh/bvh.h"
#include "bvh/validate.h"
#include "tests/bvh_meshes.h"

#include <doctest/doctest.h>

#include <cstring>

/// What the tests of building and of refitting ask of a hierarchy.
namespace wedge::test {

inline constexpr bvh::Mode allModes[] = { bvh::Mode::Fast, bvh::Mode::Default, bvh::Mode::Quality };

inline void checkValid(const bvh::Bvh& hierarchy, const TestMesh& mesh)
{
    CAPTURE(mesh.name);
    for (const std::string& problem : bvh::validate(hierarchy, mesh.view()))
        FAIL_CHECK(problem);
}

inline bool sameBits(const bvh::Bvh& a, const bvh::Bvh& b)
{
    return a.nodes.size() == b.nodes.size() && a.blocks.size() == b.blocks.size()
        && std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(a.nodes[0])) == 0
        && std::memcmp(a.blocks.data(), b.blocks.data(), a.blocks.size() * sizeof(a.blocks[0])) == 0;
}

} // namespace wedge::test
