// analysis.cl alone: slopes to widths, against the same in double.
#include "kernels/shared/wedge.h"
#include "tests/distributed_support.h"

#include <algorithm>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// First-pass results of a made-up image: two objects and holes, slopes at some of the pixels.
struct Slopes {
    shared::AnalysisParams params {};
    Planes<float> slopes, position, pixelSize, sums;
    Planes<std::uint32_t> objectId;

    Slopes(int width, int height, unsigned seed, double occluded)
        : Slopes(render::PlaneLayout(width, height))
    {
        std::mt19937 random(seed);
        everyPixel(layout(), [&](int x, int y) {
            objectId.at(x, y) = random() % 9 == 0 ? 0 : 1 + static_cast<std::uint32_t>(x / 13 + y / 11) % 2;
            const bool has = uniform(random) < occluded && objectId.at(x, y) != 0;
            const double sMin = std::pow(10.0, uniform(random, -4, 2));
            slopes.at(x, y) = has ? static_cast<float>(sMin) : 0.0f;
            slopes.at(x, y, 1) = has ? static_cast<float>(sMin * (1 + uniform(random, 0, 3))) : 0.0f;
            position.setVector(x, y, { 0.1 * x, 0.3 * uniform(random), 0.1 * y });
            pixelSize.at(x, y) = static_cast<float>(uniform(random, 0.005, 0.02));
            sums.at(x, y) = random() % 10 == 0 ? 0.0f : 9.0f;
        });
    }
    explicit Slopes(const render::PlaneLayout& layout)
        : slopes(layout, 2, 0.0f)
        , position(layout, 3, 0.0f)
        , pixelSize(layout, 1, 0.0f)
        , sums(layout, 1, 0.0f)
        , objectId(layout, 1, 0u)
    {
        params = paramsOf(layout);
        params.sigma = 0.25f;
        params.lightSize = 0.5f;
        params.k = 3;
        params.mu = 2;
        params.alpha = 1;
        params.fillRadius = 5;
        params.countCap = 100;
        params.lightCentre = shared::vec3(1, 4, 1.5f);
    }
    const render::PlaneLayout& layout() const { return slopes.layout; }
    int width() const { return static_cast<int>(layout().width); }
    int height() const { return static_cast<int>(layout().height); }
};

/// What published settings make of slopes.
struct Published {
    Planes<float> beta;
    Planes<std::uint32_t> wanted;
};

/// Passes of frames of one receiver a pixel and one light, with the default analysis and the published one.
class Analysis {
public:
    Analysis(const device::Device& device, const render::PlaneLayout& layout)
        : smoothing_(device, glossy(), settings(render::axisAligned(16), layout))
        , publishing_(device, glossy(), settings(render::asPublished(), layout))
    {
    }
    PassBench smoothing(const std::string& kernel, const shared::AnalysisParams& p)
    {
        PassBench pass(smoothing_, kernel);
        pass.value("p", p);
        return pass;
    }
    PassBench publishing(const std::string& kernel, const shared::AnalysisParams& p)
    {
        PassBench pass(publishing_, kernel);
        pass.value("p", p);
        return pass;
    }

    Planes<float> eroded(const Slopes& in)
    {
        PassBench pass = smoothing("erodeSlopes", in.params);
        pass.plane("slopes", in.slopes);
        pass.plane("objectId", in.objectId);
        pass.run();
        return pass.pixels<float>("eroded");
    }
    Planes<float> smoothed(const Slopes& in, int radius)
    {
        PassBench pass = smoothing("smoothSlopes", in.params);
        pass.value("radius", radius);
        pass.plane("eroded",
            std::vector<float>(
                in.slopes.values.begin(), in.slopes.values.begin() + static_cast<std::ptrdiff_t>(in.layout().size)));
        pass.plane("objectId", in.objectId);
        pass.run();
        return pass.pixels<float>("logSlopes");
    }
    /// Of two planes, or of the published four.
    Planes<float> spread(const Slopes& in, const Planes<float>& from)
    {
        const bool two = from.values.size() == 2 * in.layout().size;
        PassBench rows = two ? smoothing("spreadRows", in.params) : publishing("spreadRows", in.params);
        PassBench columns = two ? smoothing("spreadColumns", in.params) : publishing("spreadColumns", in.params);
        rows.plane("in", from);
        rows.run();
        columns.plane("in", rows.read<float>("out"));
        columns.run();
        return columns.pixels<float>("out");
    }
    /// distances: sums that spread
    Published published(const Slopes& in, const shared::AnalysisParams& p, const Planes<float>& distances)
    {
        PassBench pass = publishing("publishedWidths", p);
        pass.value("countMu", in.params.mu);
        pass.plane("slopes", in.slopes);
        pass.plane("distances", distances);
        pass.plane("objectId", in.objectId);
        pass.plane("pixelSize", in.pixelSize);
        std::vector<float> sums = in.sums.values; // the first of all
        sums.resize(pass.read<float>("sums").size());
        pass.plane("sums", sums);
        pass.plane("wanted", std::vector<std::uint32_t>(in.layout().size, 777));
        pass.run();
        return { pass.pixels<float>("beta"), pass.pixels<std::uint32_t>("wanted") };
    }

private:
    static scene::Scene glossy()
    {
        scene::Scene out = smallScene();
        out.materials[0].specular = glm::vec3(0.3f);
        return out;
    }
    static render::Settings settings(const render::Settings& method, const render::PlaneLayout& layout)
    {
        return sized(method, static_cast<int>(layout.width), static_cast<int>(layout.height));
    }

