// Faces of more than 3 corners: nothing of a simple outline is lost, whatever its shape, and what cannot be kept is
// told.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "host/scene/triangulate.h"
#include "outlines.h"

using namespace outlines;
using wedge::scene::Split;
using wedge::scene::Triangulator;

namespace {

/// In a plane, rounded to single precision as most meshes are.
std::vector<glm::dvec3> inPlane(
    const Outline& outline, const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& origin)
{
    std::vector<glm::dvec3> corners;
    for (const glm::vec2& p : outline)
        corners.emplace_back(glm::vec3(origin + double { p.x } * u + double { p.y } * v));
    return corners;
}

glm::dvec3 areaOf(const std::vector<glm::dvec3>& corners)
{
    glm::dvec3 sum(0.0);
    const glm::dvec3 origin(corners[0]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
    return 0.5 * sum;
}

/// The area of all triangles, each as large as it is, those that face the other way counted off.
double coveredArea(const std::vector<glm::dvec3>& corners, const Triangulator& triangulator)
{
    const glm::dvec3 facing = areaOf(corners);
    double sum = 0.0;
    for (const auto& t : triangulator.triangles()) {
        const glm::dvec3 a(corners[t[0]]), b(corners[t[1]]), c(corners[t[2]]);
        const glm::dvec3 area = 0.5 * glm::cross(b - a, c - a);
        sum += glm::dot(area, facing) > 0.0 ? glm::length(area) : -glm::length(area);
    }
    return sum;
}

struct Result {
    Split split;
    std::size_t triangles;
    double lost; ///< of the area, relative
};

Result splitUp(const std::vector<glm::dvec3>& corners)
{
    static Triangulator triangulator;
    const Split split = triangulator.split(corners);
    const double before = glm::length(areaOf(corners));
    return { split, triangulator.triangles().size(), std::abs(coveredArea(corners, triangulator) - before) / before };
}

Result splitFlat(const Outline& outline)
{
    return splitUp(inPlane(outline, { 1, 0, 0 }, { 0, 1, 0 }, glm::dvec3(0.0)));
}

} // namespace

TEST_CASE("10,000 random simple outlines keep their area, in random planes and sizes")
{
    Random random(1);
    Triangulator triangulator;
    for (int i = 0; i < 10'000; ++i) {
        const std::size_t corners = i % 100 == 0 ? number(random, 60, 200) : number(random, 4, 30);
        Outline outline;
        switch (i % 4) {
        case 0:
            outline = untangled(random, corners);
            break;
        case 1:
            outline = star(random, corners);
            break;
        case 2:
            outline = comb(corners / 4 + 1);
            break;
        default:
            outline = spiral(std::max<std::size_t>(corners, 6));
        }
        if (i % 3 == 0)
            outline = withExtras(random, outline, false);
        if (i % 2 == 0)
            std::reverse(outline.begin(), outline.end());
        const glm::dvec3 normal(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.4, 0.5)));
        const glm::dvec3 v = glm::normalize(glm::cross(normal, u));
        const double scale = std::pow(10.0, uniform(random, -6, 6));
        const auto corners3 = inPlane(outline, scale * u, scale * v, scale * glm::dvec3(uniform(random, -1, 1)));
        std::set<std::pair<float, float>> places;
        for (const glm::vec2& p : outline)
            places.emplace(p.x, p.y);
        CAPTURE(i);
        const Result result = splitUp(corners3);
        CHECK(result.split == Split::Whole);
        CHECK(result.triangles == places.size() - 2);
        CHECK(result.lost < 1e-4);
    }
}

TEST_CASE("corners on one line and repeated ones, with integer coordinates: exact areas")
{
    Random random(2);
    for (std::size_t steps = 1; steps < 60; ++steps) {
        CAPTURE(steps);
        const Outline outline = staircase(steps);
        const Result plain = splitFlat(outline);
        CHECK(plain.split == Split::Whole);
        CHECK(plain.lost == 0.0);
        CHECK(plain.triangles == outline.size() - 2);
        const Result extra = splitFlat(withExtras(random, outline, true));
        CHECK(extra.split == Split::Whole);
        CHECK(extra.lost == 0.0);
    }
}

