#include "host/text.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

namespace wedge {
namespace {

/// The length of the UTF-8 character at the text's beginning and its code point; length 0 where there is none.
struct Character {
    std::size_t length = 0;
    std::uint32_t code = 0;
};

Character characterAt(std::string_view text)
{
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x80)
        return { 1, lead };
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length)
        return {};
    std::uint32_t code = lead & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0) != 0x80)
            return {};
        code = code << 6 | (byte & 0x3fu);
    }
    constexpr std::array<std::uint32_t, 5> least = { 0, 0, 0x80, 0x800, 0x10000 };
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < least[length] || code > 0x10ffff || surrogate ? Character {} : Character { length, code };
}

bool movesTheTerminal(std::uint32_t code)
{
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x2028 && code <= 0x202e)
        || (code >= 0x2066 && code <= 0x2069) || code == 0x200e || code == 0x200f || code == 0x061c;
}

void appendEscaped(std::string& out, unsigned char byte)
{
    constexpr std::string_view digits = "0123456789abcdef";
    if (byte == '\n' || byte == '\t') {
        out += byte == '\n' ? "\\n" : "\\t";
        return;
    }
    out += "\\x";
    out += digits[byte >> 4];
    out += digits[byte & 15];
}

bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

} // namespace

std::string printable(std::string_view text)
{
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const Character character = characterAt(text);
        const std::size_t length = std::max<std::size_t>(character.length, 1);
        if (character.length > 0 && !movesTheTerminal(character.code)) {
            out += text.substr(0, length);
        } else {
            for (const char byte : text.substr(0, length))
                appendEscaped(out, static_cast<unsigned char>(byte));
        }
        text.remove_prefix(length);
    }
    return out;
}

std::string shortened(std::string_view text, std::size_t most)
{
    assert(most >= 8);
    if (text.size() <= most)
        return std::string(text);
    constexpr std::string_view gap = "...";
    std::size_t head = (most - gap.size()) / 2;
    std::size_t tail = text.size() - (most - gap.size() - head);
    while (head > 0 && isContinuation(text[head]))
        --head;
    while (tail < text.size() && isContinuation(text[tail]))
        ++tail;
    return std::string(text.substr(0, head)).append(gap).append(text.substr(tail));
}

std::string message(std::string_view what, std::string_view value, std::string_view remedy)
{
    // Before anything else, so that a text of megabytes is not worked through several times.
    std::array<std::string, 3> parts;
    const std::array<std::string_view, 3> given = { what, value, remedy };
    std::ranges::transform(
        given, parts.begin(), [](std::string_view part) { return printable(shortened(part, 2 * maxMessage)); });
    constexpr std::size_t separators = 4;
    constexpr std::size_t leastPart = 90;
    const auto total = [&] { return parts[0].size() + parts[1].size() + parts[2].size() + separators; };
    for (const std::size_t part : { 1, 0, 2 }) {
        if (total() > maxMessage && parts[part].size() > leastPart) {
            const std::size_t excess = total() - maxMessage;
            parts[part] =
                shortened(parts[part], std::max(leastPart, parts[part].size() - std::min(parts[part].size(), excess)));
        }
    }
    return parts[0] + ": " + parts[1] + ": " + parts[2];
}

} // namespace wedge