    DeclaredFrame smoothing_, publishing_;
};

/// Calls visit(qx, qy) for the pixels of the image within `radius` of (x, y).
void around(const Slopes& in, int x, int y, int radius, const std::function<void(int, int)>& visit)
{
    for (int qy = std::max(0, y - radius); qy <= std::min(in.height() - 1, y + radius); ++qy)
        for (int qx = std::max(0, x - radius); qx <= std::min(in.width() - 1, x + radius); ++qx)
            visit(qx, qy);
}

/// The sizes and densities that every kernel here is tried with, degenerate first.
std::vector<Slopes> cases()
{
    return { Slopes(1, 1, 1, 1.0), Slopes(1, 19, 2, 0.5), Slopes(33, 1, 3, 0.5), Slopes(20, 11, 4, 0.0),
        Slopes(47, 29, 5, 1.0), Slopes(47, 29, 6, 0.3), Slopes(32, 16, 7, 0.03) };
}

} // namespace

TEST_CASE("luminanceOf reads textures of all kinds of terms and frames")
{
    onEveryDevice([](const device::Device& device) {
        for (const Slopes& in : cases())
            for (const Kept kept : { Kept::Full, Kept::Lean }) {
                MovingFrame frame(device, kept, in.layout());
                for (const char* name : { "widths", "filter of indirect" }) {
                    PassBench pass(frame, "luminanceOf", name);
                    std::mt19937 random(1);
                    std::vector<float> colours = someNumbers(random, 3 * in.layout().size, 0, 1);
                    for (std::size_t i = 0; i < colours.size(); ++i)
                        colours[i] *= i % in.layout().size % 5 == 0 ? 0.0f : 1.0f;
                    pass.plane("image", colours);
                    pass.run();
                    const auto image = pass.pixels<float>("image"), found = pass.pixels<float>("out");
                    everyPixel(in.layout(), [&](int x, int y) {
                        REQUIRE(found.at(x, y) == doctest::Approx(luminanceOf(image.vector(x, y))).epsilon(1e-5));
                    });
                }
            }
    });
}

TEST_CASE("erodeSlopes takes the least slope of the same object within 3x3")
{
    onEveryDevice([](const device::Device& device) {
        for (const Slopes& in : cases()) {
            const Planes<float> found = Analysis(device, in.layout()).eroded(in);
            everyPixel(in.layout(), [&](int x, int y) {
                float least = 0;
                around(in, x, y, 1, [&](int qx, int qy) {
                    const float s = in.slopes.at(qx, qy);
                    if (s > 0 && in.objectId.at(x, y) != 0 && in.objectId.at(qx, qy) == in.objectId.at(x, y))
                        least = least > 0 ? std::min(least, s) : s;
                });
                REQUIRE(found.at(x, y) == least);
            });
        }
    });
}

