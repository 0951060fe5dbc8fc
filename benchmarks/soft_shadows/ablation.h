#pragma once

#include "benchmarks/soft_shadows/lab.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// One curve of Fig. 3.6c.
struct Series {
    std::string setting; ///< "default" or "published"
    std::string sampling; ///< "NAS": uniform counts, "AS": adaptive
    std::string filter; ///< "UF": none, "NAF": one width for the image, "AF": adaptive
    std::optional<float> fixedWidth; ///< of NAF, pixels
    std::vector<Measured> points;
};

/// The six combinations of sampling and filter at the plan's budgets, for one setting. Uniform counts are about the
/// means of the adaptive ones; NAS with UF is plain Monte Carlo. NAF has the width with the smallest error at about 28
/// samples, found for AS and NAS each.
std::vector<Series> ablations(Lab& lab, bool published);

/// The width in pixels of least error with these settings: from `start` by factors of sqrt 2 in the direction in which
/// the error falls.
float bestFixedWidth(Lab& lab, render::Settings settings, float start);

/// The default setting at its usual budget, with one width in place of the adaptive ones: the best one.
struct FixedBlur {
    float width = 0; ///< pixels
    Measured measured;
};
FixedBlur bestFixedBlur(Lab& lab);

/// The error by mu; sampling and filter adaptive, samples following from mu.
std::vector<Measured> convergence(Lab& lab, bool published);

/// True if each point has a smaller error than the one before.
bool falls(const std::vector<Measured>& points);

} // namespace wedge::benchmark
