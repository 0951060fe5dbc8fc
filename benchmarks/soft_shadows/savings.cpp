#include "benchmarks/soft_shadows/savings.h"

namespace wedge::benchmark {
namespace {

using render::Sampler;
using render::Shading;

BaselineSettings unfiltered(Sampler sampler, Shading shading)
{
    return [sampler, shading](int spp) {
        render::Settings settings = render::monteCarlo(spp);
        settings.sampler = sampler;
        settings.shading = shading;
        settings.lightSampling = render::LightSampling::Lights; // what the filtered methods are made of
        return settings;
    };
}

} // namespace

std::vector<Comparison> compareWithBaselines(Lab& lab, const Method& method)
{
    const auto compare = [&](const char* name, const char* meaning, Sampler sampler, Shading shading) {
        return compareWith(lab, method, name, meaning, unfiltered(sampler, shading));
    };
    if (method.setting == "published") {
        return { compare("stratified_separate", "unfiltered, stratified, shading apart from visibility",
            Sampler::Stratified, Shading::Separate) };
    }
    return {
        compare("stratified", "unfiltered, stratified, shaded like the method", Sampler::Stratified, Shading::Ratio),
        compare("sobol", "unfiltered, Owen-scrambled Sobol, shaded like the method", Sampler::Sobol, Shading::Ratio),
        compare("plain_mc", "unfiltered, stratified, cosine and distance sampled too", Sampler::Stratified,
            Shading::Inside),
    };
}

} // namespace wedge::benchmark
