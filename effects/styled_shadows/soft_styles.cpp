#include "effects/styled_shadows/soft_styles.h"

#include "effects/styled_shadows/object_list.h"
#include "effects/styled_shadows/shadow_distances.h"
#include "effects/styled_shadows/style_knobs.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/shadow_levels.cl";

/// The level k of so many, 0 to 1: close to each other where hardly anything or nearly all is seen of a light, since
/// the tails of penumbras are long.
float levelOf(std::uint32_t k, std::uint32_t count)
{
    const double turn = (k + 0.5) / count * std::numbers::pi;
    return static_cast<float>(0.5 - 0.5 * std::cos(turn));
}

/// Metres that distances of a light's levels are told apart up to, beyond what styles ask for: penumbras are about as
/// wide as lights, and more than the distance between two levels has to be known.
float widthOf(const shared::AreaLight& light)
{
    return 8.0f * std::max(shared::vecLength(light.halfU), shared::vecLength(light.halfV));
}

/// Styles of a light whose level sets are the same, and by how much each changes what is seen.
class LevelStyles {
public:
    LevelStyles(FrameBuilder& frame, const SeenLight& seen, std::vector<const scene::ShadowStyle*> styles)
        : f_(frame)
        , seen_(seen)
        , styles_(std::move(styles))
        , penumbra_(styles_.front()->penumbra)
        , changes_(styles_.size())
    {
        for (const scene::ShadowStyle* style : styles_) {
            largest_ = std::max(largest_, mostDistance({ style, 1 }, 0.0f));
        }
        largest_ += largest_ > 0.0f ? widthOf(seen.light) : 0.0f;
    }

    /// Adds to R, G and B of what is seen.
    void declare(graph::Handle<Value>& sum)
    {
        if (largest_ > 0.0f) {
            levels();
        }
        for (std::size_t i = 0; i < styles_.size(); ++i) {
            addStyle(*styles_[i], changes_[i], sum);
        }
    }

private:
    /// One of them as it was at the level before.
    struct Level {
        graph::Handle<Metres> distance;
        std::vector<SmoothedDistance> smoothed; ///< of each style
    };

    void levels()
    {
        for (graph::Handle<Share>& change : changes_) {
            change = f_.graph.plane<Share>("change by levels", graph::floatPlanes(WEDGE_LEVEL_PLANES));
            f_.zero(change);
        }
        // Without a penumbra all levels are one.
        const std::uint32_t count = penumbra_ > 0.0f ? WEDGE_SHADOW_LEVELS : 1u;
        Level before;
        for (std::uint32_t k = 0; k < count; ++k) {
            Level level = levelAt(0.5f + penumbra_ * (levelOf(k, count) - 0.5f));
            if (k > 0 || count == 1) {
                for (std::size_t i = 0; i < styles_.size(); ++i) {
                    addLevels(i, k, count, level, before);
                }
            }
            before = std::move(level);
        }
    }

    Level levelAt(float level)
    {
        auto matte = f_.graph.plane<Matte>("matte of a level", graph::floats);
        f_.pixels("levels of a shadow", PassKind::Analysis, { program, "levelMatte" },
            { f_.rectangle(f_.analysisParams()), reads("position", f_.surfaces.position),
                reads("normal", f_.surfaces.normal), reads("objectId", f_.surfaces.objectId),
                value("light", seen_.light), reads("value", seen_.value), value("level", level),
                writes("matte", matte) });
        Level out;
        out.distance = shadowDistances(f_, matte, {}, 0.0f, largest_).distance;
        for (const scene::ShadowStyle* style : styles_) {
            const shared::StyleKnob deviation = abstractionOf(*style);
            out.smoothed.push_back(mostOf(deviation, 0.0f) > 0.0f
                    ? smoothedDistance(f_, matte, out.distance,
                        { graph::absent("away"), value("deviation", deviation), largest_, style->keepArea })
                    : SmoothedDistance { out.distance, {} });
        }
        return out;
    }

