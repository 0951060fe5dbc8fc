// filter/kept_bins.cl alone against its definition in double: what is left of a term by the shares of its bins.
#include "tests/sample_bins_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double withinBin = 0.35; ///< deviation of luminances in a bin, of their mean

/// What kinds of frames have of a term besides texture and value.
struct Kind {
    bool filtered, layers;
    bool deviation() const { return filtered; }
    bool spreads() const { return filtered && !layers; } ///< of frames in fewer bits
    bool squares() const { return layers; }
};

/// A term's planes, as its frame's formats hold them.
struct Term {
    explicit Term(const render::PlaneLayout& layout)
        : value(layout, 0, 0.0f)
        , texture(layout, 0, 0.0f)
        , deviation(layout, 0, 0.0f)
        , spreads(layout, 0, 0.0f)
        , squares(layout, 0, 0.0f)
        , textureSquares(layout, 0, 0.0f)
        , shares(layout, 0, 0.0f)
    {
    }
    Planes<float> value, texture, deviation, spreads, squares, textureSquares, shares;
};

/// Shares of a pixel's bins: all whole but for those that no bin has, none of a bin with samples, or any.
enum class Shares { Whole, None, Any };
Shares sharesOf(int x, int y)
{
    const int kind = (x * 5 + y * 3) % 7;
    return kind < 2 ? Shares::Whole : kind == 2 ? Shares::None : Shares::Any;
}

/// Textures one in five of which is black, mean squares that are a variance more than the square of the mean, from next
/// to none to much, and values some of which are no numbers.
class TermMaker {
public:
    TermMaker(unsigned seed, const PassBench& bench, const BinField& field)
        : random_(seed)
        , layout_(bench.layout)
        , field_(field)
    {
    }
    void fill(PassBench& bench, const Kind& kind)
    {
        Planes<float> value(layout_, 3, untouched), texture(layout_, 3, 0.5f), one(layout_, 1, untouched);
        Planes<float> deviation = one, squares = one, textureSquares = one, spreads(layout_, 2, untouched),
                      shares(layout_, binsOfPixel, 0.5f);
        const auto anything = [&](double scale) {
            return scale * glm::dvec3(uniform(random_), uniform(random_), uniform(random_));
        };
        everyPixelOf({ 0, 0, field_.width, field_.height }, [&](int x, int y) {
            glm::dvec3 mean = anything(std::pow(10, uniform(random_, -1, 2)));
            const glm::dvec3 own = random_() % 5 == 0 ? glm::dvec3(0) : anything(1);
            const double spread = luminanceOf(own * mean) * std::pow(10, uniform(random_, -3, 1)),
                         ofTexture = luminanceOf(own) * uniform(random_, 0, 0.5);
            squares.at(x, y) = static_cast<float>(std::pow(luminanceOf(own * mean), 2) + spread * spread);
            textureSquares.at(x, y) = static_cast<float>(std::pow(luminanceOf(own), 2) + ofTexture * ofTexture);
            if (random_() % 12 == 0)
                mean[static_cast<int>(random_() % 3)] = random_() % 2 == 0 || kind.spreads()
                    ? std::numeric_limits<double>::quiet_NaN()
                    : std::numeric_limits<double>::infinity(); // in fewer bits none is held
            value.setVector(x, y, mean);
            texture.setVector(x, y, own);
            deviation.at(x, y) = static_cast<float>(uniform(random_, -1, 1) * std::pow(10, uniform(random_, -3, 2)));
            // As it is of such values; in fewer bits none are held.
            if (!isFinite(mean) && !kind.spreads())
                deviation.at(x, y) = std::numeric_limits<float>::quiet_NaN();
            spreads.at(x, y) = static_cast<float>(spread);
            spreads.at(x, y, 1) = static_cast<float>(ofTexture);
            for (std::size_t b = 0; b < binsOfPixel; ++b)
                shares.at(x, y, b) = shareOf(x, y, field_.at(x, y)[b].count > 0);
        });
        bench.plane("value", value);
        bench.plane("texture", texture);
        bench.plane("shares", shares);
        if (kind.deviation())
            bench.plane("deviation", deviation);
        if (kind.spreads())
            bench.plane("spreads", spreads);
        if (kind.squares()) {
            bench.plane("squares", squares);
            bench.plane("textureSquares", textureSquares);
        }
    }

private:
    float shareOf(int x, int y, bool samples)
    {
        const double any = random_() % 3 == 0 ? 1 : random_() % 3 == 0 ? 0 : uniform(random_);
        const Shares kind = sharesOf(x, y);
        return !samples || kind == Shares::Any ? static_cast<float>(any) : kind == Shares::Whole ? 1.0f : 0.0f;
    }

