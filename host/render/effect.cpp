#include "host/render/effect.h"

#include "host/render/distributed_samples.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::render {
namespace {

std::vector<std::unique_ptr<const Effect>>& registry()
{
    static std::vector<std::unique_ptr<const Effect>> registered; // before any that registers itself
    return registered;
}

} // namespace

const std::vector<std::unique_ptr<const Effect>>& effects() { return registry(); }

void registerEffect(std::unique_ptr<const Effect> effect)
{
    if (std::ranges::any_of(registry(), [&](const auto& known) { return known->name() == effect->name(); })) {
        throw std::logic_error("there are two effects called " + effect->name());
    }
    registry().push_back(std::move(effect));
}

const Effect* changerOfVisibility(const Settings& settings, const scene::AreaLight& light)
{
    for (const auto& effect : effects()) {
        if (effect->changesVisibility(settings, light)) {
            return effect.get();
        }
    }
    return nullptr;
}

std::vector<Term> frameTerms(const Settings& settings, const PreparedScene& scene)
{
    std::vector<Term> terms;
    for (const auto& effect : effects()) {
        std::ranges::move(effect->terms(settings, scene), std::back_inserter(terms));
    }
    std::ranges::stable_sort(terms, {}, &Term::part);
    return terms;
}

std::size_t countOf(Part part, const std::vector<Term>& terms)
{
    return static_cast<std::size_t>(std::ranges::count(terms, part, &Term::part));
}

std::vector<Unfiltered> frameUnfiltered(const Settings& settings, const PreparedScene& scene)
{
    std::vector<Unfiltered> out;
    for (const auto& effect : effects()) {
        if (std::optional<Unfiltered> light = effect->unfiltered(settings, scene)) {
            out.push_back(std::move(*light));
        }
    }
    return out;
}

PlaneLayout frameLayout(const Settings& settings, const PreparedScene& scene)
{
    int margin = 0;
    for (const auto& effect : effects()) {
        margin = isDistributed(settings, scene) ? 0 : std::max(margin, effect->margin(settings, scene));
    }
    return { settings.width, settings.height, margin };
}

device::GeneratedSources programSources(const scene::Scene& scene)
{
    device::GeneratedSources out;
    std::string functions, sum;
    for (const auto& effect : effects()) {
        out.merge(effect->sources());
        if (const std::optional<Environment> seen = effect->environment(scene)) {
            functions += seen->source;
            sum += fmt::format("    sum = vecAdd(sum, {}(direction));\n", seen->function);
        }
    }
    if (!sum.empty()) {
        out["trace/environment.h"] =
            fmt::format("#ifndef WEDGE_ENVIRONMENT_H\n#define WEDGE_ENVIRONMENT_H\n"
                        "#include \"shared/vec.h\"\n#define WEDGE_ENVIRONMENT 1\n{}"
                        "WEDGE_INLINE Vec3 environmentRadiance(Vec3 direction)\n{{\n"
                        "    Vec3 sum = vec3(0.0f, 0.0f, 0.0f);\n{}    return sum;\n}}\n#endif\n",
                functions, sum);
    }
    return out;
}

std::shared_ptr<const EnvironmentPicture> pictureOf(const scene::Scene& scene)
{
    for (const auto& effect : effects()) {
        if (auto picture = effect->picture(scene)) {
            return picture;
        }
    }
    return nullptr;
}

std::string absenceOf(Part part)
{
    for (const auto& effect : effects()) {
        if (std::string why = effect->absence(part); !why.empty()) {
            return why;
        }
    }
    return "no effect has any";
}

} // namespace wedge::render