TEST_CASE("outlines that touch themselves in corners")
{
    Random random(4);
    for (int i = 0; i < 4000; ++i) {
        const Outline outline = cells(random, 2 + i % 60, i % 2 == 0);
        const Result result = splitFlat(outline);
        CAPTURE(i);
        CHECK(result.split == Split::Whole);
        CHECK(result.triangles == outline.size() - 2);
        CHECK(result.lost == 0.0);
    }
}

TEST_CASE("holes that a bridge walked twice joins to the outline")
{
    const Outline hole = { at(0, 0), at(3, 0), at(3, 3), at(0, 3), at(0, 0), at(1, 1), at(1, 2), at(2, 2), at(2, 1),
        at(1, 1) };
    for (std::size_t first = 0; first < hole.size(); ++first) { // whichever corner the file begins with
        Outline turned = hole;
        std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
        const Result result = splitFlat(turned);
        CAPTURE(first);
        CHECK(result.split == Split::Whole);
        CHECK(result.triangles == 8);
        CHECK(result.lost == 0.0);
        std::reverse(turned.begin(), turned.end());
        CHECK(splitFlat(turned).triangles == 8);
    }
    for (std::size_t holes = 1; holes < 40; ++holes) {
        const Outline outline = withHoles(holes);
        const Result result = splitFlat(outline);
        CAPTURE(holes);
        CHECK(result.split == Split::Whole);
        CHECK(result.triangles == outline.size() - 2);
        CHECK(result.lost == 0.0);
    }
    // A hole that touches the outline in a corner of both, and petals that meet in one point.
    const Outline touching = { at(0, 0), at(4, 0), at(4, 4), at(0, 4), at(0, 0), at(1, 2), at(2, 1) };
    CHECK(splitFlat(touching).lost == 0.0);
    CHECK(splitFlat(touching).triangles == 5);
    // A notch that reaches as far as the corner opposite of it, whose own ear would be the first to go.
    const Outline notch = { at(0, 0), at(1, 0), at(9, 7), at(9, 8), at(0, 0), at(8, 9), at(7, 9), at(0, 1) };
    CHECK(splitFlat(notch).split == Split::Whole);
    CHECK(splitFlat(notch).triangles == 4); // two lobes that touch
    CHECK(splitFlat(notch).lost < 1e-12);
    Outline petals;
    for (int i = 0; i < 50; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 50.0;
        petals.push_back(at(0, 0));
        petals.push_back(at(std::cos(angle), std::sin(angle)));
        petals.push_back(at(std::cos(angle + 0.1), std::sin(angle + 0.1)));
    }
    CHECK(splitFlat(petals).split == Split::Whole);
    CHECK(splitFlat(petals).triangles == 50);
}

TEST_CASE("quads: the shorter diagonal, or the one that is inside")
{
    Triangulator t;
    const auto quad = [&](const Outline& outline) {
        const Split split = t.split(inPlane(outline, { 0, 1, 0 }, { 0, 0, 1 }, { 5, 0, 0 }));
        return std::pair(split, t.triangles());
    };
    const std::vector<std::array<std::uint32_t, 3>> by02 = { { 0, 1, 2 }, { 0, 2, 3 } },
                                                    by13 = { { 0, 1, 3 }, { 1, 2, 3 } };
    CHECK(quad({ at(0, 0), at(2, -1), at(4, 0), at(2, 1) }).second == by13);
    CHECK(quad({ at(0, 0), at(1, -2), at(2, 0), at(1, 2) }).second == by02);
    CHECK(quad({ at(0, 0), at(4, 0), at(1, 1), at(0, 4) }).second == by02); // concave at corner 2
    CHECK(quad({ at(4, 0), at(1, 1), at(0, 4), at(0, 0) }).second == by13); // at corner 1
    CHECK(quad({ at(0, 0), at(1, 0), at(2, 0), at(1, 9) }).second == by13); // corner 1 on a side
    CHECK(quad({ at(0, 0), at(1, 0), at(1, 0), at(1, 1) })
        == std::pair(Split::Whole, std::vector<std::array<std::uint32_t, 3>> { { 0, 1, 3 } }));
    CHECK(quad({ at(0, 0), at(1, 1), at(1, 0), at(0, 1) }).first == Split::Crossed);
    CHECK(quad({ at(0, 0), at(2, 2), at(2, 0), at(0, 1) }).first == Split::Crossed);
    CHECK(quad({ at(0, 0), at(1, 1), at(2, 2), at(3, 3) }).first == Split::NoArea);
    CHECK(
        t.split(std::vector<glm::dvec3> { { 0, 0, 0 }, { 1, 0, 0.1f }, { 1, 1, 0 }, { 0, 1, 0.1f } }) == Split::Whole);
}

