#include "host/scene/mtl_texture.h"

#include <map>

namespace wedge::scene {
namespace {

/// The words behind an option; numbers may be fewer than that.
struct Option {
    int words = 0;
    bool numbers = false;
    float harmless = 0.0f; ///< the numbers that do nothing
};

const std::map<std::string_view, Option> options = { { "-o", { 3, true, 0.0f } }, { "-s", { 3, true, 1.0f } },
    { "-t", { 3, true, 0.0f } }, { "-mm", { 2, true, 0.0f } }, { "-bm", { 1, true, 0.0f } },
    { "-boost", { 1, true, 0.0f } }, { "-texres", { 1, true, 0.0f } }, { "-blendu", { 1 } }, { "-blendv", { 1 } },
    { "-cc", { 1 } }, { "-clamp", { 1 } }, { "-imfchan", { 1 } }, { "-type", { 1 } }, { "-colorspace", { 1 } } };

} // namespace

MtlTexture parseMtlTexture(StatementReader& statement)
{
    MtlTexture texture;
    for (auto option = options.find(statement.ahead()); option != options.end();
         option = options.find(statement.ahead())) {
        const std::string_view keyword = statement.word();
        const auto& [words, numbers, harmless] = option->second;
        for (int i = 0; i < words; ++i) {
            float value = 0.0f;
            if (numbers && parseNumber(statement.ahead(), value) == NumberKind::Unreadable)
                break;
            const std::string_view word = statement.word();
            texture.hasUnsupported = texture.hasUnsupported || (keyword == "-clamp" && word == "on")
                || ((keyword == "-o" || keyword == "-s") && value != harmless);
            if (keyword == "-bm")
                texture.multiplier = word;
        }
    }
    texture.name = statement.rest();
    return texture;
}

} // namespace wedge::scene
