#include "host/image/metrics.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <stdexcept>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

RgbImage constant(int width, int height, float r, float g, float b)
{
    RgbImage image { width, height, {} };
    for (int i = 0; i < width * height; ++i)
        image.rgb.insert(image.rgb.end(), { r, g, b });
    return image;
}

RgbImage movedRight(const RgbImage& image)
{
    RgbImage moved = image;
    for (int y = 0; y < image.height; ++y) {
        const auto first = moved.rgb.begin() + 3 * y * image.width;
        std::rotate(first, first + 3 * (image.width - 1), first + 3 * image.width);
    }
    return moved;
}

RgbImage withRedAndBlueSwapped(RgbImage image)
{
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        std::swap(image.rgb[i], image.rgb[i + 2]);
    return image;
}

double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

} // namespace

TEST_CASE("equal images have no error")
{
    for (const auto& [width, height] : { std::pair(1, 1), std::pair(2, 40), std::pair(64, 48) }) {
        CAPTURE(width);
        const RgbImage image = noisyCard(width, height, 0.5, 7);
        const Comparison result = compare(image, image);
        CHECK(result.rmse == 0.0);
        CHECK(result.relMse == 0.0);
        CHECK(result.psnr == std::numeric_limits<double>::infinity());
        CHECK(result.ssim == doctest::Approx(1.0).epsilon(1e-12));
        CHECK(result.flip == 0.0);
        CHECK(result.invalidPixels == 0);
    }
}

TEST_CASE("constant images follow the closed forms")
{
    const double a = 0.5;
    const double b = 0.2;
    for (const int size : { 1, 10, 11, 30 }) {
        CAPTURE(size);
        const RgbImage image = constant(size, size, 0.5f, 0.5f, 0.5f);
        const RgbImage reference = constant(size, size, 0.2f, 0.2f, 0.2f);
        CHECK(rmse(image, reference) == doctest::Approx(a - b).epsilon(1e-6));
        CHECK(relMse(image, reference) == doctest::Approx((a - b) * (a - b) / (b * b + 0.01)).epsilon(1e-6));
        const double sa = srgb(a);
        const double sb = srgb(b);
        CHECK(psnr(image, reference) == doctest::Approx(-20.0 * std::log10(sa - sb)).epsilon(1e-6));
        // Without variance only the luminance term is left.
        CHECK(
            ssim(image, reference) == doctest::Approx((2 * sa * sb + 1e-4) / (sa * sa + sb * sb + 1e-4)).epsilon(1e-6));
    }
}

TEST_CASE("the root mean square counts each channel, and relative error divides by the reference")
{
    const RgbImage image { 2, 1, { 1, 0, 0, 0, 0, 4 } };
    const RgbImage reference { 2, 1, { 0, 0, 0, 0, 0, 2 } };
    CHECK(rmse(image, reference) == doctest::Approx(std::sqrt(5.0 / 6.0)));
    CHECK(relMse(image, reference) == doctest::Approx((1.0 / 0.01 + 4.0 / 4.01) / 6.0));
    CHECK(relMse(reference, image) == doctest::Approx((1.0 / 1.01 + 4.0 / 16.01) / 6.0));
}

TEST_CASE("peak signal-to-noise ratio sees what a display shows")
{
    // 50 and 1 are the same white; -1 and 0 the same black.
    CHECK(psnr(constant(3, 3, 50, 1, -1), constant(3, 3, 1, 50, 0)) == std::numeric_limits<double>::infinity());
    CHECK(psnr(constant(3, 3, 9, 9, 9), constant(3, 3, 0, 0, 0)) == doctest::Approx(0.0));
}

namespace {

struct Recorded {
    const char* name;
    RgbImage image;
    RgbImage reference;
    double rmse, relMse, psnr, ssim, flip, flipAt; // flipAt: the error at (width / 4, height / 2)
};

// Values recorded with NumPy in double precision; SSIM from scikit-image 0.26 structural_similarity on the luma
// (gaussian_weights, sigma 1.5, use_sample_covariance=False, data_range 1); FLIP from flip-evaluator 1.7, the
// implementation of the paper's authors, at 67 pixels per degree on the clipped, sRGB-encoded images.
// SSIM is -1 where scikit-image refuses an image smaller than its window.
std::vector<Recorded> recordedComparisons()
{
    const RgbImage card = testCard(64, 48);
    return {
        { "weak noise", noisyCard(64, 48, 0.1, 1), card, 0.029036389420982005, 0.024103334359650005, 26.85070053565749,
            0.9056584389538486, 0.07529667764902115, 0.08467225730419159 },
        { "strong noise", noisyCard(64, 48, 1.0, 2), card, 0.2903934107412665, 2.4176361129166155, 10.829345554489693,
            0.3149149793558009, 0.41319718956947327, 0.29087936878204346 },
        { "odd size", noisyCard(37, 23, 0.4, 3), testCard(37, 23), 0.11698956916075182, 0.39422943390281545,
            15.929026484072564, 0.5661468988626567, 0.23494836688041687, 0.18724529445171356 },
        { "smaller than any window", noisyCard(7, 5, 0.4, 4), testCard(7, 5), 0.11512422794737077, 0.17579056094419912,
            17.4206268780398, -1, 0.24897460639476776, 0.09785221517086029 },
        { "one pixel", noisyCard(1, 1, 0.5, 5), testCard(1, 1), 0.12505911692700364, 0.07097234327643596,
            20.363799163923897, -1, 0.42355218529701233, 0.42355218529701233 },
        { "moved by a pixel", movedRight(card), card, 0.13683664683204064, 0.4974507556782559, 18.71992498051966,
            0.7035514118596318, 0.21202786266803741, 0.3101843297481537 },
        { "red and blue swapped", withRedAndBlueSwapped(card), card, 0.3062474515921678, 2.0518674155483407,
            12.487973522909147, 0.9783450246314929, 0.5300975441932678, 0.25248029828071594 },
    };
}

} // namespace

