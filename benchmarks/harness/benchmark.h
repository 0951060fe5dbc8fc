#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/common/lab.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/timing.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wedge::benchmark {

struct CaseSetting;
struct SceneResult;

/// Numbers of quantities, by name.
using Numbers = std::vector<std::pair<std::string, double>>;

/// What the thesis reports of a frame.
struct Paper {
    Json row; ///< as it is written; null for nothing
    Numbers claims; ///< beside claims, by their quantities without suffixes
};

/// What frames of a scene show: of each case both settings are measured.
struct Case {
    std::optional<int> bounces = 0; ///< the scene file's if it has no value
    Paper paper = {};
    bool errors = true; ///< else times alone
    bool ambient = false; ///< ambient occlusion in place of light
    float ambientDistance = 0; ///< metres within which surfaces occlude; 0: any
    std::string suffix = ""; ///< of claims
    std::string label = ""; ///< of rows of tables, after the scene's name
};

/// A scene as a benchmark measures it.
struct BenchmarkScene : SceneSource {
    std::vector<Case> cases; ///< none: as scene files are measured
    Numbers goals; ///< of claims: by a quantity with its suffixes, or "quantity*" for any suffixes
    bool curves = false; ///< with the benchmark's ablations, of the first case
    bool bias = false; ///< with what the filter blurs, of the first case
    std::optional<double> aim; ///< more than the goal asks for
};

using Change = std::function<void(render::Settings&)>;

/// Unfiltered images with the same count everywhere. The first one of a setting is what goals are about.
struct BaselineRow {
    const char* name;
    const char* meaning; ///< one line
    render::Sampler sampler;
    bool ofDefault = true, ofPublished = true; ///< which settings are measured against it
    Change change = {};
};

/// A curve of error against samples: uniform counts (NAS) or adaptive ones (AS); no filter (UF), one width for the
/// image (NAF), adaptive widths (AF). Of both settings.
struct AblationRow {
    bool adaptive;
    render::Filtering filter;
    bool baseline = false; ///< the first baseline's points in place of a curve of its own
};

/// A curve of error against rays.
struct VariantRow {
    enum Kind { OfDefault, OfPublished, ImageBlur }; ///< budgets of samples; of mu; the best Gaussian over a baseline
    const char* name;
    const char* meaning; ///< one line
    Kind kind = OfDefault;
    Change change = {};
};

/// The best single filter width in place of the adaptive ones.
struct FixedWidthRule {
    float firstWidth; ///< pixels, where the search starts
    int firstPass; ///< samples that uniform counts have at least
    bool uniformCounts; ///< else the counts stay adaptive
};

/// A column of the table of times, and what the thesis' row has there.
struct TableColumn {
    const char* heading;
    int width; ///< characters
    const char* value; ///< "triangles", "spp", "rays_per_pixel", "mrays_s" or a column of times
    std::string (*form)(double); ///< wholeNumber and others of tables.h
    const char* paper; ///< key of its row or of its claims
};

/// A claim of each setting's times.
struct TimeClaim {
    const char* quantity;
    const char* column;
    const char* unit;
};

/// Another published method, of as many samples: what a setting becomes it by.
struct Rival {
    const char* name;
    const char* meaning;
    void (*change)(render::Settings& settings);
};

/// A benchmark of error against samples or rays: all that makes it another one than its neighbours.
struct Benchmark {
    std::string program; ///< its name
    std::string about; ///< one line, for its help
    std::string table; ///< of the thesis, whose columns times have
    std::string quickMeans; ///< for its help
    MeasurePlan plan, quick;
    Json (*planData)(const MeasurePlan&); ///< what is written of the plan besides what all have
    int references = 1; ///< of each scene, each in two halves: samples divide by twice that
    std::shared_ptr<Subject> (*subject)(const MeasurePlan&);
    std::vector<BenchmarkScene> scenes = {};
    BenchmarkScene fileScene = {}; ///< as scene files are measured
    Numbers goals = {}; ///< of all scenes
    bool needsAreaLight = false;

    std::optional<int> usualSpp = {}; ///< of the default setting; its own if none
    std::optional<float> usualMu = {}; ///< of the published setting; its own if none
    std::vector<BaselineRow> baselines = {};
    std::optional<FixedWidthRule> fixedWidth = {};
    std::optional<float> blurWidth = {}; ///< pixels: the default is held against one fixed width as well
    std::optional<Rival> rival = {}; ///< the published setting is held against it as well
    const char* region = nullptr; ///< what claims call Subject::regionOf(); null where it has none
    std::vector<AblationRow> ablations = {};
    std::vector<VariantRow> variants = {}; ///< of all scenes
    std::optional<int> memorySide = {}; ///< pixels a side of the frame whose memory is told

    std::vector<TimingColumn> columns = {};
    std::vector<TableColumn> times = {};
    std::vector<TimeClaim> timeClaims = {}; ///< besides those that all have
    bool byRays = false; ///< compares rays, of all pixels, and not samples; offers maps and errors alone
    const char* raysKey = "rays"; ///< of points
    bool settingsByName = false; ///< settings are written as an object, with the fixed width beside them, not in them
    Json (*sceneData)(const SceneResult&); ///< what is written of a scene besides what all have
    Json (*settingData)(const CaseSetting&); ///< and of a setting
};

/// The method at a setting: with so many samples or this mu, or its own.
render::Settings methodSettings(
    const Case& of, bool published, std::optional<int> spp = {}, std::optional<float> mu = {});
/// As the benchmark judges the setting.
render::Settings usualSettings(const Benchmark& benchmark, const Case& of, bool published);
/// What a baseline renders.
render::Settings baselineSettings(const BaselineRow& row, const Case& of, int spp);

/// "default" or "published".
const char* settingName(bool published);

/// The number of that name; nothing where there is none.
std::optional<double> numberOf(const Numbers& numbers, const std::string& name);

/// The benchmark's main(): reads the command line, measures, prints tables. Returns the exit status.
int runBenchmark(int argc, char** argv, const Benchmark& benchmark);

} // namespace wedge::benchmark
