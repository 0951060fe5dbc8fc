#include "host/scene/mtl_texture.h"

#include <array>
#include <map>

#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

/// The words behind an option; numbers may be fewer than that.
struct Option {
    int words = 0;
    bool numbers = false;
    std::array<std::string_view, 3> harmless {}; ///< words or numbers that change nothing; empty: all
};

const std::map<std::string_view, Option> options = { { "-o", { 3, true, { "0", "0", "0" } } },
    { "-s", { 3, true, { "1", "1", "1" } } }, { "-t", { 3, true, { "0", "0", "0" } } },
    { "-mm", { 2, true, { "0", "1" } } }, { "-bm", { 1, true } }, { "-boost", { 1, true } }, { "-texres", { 1, true } },
    { "-blendu", { 1 } }, { "-blendv", { 1 } }, { "-cc", { 1, false, { "off" } } },
    { "-clamp", { 1, false, { "off" } } }, { "-imfchan", { 1, false, { "m" } } }, { "-type", { 1 } },
    { "-colorspace", { 1, false, { "srgb" } } } };

bool isHarmless(std::string_view word, std::string_view harmless)
{
    double value = 0.0, same = 0.0;
    if (parseNumber(harmless, same) == NumberKind::Good)
        return parseNumber(word, value) == NumberKind::Good && value == same;
    return harmless.empty() || lowerCase(std::string(word.substr(0, 8))) == harmless;
}

} // namespace

MtlTexture parseMtlTexture(StatementReader& statement)
{
    MtlTexture texture;
    const auto ahead = [&] { return options.find(lowerCase(std::string(statement.ahead().substr(0, 16)))); };
    for (auto option = ahead(); option != options.end(); option = ahead()) {
        const std::string_view keyword = option->first;
        statement.word();
        const auto& [words, numbers, harmless] = option->second;
        for (int i = 0; i < words; ++i) {
            float value = 0.0f;
            if (numbers && parseNumber(statement.ahead(), value) == NumberKind::Unreadable)
                break;
            const std::string_view word = statement.word();
            if (texture.unsupported.empty() && !isHarmless(word, harmless[static_cast<std::size_t>(i)]))
                texture.unsupported = keyword;
            if (keyword == "-bm")
                texture.multiplier = word;
        }
    }
    texture.name = unquoted(statement.rest());
    return texture;
}

} // namespace wedge::scene
