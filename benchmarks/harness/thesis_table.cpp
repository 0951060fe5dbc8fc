#include "benchmarks/harness/thesis_table.h"

#include "benchmarks/harness/tables.h"

namespace wedge::benchmark {

Paper thesisRow(const char* name, double triangles, double spp, double firstPass, double secondPass, double tracing,
    double analysis, double filter, double overhead, double total, double fpsWith, double fpsWithout,
    std::optional<double> samplesSaved)
{
    Paper out { { { "scene", name }, { "triangles", triangles }, { "spp", spp }, { "first_pass", firstPass },
                    { "second_pass", secondPass }, { "tracing", tracing }, { "widths_and_counts", analysis },
                    { "filter", filter }, { "overhead", overhead }, { "total", total }, { "fps_with", fpsWith },
                    { "fps_without", fpsWithout }, { "overhead_fraction", overhead / total } },
        { { "overhead", overhead / total }, { "overhead_ms", overhead }, { "total_ms", total }, { "spp", spp } } };
    if (samplesSaved) {
        out.claims.emplace_back("samples_saved", *samplesSaved);
    }
    return out;
}

std::vector<TableColumn> thesisTable(const char* heading, const char* column)
{
    return {
        { "tris", 8, "triangles", shortNumber, "triangles" },
        { "spp", 7, "spp", tenths, "spp" },
        { heading, 9, column, tenths, "" },
        { "1st pass", 9, "first_pass", tenths, "first_pass" },
        { "2nd pass", 9, "second_pass", tenths, "second_pass" },
        { "tracing", 9, "tracing", tenths, "tracing" },
        { "widths+n", 9, "widths_and_counts", hundredths, "widths_and_counts" },
        { "of 1st", 8, "first_pass_filter", hundredths, "" },
        { "filter", 8, "filter", hundredths, "filter" },
        { "compos.", 9, "composite", hundredths, "" },
        { "overhead", 9, "overhead", hundredths, "overhead" },
        { "total", 8, "total", tenths, "total" },
        { "fps", 8, "fps_with", hundredths, "fps_with" },
        { "fps w/o", 8, "fps_without", hundredths, "fps_without" },
        { "ovh", 7, "overhead_fraction", percent, "overhead_fraction" },
    };
}

} // namespace wedge::benchmark
