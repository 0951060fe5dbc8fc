#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wedge {

/// Text that came from a file or a call, safe to print on one line of a terminal: control characters (C0, DEL, C1, line
/// and paragraph separators, and those that turn the direction of writing) and bytes that are not UTF-8 become `\n`,
/// `\t` or `\x1b`.
std::string printable(std::string_view text);

/// The text as it is, or its beginning and its end with "..." between where it has more than `most` bytes. No character
/// of UTF-8 is cut. most: at least 8.
std::string shortened(std::string_view text, std::size_t most);

/// "what: value: remedy", printable and of at most maxMessage bytes: of what is too long the value is shortened first,
/// then what, then the remedy.
std::string message(std::string_view what, std::string_view value, std::string_view remedy);

/// Bytes of a message, so that with the program's own words before and behind it a line stays within 400.
constexpr std::size_t maxMessage = 350;

} // namespace wedge
