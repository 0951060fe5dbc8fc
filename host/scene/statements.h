#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wedge::scene {

/// Walks the statements of an OBJ or MTL text: one a line, of words between spaces and tabs. Lines end with LF, CR or
/// both; a backslash before the end continues a line on the next.
class StatementReader {
public:
    /// A byte order mark before the text is skipped.
    explicit StatementReader(std::string_view text)
        : text_(text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text)
    {
    }

    /// Goes to the next statement; false at the text's end.
    bool next();

    /// The number of the line that the statement begins on.
    std::size_t line() const { return line_; }

    /// The statement's next word, or an empty one.
    std::string_view word();

    /// The word that word() gives next.
    std::string_view ahead() const;

    /// What is left of the statement, without the spaces around it.
    std::string_view rest();

private:
    std::string_view text_, statement_;
    std::string joined_; ///< a statement of several lines
    std::size_t line_ = 0, following_ = 1;
};

/// A name without the quotation marks, double or single, that some programs write around it; a comment may follow them.
std::string_view unquoted(std::string_view name);

/// What a word is when it is read as a number.
enum class NumberKind {
    Good, ///< finite in single precision
    NotFinite,
    Unreadable,
};

/// value: 0 unless the kind is Good.
NumberKind parseNumber(std::string_view word, double& value);
NumberKind parseNumber(std::string_view word, float& value);

} // namespace wedge::scene
