#include "bvh/bvh.h"

#include <utility>

namespace wedge::bvh {
namespace {

constexpr std::pair<std::string_view, Mode> names[] = {
    { "fast", Mode::Fast },
    { "default", Mode::Default },
    { "quality", Mode::Quality },
};

} // namespace

std::optional<Mode> parseMode(std::string_view name)
{
    for (const auto& [known, mode] : names)
        if (known == name)
            return mode;
    return std::nullopt;
}

std::string_view modeName(Mode mode)
{
    for (const auto& [name, known] : names)
        if (known == mode)
            return name;
    return {};
}

Config config(Mode mode)
{
    Config config;
    config.mortonRuns = mode == Mode::Fast;
    config.bins = mode == Mode::Fast ? 16 : config.bins;
    config.reinsertionRounds = mode == Mode::Quality ? 3 : mode == Mode::Fast ? 0 : config.reinsertionRounds;
    config.extraReferences = mode == Mode::Quality ? 0.5f : 0.0f;
    return config;
}

} // namespace wedge::bvh
