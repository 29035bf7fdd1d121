#include "scenes/volumes/read_grids.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "scenes/volumes/write_vdb.h"
#include "tests/scenes/support/files.h"
#include "tests/scenes/support/volume_files.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// The test files, made once.
struct VolumeFiles {
  TemporaryFolder folder;
  std::string vdb = (folder.path() / "all.vdb").string();
  VolumeFiles() { write_test_vdb(vdb); }
  std::string nano(const std::string& type, const std::string& codec) {
    const std::string path = (folder.path() / (type + codec + ".nvdb")).string();
    if (!std::filesystem::exists(path)) write_nvdb(vdb, path, type, codec);
    return path;
  }
};
VolumeFiles& files() {
  static VolumeFiles made;
  return made;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

GridRequest read(const std::string& path, const std::string& name, Diagnostics& diagnostics) {
  GridRequest request{path, name, {"scene", 7}};
  read_grids({&request, 1}, diagnostics);
  return request;
}

Grid grid_of(const std::string& path, const std::string& name) {
  Diagnostics diagnostics;
  const GridRequest request = read(path, name, diagnostics);
  EXPECT_TRUE(request.found) << format_diagnostics(diagnostics);
  return request.grid;
}

std::string mistake_of(const std::string& path, const std::string& name) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read(path, name, diagnostics).found) << name;
  EXPECT_EQ(diagnostics.error_count(), 1u) << name;
  return format_diagnostics(diagnostics);
}

void expect_same(const Grid& a, const Grid& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.index_to_local, b.index_to_local);
  EXPECT_EQ(a.origins, b.origins);
  EXPECT_TRUE(a.values == b.values);
}

TEST(ReadGrids, AnOpenVdbGridHasItsValuesTilesAndTransform) {
  const Grid grid = grid_of(files().vdb, "density");
  EXPECT_EQ(grid.channels, 1u);
  EXPECT_EQ(grid.stored_as, "float");
  EXPECT_EQ(grid_value(grid, {4, -3, 2}).x, (28 - 15 + 6) / 64.0f);
  EXPECT_EQ(grid_value(grid, {-9, 0, 0}).x, ((-63) & 511) / 64.0f);
  EXPECT_EQ(grid_value(grid, {9, 9, 9}).x, 0.25f) << "the background";
  EXPECT_EQ(grid_value(grid, {3, 2, 1}).x, 0.5f) << "inactive values are looked up, too";
  EXPECT_EQ(grid_value(grid, {47, 23, -41}).x, 0.75f) << "a tile of 8";
  EXPECT_EQ(grid_value(grid, {-129, 127, 255}).x, 0.125f) << "a tile of 128";
  EXPECT_EQ(grid_value(grid, {-128, 127, 255}).x, 0.25f);
  EXPECT_EQ(grid_value(grid, {48, 16, -48}).x, 0.25f) << "an inactive tile beyond the active voxels does not count";
  EXPECT_EQ(grid.lower, glm::ivec3(-256, -9, -48));
  EXPECT_EQ(grid.upper, glm::ivec3(48, 128, 256));
  for (size_t i = 0; i < grid.origins.size(); ++i) {
    const glm::ivec3 o = grid.origins[i];
    EXPECT_EQ((o.x | o.y | o.z) & 7, 0);
    EXPECT_EQ(find_brick(grid, o + glm::ivec3(7, 0, 7)), i) << "sorted";
  }
  // The columns: images of the axes of an 0.1 by 0.2 by 0.15 grid that was sheared and rotated; moved by the last.
  EXPECT_NEAR(grid.index_to_local[3].x, 3, 1e-12);
  EXPECT_NEAR(grid.index_to_local[3].y, -2, 1e-12);
  EXPECT_NEAR(std::abs(glm::determinant(grid.index_to_local)), 0.1 * 0.2 * 0.15, 1e-12);
}

TEST(ReadGrids, HalvesDoublesAndSharedVoxelsAreTheSame) {
  Grid density = grid_of(files().vdb, "density");
  EXPECT_EQ(grid_of(files().vdb, "half").stored_as, "float, half");
  expect_same(grid_of(files().vdb, "half"), density);
  expect_same(grid_of(files().vdb, "double"), density);
  density.index_to_local = glm::dmat4(1.0);
  expect_same(grid_of(files().vdb, "sharer"), density);
}

TEST(ReadGrids, VectorsHaveThreeChannels) {
  const Grid color = grid_of(files().vdb, "color");
  EXPECT_EQ(color.channels, 3u);
  const float v = (28 - 15 + 6) / 64.0f;
  EXPECT_EQ(grid_value(color, {4, -3, 2}), glm::vec3(v, v / 2, v / 4));
  EXPECT_EQ(grid_value(color, {-129, 127, 255}), glm::vec3(0.125f));
  expect_same(grid_of(files().vdb, "color64"), color);
}