    /// Adds what is seen between a level and the one before; of one level, of no graph, of all of the light.
    void addLevels(std::size_t style, std::uint32_t k, std::uint32_t count, const Level& level, const Level& before)
    {
        const auto zeros = [](const char* name, const SmoothedDistance& of) {
            return of.zeros.graph != 0 ? reads(name, of.zeros) : graph::absent(name);
        };
        const bool one = count == 1;
        const float at = levelOf(k, count), from = one ? at : levelOf(k - 1, count);
        const SmoothedDistance& now = level.smoothed[style];
        const SmoothedDistance previous = one ? SmoothedDistance() : before.smoothed[style];
        f_.pixels("styles of shadows", PassKind::Composite, { program, "addLevel" },
            joined({ f_.rectangle(f_.analysisParams()), reads("distance", level.distance),
                       reads("smoothed", now.distance), zeros("zeros", now) },
                Arguments { one ? graph::absent("previous") : reads("previous", before.distance),
                    one ? graph::absent("previousSmoothed") : reads("previousSmoothed", previous.distance),
                    zeros("previousZeros", previous) },
                graph::together("style",
                    { value("inflation", inflationOf(*styles_[style]).base),
                        value("softness", softnessOf(*styles_[style]).base), value("both", at - from),
                        value("beforeThem", k <= 1 ? from : 0.0f),
                        value("afterThem", k + 1 == count ? 1.0f - at : 0.0f),
                        value("end", one ? 0.0f : levelOf(0, count) / (levelOf(1, count) - levelOf(0, count))),
                        value("levels", static_cast<float>(one ? 1 : count - 1)) }),
                Arguments { updates("change", changes_[style]) }));
    }

    void addStyle(const scene::ShadowStyle& style, const graph::Handle<Share>& change, graph::Handle<Value>& sum)
    {
        Arguments passes =
            joined({ f_.rectangle(f_.analysisParams()), value("light", seen_.light), reads("value", seen_.value),
                       change.graph != 0 ? reads("change", change)
                                         : graph::absent("change", graph::floatPlanes(WEDGE_LEVEL_PLANES)),
                       reads("pixelSize", f_.surfaces.pixelSize) },
                places(f_.surfaces),
                graph::together("style",
                    { value("channels", f_.specular() ? 2u : 1u), value("penumbra", style.penumbra),
                        value("softness", softnessOf(style).base), value("largest", largest_),
                        value("red", brightnessOf(style, 0).base), value("green", brightnessOf(style, 1).base),
                        value("blue", brightnessOf(style, 2).base), value("weight", style.weight) }));
        if (style.receivers.empty()) {
            passes.push_back(graph::absent("receivers", graph::counts));
        } else {
            passes = joined(passes, objectList(f_, "receivers", style.receivers));
        }
        passes.push_back(updates("seen", sum));
        f_.pixels("styles of shadows", PassKind::Composite, { program, "softStyle" }, std::move(passes));
    }

    FrameBuilder& f_;
    const SeenLight& seen_;
    std::vector<const scene::ShadowStyle*> styles_;
    float penumbra_;
    float largest_ = 0; ///< metres, of distances that are told apart
    std::vector<graph::Handle<Share>> changes_; ///< of what is seen, by each style; of no graph: by none
};

} // namespace

graph::Handle<Value> softStyles(FrameBuilder& f, const SeenLight& seen)
{
    auto sum = f.graph.plane<Value>("change by styles", graph::floatPlanes(f.specular() ? 6 : 3));
    f.zero(sum);
    std::set<float> penumbras;
    for (const scene::ShadowStyle& style : seen.styles) {
        penumbras.insert(style.penumbra);
    }
    for (const float penumbra : penumbras) {
        std::vector<const scene::ShadowStyle*> alike;
        for (const scene::ShadowStyle& style : seen.styles) {
            if (style.penumbra == penumbra) {
                alike.push_back(&style);
            }
        }
        LevelStyles(f, seen, std::move(alike)).declare(sum);
    }
    return sum;
}

} // namespace wedge::render
