#pragma once

#include "benchmarks/common/statistics.h"
#include "benchmarks/rays/compare.h"
#include "benchmarks/rays/counting.h"
#include "benchmarks/rays/embree_trace.h"
#include "benchmarks/rays/plan.h"
#include "benchmarks/rays/wedge_trace.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A way of Embree's: which build, and how rays are handed over.
struct EmbreeColumn {
    std::string name; ///< of the column, "embree single high"
    const EmbreeScene* scene;
    EmbreeWay way;
};

/// One mesh, built by both sides in all ways.
class BuiltScene {
public:
    /// all: every build of Embree's, and every mode of ours; otherwise what growth compares. mesh must outlive this.
    BuiltScene(WedgeTracer& tracer, const bvh::Mesh& mesh, unsigned threads, bool all);

    const bvh::Mesh& mesh() const { return mesh_; }
    const WedgeHierarchy& hierarchy() const { return *hierarchies_.front(); }
    const std::vector<std::unique_ptr<WedgeHierarchy>>& hierarchies() const { return hierarchies_; }
    const std::vector<std::unique_ptr<EmbreeScene>>& embree() const { return embree_; }
    const EmbreeScene& embree(const std::string& build) const;
    std::vector<EmbreeColumn> columns() const;

private:
    bvh::Mesh mesh_;
    EmbreeMesh embreeMesh_;
    std::vector<std::unique_ptr<WedgeHierarchy>> hierarchies_;
    std::vector<std::unique_ptr<EmbreeScene>> embree_;
};

/// All that was measured of one ray set.
struct ClassResult {
    std::string name;
    bool anyHit = false, coherent = false;
    std::size_t rays = 0; ///< live ones
    std::vector<Runs> runs;
    TraversalCounts counts; ///< of our default hierarchy
    Comparison difference; ///< from Embree's default build, single rays
    Comparison differenceFromRobust;
    std::size_t packetMismatches = 0; ///< rays for which our packets and our single rays find other bits

    const Runs& column(const std::string& name) const;
    /// The column that the renderer goes by: packets: it has no other rays.
    std::string chosen(const std::string& mode = "") const;
    /// Embree's fastest column by its median, watertight builds left out.
    std::string embreeBest() const;
    /// Mrays/s of every repetition.
    std::vector<double> megarays(const std::string& column) const;
    /// Of every repetition, their time over ours.
    std::vector<double> ratios(const std::string& ours, const std::string& theirs) const;
};

/// Our column's name: "wedge single" or "wedge packets", and the mode of the hierarchy if not the default.
std::string wedgeColumn(bool packets, const std::string& mode);

/// Times and compares everything on one ray set.
ClassResult measureClass(
    WedgeTracer& tracer, const BuiltScene& built, const RaySet& set, Workers& workers, const RayPlan& plan);

} // namespace wedge::benchmark
