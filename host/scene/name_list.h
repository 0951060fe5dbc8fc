#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wedge::scene {

/// Names in order, each once.
class NameList {
public:
    std::uint32_t add(std::string_view name)
    {
        auto known = indices_.find(name);
        if (known == indices_.end()) {
            known = indices_.emplace(name, static_cast<std::uint32_t>(names_.size())).first;
            names_.emplace_back(name);
        }
        return known->second;
    }
    std::size_t size() const { return names_.size(); }
    std::vector<std::string> take() { return std::move(names_); }

private:
    std::vector<std::string> names_;
    std::map<std::string, std::uint32_t, std::less<>> indices_;
};

} // namespace wedge::scene
