#pragma once

#include <chrono>
#include <string>

namespace wedge::app {

/// A line on stderr that overwrites itself; silent where stderr is no terminal.
class ProgressLine {
public:
    explicit ProgressLine(bool wanted);
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Shows a text.
    void show(const std::string& text);
    /// Shows what is done, 0 to 1, and the time left, a few times a second at most. The clock starts with the first
    /// call.
    void update(double fraction);
    /// Removes the line.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    bool active_;
    bool shown_ = false;
    Clock::time_point start_ {}, last_ {};
};

} // namespace wedge::app
