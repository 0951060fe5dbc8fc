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

template <typename T>
bool sameBits(const bvh::Array<T>& a, const bvh::Array<T>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool sameBits(const bvh::Bvh& a, const bvh::Bvh& b)
{
    return sameBits(a.nodes, b.nodes) && sameBits(a.blocks, b.blocks);
}

} // namespace wedge::test
