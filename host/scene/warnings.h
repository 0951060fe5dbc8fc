#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::scene {

/// Collects warnings for the user: of each kind the first ten and then how many more there are, each printable, on one
/// line and of bounded length (host/text.h), whatever a file put into it.
class Warnings {
public:
    static constexpr std::size_t mostOfAKind = 10;

    /// kind: what the warnings are about, in the plural ("faces without area").
    void add(std::string_view kind, std::string_view text);

    /// All lines, in the order in which they came; the one about those left out stands behind the tenth of its kind.
    std::vector<std::string> lines() const;

private:
    struct Line {
        std::string kind, text;
        bool isLast; ///< of its kind that is kept
    };
    std::vector<Line> lines_;
    std::map<std::string, std::size_t, std::less<>> counts_;
};

} // namespace wedge::scene
