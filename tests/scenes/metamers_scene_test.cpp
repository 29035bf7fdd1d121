// scenes/library/metamers.json: its paints in numbers, and in its picture.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/spectrum/metamers.h"
#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"
#include "scenes/library.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"
#include "systems/render.h"
#include "systems/write_frame.h"
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

struct Pair {
  std::string name;
  std::array<Samples, 2> paints;  // square, disc
};

Samples table_of(const Json::Value& spectrum) {
  std::vector<double> lambda_nm, values;
  for (const Json::Value& row : spectrum["table"]) {
    lambda_nm.push_back(row[0].asDouble());
    values.push_back(row[1].asDouble());
  }
  return resample(lambda_nm, values, Extend::constant);
}

std::vector<Pair> pairs_in_the_scene() {
  const Json::Value spectra = parse_json(read_bytes(shipped_scene("metamers.json")))["spectra"];
  EXPECT_EQ(spectra.size(), 8u);
  std::vector<Pair> pairs;
  for (const char* name : {"skin", "leaf", "flower", "grey"})
    pairs.push_back(
        {name, {table_of(spectra[std::string(name) + " square"]), table_of(spectra[std::string(name) + " disc"])}});
  return pairs;
}

TEST(MetamersScene, PaintsMatchInD65ForTheObserverOf1931AndSplitInAAndForThatOf1964) {
  const Viewing same{*cie_illuminant("D65"), Observer::cie1931};
  for (const Pair& pair : pairs_in_the_scene()) {
    SCOPED_TRACE(pair.name);
    const Color3 square = seen_xyz(pair.paints[0], same), disc = seen_xyz(pair.paints[1], same);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(square[c], disc[c], 1e-7);
    EXPECT_LT(seen_difference(pair.paints[0], pair.paints[1], same), 1e-4);
    EXPECT_GT(seen_difference(pair.paints[0], pair.paints[1], {*cie_illuminant("A"), Observer::cie1931}), 10.0);
    EXPECT_GT(seen_difference(pair.paints[0], pair.paints[1], {*cie_illuminant("D65"), Observer::cie1964}), 5.0);
  }
}

TEST(MetamersScene, HoldsWhatTheSolverMakes) {
  const Viewing same{*cie_illuminant("D65"), Observer::cie1931};
  const std::array<Viewing, 2> apart = {Viewing{*cie_illuminant("A"), Observer::cie1931},
                                        Viewing{same.light, Observer::cie1964}};
  const std::vector<Pair> pairs = pairs_in_the_scene();
  const std::array<const char*, 3> bases = {"colorchecker.light_skin", "colorchecker.foliage",
                                            "colorchecker.blue_flower"};
  for (size_t i = 0; i < bases.size(); ++i) {
    const auto curves = make_metamers(*named_spectrum(bases[i]), same, apart);
    for (size_t k = 0; k < 2; ++k)
      for (size_t point = 0; point < metamer_points; ++point)
        EXPECT_NEAR(interpolate(pairs[i].paints[k], metamer_lambda_nm(point)), curves[k][point], 6e-8);
  }
}

// X, Y, Z averaged over a disc in the picture; the places are those of make_metamers.py, in metres on the board.
Color3 mean_around(const Picture& xyz, double x, double y, double inner, double outer) {
  const double pixels_per_metre = xyz.height / (2 * 9 * std::tan(0.5 * 14.2 * M_PI / 180));
  Color3 sum{};
  int count = 0;
  for (uint32_t row = 0; row < xyz.height; ++row)
    for (uint32_t column = 0; column < xyz.width; ++column) {
      const double dx = (column + 0.5 - 0.5 * xyz.width) / pixels_per_metre - x;
      const double dy = (0.5 * xyz.height - row - 0.5) / pixels_per_metre - y;
      const double r = std::max(std::fabs(dx), std::fabs(dy));
      if (r < inner || r > outer) continue;
      const size_t pixel = size_t{row} * xyz.width + column;
      sum = {sum[0] + double{xyz.r[pixel]}, sum[1] + double{xyz.g[pixel]}, sum[2] + double{xyz.b[pixel]}};
      ++count;
    }
  for (double& v : sum) v /= count;
  return sum;
}

TEST(MetamersScene, ShowsNoDiscInDaylightAndOneUnderTheBulb) {
  Scene scene;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_scene(shipped_scene("metamers.json"), scene, diagnostics)) << format_diagnostics(diagnostics);
  scene.settings.width = 256;
  scene.settings.height = 136;
  scene.settings.samples_per_pixel = 64;
  const std::unique_ptr<World> world = freeze(scene, diagnostics);
  ASSERT_TRUE(world);
  Film film(256, 136);
  RenderProgress progress;
  render(*world, {}, Cancellation(), progress, film);
  const Picture xyz = develop(observe(film, Observer::cie1931, 0), ColourMatrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  for (const auto& [px, py] : {std::pair{-0.5, 0.52}, {0.5, 0.52}, {-0.5, -0.52}, {0.5, -0.52}}) {
    const auto differences = [&](double half) {
      const Color3 disc = mean_around(xyz, half + px, py, 0, 0.16),
                   square = mean_around(xyz, half + px, py, 0.31, 0.40);
      double largest = 0;
      for (size_t c = 0; c < 3; ++c) largest = std::max(largest, std::fabs(disc[c] / square[c] - 1));
      return largest;
    };
    EXPECT_LT(differences(-1.05), 0.015) << px << ' ' << py;
    EXPECT_GT(differences(1.05), 0.06) << px << ' ' << py;
  }
}

}  // namespace
}  // namespace metamer
