// Media of grids in the native format.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scenes/native/read_native.h"
#include "scenes/volumes/write_vdb.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::HasSubstr;

// A folder with smoke.vdb: density, 1.5 in 4x4x4 voxels of half a unit from (1, 1, 1) on, and color, the same in red.
struct GridScene {
  TemporaryFolder folder;
  Scene scene;
  Diagnostics diagnostics;
  bool ok = false;

  explicit GridScene(const std::string& media, const std::string& units = "m") {
    Grid density, color;
    density.index_to_local = {{0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 0.5, 0}, {1.25, 1.25, 1.25, 1}};
    color.channels = 3;
    set_dense_values(density, glm::ivec3(4), std::vector<float>(64, 1.5f));
    std::vector<float> red;
    for (int i = 0; i < 64; ++i) red.insert(red.end(), {1, 0.25f, 0});
    set_dense_values(color, glm::ivec3(4), red);
    const NamedGrid grids[] = {{"density", &density}, {"color", &color}};
    EXPECT_FALSE(write_vdb((folder.path() / "smoke.vdb").string(), grids));
    const std::string path = folder.write(
        "scene.json",
        fmt::format("{{\"metamer\": 1, \"units\": \"{}\", \"entities\": [],\n\"media\": {{\n{}}}}}", units, media));
    ok = read_native(path, scene, diagnostics);
  }
  std::string messages() const { return format_diagnostics(diagnostics); }
  MediumGrid grids(uint32_t row = 0) const { return scene.registry.table<MediumGrid>().get(row); }
  Medium medium(uint32_t row = 0) const { return scene.registry.table<Medium>().get(row); }
  double value(SpectrumId id, double lambda_nm = 550) const { return scene.spectra.value(id, lambda_nm); }
};

const std::string density = "\"density\": {\"file\": \"smoke.vdb\", \"grid\": \"density\"}";

TEST(NativeGrids, AFileOfGridsIsReadInUnitsOfTheScene) {
  const GridScene cm("\"a\": {\"type\": \"grid\", \"sigma_s\": 3, " + density + "}", "cm");
  ASSERT_TRUE(cm.ok) << cm.messages();
  const Grid& grid = cm.scene.grids[cm.grids().density];
  EXPECT_EQ(grid_value(grid, {3, 0, 2}).x, 1.5f);
  EXPECT_NEAR(grid.index_to_local[0].x, 0.005, 1e-15);
  EXPECT_NEAR(grid.index_to_local[3].z, 0.0125, 1e-15);
  EXPECT_EQ(cm.medium().scale, 100.0f);
  // From a voxel before the centre of the first to a voxel behind that of the last.
  for (int i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(cm.grids().lower[i], 0.0075f);
    EXPECT_FLOAT_EQ(cm.grids().upper[i], 0.0325f);
  }
  EXPECT_EQ(cm.grids().lookup, GridLookup::trilinear);
}

TEST(NativeGrids, MediaShareTheGridsOfAFile) {
  const GridScene read("\"a\": {\"type\": \"grid\", \"sigma_s\": 3, " + density +
                       "},\n\"b\": {\"type\": \"grid\", \"sigma_s\": 1, \"lookup\": \"stochastic\", \"transform\": "
                       "{\"translate\": [1, 2, 3]}, \"box\": [[0, 0, 0], [2, 3, 4]], " +
                       density + "}");
  ASSERT_TRUE(read.ok) << read.messages();
  EXPECT_EQ(read.scene.grids.size(), 1u);
  EXPECT_EQ(read.grids(0).density, read.grids(1).density);
  EXPECT_EQ(read.grids(1).lookup, GridLookup::stochastic);
  EXPECT_EQ(read.grids(1).upper, glm::vec3(2, 3, 4));
  const Registry& registry = read.scene.registry;
  EXPECT_EQ(registry.get<Transform>(registry.table<Medium>().owner(1)).row2.w, 3.0f);
  EXPECT_FALSE(registry.has<Transform>(registry.table<Medium>().owner(0)));
}

TEST(NativeGrids, ColorsAndTemperaturesHaveTheirHandles) {
  const GridScene read(
      "\"a\": {\"type\": \"grid\", \"sigma_s_grid\": {\"file\": \"smoke.vdb\", \"grid\": \"color\", \"space\": "
      "\"rec2020\"},\n"
      "\"sigma_a_grid\": {\"file\": \"smoke.vdb\", \"grid\": \"color\"}, \"sigma_a\": 0.5,\n"
      "\"temperature\": {\"file\": \"smoke.vdb\", \"grid\": \"density\", \"offset\": -2, \"scale\": 500, "
      "\"normalized\": true}}");
  ASSERT_TRUE(read.ok) << read.messages();
  const MediumGrid grids = read.grids();
  EXPECT_EQ(read.scene.grids.size(), 3u);
  EXPECT_EQ(read.scene.grids[grids.sigma_s].color_space, ColorSpace::rec2020);
  EXPECT_EQ(read.scene.grids[grids.sigma_a].color_space, ColorSpace::srgb);
  EXPECT_EQ(grid_value(read.scene.grids[grids.sigma_a], {1, 1, 1}), glm::vec3(1, 0.25f, 0));
  EXPECT_EQ(read.value(read.medium().sigma_s), 1) << "where only the grid is given";
  EXPECT_EQ(read.value(read.medium().sigma_a), 0.5);
  EXPECT_EQ(grids.temperature_offset, -2.0f);
  EXPECT_EQ(grids.temperature_scale, 500.0f);
  EXPECT_EQ(grids.blackbody, BlackbodyUnit::peak);
}

