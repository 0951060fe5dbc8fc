// Settings of distributed frames: which are refused, and that all that shape an image are told apart.
#include "host/error.h"
#include "host/render/filters/gaussian.h"
#include "host/render/settings.h"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {
namespace {

using Change = std::function<void(DistributedSettings&)>;

Settings with(Settings settings, const Change& change)
{
    change(settings.distributed);
    return settings;
}

} // namespace

TEST_CASE("what bounds the error of distributed frames goes on with the samples")
{
    // More samples of a pixel at most, and less error by taking texture and irradiance apart.
    CHECK(axisAligned().distributed.maxSpp == 512);
    CHECK(axisAligned(28).distributed.maxSpp == 512);
    CHECK(axisAligned(100).distributed.maxSpp == 1828);
    CHECK(axisAligned(512).distributed.maxSpp == 9362);
    CHECK(axisAligned(2048).distributed.maxSpp == mostPixelSpp);
    CHECK(axisAligned(9).distributed.factoringError == axisAligned().distributed.factoringError);
    CHECK(axisAligned(112).distributed.factoringError
        == doctest::Approx(0.5f * axisAligned(28).distributed.factoringError));
}

TEST_CASE("settings of distributed frames out of range are refused")
{
    CHECK_NOTHROW(validate(axisAligned(), true));
    CHECK_NOTHROW(validate(asPublished(), true));
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    std::vector<Change> wrong = {
        [](auto& d) { d.firstPaths = 1; }, // no variance of one
        [](auto& d) { d.maxSpp = d.firstPaths - 1; },
        [](auto& d) { d.maxSpp = mostPixelSpp + 1; },
        [](auto& d) { d.mixedPaths = 0; },
        [](auto& d) { d.mu = 0; },
        [](auto& d) { d.factoringRadius = -1; },
        [](auto& d) { d.factoringRadius = 41; },
        [](auto& d) { d.leastRadius = 0; }, // its power is infinite
        [](auto& d) { d.varianceSpread = 1.5f; },
    };
    float DistributedSettings::*const members[] = { &DistributedSettings::mu, &DistributedSettings::factoringError,
        &DistributedSettings::blurWidth, &DistributedSettings::blurExponent, &DistributedSettings::shutterWidth,
        &DistributedSettings::shutterExponent, &DistributedSettings::leastRadius, &DistributedSettings::irradianceWidth,
        &DistributedSettings::countExponent, &DistributedSettings::varianceSpread, &DistributedSettings::oneVelocity };
    for (const auto member : members)
        for (const float value : { -1.0f, nan, infinity })
            wrong.emplace_back([=](DistributedSettings& d) { d.*member = value; });
    for (std::size_t i = 0; i < wrong.size(); ++i) {
        CAPTURE(i);
        CHECK_THROWS_AS(validate(with(axisAligned(), wrong[i]), true), UsageError);
    }
    const std::vector<Change> right = {
        [](auto& d) { d.firstPaths = d.maxSpp = 2; },
        [](auto& d) { d.firstPaths = d.maxSpp = mostDistributedSpp; },
        [](auto& d) { d.factoringError = d.blurWidth = d.shutterWidth = d.irradianceWidth = d.countExponent = 0; },
    };
    for (const Change& change : right)
        CHECK_NOTHROW(validate(with(axisAligned(mostDistributedSpp), change), true));
}

TEST_CASE("the fewest samples are those of the first pass, the most of a distributed frame what fits in a wave")
{
    Settings bounced = axisAligned(16), progressive = axisAligned(16);
    bounced.bounces = 1;
    progressive.progressive = true;
    CHECK(leastSpp(axisAligned(), false) == 9);
    CHECK(leastSpp(bounced, false) == 16);
    CHECK(leastSpp(bounced, true) == 8);
    CHECK(leastSpp(asPublished(), true) == 16);
    CHECK(leastSpp(progressive, true) == 16);
    const auto allowed = [](Settings settings, int spp, bool distributed) {
        settings.spp = spp;
        try {
            validate(settings, distributed);
            return true;
        } catch (const UsageError&) {
            return false;
        }
    };
    for (const Settings& settings : { axisAligned(), bounced, progressive }) {
        for (const bool distributed : { false, true }) {
            if (settings.progressive && !distributed) {
                continue; // all progressive frames are
            }
            const int least = leastSpp(settings, distributed);
            CHECK(allowed(settings, least, distributed));
            CHECK_FALSE(allowed(settings, least - 1, distributed));
            CHECK(allowed(settings, mostDistributedSpp, distributed));
            CHECK(allowed(settings, mostDistributedSpp + 1, distributed) == (!distributed || settings.progressive));
        }
    }
    CHECK(allowed(monteCarlo(1), mostDistributedSpp + 1, true));
    CHECK(allowed(monteCarlo(1), 1, true));
}

