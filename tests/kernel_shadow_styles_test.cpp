// shadow_styles.cl, kernel by kernel, against the host in double.
#include "effects/styled_shadows/style_knobs.h"
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

/// Counts, sums and finds, first the class that the edge is in and then itself.
class AreaBench {
public:
    explicit AreaBench(const Traced& traced, DeclaredFrame& frame)
        : count_ { PassBench(frame, "countAreas"), PassBench(frame, "countAreas", "", 1) }
        , keep_ { PassBench(frame, "keepArea"), PassBench(frame, "keepArea", "", 1) }
        , sum_(frame, "sumAreas")
    {
        for (PassBench& count : count_)
            traced.give(count);
    }
    /// Counts within these pixels alone.
    void within(const image::Window& window)
    {
        for (PassBench& count : count_) {
            auto p = count.own<shared::AnalysisParams>("p");
            render::setRectangle(p, window);
            count.value("p", p);
        }
    }
    void plane(const char* name, const std::vector<float>& values)
    {
        for (PassBench& count : count_)
            count.plane(name, values);
    }
    float zero()
    {
        for (const std::size_t level : { std::size_t { 0 }, std::size_t { 1 } }) {
            for (PassBench* pass : { &count_[level], &keep_[level] })
                if (level == 1)
                    pass->plane("found", keep_[0].read<float>("zeros"));
            count_[level].run();
            sum_.plane("areas", count_[level].read<float>("areas"));
            sum_.run();
            keep_[level].plane("sums", sum_.read<float>("sums"));
            keep_[level].run();
        }
        return keep_[1].read<float>("zeros").at(0);
    }

private:
    PassBench count_[2], keep_[2], sum_;
};

} // namespace

TEST_CASE("countAreas, sumAreas and keepArea: the distance below which as much lies as was in shadow, at any scale")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        Seen s(traced);
        int turn = 0; // some of it is right at the edge, which is in shadow
        for (float& v : s.matte.values)
            v = v == WEDGE_MATTE_LIT && ++turn % 11 == 0 ? 0.5f : v;
        AreaBench bench(traced, traced.frame);
        const image::Window window { 13, 6, width - 11, height - 7 }; // as where there are margins
        const auto isShown = [&](int x, int y) {
            return x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
        };
        bench.within(window);
        for (const double scale : { 1e-6, 1.0, 1e6 }) {
            CAPTURE(scale);
            std::mt19937 random(1);
            std::vector<float> distances = someNumbers(random, traced.frame.layout.size, -0.1 * scale, 0.17 * scale);
            for (std::size_t i = 0; i < distances.size(); i += 7)
                distances[i] *= 1e5f; // of another shadow, or none
            Planes<float> distance = planesOf(traced.frame.layout, distances);
            everyPixel(traced.frame.layout, [&](int x, int y) {
                if (!isShown(x, y))
                    distance.at(x, y) = static_cast<float>(-0.1 * scale); // has no say
            });
            bench.plane("distance", distance.values);
            bench.plane("matte", s.matte.values);
            const double zero = double { bench.zero() };
            double shadow = 0, below = 0, all = 0, largest = 0;
            everyPixel(traced.frame.layout, [&](int x, int y) {
                if (!isShown(x, y))
                    return;
                const double area = std::pow(double { s.size.at(x, y) }, 2), v = s.matte.at(x, y);
                all += v >= 0 ? area : 0;
                largest = std::max(largest, area);
                shadow += v >= 0 && v <= 0.5 ? area : 0;
                below += v >= 0 && distance.at(x, y) <= zero ? area : 0;
            });
            CHECK(shadow > 0.05 * all);
            CHECK(std::abs(zero) < 0.2 * scale);
            CHECK(std::abs(below - shadow) < 2 * largest + 1e-4 * shadow); // pixels are whole
            // All in shadow, or nothing: the edge stays.
            for (const float v : { WEDGE_MATTE_LIT, WEDGE_MATTE_SHADOW }) {
                bench.plane("matte", std::vector<float>(traced.frame.layout.size, v));
                CHECK(bench.zero() == 0);
            }
        }
    });
}

