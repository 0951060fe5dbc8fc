#pragma once

#include <cstddef>
#include <vector>

#include "host/scene/toml_reader.h"

namespace wedge::scene {

/// The two keys that a time lies between.
struct KeySpan {
    std::size_t from = 0, to = 0;
    double weight = 0.0; ///< of `to`, 0 to 1; `from` has the rest
};

/// times: of the keys, at least one, ascending. Before the first and after the last key these hold.
KeySpan spanAt(const std::vector<double>& times, double time);

/// The `time` of a key, which must come after those of the keys before it.
double readKeyTime(TableReader& key, const std::vector<double>& before);

} // namespace wedge::scene
