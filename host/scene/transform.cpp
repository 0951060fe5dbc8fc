#include "host/scene/transform.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "host/scene/single_precision.h"

namespace wedge::scene {
namespace {

glm::dmat4 readMatrix(TableReader& step)
{
    const std::vector<double> m = *step.numbers("matrix", 16, 16);
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < m.size(); ++i)
        matrix[static_cast<int>(i % 4)][static_cast<int>(i / 4)] = m[i];
    if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0)
        step.fail("matrix", "is projective", fmt::format("last row {:g} {:g} {:g} {:g}", m[12], m[13], m[14], m[15]),
            "end it with 0, 0, 0, 1 (the translation is the last column)");
    return matrix;
}

Transform readStep(TableReader& step)
{
    const glm::dmat4 none(1.0);
    Transform out;
    int found = 0;
    if (step.has("translate") && ++found) {
        const FileVector by = readVector(step, "translate");
        out = { glm::translate(none, by.exact), glm::translate(none, by.single) };
    }
    if (step.has("rotate") && ++found)
        out.exact = out.single = glm::mat4_cast(readRotation(step, "rotate"));
    if (step.has("scale") && ++found) {
        const FileVector by = readScale(step, "scale");
        out = { glm::scale(none, by.exact), glm::scale(none, by.single) };
    }
    if (step.has("matrix") && ++found)
        out.exact = out.single = readMatrix(step);
    step.finish();
    if (found != 1)
        step.failHere("must have one key", std::to_string(found),
            "write one of translate, rotate, scale, matrix a step: [{ rotate = [..] }, { translate = [..] }]");
    const double volume = glm::determinant(glm::dmat3(out.single));
    if (!(std::abs(volume) > 1e-30))
        step.failHere("squeezes the mesh flat, or to next to nothing", fmt::format("determinant {:g}", volume),
            "use factors of which none is 0 and whose product is above 1e-30");
    return out;
}

} // namespace

bool isPrecise(const glm::dvec3& single, const glm::dvec3& exact)
{
    constexpr double roundings = 4.0 / (1 << 24);
    const auto largest = [](const glm::dvec3& v) { return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) }); };
    return largest(single - exact) <= roundings * largest(exact);
}

const glm::dmat4& Transform::chosen(bool isSingle) const
{
    return isSingle && isPrecise(glm::dvec3(single[3]), glm::dvec3(exact[3])) ? single : exact;
}

glm::dquat readRotation(TableReader& table, const std::string& key)
{
    const std::vector<double> r = *table.numbers(key, 4, 4);
    const glm::dvec3 axis(r[0], r[1], r[2]);
    if (!(glm::length(axis) > 0.0))
        table.fail(key, "has no axis", "[0, 0, 0]", "give an axis that is not zero");
    return glm::angleAxis(glm::radians(r[3]), glm::normalize(axis));
}

FileVector readVector(TableReader& table, const std::string& key)
{
    const glm::dvec3 exact = *table.vector(key);
    return { exact, inSingle(exact) };
}

FileVector readScale(TableReader& table, const std::string& key)
{
    if (table.isList(key))
        return readVector(table, key);
    const glm::dvec3 even(*table.number(key));
    return { even, even };
}

Transform readTransform(TableReader& table, const std::string& key)
{
    Transform all;
    for (TableReader& step : table.tables(key))
        all = readStep(step) * all;
    return all;
}

} // namespace wedge::scene