TEST_CASE("metrics agree with other implementations")
{
    for (const Recorded& recorded : recordedComparisons()) {
        CAPTURE(recorded.name);
        const Comparison result = compare(recorded.image, recorded.reference);
        CHECK(result.rmse == doctest::Approx(recorded.rmse).epsilon(1e-6));
        CHECK(result.relMse == doctest::Approx(recorded.relMse).epsilon(1e-6));
        CHECK(result.psnr == doctest::Approx(recorded.psnr).epsilon(1e-5));
        if (recorded.ssim != -1)
            CHECK(result.ssim == doctest::Approx(recorded.ssim).epsilon(1e-5));
        CHECK(std::abs(result.flip - recorded.flip) < 2e-5);
        const FlipResult map = flip(recorded.image, recorded.reference);
        REQUIRE(map.error.size() == recorded.image.rgb.size() / 3);
        const int middle = map.height / 2 * map.width + map.width / 4;
        CHECK(std::abs(map.error[static_cast<std::size_t>(middle)] - recorded.flipAt) < 2e-4);
        CHECK(map.mean == result.flip);
    }
}

TEST_CASE("FLIP follows the viewing distance and spans 0 to 1")
{
    const RgbImage card = testCard(64, 48);
    // flip-evaluator 1.7 at 30 pixels per degree.
    CHECK(std::abs(flip(movedRight(card), card, 30.0).mean - 0.20761598646640778) < 2e-5);
    // The corners of the RGB cube that are furthest apart, by construction of the colour map.
    CHECK(flip(constant(4, 4, 0, 1, 0), constant(4, 4, 0, 0, 1)).mean == doctest::Approx(1.0).epsilon(1e-6));
    // flip-evaluator 1.7.
    CHECK(flip(constant(4, 4, 1, 1, 1), constant(4, 4, 0, 0, 0)).mean == doctest::Approx(0.9673919082).epsilon(1e-5));
    CHECK_THROWS_AS(flip(card, card, 0.0), std::logic_error);
}

TEST_CASE("an axis shorter than the SSIM window is handled on its own")
{
    // Every row is alike, so that three rows give what forty do: the windows differ only in the axis that is constant.
    const auto stripes = [](int height, float phase) {
        RgbImage image { 40, height, {} };
        for (int i = 0; i < 40 * height; ++i)
            image.rgb.insert(image.rgb.end(), 3, 0.5f + 0.4f * std::sin(0.3f * static_cast<float>(i % 40) + phase));
        return image;
    };
    const double tall = ssim(stripes(40, 0.2f), stripes(40, 0.0f));
    CHECK(tall < 0.999);
    CHECK(ssim(stripes(3, 0.2f), stripes(3, 0.0f)) == doctest::Approx(tall).epsilon(1e-9));
    CHECK(ssim(stripes(10, 0.2f), stripes(10, 0.0f)) == doctest::Approx(tall).epsilon(1e-9));
}

TEST_CASE("invalid pixels are counted and left out of the pixel-wise errors")
{
    const RgbImage reference = testCard(20, 20);
    RgbImage image = noisyCard(20, 20, 0.2, 9);
    const double before = rmse(image, reference);
    image.rgb[0] = notANumber;
    image.rgb[1] = infinity; // the same pixel
    image.rgb[3 * 57 + 2] = -infinity;
    RgbImage spoiled = reference;
    spoiled.rgb[3 * 399] = notANumber;
    const Comparison result = compare(image, spoiled);
    CHECK(result.invalidPixels == 3);
    CHECK(std::isfinite(result.rmse));
    CHECK(result.rmse == doctest::Approx(before).epsilon(0.05));
    CHECK(result.rmse != before);
    CHECK(std::isfinite(result.relMse));
    CHECK(std::isfinite(result.psnr));
    CHECK(result.ssim < 1.0);
    CHECK(result.ssim > 0.0);
    CHECK(result.flip > 0.0);
    CHECK(result.flip < 1.0);

    const Comparison nothingLeft = compare(constant(2, 2, notANumber, 0, 0), constant(2, 2, 1, 1, 1));
    CHECK(nothingLeft.invalidPixels == 4);
    CHECK(std::isnan(nothingLeft.rmse));
    CHECK(std::isnan(nothingLeft.relMse));
    CHECK(std::isnan(nothingLeft.psnr));
    CHECK(nothingLeft.flip > 0.9);
}

TEST_CASE("images of different sizes are refused with both sizes")
{
    const RgbImage a = testCard(4, 3);
    const RgbImage b = testCard(3, 4);
    const char* message = "image and reference differ in size: 4x3 and 3x4: compare images of one size";
    CHECK_THROWS_WITH_AS(compare(a, b), message, wedge::Error);
    CHECK_THROWS_WITH_AS(rmse(a, b), message, wedge::Error);
    CHECK_THROWS_WITH_AS(relMse(a, b), message, wedge::Error);
    CHECK_THROWS_WITH_AS(psnr(a, b), message, wedge::Error);
    CHECK_THROWS_WITH_AS(ssim(a, b), message, wedge::Error);
    CHECK_THROWS_WITH_AS(flip(a, b), message, wedge::Error);
    CHECK_THROWS_AS(compare(RgbImage {}, RgbImage {}), std::logic_error);
    CHECK_THROWS_AS(compare(RgbImage { 4, 3, {} }, a), std::logic_error);
}