TEST_CASE("addStyle: from what is left in shadow to all, softly or at once")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        std::mt19937 random(1);
        const std::size_t size = traced.frame.layout.size;
        const Planes<float> distance = planesOf(traced.frame.layout, someNumbers(random, size, -0.2, 0.3));
        const Planes<float> share = planesOf(traced.frame.layout, someNumbers(random, 3 * size));
        for (const float width : { 0.1f, 0.0f }) {
            CAPTURE(width);
            PassBench bench(traced.frame, "addStyle");
            bench.plane("distance", distance);
            bench.plane("share", share);
            bench.plane("zeros", std::vector<float> { 0.02f, 0 });
            bench.value("softness", shared::StyleKnob { width, 0, 0, width, width });
            bench.value("weight", 0.25f);
            bench.run();
            const auto after = bench.pixels<float>("share");
            const glm::dvec3 left(0.1f, 0.2f, 0.3f);
            double worst = 0;
            everyPixel(traced.frame.layout, [&](int x, int y) {
                const double d = double { distance.at(x, y) } - double { 0.02f } - double { inflation };
                const double t = std::clamp(d / double { width } + 0.5, 0.0, 1.0);
                const double f = width > 0 ? t * t * (3 - 2 * t) : d > 0 ? 1 : 0;
                const glm::dvec3 expected = share.vector(x, y) + 0.25 * (left + (1.0 - left) * f);
                worst = std::max(worst, glm::length(after.vector(x, y) - expected));
            });
            CHECK(worst < 1e-6);
        }
    });
}

TEST_CASE("styledLight: what the light brings where nothing hides it, times the share that is left")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        PassBench bench(traced.frame, "styledLight");
        for (const char* name : { "position", "normal", "origin", "diffuse", "specular" })
            bench.plane(name, traced.primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            bench.plane(name, traced.primary.read<std::uint32_t>(name));
        std::vector<float> matte = traced.matte.read<float>("matte");
        for (std::size_t i = 0; i < matte.size(); i += 5) // no ray came to these before the frame was stopped
            matte[i] = WEDGE_MATTE_UNKNOWN;
        bench.plane("matte", matte);
        const auto known = bench.pixels<float>("matte");
        std::mt19937 random(1);
        bench.plane("share", someNumbers(random, 3 * traced.frame.layout.size, 0, 1));
        bench.plane("lit", someNumbers(random, 3 * traced.frame.layout.size));
        const auto before = bench.pixels<float>("lit"), share = bench.pixels<float>("share");
        const auto diffuse = bench.pixels<float>("diffuse"), specular = bench.pixels<float>("specular");
        const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
        bench.run();
        const auto after = bench.pixels<float>("lit");
        const double m = 12; // of Blinn and Phong's lobe, docs/materials.md
        const double scale = (m + 2) * (m + 4) / (8 * std::numbers::pi * (std::exp2(-0.5 * m) + m));
        unsigned lit = 0, away = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const glm::dvec3 added = after.vector(x, y) - before.vector(x, y), n = s.normal.vector(x, y);
            const double cosine = glm::dot(n, sunward);
            if (s.object.at(x, y) == 0 || cosine <= 0 || known.at(x, y) < 0) {
                REQUIRE(added == glm::dvec3(0));
                ++away;
                return;
            }
            const glm::dvec3 view = glm::normalize(eye - s.position.vector(x, y));
            const double lobe = scale * std::pow(std::max(glm::dot(n, glm::normalize(view + sunward)), 0.0), m);
            const glm::dvec3 reflected = diffuse.vector(x, y) / std::numbers::pi + lobe * specular.vector(x, y);
            const glm::dvec3 expected = share.vector(x, y) * irradiance * cosine * reflected;
            REQUIRE(glm::length(added - expected) <= 1e-4 * (1 + glm::length(expected)));
            ++lit;
        });
        CHECK(lit > 1000);
        CHECK(away > 300);
    });
}
