#pragma once

#include "host/text.h"

#include <stdexcept>
#include <string>

namespace wedge {

/// A failure that the user can do something about. what() is one line "<what>: <value>: <what to do>", printable and of
/// bounded length whatever the parts hold (message() of host/text.h).
class Error : public std::runtime_error {
public:
    /// what: the thing that is wrong, with its place ("scene file a.toml:3:7: unknown key").
    /// value: the offending value. remedy: the way out, an imperative.
    Error(const std::string& what, const std::string& value, const std::string& remedy)
        : std::runtime_error(message(what, value, remedy))
    {
    }
};

/// A wrong call of the program (exit status 2); everything else an Error says is exit status 1.
class UsageError : public Error {
public:
    using Error::Error;
};

} // namespace wedge