TEST_CASE("smoothSlopes averages the logarithm over the object's slopes near by, where there is one")
{
    onEveryDevice([](const device::Device& device) {
        for (const Slopes& in : cases())
            for (const int radius : { 1, 2 }) {
                const Planes<float> found = Analysis(device, in.layout()).smoothed(in, radius);
                everyPixel(in.layout(), [&](int x, int y) {
                    double sum = 0, count = 0;
                    around(in, x, y, radius, [&](int qx, int qy) {
                        if (in.slopes.at(qx, qy) > 0 && in.objectId.at(qx, qy) == in.objectId.at(x, y)) {
                            sum += std::log2(in.slopes.at(qx, qy));
                            count += 1;
                        }
                    });
                    const bool has = in.slopes.at(x, y) > 0 && in.objectId.at(x, y) != 0;
                    REQUIRE(found.at(x, y, 1) == (has ? 1.0f : 0.0f));
                    REQUIRE(std::fabs(found.at(x, y) - (has ? sum / count : 0.0)) < 1e-3);
                });
            }
    });
}

TEST_CASE("spreadRows and spreadColumns sum a window, plain or with Gaussian weights, the same on both sides")
{
    onEveryDevice([](const device::Device& device) {
        for (Slopes in : cases())
            for (const float sigma : { 0.0f, 2.5f }) {
                in.params.fillRadius = 7;
                in.params.fillScale = sigma > 0 ? -0.5f * 1.44269504f / (sigma * sigma) : 0.0f;
                Planes<float> from(in.layout(), 2, 0.0f);
                std::mt19937 random(11);
                everyPixel(in.layout(), [&](int x, int y) {
                    from.at(x, y) = static_cast<float>(uniform(random, -3, 3));
                    from.at(x, y, 1) = static_cast<float>(random() % 2);
                });
                const Planes<float> found = Analysis(device, in.layout()).spread(in, from);
                everyPixel(in.layout(), [&](int x, int y) {
                    double sums[2] = { 0, 0 };
                    around(in, x, y, 7, [&](int qx, int qy) {
                        const double d = (qx - x) * (qx - x) + (qy - y) * (qy - y);
                        const double w = sigma > 0 ? std::exp(-0.5 * d / (sigma * sigma)) : 1.0;
                        sums[0] += w * from.at(qx, qy);
                        sums[1] += w * from.at(qx, qy, 1);
                    });
                    REQUIRE(std::fabs(found.at(x, y) - sums[0]) < 2e-4);
                    REQUIRE(std::fabs(found.at(x, y, 1) - sums[1]) < 1e-4);
                });
            }
    });
}

TEST_CASE("widths are (3.13) of the pixel's own slope, else of what spread to it; 0 far from shadows, -1 without light")
{
    onEveryDevice([](const device::Device& device) {
        for (Slopes in : cases())
            for (const Kept kept : { Kept::Full, Kept::Lean }) {
                MovingFrame frame(device, kept, in.layout());
                in.params.fillScale = -0.05f;
                Analysis analysis(device, in.layout());
                const Planes<float> logs = analysis.smoothed(in, 1), spread = analysis.spread(in, logs);
                PassBench pass(frame, "widths");
                pass.plane("logSlopes", logs);
                pass.plane("spread", spread);
                pass.plane("objectId", in.objectId);
                pass.plane("pixelSize", in.pixelSize);
                pass.plane("sums", in.sums);
                in.pixelSize = pass.pixels<float>("pixelSize");
                for (const float fixedWidth : { 0.0f, 2.5f }) {
                    in.params.fixedWidth = fixedWidth;
                    pass.value("p", in.params);
                    pass.run();
                    const auto beta = pass.pixels<float>("beta");
                    everyPixel(in.layout(), [&](int x, int y) {
                        const double d = in.pixelSize.at(x, y), own = logs.at(x, y, 1), near = spread.at(x, y, 1);
                        const double s = std::exp2(own > 0 ? logs.at(x, y) : spread.at(x, y) / near);
                        double expected = std::max(0.25 * s, (1 + s) * d) / 6;
                        expected = own > 0 || near > 1e-4 ? expected : 0.0;
                        expected = fixedWidth > 0 ? fixedWidth * d : expected;
                        if (in.objectId.at(x, y) == 0 || !(in.sums.at(x, y) > 0))
                            expected = -1;
                        REQUIRE(beta.at(x, y) == doctest::Approx(expected).epsilon(1e-4));
                    });
                }
            }
    });
}

/// A width that a highlight of that share narrows, as analysis.cl says.
double narrowedWidth(glm::dvec3 toLight, glm::dvec3 toEye, shared::Gloss gloss, double share, double wide)
{
    const double light = glm::length(toLight), eye = glm::length(toEye);
    const double spread = gloss.kind == WEDGE_PHONG ? 1.0 : glm::length(toLight / light + toEye / eye);
    const double s = wide * 3 * 2 / 0.25; // k, mu and sigma of Slopes
    const double occluder = light * s / (1 + s);
    const double lobe = spread / std::sqrt(std::max<double>(gloss.exponent, 1)) / (1 / occluder + 1 / eye) / 6;
    return 1 / std::sqrt(1 / (wide * wide) + share / (lobe * lobe));
}