    std::mt19937 random_;
    render::PlaneLayout layout_;
    const BinField& field_;
};

/// Planes of a pass before or after it.
Term read(const PassBench& bench, const std::string& kept)
{
    Term out(bench.layout);
    const auto to = [&](Planes<float>& plane, const std::string& name) {
        if (bench.has(name))
            plane = bench.pixels<float>(name);
    };
    to(out.value, "value");
    to(out.texture, "texture");
    to(out.deviation, kept + "deviation");
    to(out.spreads, kept + "spreads");
    to(out.squares, kept + "squares");
    to(out.textureSquares, "textureSquares");
    to(out.shares, "shares");
    return out;
}

/// What is left of a pixel, brute force over its bins.
struct Left {
    glm::dvec3 mean { 0 }; ///< of value what bins say is left of it, in each channel; where value is no number, of bins
    double variance = 0; ///< of the luminance of a sample that is kept
    double samples = 0; ///< that are kept
    bool whole = true;

    Left(const Bins& bins, const Planes<float>& shares, int x, int y, bool lossy, const glm::dvec3& value)
    {
        double kept = 0, all = 0, squares = 0;
        glm::dvec3 sum(0), total(0);
        for (std::size_t b = 0; b < binsOfPixel; ++b) {
            const Bin& bin = bins[b];
            if (bin.count == 0)
                continue;
            const double share = shares.at(x, y, b), weight = share * bin.weight * bin.count;
            const double luminance = luminanceOf(bin.mean), deviation = withinBin * luminance;
            whole = whole && share == 1;
            sum += weight * bin.mean;
            total += bin.weight * bin.count * bin.mean;
            squares += weight * (luminance * luminance + deviation * deviation);
            kept += weight;
            all += bin.weight * bin.count;
            samples += share * bin.count;
        }
        const double over = lossy ? all : kept;
        for (int k = 0; k < 3 && !isFinite(value); ++k)
            mean[k] = over > 0 ? sum[k] / over : 0;
        for (int k = 0; k < 3 && isFinite(value); ++k)
            mean[k] = total[k] == 0 ? value[k] : over > 0 ? value[k] * (sum[k] / over) / (total[k] / all) : 0;
        if (kept > 0) {
            variance = squares / kept - std::pow(luminanceOf(sum / kept), 2);
        }
    }
};

/// How often what is kept is less noisy than all was, and how often as noisy.
struct Noise {
    unsigned less = 0, same = 0;
    void count(double now, double before) { ++(now < 0.99 * before ? less : same); }
};

bool near(double found, double expected, double relative, double absolute)
{
    return std::fabs(found - expected) <= relative * std::fabs(expected) + absolute;
}