// Whatever is rendered of the one is rendered of the other.
TEST(ReadGrids, ANanoVdbFileIsTheSameAsTheOpenVdbFileItWasMadeFrom) {
  for (const char* codec : {"none", "zip", "blosc"})
    for (const char* name : {"density", "half", "double", "color", "sharer"})
      expect_same(grid_of(files().nano("float", codec), name), grid_of(files().vdb, name));
}

TEST(ReadGrids, QuantisedGridsAreWithinTheirSteps) {
  const Grid exact = grid_of(files().vdb, "density");
  const struct {
    const char *type, *stored_as;
    double step;  // of values between 0 and 8
  } cases[] = {{"Fp4", "Float4", 8 / 15.0},
               {"Fp8", "Float8", 8 / 255.0},
               {"Fp16", "Float16", 8 / 65535.0},
               {"FpN", "FloatN", 0.2}};
  for (const auto& c : cases) {
    const Grid grid = grid_of(files().nano(c.type, "none"), "density");
    EXPECT_EQ(grid.stored_as, c.stored_as);
    double largest = 0;
    for (int z = -9; z <= 9; ++z)
      for (int y = -9; y <= 9; ++y)
        for (int x = -9; x <= 9; ++x)
          largest = std::max(largest, std::abs(double{grid_value(grid, {x, y, z}).x} - grid_value(exact, {x, y, z}).x));
    EXPECT_LE(largest, 0.5001 * c.step + 1e-6) << c.type;
    EXPECT_GT(largest, 0) << c.type;
    EXPECT_EQ(grid_value(grid, {-129, 127, 255}).x, 0.125f) << c.type;
  }
}

TEST(ReadGrids, WhatWasWrittenComesBackWithItsBounds) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "w.vdb").string(), again = (folder.path() / "again.vdb").string();
  Grid dense;
  dense.background = glm::vec3(0);
  dense.index_to_local[0] = {0.1, 0.2, 1 / 3.0, 0};
  std::vector<float> values(17 * 3 * 9, 0.0f);
  values[20] = 2;
  set_dense_values(dense, {17, 3, 9}, values);
  const Grid density = grid_of(files().vdb, "density"), color = grid_of(files().vdb, "color");
  const NamedGrid grids[] = {{"density", &density}, {"color", &color}, {"dense", &dense}};
  ASSERT_FALSE(write_vdb(path, grids));
  ASSERT_FALSE(write_vdb(again, grids));
  expect_same(grid_of(path, "density"), density);
  expect_same(grid_of(path, "color"), color);
  expect_same(grid_of(path, "dense"), dense);
  EXPECT_TRUE(bytes_of(path) == bytes_of(again)) << "equal grids give equal files";
}

TEST(ReadGrids, OfSeveralFilesAreReadTogetherAndReportedInOrder) {
  std::vector<GridRequest> requests;
  for (const char* name : {"nan", "density", "negative", "heat", "color"})
    requests.push_back({files().vdb, name, {"scene", static_cast<uint32_t>(requests.size() + 1)}});
  requests[3].may_be_missing = true;
  Diagnostics diagnostics;
  read_grids(requests, diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 2u);
  EXPECT_EQ(diagnostics.all()[0].line, 1u);
  EXPECT_EQ(diagnostics.all()[1].line, 3u);
  EXPECT_TRUE(requests[1].found && requests[4].found);
  EXPECT_FALSE(requests[0].found || requests[2].found || requests[3].found);
  expect_same(requests[4].grid, grid_of(files().vdb, "color"));
}

TEST(ReadGrids, TheOnlyGridNeedsNoName) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "cube.vdb").string();
  write_cube_vdb(path, "smoke", 10);
  const Grid grid = grid_of(path, "");
  EXPECT_EQ(grid_value(grid, {9, 9, 9}).x, 1.5f);
  EXPECT_EQ(grid.upper, glm::ivec3(10));
  EXPECT_EQ(grid_mean(grid).x, 1.5);
}

