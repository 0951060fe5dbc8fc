#include "host/scene/toml_limits.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::scene {
namespace {

/// Where it takes a text for something else than the parser does, the text is wrong and the parser stops there.
class DepthCheck {
public:
    DepthCheck(std::string_view text, const std::filesystem::path& file)
        : text_(text)
        , file_(file)
    {
    }

    void run()
    {
        while (at_ < text_.size())
            step();
    }

private:
    void step()
    {
        const char c = text_[at_];
        if (c == '#')
            at_ = std::min(text_.find('\n', at_), text_.size());
        else if (c == '"' || c == '\'')
            skipString(c);
        else {
            count(c);
            ++at_;
        }
    }

    void count(char c)
    {
        if (c == '.') {
            if (++parts_ > mostKeyParts)
                fail("key has too many parts", mostKeyParts);
            return;
        }
        if (c == '[' || c == '{') {
            if (++brackets_ > mostBrackets)
                fail("brackets are nested too deep", mostBrackets);
        } else if (c == ']' || c == '}') {
            brackets_ = std::max(brackets_ - 1, 0);
        }
        if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{')
            parts_ = 1;
    }

    /// A string ends with its quotes, or with the line where it is of one line and wrong.
    void skipString(char quote)
    {
        const std::string three(3, quote);
        const bool isLong = text_.substr(at_).starts_with(three);
        at_ += isLong ? 3 : 1;
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '\\' && quote == '"') {
                ++at_;
            } else if (isLong && text_.substr(at_).starts_with(three)) {
                for (int i = 0; i < 5 && at_ < text_.size() && text_[at_] == quote; ++i) // two may belong to the string
                    ++at_;
                return;
            } else if (!isLong && (c == quote || c == '\n')) {
                at_ += c == quote;
                return;
            }
        }
    }

    [[noreturn]] void fail(const char* what, int most) const
    {
        const std::size_t before = text_.substr(0, at_).rfind('\n');
        const std::size_t column = before == std::string_view::npos ? at_ + 1 : at_ - before;
        const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
        throw Error(fmt::format("scene file {}:{}:{}: {}", file_.string(), line, column, what),
            fmt::format("more than {}", most), "nest it less");
    }

    std::string_view text_;
    const std::filesystem::path& file_;
    std::size_t at_ = 0;
    int parts_ = 1, brackets_ = 0;
};

} // namespace

void checkTomlDepth(std::string_view text, const std::filesystem::path& file) { DepthCheck(text, file).run(); }

} // namespace wedge::scene
