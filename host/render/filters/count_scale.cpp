#include "host/render/filters/count_scale.h"

#include "kernels/shared/filter_params.h"

#include <cassert>
#include <string>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* pass = "counts";
constexpr const char* file = "analysis/counts.cl";

/// What stripes of rows add up: of the first kind of samples, and of all others.
struct StripeSums {
    graph::Handle<Share> first, others;
};

graph::Argument readIfAny(const char* name, const std::optional<graph::Version>& plane)
{
    return plane ? reads(name, *plane) : graph::absent(name, graph::counts);
}

class ScaledCounts {
public:
    ScaledCounts(FrameBuilder& frame, const std::vector<AskedSamples>& kinds, const CountScale& scale)
        : f_(frame)
        , kinds_(kinds)
        , asked_(scale)
        , scale_(frame.graph.list<Share>("scales of demands", graph::floats, WEDGE_SCALE_NUMBERS))
    {
        assert(!kinds.empty() && kinds[0].rays == 1.0f);
        assert(!kinds[0].uncertainty || !scale.mask); // all pixels have noise
    }

    void declare()
    {
        f_.items(pass, PassKind::Analysis, { file, "firstScales" }, 1, { writes("scale", scale_) });
        StripeSums sums = stripes(WEDGE_SCALE_SUMS);
        for (int round = 0; round < WEDGE_SCALE_ROUNDS; ++round) {
            add("samplesAtScales", sums, [&](const AskedSamples& kind) {
                return Arguments { reads("demand", kind.demand), readIfAny("taken", kind.taken),
                    readIfAny("mask", asked_.mask) };
            });
            f_.items(pass, PassKind::Analysis, { file, "refineScales" }, 1,
                { value("rays", asked_.rays), reads("sums", sums.first), ofOthers("sumsOfOthers", sums),
                    updates("scale", scale_) });
        }
        if (kinds_[0].uncertainty) {
            StripeSums noise = stripes(WEDGE_EVEN_SHARES);
            add("noiseOfCounts", noise, [](const AskedSamples& kind) {
                return Arguments { reads("demand", kind.demand), readIfAny("taken", kind.taken),
                    reads("uncertainty", kind.uncertainty.value()) };
            });
            f_.items(pass, PassKind::Analysis, { file, "shareOfEven" }, 1,
                { reads("noise", noise.first), ofOthers("noiseOfOthers", noise), updates("scale", scale_) });
        }
        for (const AskedSamples& kind : kinds_) {
            const bool evens = &kind == kinds_.data() && kind.uncertainty;
            f_.pixels(pass, PassKind::Analysis, { file, "countsFromDemand" },
                { f_.rectangle(f_.analysisParams()), value("evens", evens ? 1u : 0u), value("least", kind.least),
                    value("most", asked_.most), reads("scale", scale_), reads("demand", kind.demand),
                    readIfAny("taken", kind.taken), readIfAny("mask", asked_.mask), writes("wanted", *kind.wanted) });
        }
    }

private:
    graph::Argument ofOthers(const char* name, const StripeSums& sums) const
    {
        return kinds_.size() > 1 ? reads(name, sums.others) : graph::absent(name);
    }

    /// So many numbers a stripe.
    StripeSums stripes(std::uint64_t numbers)
    {
        const std::uint64_t elements = WEDGE_SCALE_STRIPES * numbers;
        return { f_.graph.list<Share>("sums of stripes", graph::floats, elements),
            f_.graph.list<Share>("sums of stripes of others", graph::floats, elements) };
    }

    /// What a kernel adds up over all kinds of samples. planes(kind): what it reads of pixels.
    template <class Planes>
    void add(const char* kernel, StripeSums& out, const Planes& planes)
    {
        for (std::size_t i = 0; i < kinds_.size(); ++i) {
            const AskedSamples& kind = kinds_[i];
            // What is beyond the image takes as many as the image would, and has no say.
            f_.items(pass, PassKind::Analysis, { file, kernel }, WEDGE_SCALE_STRIPES,
                joined({ f_.rectangle(f_.analysisParams()), value("add", i > 1 ? 1u : 0u), value("rays", kind.rays),
                           value("least", kind.least), value("most", asked_.most), reads("scale", scale_) },
                    planes(kind),
                    Arguments { i == 0 ? writes("sums", out.first)
                            : i == 1   ? writes("sums", out.others)
                                       : updates("sums", out.others) }),
                true);
        }
    }

    FrameBuilder& f_;
    const std::vector<AskedSamples>& kinds_;
    const CountScale& asked_;
    graph::Handle<Share> scale_;
};

} // namespace

void countsFromDemands(FrameBuilder& frame, const std::vector<AskedSamples>& kinds, const CountScale& scale)
{
    ScaledCounts(frame, kinds, scale).declare();
}

void uniformCounts(FrameBuilder& frame, std::uint32_t count, const graph::Version& mask, graph::Handle<Count>& wanted)
{
    frame.pixels(pass, PassKind::Analysis, { file, "uniformCounts" },
        { frame.rectangle(frame.analysisParams()), value("count", count), reads("mask", mask),
            writes("wanted", wanted) });
}

} // namespace wedge::render
