#pragma once

#include "host/render/environment_table.h"

#include <memory>
#include <optional>

namespace wedge::render {

/// B_e of thesis section 6.7: the least radius in the plane of frequencies, angular ones per radian, within which is 99
/// % of the energy of the picture's luminance, of the mean as well, rounded up to a whole number; 0 of an even picture.
/// Columns are 2 pi apart in all and rows pi, as the thesis has it, whatever a column is worth near the poles. Pictures
/// of more than 2048 columns or 1024 rows, or of numbers with prime factors above 5, of which transforms take as long
/// as one likes, are averaged onto the next smaller grid without.
float environmentBandwidth(const EnvironmentPicture& picture);

/// The same of a scene's picture, worked out when it is first asked for: 0.1 s at 1024x512.
class EnvironmentBandwidth {
public:
    /// picture: null: there is none, and the bandwidth is 0
    explicit EnvironmentBandwidth(std::shared_ptr<const EnvironmentPicture> picture);

    float value() const;

private:
    std::shared_ptr<const EnvironmentPicture> picture_;
    mutable std::optional<float> value_;
};

} // namespace wedge::render