/// One pass, checked pixel by pixel.
class KeptBins {
public:
    KeptBins(PassBench& bench, const BinField& field, const BinArea& area, bool lossy, const Kind& kind)
        : field_(field)
        , lossy_(lossy)
        , before_(bench.layout)
        , after_(bench.layout)
        , sums_(bench.layout, 0, 0.0f)
        , excess_(bench.layout, 0, 0.0f)
        , taken_(bench.layout, 0, 0u)
    {
        TermMaker(7, bench, field).fill(bench, kind);
        setBins(bench, field, area);
        bench.value("lossy", lossy ? 1u : 0u);
        bench.plane("sums", Planes<float>(bench.layout, 3, untouched));
        bench.plane("excess", Planes<float>(bench.layout, 3, untouched));
        bench.plane("taken", Planes<std::uint32_t>(bench.layout, 1, 9u));
        before_ = read(bench, "");
        bench.run();
        after_ = read(bench, "kept_");
        sums_ = bench.pixels<float>("sums");
        excess_ = bench.pixels<float>("excess");
        taken_ = bench.pixels<std::uint32_t>("taken");
    }
    void check(int x, int y)
    {
        CAPTURE(x);
        CAPTURE(y);
        const Bins& bins = field_.at(x, y);
        const glm::dvec3 all = before_.value.vector(x, y);
        const Left left(bins, before_.shares, x, y, lossy_, all);
        const glm::dvec3 mean = sums_.vector(x, y), lost = excess_.vector(x, y);
        REQUIRE(taken_.at(x, y) == (samplesIn(bins) > 0 ? 1u : 0u));
        if (left.whole && isFinite(all)) {
            ++wholes;
            requireSame(x, y);
            return;
        }
        ++others;
        // No more than rounding of floats: bins are as 16 bits have them on both sides.
        const double largest = std::max({ left.mean.x, left.mean.y, left.mean.z, 1e-20 });
        for (int k = 0; k < 3; ++k) {
            CAPTURE(left.mean[k]);
            CAPTURE(mean[k]);
            REQUIRE(std::fabs(mean[k] - left.mean[k]) <= 1e-5 * largest);
            const double expected = isFinite(all) ? all[k] - left.mean[k] : 0;
            REQUIRE(near(lost[k], expected, 1e-5, 1e-5 * (isFinite(all) ? largest + all[k] : 0)));
        }
        checkDeviation(x, y, left);
        checkVariance(x, y, left);
    }

    unsigned wholes = 0, others = 0;
    Noise deviations, variances;

private:
    void requireSame(int x, int y) const
    {
        REQUIRE(sums_.vector(x, y) == before_.value.vector(x, y));
        REQUIRE(excess_.vector(x, y) == glm::dvec3(0));
        if (!before_.deviation.values.empty())
            REQUIRE(after_.deviation.at(x, y) == before_.deviation.at(x, y));
        for (std::size_t k = 0; k < 2 && !before_.spreads.values.empty(); ++k)
            REQUIRE(after_.spreads.at(x, y, k) == before_.spreads.at(x, y, k));
        if (!before_.squares.values.empty())
            REQUIRE(after_.squares.at(x, y) == before_.squares.at(x, y));
    }
    /// Of the mean of so many samples, and no larger than it was.
    void checkDeviation(int x, int y, const Left& left)
    {
        if (before_.deviation.values.empty())
            return;
        const double was = before_.deviation.at(x, y), is = after_.deviation.at(x, y);
        const double most = std::sqrt(left.variance / std::max(left.samples, 1.0));
        CAPTURE(was);
        CAPTURE(is);
        CAPTURE(most);
        if (std::isnan(was)) {
            REQUIRE(std::fabs(is) <= most * (1 + roundingOfShorts));
            return;
        }
        REQUIRE(near(is, std::clamp(was, -most, most), roundingOfShorts, 1e-5 * most));
        deviations.count(std::fabs(is), std::fabs(was));
    }
    /// Of a primary sample's radiance: that of irradiance and of texture, k^2 Var E + E^2 Var k, and of all, in the
    /// geometric mean.
    void checkVariance(int x, int y, const Left& left)
    {
        const double k = luminanceOf(before_.texture.vector(x, y)), e = luminanceOf(left.mean);
        if (!before_.spreads.values.empty()) {
            const double was = before_.spreads.at(x, y), ofTexture = before_.spreads.at(x, y, 1),
                         is = after_.spreads.at(x, y);
            const double own = std::sqrt(k * k * left.variance + e * e * ofTexture * ofTexture);
            CAPTURE(was);
            CAPTURE(is);
            CAPTURE(own);
            REQUIRE(near(is, std::sqrt(was * std::min(was, own)), roundingOfShorts, 1e-5 * own));
            REQUIRE(after_.spreads.at(x, y, 1) == before_.spreads.at(x, y, 1));
            variances.count(is, was);
        }
        if (!before_.squares.values.empty()) {
            const bool finite = isFinite(before_.value.vector(x, y));
            const glm::dvec3 texture = before_.texture.vector(x, y);
            const double wasMean = luminanceOf(texture * before_.value.vector(x, y)),
                         isMean = luminanceOf(texture * left.mean), squares = before_.squares.at(x, y);
            const double was = finite ? std::max(0.0, squares - wasMean * wasMean)
                                      : std::numeric_limits<double>::infinity(),
                         ofTexture = std::max(0.0, before_.textureSquares.at(x, y) - k * k);
            const double own = k * k * left.variance + e * e * ofTexture, is = after_.squares.at(x, y);
            CAPTURE(was);
            CAPTURE(is);
            CAPTURE(own);
            // Differences of squares in floats.
            const double error = 1e-5 * ((finite ? squares : 0) + own + isMean * isMean);
            const double kept = finite ? std::sqrt(was * std::min(was, own)) : own;
            REQUIRE(near(is, kept + isMean * isMean, 1e-5, error));
            if (finite)
                variances.count(kept, was);
        }
    }