TEST_CASE("the first pass of distributed frames grows with the samples, but not of progressive ones")
{
    const auto first = [](const Settings& settings) { return settings.distributed.firstPaths; };
    CHECK(first(axisAligned(8)) == 8);
    CHECK(first(axisAligned(64)) == 8);
    CHECK(first(axisAligned(512)) == 64);
    CHECK(first(axisAligned(mostDistributedSpp)) == mostDistributedSpp / 8);
    CHECK(first(axisAligned(1 << 20)) == mostDistributedSpp); // of a pinhole frame, which has no use for it
    CHECK_NOTHROW(validate(axisAligned(1 << 20), false));
    CHECK(first(halfAt(axisAligned(512), 512)) == 8);
    CHECK(first(asPublished()) == 16);
}

TEST_CASE("the published filter of irradiance measures plain distances and takes the narrower of both kernels")
{
    // (5.31). Under a light, too: distances in its plane are those of the default, and of chapter 3.
    const shared::FrameParams frame {};
    const image::Window window { 0, 0, 16, 16 };
    const Settings published = asPublished();
    const shared::FilterParams filter = publishedParams(published, frame, window);
    CHECK(filter.oblique == 0);
    CHECK(glm::vec3(filter.lightNormal.x, filter.lightNormal.y, filter.lightNormal.z) == glm::vec3(0.0f));
    CHECK(filter.narrower == 1);
    shared::AreaLight light {};
    light.normal = { 0, 0, -1 };
    CHECK(filterParams(published, frame, light, window).lightNormal.z == -1);
    CHECK(filterParams(axisAligned(), frame, light, window).oblique == 1);
}

TEST_CASE("settings that differ are described differently")
{
    const std::vector<Change> changes = { [](auto& d) { ++d.firstPaths; }, [](auto& d) { ++d.maxSpp; },
        [](auto& d) { d.published = true; }, [](auto& d) { d.mu = 2; }, [](auto& d) { ++d.mixedPaths; },
        [](auto& d) { d.factoring = Factoring::Never; }, [](auto& d) { d.factoringError = 0.02f; },
        [](auto& d) { ++d.factoringRadius; }, [](auto& d) { d.blur = false; }, [](auto& d) { d.blurWidth = 0.5f; },
        [](auto& d) { d.blurExponent = 0.5f; }, [](auto& d) { d.shutterWidth = 0.5f; },
        [](auto& d) { d.shutterExponent = 0.5f; }, [](auto& d) { d.leastRadius = 3; },
        [](auto& d) { d.irradianceWidth = 0.5f; }, [](auto& d) { d.countExponent = 0.4f; },
        [](auto& d) { d.varianceSpread = 0.4f; }, [](auto& d) { d.leastShare = 0.4f; },
        [](auto& d) { d.leastTermShare = 0.4f; }, [](auto& d) { d.leastPrimaries = 0.4f; },
        [](auto& d) { d.leastSecondaries = 0.4f; }, [](auto& d) { d.oneVelocity = 0.5f; } };
    std::vector<decltype(describe(Settings()))> seen = { describe(axisAligned()) };
    std::set<std::string> names; // reports keep one value of each
    for (const auto& described : seen.front()) {
        CAPTURE(described.first);
        CHECK(names.insert(described.first).second);
    }
    for (float Settings::*number : { &Settings::wideBlur, &Settings::wideBlurExponent, &Settings::shearedWidth }) {
        Settings other = axisAligned();
        other.*number += 0.5f;
        seen.push_back(describe(other));
    }
    for (const Change& change : changes)
        seen.push_back(describe(with(axisAligned(), change)));
    Settings smooth = axisAligned();
    smooth.antialias = true;
    seen.push_back(describe(smooth));
    for (std::size_t i = 0; i < seen.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            CAPTURE(i);
            CAPTURE(j);
            CHECK(seen[i] != seen[j]);
        }
    Settings plain = monteCarlo(4), square = plain;
    square.antialias = true;
    CHECK(describe(plain) != describe(square));
}

} // namespace wedge::render