TEST_CASE("outlines that cross themselves are told, and what can be kept is")
{
    const Result eight = splitFlat({ at(0, 0), at(2, 2), at(3, 2), at(3, 0), at(2, 0), at(0, 2) });
    CHECK(eight.split == Split::Crossed);
    CHECK(eight.triangles == 4);
    Outline pentagram;
    for (int i = 0; i < 5; ++i)
        pentagram.push_back(at(std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i)));
    CHECK(splitFlat(pentagram).split == Split::Crossed);
    Outline twice = { at(0, 0), at(2, 0), at(3, 2), at(2, 4), at(0, 4), at(-1, 2) };
    CHECK(splitFlat(twice).split == Split::Whole);
    twice.insert(twice.end(), { at(0, 0), at(2, 0), at(3, 2), at(2, 4), at(0, 4), at(-1, 2) });
    CHECK(splitFlat(twice).split == Split::Crossed);
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Outline tangle;
        for (int k = 0; k < 40; ++k)
            tangle.push_back(at(uniform(random, 0, 1), uniform(random, 0, 1)));
        const Result result = splitFlat(tangle);
        CHECK(result.split == Split::Crossed);
        CHECK(result.triangles > 20);
    }
    // Folded along its middle, so far that it faces itself.
    Triangulator t;
    CHECK(t.split(std::vector<glm::dvec3> {
              { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 2, 1, 0 }, { 1, 1, 0 }, { 0.2f, 1, 0.1f }, { 3, 0.5f, 0.1f } })
        == Split::Crossed);
}

TEST_CASE("outlines without area")
{
    const Outline line = { at(0, 0), at(1, 1), at(2, 2), at(5, 5), at(3, 3) };
    CHECK(splitFlat(line).split == Split::NoArea);
    CHECK(splitFlat(Outline(7, at(1, 2))).split == Split::NoArea);
    // A tree that is walked around has none either.
    CHECK(splitFlat({ at(0, 0), at(2, 0), at(2, 1), at(2, 0), at(3, -1), at(2, 0) }).split == Split::NoArea);
    Triangulator t;
    CHECK(t.split(std::vector<glm::dvec3> { { 1, 2, 3 }, { 2, 4, 6 }, { 3, 6, 9 }, { 4, 8, 12 } }) == Split::NoArea);
    CHECK(t.triangles().empty());
}

TEST_CASE("orientation is exact")
{
    using wedge::scene::orientation;
    const float tiny = 1e-30f, big = 1e30f;
    CHECK(orientation({ 0, 0 }, { 1, 1 }, { 2, 2 }) == 0);
    CHECK(orientation({ 0, 0 }, { big, big }, { tiny, tiny }) == 0);
    CHECK(orientation({ 0, 0 }, { big, big }, { tiny, 2.0f * tiny }) == 1);
    CHECK(orientation({ tiny, 0 }, { big, big }, { 0, 0 }) == 1);
    CHECK(orientation({ 0, tiny }, { big, big }, { 0, 0 }) == -1);
    // Three points that rounding of their differences would put on one line.
    const glm::dvec2 a(0.1f, 0.1f), b(1e8f, 1e8f), c(0.2f, std::nextafter(0.2f, 1.0f));
    CHECK(orientation(a, b, c) == 1);
    CHECK(orientation(b, a, c) == -1);
}