TEST(NativeGrids, AlbedoAndExtinctionAreScatteringAndAbsorption) {
  const GridScene read(
      "\"a\": {\"type\": \"homogeneous\", \"albedo\": 0.75, \"sigma_t\": 8},\n"
      "\"b\": {\"type\": \"homogeneous\", \"albedo\": {\"table\": [[400, 0.2], [700, 0.8]]},\n"
      "\"sigma_t\": {\"table\": [[400, 10], [700, 20]]}}");
  ASSERT_TRUE(read.ok) << read.messages();
  EXPECT_NEAR(read.value(read.medium(0).sigma_s), 6, 1e-6);
  EXPECT_NEAR(read.value(read.medium(0).sigma_a), 2, 1e-6);
  for (const double lambda_nm : {400, 550, 700}) {
    const double albedo = 0.2 + 0.6 * (lambda_nm - 400) / 300, sigma_t = 10 + 10 * (lambda_nm - 400) / 300;
    EXPECT_NEAR(read.value(read.medium(1).sigma_s, lambda_nm), albedo * sigma_t, 1e-4);
    EXPECT_NEAR(read.value(read.medium(1).sigma_a, lambda_nm), (1 - albedo) * sigma_t, 1e-4);
  }
}

TEST(NativeGrids, NoiseFillsItsBoxAndFades) {
  const GridScene read(
      "\"a\": {\"type\": \"grid\", \"sigma_s\": 1, \"density\": {\"noise\": {\"box\": [[-1, -2, 0], [1, 2, 1]], "
      "\"resolution\": 32, "
      "\"falloff\": 0.3, \"frequency\": 3, \"seed\": 5}}},\n"
      "\"b\": {\"type\": \"grid\", \"sigma_s\": 1, \"density\": {\"noise\": {\"resolution\": 16, \"bias\": 9}}},\n"
      "\"c\": {\"type\": \"grid\", \"sigma_s\": 1, \"density\": {\"noise\": {\"resolution\": 16, \"bias\": 9, "
      "\"seed\": 1}}}");
  ASSERT_TRUE(read.ok) << read.messages();
  const Grid& cloud = read.scene.grids[read.grids().density];
  EXPECT_EQ(cloud.upper, glm::ivec3(16, 32, 8));
  EXPECT_EQ(glm::dvec3(cloud.index_to_local * glm::dvec4(-0.5, -0.5, -0.5, 1)), glm::dvec3(-1, -2, 0));
  EXPECT_EQ(glm::dvec3(cloud.index_to_local * glm::dvec4(15.5, 31.5, 7.5, 1)), glm::dvec3(1, 2, 1));
  EXPECT_EQ(grid_value(cloud, {0, 0, 0}).x, 0.0f) << "beyond the ellipsoid";
  EXPECT_GT(grid_mean(cloud).x, 0.1);
  EXPECT_LT(grid_mean(cloud).x, 0.5);
  const Grid &full = read.scene.grids[read.grids(1).density], &other = read.scene.grids[read.grids(2).density];
  EXPECT_NEAR(grid_mean(full).x, 9, 0.3) << "noise is even around the bias";
  EXPECT_GT(std::abs(grid_value(full, {3, 4, 5}).x - grid_value(other, {3, 4, 5}).x), 1e-4) << "seeds differ";
}

TEST(NativeGrids, AllMistakesAreReportedInOneGo) {
  const GridScene read(R"("a": {"type": "grid", "sigma_s": 1,
 "density": {"file": "smoke.vdb", "grid": "densty"}},
"b": {"type": "grid", "sigma_s": 1,
 "density": {"file": "nothing.vdb"}},
"c": {"type": "grid",
 "density": {"file": "smoke.vdb"}, "lookup": "nearest"},
"d": {"type": "grid", "sigma_s": 1},
"e": {"type": "grid", "albedo": 0.5,
 "density": {"noise": {"octaves": 0, "box": [[0, 0, 0], [1, 0, 1]]}}},
"f": {"type": "grid", "albedo": 0.5, "sigma_t": 1, "sigma_a": 1,
 "density": {"noise": {}, "grid": "density"}},
"g": {"type": "grid", "sigma_s": 1,
 "density": {"grid": "density"},
 "temperature": {"noise": {}}}
)");
  EXPECT_FALSE(read.ok);
  const std::string messages = read.messages();
  for (const char* expected :
       {":4: error: '", "there is no grid 'densty' (did you mean 'density'?) in it; there are: 'density', 'color'",
        ":6: error: cannot", "nothing.vdb",
        ":8: error: 'lookup' is the string \"nearest\"; expected 'trilinear' or 'stochastic'",
        "the file has 2 grids; expected the name of one of them: 'density', 'color'",
        ":9: error: a medium of type 'grid' needs a 'density', a 'sigma_a_grid' or a 'sigma_s_grid'",
        ":10: error: 'albedo' and 'sigma_t' go together only", ":11: error: 'octaves' is the number 0; expected",
        ":11: error: 'box' has its lower corner at 0 and its upper one at 0 along y",
        ":12: error: 'sigma_a' does not go with 'albedo' and 'sigma_t'", ":13: error: 'grid' goes with 'file' only",
        ":16: error: what absorbs nothing emits nothing: 'temperature' needs a 'sigma_a'"})
    EXPECT_THAT(messages, HasSubstr(expected));
}

}  // namespace
}  // namespace metamer
