#pragma once

#include <cstddef>
#include <functional>
#include <optional>

namespace wedge::benchmark {

/// How much more memory than before the process had at most while body ran; none where the system does not tell.
std::optional<std::size_t> peakMemory(const std::function<void()>& body);

} // namespace wedge::benchmark
