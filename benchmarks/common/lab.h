#pragma once

#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/references.h"
#include "host/render/renderer.h"

#include <map>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// One render, and how far it is from the reference of its integrand.
struct Measured {
    double spp = 0; ///< mean over shaded pixels
    double rays = 0; ///< a pixel of Subject::pixelsOf(); less than spp where samples need none
    double rmse = 0; ///< linear RGB, whole image, as measured
    double error = 0; ///< what is compared: the same, without the reference's noise if the plan wants that
    float mu = 0;
    std::uint32_t seed = 0;
    double corrected = 0; ///< the RMS error with the reference's noise taken out in quadrature
    double regionError = 0; ///< as `error`, over Subject::regionOf() alone; 0 where there is none
};

/// What images converge to: its name, and the settings of its reference, size and seed left open.
struct Integrand {
    std::string name;
    render::Settings settings;
};

/// What a benchmark measures of an image.
class Subject {
public:
    virtual ~Subject() = default;

    virtual std::string program() const = 0; ///< the benchmark's name
    virtual std::string layer() const { return ""; } ///< as readLayers() has it, "" for the whole image
    virtual Integrand integrandOf(const render::Settings& settings) const = 0;
    virtual double sppOf(const render::FrameStatistics& frame) const = 0;
    virtual double raysOf(const render::FrameStatistics& frame) const = 0; ///< of the whole image
    /// What rays are counted by: the pixels that see something.
    virtual double pixelsOf(const render::FrameStatistics& frame) const
    {
        return static_cast<double>(frame.shadedPixels);
    }
    virtual float muOf(const render::Settings& settings) const = 0;
    /// Pixels whose error is told apart as well, by what the reference has in them; empty: none.
    virtual std::vector<bool> regionOf(const Reference&) const { return {}; }
    virtual std::string describe(const render::Settings& settings) const = 0; ///< a few words
};

/// A line on stderr, after the benchmark's name.
void progress(const std::string& program, const std::string& text);

/// "default mu 2.00 AS AF" and the like; counts: whether they are adaptive.
std::string describeVariant(const render::Settings& settings, float mu, bool adaptiveCounts);

/// One scene on one device: renders it and measures errors. The same settings are rendered only once.
class Lab {
public:
    /// Everything but device and name must outlive the lab; name: for files and progress.
    Lab(const scene::Scene& scene, const device::Device& device, const Subject& subject, const MeasurePlan& plan,
        std::string name);

    /// RMS error of one image. Size comes from the plan.
    Measured measure(render::Settings settings, std::uint32_t seed = 1);

    /// An RMS error as it is compared, where that of `settings`' reference is in it.
    double compared(double rmse, const render::Settings& settings);

    /// Subject::regionOf() of the reference of `settings`.
    const std::vector<bool>& region(const render::Settings& settings);

    /// What is measured of one image, as it comes out of the renderer.
    image::RgbImage render(render::Settings settings, std::uint32_t seed);

    /// What images of these settings converge to.
    const Reference& reference(const render::Settings& settings);
    /// Those made so far, by their integrands' names.
    const std::map<std::string, Reference>& references() const { return references_; }

    /// A line on stderr that begins with the scene's name.
    void say(const std::string& text) const;

    render::Renderer& renderer() { return renderer_; }
    const Subject& subject() const { return subject_; }
    const MeasurePlan& plan() const { return plan_; }
    const std::string& name() const { return name_; }

private:
    render::FrameStatistics renderFrame(render::Settings& settings, std::uint32_t seed);
    double withoutNoiseOf(double rmse, double noise) const;

    const Subject& subject_;
    const MeasurePlan& plan_;
    std::string name_;
    render::Renderer renderer_;
    std::map<std::string, Reference> references_;
    std::map<std::string, std::vector<bool>> regions_; ///< by their integrands' names, as references
    std::map<std::string, Measured> measured_;
};

/// References without their pixels.
std::map<std::string, Reference> summaries(const std::map<std::string, Reference>& references);

} // namespace wedge::benchmark
