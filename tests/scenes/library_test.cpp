// The scenes we ship, as they are in the source tree.
#include "scenes/library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scenes/read_scene.h"
#include "systems/freeze.h"
#include "systems/render.h"
#include "systems/write_frame.h"

namespace metamer {
namespace {

namespace fs = std::filesystem;

const fs::path source_folder = METAMER_SOURCE_DIR;

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(source_folder / "scenes/library"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

// XYZ in the columns r, g, b; fails the test if anything was to be said about the scene or a sample was refused.
Picture render_small(const std::string& name, uint32_t width, uint32_t height, uint32_t samples_per_pixel) {
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene(shipped_scene(name + ".json"), scene, diagnostics)) << format_diagnostics(diagnostics);
  scene.settings.width = width;
  scene.settings.height = height;
  scene.settings.samples_per_pixel = samples_per_pixel;
  const std::unique_ptr<World> world = freeze(scene, diagnostics);
  EXPECT_TRUE(diagnostics.all().empty()) << format_diagnostics(diagnostics);
  Film film(width, height);
  if (world != nullptr) {
    const Cancellation cancellation;
    RenderProgress progress;
    EXPECT_EQ(render(*world, {}, cancellation, progress, film).counters.invalid_samples, 0u);
  }
  return develop(observe(film, Observer::cie1931, 0), ColourMatrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, IsReadWithoutRemarksAndShowsLight) {
  const Picture xyz = render_small(GetParam(), 32, 32, 2);
  double luminance = 0;
  for (size_t i = 0; i < xyz.pixel_count(); ++i) luminance += double{xyz.g[i]} / double(xyz.pixel_count());
  // A picture for a screen whose white is 1: neither black nor burnt out.
  EXPECT_GT(luminance, 0.02);
  EXPECT_LT(luminance, 1.5);
}

TEST_P(ShippedScene, IsSmallAndShownInTheDocumentation) {
  EXPECT_LT(fs::file_size(shipped_scene(GetParam() + ".json")), 20'000u);
  const fs::path picture = source_folder / "docs/pictures" / (GetParam() + ".png");
  ASSERT_TRUE(fs::exists(picture)) << picture;
  EXPECT_LT(fs::file_size(picture), 150'000u);
  std::ifstream page(source_folder / "docs/scenes.md");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  EXPECT_NE(text.find("pictures/" + GetParam() + ".png"), std::string::npos);
  EXPECT_NE(text.find(GetParam() + ".json"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Library, ShippedScene, testing::ValuesIn(shipped_names()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Library, HasTheDefaultScene) {
  EXPECT_TRUE(fs::exists(shipped_scene(default_scene_name))) << shipped_scene(default_scene_name);
}

// The lamps stand on the right, so the image that is deviated most is the leftmost: Z (blue) lies left of Y, Y of X.
TEST(Library, PrismDeviatesShortWavelengthsMost) {
  const uint32_t size = 90;
  const Picture xyz = render_small("prism", size, size, 64);
  const Column<float>* channels[3] = {&xyz.r, &xyz.g, &xyz.b};
  double weight[3] = {}, moment[3] = {};
  // The spectra's part of the left face.
  for (uint32_t y = size * 22 / 100; y < size * 60 / 100; ++y)
    for (uint32_t x = size * 22 / 100; x < size * 50 / 100; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const double value = (*channels[c])[size_t{y} * size + x];
        weight[c] += value;
        moment[c] += value * x;
      }
  const double centre_x = moment[0] / weight[0], centre_y = moment[1] / weight[1], centre_z = moment[2] / weight[2];
  // Pixels; the spectrum is about 18 wide.
  EXPECT_LT(centre_z, centre_y - 3);
  EXPECT_LT(centre_y, centre_x - 0.3);
}

// The four lamps' centres in the picture: 1, 2 and 4 m away and 2 m turned.
TEST(Library, LampsAreEquallyBrightAtAnyDistance) {
  const uint32_t width = 240, height = 100;
  const Picture xyz = render_small("radiance-and-distance", width, height, 16);
  const double half = std::tan(17 * 3.14159265358979 / 180);  // of the shorter side, at a distance of 1
  for (const auto& [x, z] : {std::pair{-0.47, 1.0}, {-0.2, 2.0}, {0.6, 4.0}, {0.9, 2.0}}) {
    const double column = width / 2.0 + x / z / half * height / 2, row = height / 2.0 + 0.05 / z / half * height / 2;
    const size_t pixel = static_cast<size_t>(row) * width + static_cast<size_t>(column);
    EXPECT_NEAR(xyz.g[pixel], 0.8, 0.008) << x;
  }
}

}  // namespace
}  // namespace metamer