TEST_CASE("highlights narrow widths by their share, those of no width and of no highlight stay")
{
    onEveryDevice([](const device::Device& device) {
        shared::FrameParams frame {};
        frame.eye = shared::vec3(2, 3, 6);
        const glm::dvec3 eye(2, 3, 6), centre(1, 4, 1.5);
        shared::AreaLight light {};
        light.halfU = shared::vec3(0.5f, 0, 0);
        light.halfV = shared::vec3(0, 0, 0.3f);
        light.power = shared::vec3(20, 30, 10);
        const double pi = 3.14159265358979, power = 0.2126 * 20 + 0.7152 * 30 + 0.0722 * 10;
        for (const Slopes& in : cases()) {
            std::mt19937 random(9);
            Planes<float> sums(in.layout(), 4, 0.0f), diffuse(in.layout(), 3, 0.0f), specular(in.layout(), 3, 0.0f),
                texture(in.layout(), 3, 0.0f), before(in.layout(), 1, 0.0f);
            Planes<std::uint32_t> gloss(in.layout(), 1, 0u);
            everyPixel(in.layout(), [&](int x, int y) {
                sums.at(x, y) = static_cast<float>(uniform(random));
                sums.at(x, y, 2) = random() % 4 == 0 ? 0.0f : static_cast<float>(uniform(random, 0, 5));
                diffuse.setVector(x, y, glm::dvec3(uniform(random)));
                specular.setVector(x, y, glm::dvec3(random() % 4 == 0 ? 0.0 : uniform(random)));
                texture.setVector(x, y, glm::dvec3(uniform(random, 0, 2)));
                gloss.at(x, y) =
                    shared::packGloss(shared::makeGloss(static_cast<float>(std::pow(10.0, uniform(random, -1, 4))),
                        random() % 2 == 0 ? WEDGE_PHONG : WEDGE_BLINN_PHONG));
                before.at(x, y) = random() % 5 == 0 ? static_cast<float>(random() % 2) - 1.0f
                                                    : static_cast<float>(uniform(random, 0.001, 0.5));
            });
            Analysis analysis(device, in.layout());
            PassBench lobes = analysis.smoothing("narrowForLobes", in.params);
            lobes.value("frame", frame);
            lobes.plane("sums", sums);
            lobes.plane("position", in.position);
            lobes.plane("gloss", gloss);
            lobes.plane("diffuse", diffuse);
            lobes.plane("specular", specular);
            lobes.plane("objectId", in.objectId);
            lobes.plane("beta", before);
            lobes.run();
            const auto one = lobes.pixels<float>("beta");
            everyPixel(in.layout(), [&](int x, int y) {
                const glm::dvec3 at = in.position.vector(x, y), toLight = centre - at, toEye = eye - at;
                const double wide = before.at(x, y);
                const double lobe = specular.at(x, y) * sums.at(x, y, 2), matt = diffuse.at(x, y) * sums.at(x, y) / pi;
                const double expected = wide > 0 && in.objectId.at(x, y) != 0 && lobe > 0
                    ? narrowedWidth(toLight, toEye, shared::unpackGloss(gloss.at(x, y)), lobe / (lobe + matt), wide)
                    : wide;
                REQUIRE(one.at(x, y) == doctest::Approx(expected).epsilon(1e-4));
            });
            for (const Kept kept : { Kept::Full, Kept::Lean }) {
                MovingFrame declared(device, kept, in.layout());
                PassBench pass(declared, "narrowForLobes");
                pass.value("p", in.params);
                pass.value("frame", frame);
                pass.value("light", light);
                pass.plane("texture", texture);
                pass.plane("position", in.position);
                pass.plane("gloss", gloss);
                pass.plane("objectId", in.objectId);
                pass.plane("beta", before);
                const auto shown = pass.pixels<float>("texture");
                const auto lobe = pass.pixels<std::uint32_t>("gloss");
                pass.run();
                const auto many = pass.pixels<float>("beta");
                everyPixel(in.layout(), [&](int x, int y) {
                    const glm::dvec3 at = in.position.vector(x, y), toLight = centre - at, toEye = eye - at;
                    const double wide = before.at(x, y), nearest = std::max(glm::length(toLight) - 0.8, 0.0);
                    const double share = 1 - power / pi / (nearest * nearest) / shown.at(x, y);
                    const double expected = wide > 0 && in.objectId.at(x, y) != 0 && share > 0
                        ? narrowedWidth(toLight, toEye, shared::unpackGloss(lobe.at(x, y)), share, wide)
                        : wide;
                    REQUIRE(many.at(x, y) == doctest::Approx(expected).epsilon(1e-4));
                });
            }
        }
    });
}

