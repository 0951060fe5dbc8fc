#include "benchmarks/lottery/verdict.h"

#include "benchmarks/common/error_curve.h"
#include "benchmarks/common/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {
namespace {

const LotteryPoint& at(const std::vector<LotteryPoint>& points, int spp)
{
    return *std::ranges::find(points, spp, &LotteryPoint::spp);
}

double smallErrorAsOne(double rmse) { return std::max(rmse, 1e-12); }

/// Of what is a setting's: samples, or time.
using Value = std::function<double(const LotteryPoint&)>;

/// milliseconds = fixed + each * samples, least squares of relative errors: single frames are too short to be timed
/// well.
struct TimeLine {
    double fixed = 0, each = 0;

    TimeLine(const std::vector<LotteryPoint>& points, const Value& time)
    {
        double w = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (const LotteryPoint& p : points) {
            const double t = std::max(time(p), 1e-6), weight = 1.0 / (t * t);
            w += weight;
            x += weight * p.spp;
            y += weight * t;
            xx += weight * p.spp * p.spp;
            xy += weight * p.spp * t;
        }
        each = std::max((w * xy - x * y) / std::max(w * xx - x * x, 1e-300), 1e-9);
        fixed = std::max((y - each * x) / w, 0.0);
    }
    double milliseconds(double samples) const { return fixed + each * samples; }
    double samples(double milliseconds) const { return std::max((milliseconds - fixed) / each, 1.0); }
};

/// The plain error at any number of samples, and the other way round. Its last piece goes on with at least the slope of
/// a mean of independent samples, where noise of the measurement would have it rise.
class PlainCurve {
public:
    PlainCurve(const std::vector<LotteryPoint>& points, const Value& rmse)
    {
        for (const LotteryPoint& p : points) {
            const double least =
                curve_.empty() ? std::numeric_limits<double>::infinity() : curve_.back().error * (1.0 - 1e-6);
            curve_.push_back({ static_cast<double>(p.spp), std::min(smallErrorAsOne(rmse(p)), least) });
        }
    }
    double samplesFor(double error) const
    {
        const double cost = costAt(curve_, error).cost;
        const double law = curve_.back().cost * std::pow(curve_.back().error / error, 2.0);
        return error < curve_.back().error ? std::min(cost, law) : cost;
    }
    double errorAt(double samples) const
    {
        std::size_t i = 1;
        while (i + 1 < curve_.size() && curve_[i].cost < samples) {
            ++i;
        }
        const CurvePoint &a = curve_[i - 1], &b = curve_[i];
        const double t = std::log(samples / a.cost) / std::log(b.cost / a.cost);
        return std::exp((1.0 - t) * std::log(a.error) + t * std::log(b.error));
    }

private:
    Curve curve_;
};

double rmseOf(const LotteryPoint& p) { return p.error.rmse(); }

double slopeOf(const std::vector<LotteryPoint>& points, int compared)
{
    const LotteryPoint &from = at(points, compared), &to = points.back();
    return std::log(smallErrorAsOne(rmseOf(to)) / smallErrorAsOne(rmseOf(from)))
        / std::log(static_cast<double>(to.spp) / from.spp);
}

/// Of one seed's error: the scatter at the largest pooled budget stands for that of larger ones.
double singleDeviation(const std::vector<LotteryPoint>& points)
{
    double out = 0;
    for (const LotteryPoint& p : points) {
        if (p.error.deviation > 0) {
            out = 2.0 * p.error.rmseDeviation(); // of a mean over four seeds
        }
    }
    return out;
}

Ratio ratio(double a, double deviationA, double b, double deviationB)
{
    const double value = a / smallErrorAsOne(b);
    return { value, value * std::hypot(deviationA, deviationB) };
}

double medianOf(
    const std::vector<LotteryResult>& results, int compared, const std::function<double(const Verdict&)>& value)
{
    std::vector<double> values;
    values.reserve(results.size());
    for (const LotteryResult& r : results) {
        values.push_back(value(verdictOf(r, compared)));
    }
    return summarize(values).median;
}

struct Totals {
    double worseThanPlain = 0, behindBlur = 0, slowerThanPlain = 0;
    double slopesBroken = 0, slopesSlow = 0; ///< beyond the worst one allowed; beyond the usual one
    double biasWorst = 0;
    std::vector<double> slopes;

    explicit Totals(const std::vector<LotteryResult>& results, int compared)
    {
        for (const LotteryResult& r : results) {
            const Verdict v = verdictOf(r, compared);
            worseThanPlain += v.againstPlain.exceeds(mostAgainstPlain);
            behindBlur += v.againstBlur.exceeds(mostAgainstBlur);
            slowerThanPlain += v.againstEqualTime.exceeds(mostAgainstEqualTime);
            const double plain = v.plainSlope + slopeBehindPlain, slope = v.slope - 2.0 * v.slopeDeviation;
            slopesBroken += slope > std::max(worstSlope, plain);
            slopesSlow += slope > std::max(usualSlope, plain);
            slopes.push_back(v.slope);
            biasWorst = std::max(biasWorst, std::abs(v.bias));
        }
        std::ranges::sort(slopes);
    }
    double slopeAt(double fraction) const
    {
        return slopes.empty()
            ? 0
            : slopes[static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(slopes.size()))) - 1];
    }
};

} // namespace

