#include "host/app/values.h"

#include "host/error.h"
#include "host/scene/scene.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::app {
namespace {

[[noreturn]] void fail(const std::string& option, const std::string& text, const std::string& remedy)
{
    throw UsageError(option, text.empty() ? "(empty)" : text, remedy);
}

/// The number that is the whole text, or nothing.
template <class T>
std::optional<T> parsed(std::string_view text)
{
    T value {};
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, value);
    return !text.empty() && stop == end && status == std::errc() ? std::optional(value) : std::nullopt;
}

} // namespace

std::int64_t wholeNumber(const std::string& option, const std::string& text, std::int64_t least, std::int64_t most)
{
    const auto value = parsed<std::int64_t>(text);
    if (!value || *value < least || *value > most) {
        fail(option, text, fmt::format("give a whole number from {} to {}", least, most));
    }
    return *value;
}

double finiteNumber(const std::string& option, const std::string& text, double least, double most)
{
    const auto value = parsed<double>(text);
    if (!value || !(*value >= least && *value <= most)) {
        fail(option, text, fmt::format("give a number from {:g} to {:g}", least, most));
    }
    return *value;
}

double positiveNumber(const std::string& option, const std::string& text, double most)
{
    const auto value = parsed<double>(text);
    if (!value || !(*value > 0 && *value <= most)) {
        fail(option, text, fmt::format("give a number above 0 and at most {}", most));
    }
    return *value;
}

std::pair<int, int> imageSize(const std::string& option, const std::string& text)
{
    const std::size_t cross = std::min(text.find('x'), text.size());
    const auto width = parsed<int>(std::string_view(text).substr(0, cross));
    const auto height = parsed<int>(std::string_view(text).substr(std::min(cross + 1, text.size())));
    const auto allowed = [](const std::optional<int>& side) {
        return side && *side >= 1 && *side <= scene::maxImageSide;
    };
    if (!allowed(width) || !allowed(height)) {
        fail(option, text, fmt::format("give WIDTHxHEIGHT, each from 1 to {}", scene::maxImageSide));
    }
    return { *width, *height };
}

image::Window cropWindow(const std::string& option, const std::string& text)
{
    std::array<int, 4> values {};
    std::size_t at = 0;
    bool valid = std::ranges::count(text, ',') == 3;
    for (std::size_t i = 0; valid && i < values.size(); ++i) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const auto value = parsed<int>(std::string_view(text).substr(at, comma - at));
        valid = value && *value >= 0;
        values[i] = value.value_or(0);
        at = comma + 1;
    }
    const auto [x0, y0, x1, y1] = values;
    if (!valid || x0 >= x1 || y0 >= y1) {
        fail(option, text, "give x0,y0,x1,y1 in pixels, 0 <= x0 < x1 and 0 <= y0 < y1");
    }
    return { x0, y0, x1, y1 };
}

std::string fileName(const std::string& option, const std::string& text)
{
    if (text == "-") {
        fail(option, text, "give /dev/stdout for the standard output, or ./- for a file of that name");
    }
    return text;
}

std::int64_t texturePixels(const std::string& option, const std::string& text)
{
    return wholeNumber(option, text, 1, scene::mostTexturePixels);
}

std::size_t choice(const std::string& option, const std::string& text, const std::vector<std::string>& choices)
{
    const auto found = std::ranges::find(choices, text);
    if (found == choices.end()) {
        fail(option, text, fmt::format("choose {}", fmt::join(choices, ", ")));
    }
    return static_cast<std::size_t>(found - choices.begin());
}

void refuse(bool given, const std::string& with, const std::string& option, const std::string& remedy)
{
    if (given) {
        throw UsageError("option has no effect " + with, option, "leave it out, or " + remedy);
    }
}

} // namespace wedge::app
