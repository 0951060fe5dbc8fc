#pragma once

#include <stdexcept>
#include <string>

namespace wedge::decode {

/// Why bytes are no image that is read here. It knows no file: who named one makes it an Error.
class Failure : public std::runtime_error {
public:
    /// reason: "it ends before the picture does". remedy: the way out, an imperative.
    explicit Failure(
        const std::string& reason, const std::string& remedy = "check that the file is whole and of its type")
        : std::runtime_error(reason)
        , remedy_(remedy)
    {
    }
    const std::string& remedy() const { return remedy_; }

private:
    std::string remedy_;
};

} // namespace wedge::decode
