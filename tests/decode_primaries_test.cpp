// Colours of other primaries as those of Rec.709, against published matrices.
#include "host/decode/failure.h"
#include "host/decode/primaries.h"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace wedge::decode;

namespace {

constexpr Chromaticity d60 { 0.32168, 0.33767 };

void checkMatrix(const std::optional<ColourMatrix>& matrix, const ColourMatrix& expected, double error = 2e-4)
{
    REQUIRE(matrix);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            CAPTURE(row);
            CAPTURE(column);
            CHECK(std::abs((*matrix)[row][column] - expected[row][column]) < error);
        }
    }
}

} // namespace

TEST_CASE("primaries: those of Rec.2020, ACES and XYZ become those of Rec.709")
{
    // ITU-R BT.2087; ACES with Bradford's adaptation as in its published configurations; IEC 61966-2-1.
    checkMatrix(matrixToRec709({ { 0.708, 0.292 }, { 0.170, 0.797 }, { 0.131, 0.046 }, rec709.white }),
        { { { 1.6605, -0.5876, -0.0728 }, { -0.1246, 1.1329, -0.0083 }, { -0.0182, -0.1006, 1.1187 } } });
    checkMatrix(matrixToRec709({ { 0.7347, 0.2653 }, { 0.0, 1.0 }, { 0.0001, -0.0770 }, d60 }),
        { { { 2.5217, -1.1341, -0.3876 }, { -0.2765, 1.3727, -0.0962 }, { -0.0154, -0.1530, 1.1683 } } });
    checkMatrix(matrixToRec709({ { 0.713, 0.293 }, { 0.165, 0.830 }, { 0.128, 0.044 }, d60 }),
        { { { 1.7051, -0.6218, -0.0833 }, { -0.1303, 1.1408, -0.0105 }, { -0.0240, -0.1290, 1.1530 } } });
    checkMatrix(matrixToRec709({ { 1, 0 }, { 0, 1 }, { 0, 0 }, { 1.0 / 3, 1.0 / 3 } }),
        { { { 3.2406, -1.5372, -0.4986 }, { -0.9689, 1.8758, 0.0415 }, { 0.0557, -0.2040, 1.0570 } } }, 2e-3);
}

TEST_CASE("primaries: greys stay grey, or what the image calls neutral becomes grey")
{
    const Primaries warm { { 0.7, 0.3 }, { 0.2, 0.7 }, { 0.15, 0.05 }, { 0.4476, 0.4074 } };
    const std::array<float, 3> grey { 0.25f, 0.25f, 0.25f };
    for (const float c : converted(*matrixToRec709(warm), grey))
        CHECK(c == doctest::Approx(0.25).epsilon(1e-5));
    const Primaries white { rec709.red, rec709.green, rec709.blue, rec709.white };
    const auto cooled = converted(*matrixToRec709(white, d60), grey); // D60 is warmer, so that D65 is blue beside it
    CHECK(cooled[2] > 1.04f * cooled[0]);
}

TEST_CASE("primaries: Rec.709, rounded, and none at all change no bit; impossible ones are refused")
{
    CHECK_FALSE(matrixToRec709(rec709));
    CHECK_FALSE(matrixToRec709({ { 0.64, 0.33 }, { 0.3, 0.6 }, { 0.15, 0.06 }, { 0.313, 0.329 } }));
    CHECK_FALSE(matrixToRec709({}));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Primaries& none : { Primaries { { 0.3, 0.3 }, { 0.3, 0.3 }, { 0.3, 0.3 }, { 0.3, 0.3 } },
             Primaries { { 0.64, 0.33 }, { 0.3, 0.6 }, { 0.15, 0.06 }, { 0.3, 0.0 } },
             Primaries { { nan, 0.33 }, { 0.3, 0.6 }, { 0.15, 0.06 }, { 0.3127, 0.329 } },
             Primaries { { 1e30, 0.33 }, { 0.3, 0.6 }, { 0.15, 0.06 }, { 0.3127, 0.329 } } })
        CHECK_THROWS_AS(matrixToRec709(none), Failure);
    CHECK_THROWS_AS(matrixToRec709(rec709, Chromaticity { nan, 0.3 }), Failure);
}

TEST_CASE("primaries: a colour that is not finite stays as it is")
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const ColourMatrix swap { { { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, -1 } } };
    std::vector<float> rgb { 1, 2, 3, infinity, 2, 3 };
    convert(swap, rgb);
    CHECK(rgb == std::vector<float> { 2, 1, -3, infinity, 2, 3 });
}
