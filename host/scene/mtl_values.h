#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include <glm/glm.hpp>

#include "host/scene/statements.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// What there is to say of a material library: values that are replaced, a line each, and what has no effect, a line
/// for all of its materials.
class MtlNotes {
public:
    MtlNotes(const std::string& where, Warnings& warnings)
        : where_(where)
        , warnings_(warnings)
    {
    }

    /// The statements that follow are of a material of this name.
    void begin(std::string_view name);

    void warn(std::string_view kind, const std::string& text);

    /// what: "displacement (disp)"
    void leaveOut(const std::string& what);

    /// Says what was left out.
    void finish();

private:
    struct LeftOut {
        std::size_t materials = 0, last = 0; ///< how many have it, and the number of the last of them
        std::string first;
    };

    const std::string& where_;
    Warnings& warnings_;
    std::size_t material_ = 0; ///< number of the current one
    std::string name_, shownName_; ///< its name, and as messages have it
    std::map<std::string, LeftOut> leftOut_;
};

/// Reads the values of statements. One that makes no sense is told and replaced.
class MtlValues {
public:
    explicit MtlValues(MtlNotes& notes)
        : notes_(notes)
    {
    }

    /// A number of at least 0.
    float number(const char* key, std::string_view word, float replacement);

    /// A number in [0, 1].
    float share(std::string_view key, std::string_view word, float replacement);

    /// Linear Rec.709, of at least 0: three numbers, one for a grey, or CIE XYZ (`xyz`). A spectrum is not read and
    /// told.
    glm::vec3 colour(const char* key, StatementReader& in, float ofSpectrum);

private:
    void replaced(std::string_view key, std::string_view word, float replacement);
    glm::vec3 numbers(const char* key, StatementReader& in);

    MtlNotes& notes_;
};

} // namespace wedge::scene
