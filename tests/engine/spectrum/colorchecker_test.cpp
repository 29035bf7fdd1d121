// The ColorChecker's 24 patches, from ../shared/data by a computation of its own: XYZ under D65 and A, and sRGB.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "engine/spectrum/lab.h"
#include "engine/spectrum/metamers.h"
#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  // Straight lines between rows; beyond them the end values, or zero.
  double at(double nm, size_t column, bool keeps_ends) const {
    if (nm < rows.front()[0]) return keeps_ends ? rows.front()[column] : 0.0;
    if (nm > rows.back()[0]) return keeps_ends ? rows.back()[column] : 0.0;
    size_t upper = 1;
    while (upper + 1 < rows.size() && rows[upper][0] < nm) ++upper;
    const double t = (nm - rows[upper - 1][0]) / (rows[upper][0] - rows[upper - 1][0]);
    return (1 - t) * rows[upper - 1][column] + t * rows[upper][column];
  }
};

Table read_shared(const std::string& name) {
  Table table;
  std::ifstream file(METAMER_SOURCE_DIR "/../shared/data/" + name);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    std::vector<std::string> words;
    for (std::string word; std::getline(cells, word, ',');) words.push_back(word);
    if (table.columns.empty()) {
      table.columns = words;
      continue;
    }
    std::vector<double> row;
    for (const std::string& word : words) row.push_back(std::stod(word));
    table.rows.push_back(row);
  }
  return table;
}

class ColorChecker : public testing::Test {
 protected:
  void SetUp() override {
    patches = read_shared("reflectance/colorchecker_ohta.csv");
    if (patches.rows.empty()) GTEST_SKIP() << "../shared is not there";
    observer = read_shared("cmf/cie1931_2deg_xyz.csv");
    lamps[0] = read_shared("illuminant/D65.csv");
    lamps[1] = read_shared("illuminant/A.csv");
  }

  // Y of white is 1. Up to 780 nm, where the tables of the illuminants end: what is beyond adds less than 1e-5, in A.
  Color3 xyz(size_t patch, size_t lamp) const {
    Color3 sum{};
    double white = 0;
    for (int nm = 360; nm <= 780; ++nm) {
      const double light = lamps[lamp].at(nm, 1, false), reflectance = patches.at(nm, patch, true);
      for (size_t c = 0; c < 3; ++c) sum[c] += light * reflectance * observer.at(nm, c + 1, false);
      white += light * observer.at(nm, 2, false);
    }
    for (double& v : sum) v /= white;
    return sum;
  }

  Table patches, observer;
  std::array<Table, 2> lamps;
};

TEST_F(ColorChecker, HasTheXyzOfAnIndependentComputationUnderD65AndA) {
  const char* names[] = {"D65", "A"};
  ASSERT_EQ(patches.columns.size(), 25u);
  for (size_t lamp = 0; lamp < 2; ++lamp)
    for (size_t patch = 1; patch <= 24; ++patch) {
      SCOPED_TRACE(patches.columns[patch] + " under " + names[lamp]);
      const std::optional<Samples> ours = named_spectrum("colorchecker." + patches.columns[patch]);
      ASSERT_TRUE(ours);
      const Color3 seen = seen_xyz(*ours, {*cie_illuminant(names[lamp]), Observer::cie1931});
      const Color3 expected = xyz(patch, lamp);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], 1e-5);
    }
}

// sRGB by IEC 61966-2-1: its matrix is inverted here from the primaries, with D65 as these tables have it.
TEST_F(ColorChecker, HasTheLinearSrgbOfAnIndependentComputation) {
  Color3 white{};
  double level = 0;
  for (int nm = 360; nm <= 780; ++nm)
    for (size_t c = 0; c < 3; ++c) {
      const double v = lamps[0].at(nm, 1, false) * observer.at(nm, c + 1, false);
      white[c] += v;
      if (c == 1) level += v;
    }
  for (double& v : white) v /= level;
  // Solves rgb from xyz = sum of primaries s_i rgb_i by Cramer's rule, s from white = sum of primaries s_i.
  const double p[3][3] = {{0.64, 0.33, 0.03}, {0.30, 0.60, 0.10}, {0.15, 0.06, 0.79}};
  const auto det = [](const double* a, const double* b, const double* c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
  };
  const auto parts = [&](const Color3& v) {
    const double all = det(p[0], p[1], p[2]);
    return Color3{det(v.data(), p[1], p[2]) / all, det(p[0], v.data(), p[2]) / all, det(p[0], p[1], v.data()) / all};
  };
  const Color3 unit = parts(white);
  for (size_t patch = 1; patch <= 24; ++patch) {
    const Samples ours = *named_spectrum("colorchecker." + patches.columns[patch]);
    const Color3 seen =
        multiply(xyz_to_rgb(ColorSpace::srgb), seen_xyz(ours, {*cie_illuminant("D65"), Observer::cie1931}));
    const Color3 amounts = parts(xyz(patch, 0));
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], amounts[c] / unit[c], 1e-5) << patches.columns[patch];
  }
}

// The maker's sRGB codes for the chart (X-Rite, "Colorimetric values for ColorChecker family of targets", as given by
// D. Pascale, "RGB coordinates of the Macbeth ColorChecker", 2006, table 3). Another specimen than Ohta's, and another
// instrument: within 5 units of CIELAB.
TEST(ColorCheckerPublished, SrgbIsMetWithinADifferenceOfFive) {
  const std::vector<std::pair<std::string, std::array<int, 3>>> published = {
      {"dark_skin", {115, 82, 68}},     {"light_skin", {194, 150, 130}},
      {"blue_sky", {98, 122, 157}},     {"foliage", {87, 108, 67}},
      {"blue_flower", {133, 128, 177}}, {"orange", {214, 126, 44}},
      {"purplish_blue", {80, 91, 166}}, {"moderate_red", {193, 90, 99}},
      {"purple", {94, 60, 108}},        {"yellow_green", {157, 188, 64}},
      {"blue", {56, 61, 150}},          {"green", {70, 148, 73}},
      {"red", {175, 54, 60}},           {"yellow", {231, 199, 31}},
      {"magenta", {187, 86, 149}},      {"neutral_5_(.70_D)", {122, 122, 121}}};
  const auto decoded = [](int code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const Color3& white = white_xyz(ColorSpace::srgb);
  double sum = 0;
  for (const auto& [name, codes] : published) {
    const Color3 rgb = {decoded(codes[0]), decoded(codes[1]), decoded(codes[2])};
    const Color3 expected = lab_of_xyz(multiply(rgb_to_xyz(ColorSpace::srgb), rgb), white);
    const Samples patch = *named_spectrum("colorchecker." + name);
    const Color3 seen = lab_of_xyz(seen_xyz(patch, {*cie_illuminant("D65"), Observer::cie1931}), white);
    EXPECT_LT(delta_e_1976(expected, seen), 5.0) << name;
    sum += delta_e_1976(expected, seen);
  }
  EXPECT_LT(sum / static_cast<double>(published.size()), 3.0);
}

}  // namespace
}  // namespace metamer
