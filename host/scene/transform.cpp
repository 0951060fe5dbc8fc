#include "host/scene/transform.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace wedge::scene {
namespace {

glm::dmat4 readMatrix(TableReader& step)
{
    const std::vector<double> m = *step.numbers("matrix", 16, 16);
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = m[static_cast<std::size_t>(4 * row + column)];
    }
    if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0)
        step.fail("matrix", "is projective", fmt::format("last row {:g} {:g} {:g} {:g}", m[12], m[13], m[14], m[15]),
            "end it with 0, 0, 0, 1 (the translation is the last column)");
    return matrix;
}

glm::dmat4 readStep(TableReader& step)
{
    glm::dmat4 matrix(1.0);
    int found = 0;
    if (step.has("translate") && ++found)
        matrix = glm::translate(matrix, glm::dvec3(*step.vector("translate")));
    if (step.has("rotate") && ++found)
        matrix = glm::mat4_cast(readRotation(step, "rotate"));
    if (step.has("scale") && ++found)
        matrix = glm::scale(matrix, readScale(step, "scale"));
    if (step.has("matrix") && ++found)
        matrix = readMatrix(step);
    step.finish();
    if (found != 1)
        step.failHere("must have one key", std::to_string(found),
            "write one of translate, rotate, scale, matrix a step: [{ rotate = [..] }, { translate = [..] }]");
    const double volume = glm::determinant(glm::dmat3(matrix));
    if (!(std::abs(volume) > 1e-30))
        step.failHere("squeezes the mesh flat", fmt::format("determinant {:g}", volume), "use factors other than 0");
    return matrix;
}

} // namespace

glm::dquat readRotation(TableReader& table, const std::string& key)
{
    const std::vector<double> r = *table.numbers(key, 4, 4);
    const glm::dvec3 axis(r[0], r[1], r[2]);
    if (!(glm::length(axis) > 0.0))
        table.fail(key, "has no axis", "[0, 0, 0]", "give an axis that is not zero");
    return glm::angleAxis(glm::radians(r[3]), glm::normalize(axis));
}

glm::dvec3 readScale(TableReader& table, const std::string& key)
{
    return table.isList(key) ? glm::dvec3(*table.vector(key)) : glm::dvec3(*table.number(key));
}

glm::dmat4 readTransform(TableReader& table, const std::string& key)
{
    glm::dmat4 all(1.0);
    for (TableReader& step : table.tables(key))
        all = readStep(step) * all;
    return all;
}

} // namespace wedge::scene