Verdict verdictOf(const LotteryResult& r, int compared)
{
    const LotteryPoint &plain = at(r.plain, compared), &filtered = at(r.filtered, compared);
    const Value device = &LotteryPoint::deviceMilliseconds, wall = &LotteryPoint::wallMilliseconds;
    const PlainCurve curve(r.plain, rmseOf);
    const PlainCurve trimmed(r.plain, [](const LotteryPoint& p) { return p.error.trimmedRmse(); });
    const TimeLine plainTime(r.plain, device), plainWall(r.plain, wall), filteredTime(r.filtered, device),
        filteredWall(r.filtered, wall);
    const double error = smallErrorAsOne(rmseOf(filtered)), deviation = filtered.error.rmseDeviation();
    const double needed = curve.samplesFor(error), milliseconds = filteredTime.milliseconds(compared);
    Verdict v;
    v.againstPlain = ratio(error, deviation, rmseOf(plain), plain.error.rmseDeviation());
    v.againstBlur = ratio(error, deviation, r.fixedBlur.rmse(), r.fixedBlur.rmseDeviation());
    v.againstEqualTime =
        ratio(error, deviation, curve.errorAt(plainTime.samples(milliseconds)), plain.error.rmseDeviation());
    v.savedSamples = needed / compared;
    v.savedTrimmed = trimmed.samplesFor(smallErrorAsOne(filtered.error.trimmedRmse())) / compared;
    v.savedTime = plainTime.milliseconds(needed) / milliseconds;
    v.savedWallTime = plainWall.milliseconds(needed) / filteredWall.milliseconds(compared);
    v.slope = slopeOf(r.filtered, compared);
    v.plainSlope = slopeOf(r.plain, compared);
    // Both ends are held against one reference, so that its noise moves them together; the sum bounds what it does.
    const double fromReference =
        filtered.error.rmseReferenceDeviation() + r.filtered.back().error.rmseReferenceDeviation();
    v.slopeDeviation = std::hypot(deviation, singleDeviation(r.filtered), fromReference)
        / std::log(static_cast<double>(r.filtered.back().spp) / compared);
    v.bias = filtered.error.bias;
    v.biasDeviation = filtered.error.biasDeviation;
    return v;
}

std::vector<Claim> lotteryClaims(const std::vector<LotteryResult>& results, int compared)
{
    std::vector<Claim> out;
    const auto take = [&](const ClaimList& list) { out.insert(out.end(), list.claims.begin(), list.claims.end()); };
    const auto savings = [&](const char* name, int bounces, std::optional<double> goal) {
        std::vector<LotteryResult> chosen;
        std::ranges::copy_if(
            results, std::back_inserter(chosen), [&](const LotteryResult& r) { return r.traits.bounces == bounces; });
        ClaimList list("lottery", name);
        list.add("scenes", static_cast<double>(chosen.size()), "scenes");
        list.add("saved_time_median", medianOf(chosen, compared, [](const Verdict& v) { return v.savedTime; }), "1", {},
            goal);
        list.add("saved_wall_time_median", medianOf(chosen, compared, [](const Verdict& v) { return v.savedWallTime; }),
            "1");
        list.add(
            "saved_samples_median", medianOf(chosen, compared, [](const Verdict& v) { return v.savedSamples; }), "1");
        list.add("saved_samples_trimmed_median",
            medianOf(chosen, compared, [](const Verdict& v) { return v.savedTrimmed; }), "1");
        take(list);
    };
    savings("direct", 0, 4.0);
    savings("bounce", 1, 8.0);
    const Totals totals(results, compared);
    ClaimList all("lottery", "all");
    all.add("worse_than_mc", totals.worseThanPlain, "scenes", {}, 0.0);
    all.add("behind_fixed_blur", totals.behindBlur, "scenes", {}, 0.0);
    all.add("slower_than_mc", totals.slowerThanPlain, "scenes", {}, 0.0);
    all.add("slope_p95", totals.slopeAt(0.95), "1", {}, usualSlope);
    all.add("slope_worst", totals.slopeAt(1.0), "1", {}, worstSlope);
    all.add("slope_broken", totals.slopesBroken, "scenes", {}, 0.0);
    all.add("slope_slow", totals.slopesSlow, "scenes");
    all.add("bias_worst", totals.biasWorst, "1");
    take(all);
    return out;
}

std::string lotteryTable(const std::vector<LotteryResult>& results, int compared)
{
    std::string text = fmt::format("{:>6} {:>3} {:>6} {:>6} {:>6} {:>7} {:>7} {:>6} {:>5} {:>6} {:>8}  {}\n", "seed",
        "b", "/mc", "/blur", "/time", "samples", "time", "slope", "+-", "mc's", "bias %", "traits");
    for (const LotteryResult& r : results) {
        const Verdict v = verdictOf(r, compared);
        std::vector<std::string> traits = generator::hardCases(r.traits);
        if (r.traits.antialias) {
            traits.emplace_back("antialias");
        }
        if (r.traits.lens) {
            traits.emplace_back("lens");
        }
        if (r.traits.motion) {
            traits.emplace_back("motion");
        }
        const auto marked = [](const Ratio& ratio, double bound) {
            return fmt::format("{:.2f}{}", ratio.value, ratio.exceeds(bound) ? "!" : "");
        };
        text += fmt::format(
            "{:>6} {:>3} {:>6} {:>6} {:>6} {:>7.1f} {:>7.1f} {:>6.2f} {:>5.2f} {:>6.2f} {:>8.2f}  {} lights {}\n",
            r.seed, r.traits.bounces, marked(v.againstPlain, mostAgainstPlain), marked(v.againstBlur, mostAgainstBlur),
            marked(v.againstEqualTime, mostAgainstEqualTime), v.savedSamples, v.savedTime, v.slope, v.slopeDeviation,
            v.plainSlope, 100 * v.bias, r.traits.lights, fmt::join(traits, " "));
    }
    text += '\n';
    for (const Claim& claim : lotteryClaims(results, compared)) {
        text += fmt::format("{:<44} {:.4g}\n", claim.id, claim.value);
    }
    return text;
}

} // namespace wedge::benchmark