TEST_CASE("the published fallback: mean distances within 5 pixels, then (3.13) and (3.21)")
{
    onEveryDevice([](const device::Device& device) {
        for (const Slopes& in : cases()) {
            Analysis analysis(device, in.layout());
            PassBench distances = analysis.publishing("publishedDistances", in.params);
            distances.plane("slopes", in.slopes);
            distances.plane("position", in.position);
            distances.plane("objectId", in.objectId);
            distances.run();
            const Planes<float> spread = analysis.spread(in, distances.pixels<float>("distances"));
            shared::AnalysisParams narrower = in.params; // filters: counts keep their own mu
            narrower.mu = 3;
            const Published found = analysis.published(in, narrower, spread);
            everyPixel(in.layout(), [&](int x, int y) {
                double d1 = 0, farthest = 0, nearest = 0;
                around(in, x, y, 5, [&](int qx, int qy) {
                    if (in.slopes.at(qx, qy) > 0) {
                        const double d = glm::length(in.position.vector(qx, qy) - glm::dvec3(1, 4, 1.5));
                        d1 += d;
                        farthest += d / (1.0 + in.slopes.at(qx, qy));
                        nearest += d / (1.0 + in.slopes.at(qx, qy, 1));
                    }
                });
                const bool own = in.slopes.at(x, y) > 0, lit = in.objectId.at(x, y) != 0 && in.sums.at(x, y) > 0;
                const double sMin = own ? in.slopes.at(x, y) : std::clamp(d1 / farthest - 1, 1e-4, 1e3);
                const double sMax = own ? in.slopes.at(x, y, 1) : std::clamp(d1 / nearest - 1, 1e-4, 1e3);
                const double d = in.pixelSize.at(x, y);
                const double width = d1 > 0 ? std::max(0.25 * sMin, (1 + sMin) * d) / 9 : 0.0;
                // Distances are floats: s = d1/d2 - 1 has lost digits where it is small.
                const double slack = d1 > 0 ? 1e-5 * (1 + 1 / sMin) : 1e-5;
                REQUIRE(found.beta.at(x, y) == doctest::Approx(lit ? width : -1.0).epsilon(slack));
                const double exact =
                    4 * std::pow(1 + 2 * sMax / sMin, 2) * std::pow(2 * (2 / sMin) * d / 0.5 + 1 / (1 + sMin), 2);
                const double count = d1 > 0 && lit ? std::clamp(exact, 9.0, 100.0) : 9.0;
                const double tolerance = 0.51 + 4 * slack * count;
                if (in.objectId.at(x, y) == 0)
                    REQUIRE(found.wanted.at(x, y) == 0);
                else
                    REQUIRE(std::fabs(found.wanted.at(x, y) - count) <= tolerance);
            });
        }
    });
}

TEST_CASE("an occluder at the receiver or at the light gives widths and counts within bounds")
{
    onEveryDevice([](const device::Device& device) {
        Slopes in(2, 1, 1, 1.0);
        for (int x = 0; x < 2; ++x) {
            const float s = x == 0 ? WEDGE_SLOPE_MIN : WEDGE_SLOPE_MAX;
            in.objectId.at(x, 0) = 1;
            in.slopes.at(x, 0) = in.slopes.at(x, 0, 1) = s;
            in.sums.at(x, 0) = 9;
            in.pixelSize.at(x, 0) = 0.01f;
        }
        const Published found =
            Analysis(device, in.layout()).published(in, in.params, Planes<float>(in.layout(), 4, 0.0f));
        CHECK(found.beta.at(0, 0) == doctest::Approx(0.01 * 1.0001 / 6)); // the pixel's own bandlimit
        CHECK(found.beta.at(1, 0) == doctest::Approx(0.25 * 1e3 / 6));
        CHECK(found.wanted.at(0, 0) == 100);
        CHECK(found.wanted.at(1, 0) == 9);
    });
}