    const BinField& field_;
    bool lossy_;
    Term before_, after_;
    Planes<float> sums_, excess_;
    Planes<std::uint32_t> taken_;
};

/// Calls test(bench, kind, lossy) for keepBins of all kinds of frames; of a filter that loses light, and of one that
/// makes up for it: both of them for either value.
template <class Test>
void inEveryFrame(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const Kind& kind : { Kind { false, false }, { false, true }, { true, false }, { true, true } })
            for (const bool lossy : { false, true }) {
                CAPTURE(kind.filtered);
                CAPTURE(kind.layers);
                CAPTURE(lossy);
                const render::ChosenFilter filter = lossy
                    ? render::ChosenFilter { "clamp", { 10, 0, 1 } }
                    : render::ChosenFilter { "path-density", { 10, 2, 3, 0, 1, 0, 0 } };
                DeclaredFrame frame(device, smallScene(),
                    binnedSettings(kind.filtered ? render::axisAligned(16) : render::monteCarlo(16), filter),
                    kind.layers);
                PassBench bench(frame, "keepBins");
                REQUIRE(bench.has("deviation") == kind.deviation());
                REQUIRE(bench.has("spreads") == kind.spreads());
                REQUIRE(bench.has("squares") == kind.squares());
                REQUIRE(bench.own<std::uint32_t>("lossy") == (lossy ? 1 : 0));
                test(bench, kind, lossy);
            }
    });
}

} // namespace

TEST_CASE("keepBins: the mean of what is kept, over that or over all, what it loses, and no more noise than before")
{
    inEveryFrame([&](PassBench& bench, const Kind& kind, bool lossy) {
        unsigned wholes = 0, others = 0;
        Noise deviations, variances;
        for (const BinArea& area : binAreas()) {
            CAPTURE(area.width);
            CAPTURE(area.height);
            const BinField field = someBins(6, area.width, area.height);
            KeptBins kept(bench, field, area, lossy, kind);
            everyPixelOf(area.window, [&](int x, int y) { kept.check(x, y); });
            wholes += kept.wholes;
            others += kept.others;
            deviations.less += kept.deviations.less;
            deviations.same += kept.deviations.same;
            variances.less += kept.variances.less;
            variances.same += kept.variances.same;
        }
        CHECK(std::min(wholes, others) > 300);
        if (kind.deviation())
            CHECK(std::min(deviations.less, deviations.same) > 100);
        if (kind.spreads() || kind.squares())
            CHECK(std::min(variances.less, variances.same) > 100);
    });
}
