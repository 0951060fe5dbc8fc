#include "host/scene/warnings.h"

#include <fmt/format.h>

#include "host/text.h"

namespace wedge::scene {

void Warnings::add(std::string_view kind, std::string_view text)
{
    auto known = counts_.find(kind);
    if (known == counts_.end())
        known = counts_.emplace(kind, 0).first;
    if (++known->second > mostOfAKind)
        return;
    // Before it is made printable too, so that a text of megabytes is not worked through.
    const std::string line = shortened(printable(shortened(text, 2 * maxMessage)), maxMessage);
    lines_.push_back({ known->first, line, known->second == mostOfAKind });
}

std::vector<std::string> Warnings::lines() const
{
    std::vector<std::string> out;
    for (const Line& line : lines_) {
        out.push_back(line.text);
        const std::size_t count = counts_.find(line.kind)->second;
        if (line.isLast && count > mostOfAKind)
            out.push_back(fmt::format("... and {} more about {}", count - mostOfAKind, line.kind));
    }
    return out;
}

} // namespace wedge::scene
