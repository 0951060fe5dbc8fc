#include "host/scene/statements.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace wedge::scene {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\t'; }

/// Bytes of the line end that the text begins with.
std::size_t lineEnd(std::string_view text)
{
    if (text.empty() || (text[0] != '\n' && text[0] != '\r'))
        return 0;
    return text.starts_with("\r\n") ? 2 : 1;
}

std::size_t beforeLineEnd(std::string_view text)
{
    std::size_t end = 0;
    while (end < text.size() && text[end] != '\n' && text[end] != '\r')
        ++end;
    return end;
}

/// Comments end with their line, whatever path of another system they hold.
bool isComment(std::string_view line)
{
    const std::size_t begin = line.find_first_not_of(" \t");
    return begin != std::string_view::npos && line[begin] == '#';
}

} // namespace

bool StatementReader::next()
{
    if (text_.empty())
        return false;
    line_ = following_++;
    const std::size_t end = beforeLineEnd(text_);
    statement_ = text_.substr(0, end);
    text_.remove_prefix(end);
    const bool goesOn = statement_.ends_with('\\') && !text_.empty() && !isComment(statement_);
    text_.remove_prefix(lineEnd(text_));
    if (!goesOn)
        return true;
    joined_.assign(statement_);
    while (joined_.ends_with('\\')) {
        joined_.back() = ' ';
        const std::size_t length = beforeLineEnd(text_);
        joined_ += text_.substr(0, length);
        text_.remove_prefix(length);
        const std::size_t ending = lineEnd(text_);
        if (ending == 0) // the text ends: a backslash there stays
            break;
        text_.remove_prefix(ending);
        ++following_;
    }
    statement_ = joined_;
    return true;
}

std::string_view StatementReader::ahead() const
{
    std::size_t begin = 0;
    while (begin < statement_.size() && isSpace(statement_[begin]))
        ++begin;
    std::size_t end = begin;
    while (end < statement_.size() && !isSpace(statement_[end]))
        ++end;
    return statement_.substr(begin, end - begin);
}

std::string_view StatementReader::word()
{
    const std::string_view next = ahead();
    statement_.remove_prefix(static_cast<std::size_t>(next.data() + next.size() - statement_.data()));
    return next;
}

std::string_view StatementReader::rest()
{
    while (!statement_.empty() && isSpace(statement_.front()))
        statement_.remove_prefix(1);
    while (!statement_.empty() && isSpace(statement_.back()))
        statement_.remove_suffix(1);
    return statement_;
}

std::string_view unquoted(std::string_view name)
{
    if (name.empty() || (name.front() != '"' && name.front() != '\''))
        return name;
    const std::size_t end = name.find(name.front(), 1);
    if (end == std::string_view::npos)
        return name;
    const std::size_t behind = name.find_first_not_of(" \t", end + 1);
    const bool commented = behind != std::string_view::npos && behind > end + 1 && name[behind] == '#';
    return behind == std::string_view::npos || commented ? name.substr(1, end - 1) : name;
}

NumberKind parseNumber(std::string_view word, double& value)
{
    value = 0.0;
    if (!word.empty() && word.front() == '+')
        word.remove_prefix(1);
    double read = 0.0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), read);
    if (code == std::errc::result_out_of_range) {
        const std::size_t exponent = word.find_first_of("eE");
        const bool tiny = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                             : word.find_first_not_of("-0") == word.find('.');
        return tiny ? NumberKind::Good : NumberKind::NotFinite;
    }
    if (code != std::errc {} || end != word.data() + word.size())
        return NumberKind::Unreadable;
    if (!(std::abs(read) <= static_cast<double>(std::numeric_limits<float>::max()))) // also false for NaN
        return NumberKind::NotFinite;
    value = read;
    return NumberKind::Good;
}

NumberKind parseNumber(std::string_view word, float& value)
{
    double read = 0.0;
    const NumberKind kind = parseNumber(word, read);
    value = static_cast<float>(read);
    return kind;
}

} // namespace wedge::scene
