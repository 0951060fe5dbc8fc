#include "host/scene/mtl_values.h"

#include <fmt/format.h>

#include "host/scene/paths.h"
#include "host/text.h"

namespace wedge::scene {
namespace {

/// Linear Rec.709 of CIE XYZ, by IEC 61966-2-1; columns first.
const glm::mat3 fromXyz(
    3.2404542f, -0.9692660f, 0.0556434f, -1.5371385f, 1.8760108f, -0.2040259f, -0.4985314f, 0.0415560f, 1.0572252f);

} // namespace

void MtlNotes::begin(std::string_view name)
{
    ++material_;
    name_ = name;
    shownName_ = shortened(name, maxMessage / 3); // once, and not for each of its warnings
}

void MtlNotes::warn(std::string_view kind, const std::string& text)
{
    warnings_.add(kind, fmt::format("{}: material '{}': {}", where_, shownName_, text));
}

void MtlNotes::leaveOut(const std::string& what)
{
    LeftOut& left = leftOut_[what];
    if (left.materials > 0 && left.last == material_)
        return;
    if (left.materials++ == 0)
        left.first = name_;
    left.last = material_;
}

void MtlNotes::finish()
{
    for (const auto& [what, left] : leftOut_)
        warnings_.add("statements of material files without effect",
            fmt::format("{}: {} has no effect here; {} material(s) have it, '{}' is the first", where_, what,
                left.materials, left.first));
}

float MtlValues::number(const char* key, std::string_view word, float replacement)
{
    float value = 0.0f;
    if (parseNumber(word, value) == NumberKind::Good && value >= 0.0f)
        return value;
    replaced(key, word, replacement);
    return replacement;
}

void MtlValues::replaced(std::string_view key, std::string_view word, float replacement)
{
    notes_.warn("values of material files",
        word.empty() ? fmt::format("{} has no value, {:g} is used", key, replacement)
                     : fmt::format("{} has the value {}, {:g} is used", key, word, replacement));
}

float MtlValues::share(std::string_view key, std::string_view word, float replacement)
{
    float value = 0.0f;
    if (parseNumber(word, value) == NumberKind::Good && value >= 0.0f && value <= 1.0f)
        return value;
    replaced(key, word, replacement);
    return replacement;
}

glm::vec3 MtlValues::numbers(const char* key, StatementReader& in)
{
    glm::vec3 value(number(key, in.word(), 0.0f));
    for (int i = 1; i < 3; ++i) {
        const std::string_view word = in.word();
        if (word.empty() || word.front() == '#')
            return value;
        value[i] = number(key, word, 0.0f);
    }
    return value;
}

glm::vec3 MtlValues::colour(const char* key, StatementReader& in, float ofSpectrum)
{
    const std::string first = lowerCase(std::string(in.ahead().substr(0, 9)));
    if (first == "spectral") {
        notes_.leaveOut(fmt::format("a spectrum ({} spectral), in whose place is {:g},", key, ofSpectrum));
        return glm::vec3(ofSpectrum);
    }
    if (first != "xyz") {
        double value = 0.0;
        if (!first.empty() && first.front() != '#' && parseNumber(in.ahead(), value) == NumberKind::Unreadable)
            notes_.warn(
                "values of material files", fmt::format("{} has the word {}, which is not read", key, in.word()));
        return numbers(key, in);
    }
    in.word();
    return glm::max(fromXyz * numbers(key, in), glm::vec3(0.0f)); // what no Rec.709 has is cut
}

} // namespace wedge::scene
