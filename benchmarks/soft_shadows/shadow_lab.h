#pragma once

#include "benchmarks/common/lab.h"
#include "benchmarks/common/timing.h"
#include "benchmarks/soft_shadows/plan.h"

namespace wedge::benchmark {

/// Soft shadows: the whole image, and of the thesis' shading at the light's centre or of the true integral.
class SoftShadows : public Subject {
public:
    explicit SoftShadows(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }

    std::string program() const override { return "soft_shadows"; }
    Integrand integrandOf(const render::Settings& settings) const override;
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override;
    float muOf(const render::Settings& settings) const override { return settings.mu; }
    std::string describe(const render::Settings& settings) const override;

private:
    int referenceSpp_;
};

/// Its name in integrandOf().
std::string integrandName(bool shadingApart);

/// A lab and what it measures by the plan.
class ShadowLab : public Lab {
public:
    /// scene, subject and plan must outlive the lab.
    ShadowLab(const scene::Scene& scene, const device::Device& device, const SoftShadows& subject, const Plan& plan,
        std::string name)
        : Lab(scene, device, subject, plan, std::move(name))
        , plan_(plan)
    {
    }

    const Plan& plan() const { return plan_; }

private:
    const Plan& plan_;
};

/// The columns of Table 3.1; docs/benchmarks.md.
const std::vector<TimingColumn>& shadowColumns();

} // namespace wedge::benchmark
