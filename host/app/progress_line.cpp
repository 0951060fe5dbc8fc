#include "host/app/progress_line.h"

#include "host/app/console.h"
#include "host/text.h"

#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

namespace wedge::app {
namespace {

constexpr std::chrono::milliseconds interval { 200 };
constexpr double leastFraction = 0.02; // before, the time left would be a guess

std::string duration(double seconds)
{
    const auto whole = static_cast<long>(std::ceil(seconds));
    if (whole < 60) {
        return fmt::format("{} s", whole);
    }
    return whole < 3600 ? fmt::format("{} min {:02} s", whole / 60, whole % 60)
                        : fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

} // namespace

ProgressLine::ProgressLine(bool wanted)
    : active_(wanted && isatty(STDERR_FILENO) != 0)
{
}

void ProgressLine::show(const std::string& text)
{
    if (active_) {
        put(stderr, fmt::format("\r\033[K{}", printable(shortened(text, 200))));
        std::fflush(stderr);
        shown_ = true;
    }
}

void ProgressLine::update(double fraction)
{
    const Clock::time_point now = Clock::now();
    if (start_ == Clock::time_point()) {
        start_ = now;
    }
    if (!active_ || now - last_ < interval) {
        return;
    }
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        fraction >= leastFraction ? ", " + duration(elapsed * (1 - fraction) / fraction) + " left" : "";
    show(fmt::format("rendering {:.0f} %{}", 100 * fraction, left));
}

void ProgressLine::clear()
{
    if (shown_) {
        put(stderr, "\r\033[K");
        std::fflush(stderr);
        shown_ = false;
    }
}

} // namespace wedge::app
