#include "systems/colour_match.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "hwy/targets.h"

namespace metamer {
namespace {

// XYZ to linear sRGB, IEC 61966-2-1:1999.
constexpr ColourMatrix xyz_to_srgb = {
    {{3.2406f, -1.5372f, -0.4986f}, {-0.9689f, 1.8758f, 0.0415f}, {0.0557f, -0.2040f, 1.0570f}}};

struct Columns {
  Column<float> X, Y, Z, r, g, b;
};

Columns matched(size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(-2, 100);
  Columns c;
  for (size_t i = 0; i < count; ++i) {
    c.X.push_back(value(random));
    c.Y.push_back(value(random));
    c.Z.push_back(value(random));
  }
  colour_match(xyz_to_srgb, c.X, c.Y, c.Z, c.r, c.g, c.b);
  return c;
}

TEST(ColourMatch, AgreesWithDoublesWithinTheStatedErrorOnEveryInstructionSet) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const Columns c = matched(1003);
    for (size_t i = 0; i < 1003; ++i) {
      const float result[3] = {c.r[i], c.g[i], c.b[i]};
      for (int row = 0; row < 3; ++row) {
        const double terms[3] = {double{xyz_to_srgb[row][0]} * c.X[i], double{xyz_to_srgb[row][1]} * c.Y[i],
                                 double{xyz_to_srgb[row][2]} * c.Z[i]};
        const double size = std::fabs(terms[0]) + std::fabs(terms[1]) + std::fabs(terms[2]);
        ASSERT_NEAR(result[row], terms[0] + terms[1] + terms[2], 3 * 0x1p-24 * size) << hwy::TargetName(target);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(ColourMatch, GivesTheSameBitsOnEveryInstructionSet) {
  const Columns first = matched(517);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const Columns c = matched(517);
    EXPECT_EQ(std::memcmp(c.r.data(), first.r.data(), 517 * sizeof(float)), 0) << hwy::TargetName(target);
    EXPECT_EQ(std::memcmp(c.g.data(), first.g.data(), 517 * sizeof(float)), 0) << hwy::TargetName(target);
    EXPECT_EQ(std::memcmp(c.b.data(), first.b.data(), 517 * sizeof(float)), 0) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(ColourMatch, KeepsColoursOutsideTheGamutNegative) {
  Columns c;
  c.X.push_back(0.0763f);  // a saturated cyan: the spectral locus at 500 nm has x = 0.0082, y = 0.5384
  c.Y.push_back(5.0f);
  c.Z.push_back(4.21f);
  colour_match(xyz_to_srgb, c.X, c.Y, c.Z, c.r, c.g, c.b);
  EXPECT_LT(c.r[0], -5);
  EXPECT_GT(c.g[0], 5);
}

TEST(ColourMatch, MakesTheWhiteOfSrgbOneOneOne) {
  Columns c;
  c.X.push_back(0.9505f);
  c.Y.push_back(1.0f);
  c.Z.push_back(1.0890f);
  colour_match(xyz_to_srgb, c.X, c.Y, c.Z, c.r, c.g, c.b);
  EXPECT_NEAR(c.r[0], 1, 2e-4);  // the standard rounds its matrix to four digits
  EXPECT_NEAR(c.g[0], 1, 2e-4);
  EXPECT_NEAR(c.b[0], 1, 2e-4);
}

}  // namespace
}  // namespace metamer
