#include "engine/spectrum/color_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "engine/spectrum/lab.h"

namespace metamer {
namespace {

TEST(ColorDifference, MeetsThePublishedPairs) {
  std::ifstream file(METAMER_SOURCE_DIR "/tests/engine/spectrum/ciede2000_pairs.csv");
  std::string line;
  size_t pairs = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line[0] == 'L') continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream numbers(line);
    Color3 a, b;
    double expected;
    ASSERT_TRUE(numbers >> a[0] >> a[1] >> a[2] >> b[0] >> b[1] >> b[2] >> expected) << line;
    EXPECT_NEAR(delta_e_2000(a, b), expected, 5.1e-5) << line;
    EXPECT_NEAR(delta_e_2000(b, a), expected, 5.1e-5) << line;
    ++pairs;
  }
  EXPECT_EQ(pairs, 34u);
}

TEST(ColorDifference, IsZeroOfEqualColours) {
  for (const Color3& lab : {Color3{0, 0, 0}, {50, 20, -30}, {100, 0, 0}, {300, 1000, -2000}})
    EXPECT_EQ(delta_e_2000(lab, lab), 0);
}

TEST(ColorDifference, XyzOfLabIsTheInverseOfLab) {
  const Color3& white = white_xyz(ColorSpace::srgb);
  for (const Color3& xyz : {Color3{0.3, 0.2, 0.7}, {0.001, 0.002, 0.0001}, {-0.05, 0.1, 0.2}}) {
    const Color3 back = xyz_of_lab(lab_of_xyz(xyz, white), white);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], xyz[c], 1e-12);
  }
}

}  // namespace
}  // namespace metamer
