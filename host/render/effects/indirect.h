#pragma once

#include "host/render/effects/term_context.h"
#include "host/render/waves.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/path.h"

#include <vector>

namespace wedge::render {

/// What a term of indirect light holds.
enum class Component : std::uint32_t {
    Diffuse = WEDGE_COMPONENT_DIFFUSE,
    Glossy = WEDGE_COMPONENT_GLOSSY,
    Ambient = WEDGE_COMPONENT_AMBIENT,
};

/// A component that frames of some settings have, and what its filter widths' layer ends in.
struct IndirectTerm {
    Component component;
    const char* name;
};

/// The indirect terms of a frame. specular: the scene reflects so.
std::vector<IndirectTerm> indirectTerms(const Settings& settings, bool specular);

/// What the analysis of a component needs besides where pixels lie, and the extent of the scene.
shared::ReflectorParams reflectorParams(const Settings& settings, Component component);

/// How paths are traced where the pixels are the receivers; lights and the scene's size are to come.
shared::PathParams pathParams(const Settings& settings, Component component);

/// What counts of paths need besides where pixels lie.
shared::AnalysisParams pathCountParams(shared::AnalysisParams params, const Settings& settings);

/// Indirect light by paths, thesis chapters 4 and 5, and ambient occlusion by the same means: distances of reflectors,
/// widths and counts (kernels/shared/indirect.h), paths, filter, modulation by the surface's reflectance. One
/// component; each is a term of its own.
class Indirect {
public:
    /// What a component's term needs. analysed: with filter.
    static TermShape termShape(bool analysed) { return { 4, 3, 3, analysed, false, false, false, false }; }

    Indirect(const TermContext& context, Term& term, Component component);

    /// As SoftShadows has them.
    void sampleWave(Waves& waves, const shared::WaveParams& wave, double workUnits);
    void widths();
    void publishedWidths(const shared::DistributedParams& params, const device::Buffer<float>& flags);
    void filterDistributed(const shared::DistributedParams& params);

    /// Whether the component got widths: not so in plain Monte Carlo, nor if its first pass was cancelled.
    bool analysed() const { return analysed_; }

private:
    void visibleExtent();
    shared::PathParams pathParams() const;
    shared::ReflectorParams reflectorParams(const image::Window& window) const;
    shared::AnalysisParams countParams(const image::Window& window) const;

    TermContext c_;
    Term& term_;
    Component component_;
    bool analysed_ = false;
};

} // namespace wedge::render