TEST(ReadGrids, MistakesAreNamed) {
  const std::string& vdb = files().vdb;
  EXPECT_THAT(
      mistake_of(vdb, ""),
      HasSubstr("the file has 13 grids; expected the name of one of them: 'density', 'half', 'double', 'color', "));
  EXPECT_THAT(
      mistake_of(vdb, "densty"),
      HasSubstr("scene:7: error: '" + vdb +
                "': there is no grid 'densty' (did you mean 'density'?) in it; there are: 'density', 'half', "));
  EXPECT_THAT(mistake_of(vdb, "integer"),
              HasSubstr("grid 'integer': its type is 'Tree_int32_5_4_3'; expected float, double, vec3s or vec3d"));
  EXPECT_THAT(mistake_of(vdb, "frustum"), HasSubstr("its transform is perspective"));
  EXPECT_THAT(mistake_of(vdb, "surface"), HasSubstr("it is a level set"));
  EXPECT_THAT(mistake_of(vdb, "negative"),
              HasSubstr("the value at voxel (1, 2, 3) is -0.5; expected values of at least 0"));
  EXPECT_THAT(mistake_of(vdb, "nan"), HasSubstr("the value at voxel (1, 2, 3) is nan; expected finite values"));
  EXPECT_THAT(mistake_of(vdb, "infinite"), HasSubstr("the value at voxel (1, 2, 3) is inf; expected finite values"));
  EXPECT_THAT(mistake_of(vdb, "huge"), HasSubstr("a tile of 4096x4096x4096 voxels at (4096, 0, 0) is too large: "
                                                 "1.342e+08 bricks of 8x8x8 voxels are 276 GB; the most is"));
  EXPECT_THAT(mistake_of("/nowhere/x.vdb", "a"), HasSubstr("/nowhere/x.vdb"));
  const std::string nano = files().nano("float", "none");
  EXPECT_THAT(mistake_of(nano, "densty"),
              HasSubstr("(did you mean 'density'?) in it; there are: 'color', 'density', "));
  EXPECT_THAT(mistake_of(nano, "integer"), HasSubstr("its type is 'int32'"));
  EXPECT_THAT(mistake_of(nano, "surface"), HasSubstr("it is a level set"));
  EXPECT_THAT(mistake_of(nano, "negative"), HasSubstr("at voxel (1, 2, 3) is -0.5"));
  EXPECT_THAT(mistake_of(nano, "huge"), HasSubstr("is too large"));
  const TemporaryFile text("x.vdb", "not a volume");
  EXPECT_THAT(mistake_of(text.path(), "a"), HasSubstr("expected an OpenVDB or a NanoVDB file"));
  const TemporaryFile empty("x.nvdb", "");
  EXPECT_THAT(mistake_of(empty.path(), "a"), HasSubstr("expected an OpenVDB or a NanoVDB file"));
}

TEST(ReadGrids, TemperaturesMayBeNegative) {
  GridRequest request{files().vdb, "negative", {"scene", 7}, true};
  Diagnostics diagnostics;
  read_grids({&request, 1}, diagnostics);
  EXPECT_TRUE(request.found);
  EXPECT_EQ(grid_value(request.grid, {1, 2, 3}).x, -0.5f);
}

// A file that ends too early is told as such, wherever it ends; one with wrong bits is read or refused, never more.
void expect_no_harm(const std::string& whole, const std::string& name, const std::string& kind) {
  const TemporaryFolder folder;
  for (size_t size = 8; size < whole.size(); size += size < 400 ? 13 : whole.size() / 23) {
    const std::string path = folder.write("cut." + kind, whole.substr(0, size));
    Diagnostics diagnostics;
    const GridRequest request = read(path, name, diagnostics);
    EXPECT_FALSE(request.found) << size;
    EXPECT_EQ(diagnostics.error_count(), 1u) << size;
  }
  uint32_t state = 1;
  size_t refused = 0;
  for (int round = 0; round < 80; ++round) {
    std::string damaged = whole;
    for (int i = 0; i < 1 + round % 3; ++i) {
      state = state * 1664525 + 1013904223;
      // Half of them where the structure is: the first kilobytes.
      const size_t at = (state >> 8) % (round % 2 == 0 ? std::min<size_t>(damaged.size(), 4096) : damaged.size());
      damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(round % 5 == 0 ? 0xff : 1 << (state >> 5 & 7)));
    }
    Diagnostics diagnostics;
    const GridRequest request = read(folder.write("bad." + kind, damaged), name, diagnostics);
    EXPECT_NE(request.found, diagnostics.has_errors());
    refused += diagnostics.has_errors();
  }
  EXPECT_GT(refused, 0u);
}

TEST(ReadGrids, DamagedOpenVdbFilesAreRefused) {
  const TemporaryFolder folder;
  const Grid density = grid_of(files().vdb, "density");
  const std::string path = (folder.path() / "one.vdb").string();
  const NamedGrid grids[] = {{"density", &density}};
  ASSERT_FALSE(write_vdb(path, grids));
  expect_no_harm(bytes_of(path), "density", "vdb");
}

TEST(ReadGrids, DamagedNanoVdbFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string cube = (folder.path() / "c.vdb").string();
  write_cube_vdb(cube, "density", 20);
  const std::string path = (folder.path() / "c.nvdb").string();
  for (const auto& [type, codec] : {std::pair{"float", "none"}, {"FpN", "zip"}, {"Fp8", "blosc"}, {"FpN", "none"}}) {
    write_nvdb(cube, path, type, codec);
    expect_no_harm(bytes_of(path), "density", "nvdb");
  }
}

}  // namespace
}  // namespace metamer
