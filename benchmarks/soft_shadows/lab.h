#pragma once

#include "benchmarks/common/error_curve.h"
#include "benchmarks/common/references.h"
#include "benchmarks/soft_shadows/plan.h"
#include "host/render/renderer.h"

#include <map>
#include <optional>
#include <string>

namespace wedge::benchmark {

/// One render, and how far it is from the reference of its integrand.
struct Measured {
    double spp = 0; ///< mean over shaded pixels
    double shadowRays = 0; ///< a shaded pixel; less than spp where part of the light is below the horizon
    double rmse = 0; ///< linear RGB, whole image
    float mu = 0;
    std::uint32_t seed = 0;
};

/// A line on stderr, after the benchmark's name.
void progress(const std::string& text);

/// One scene on one device: renders it and measures errors. The same settings are rendered only once.
class Lab {
public:
    /// scene must outlive the lab; name: for files and progress.
    Lab(const scene::Scene& scene, const device::Device& device, const Plan& plan, std::string name);

    /// RMS error of one image. Size comes from the plan.
    Measured measure(render::Settings settings, std::uint32_t seed = 1);

    /// What images of this shading converge to: the thesis' shading at the light's centre, or the true integral.
    const Reference& reference(render::Shading shading);
    /// Those made so far.
    const std::map<render::Shading, Reference>& references() const { return references_; }

    render::Renderer& renderer() { return renderer_; }
    const Plan& plan() const { return plan_; }
    const std::string& name() const { return name_; }

private:
    const Plan& plan_;
    std::string name_;
    render::Renderer renderer_;
    std::map<render::Shading, Reference> references_;
    std::map<std::string, Measured> measured_;
};

/// Error that is left when the reference's own, which is independent of it, is taken out in quadrature.
double withoutNoise(double rmse, double noise);

} // namespace wedge::benchmark
