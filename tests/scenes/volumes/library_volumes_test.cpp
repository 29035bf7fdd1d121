#include "scenes/volumes/library_volumes.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/library.h"
#include "scenes/volumes/read_grids.h"
#include "scenes/volumes/write_vdb.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

GridRequest read(const std::string& path, const std::string& name) {
  GridRequest request{path, name};
  Diagnostics diagnostics;
  read_grids({&request, 1}, diagnostics);
  EXPECT_TRUE(request.found) << format_diagnostics(diagnostics);
  return request;
}

// The files we ship are what the formulas say, to the last bit of their halves; so small that they can be shipped.
void expect_shipped(const std::string& file, std::span<const NamedGrid> grids) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / file).string();
  ASSERT_FALSE(write_vdb(path, grids));
  EXPECT_LT(std::filesystem::file_size(shipped_scene(file)), 600'000u);
  for (const NamedGrid& grid : grids) {
    const GridRequest made = read(path, grid.name), shipped = read(shipped_scene(file), grid.name);
    EXPECT_EQ(made.grid.origins, shipped.grid.origins);
    EXPECT_TRUE(made.grid.values == shipped.grid.values) << file << ": run make_volumes again";
    EXPECT_EQ(made.grid.index_to_local, shipped.grid.index_to_local);
    EXPECT_GT(made.grid.origins.size(), 50u);
  }
}

TEST(LibraryVolumes, AreTheFilesWeShip) {
  const Grid cloud = cloud_volume(), plume = plume_volume();
  const FlameVolume flame = flame_volume();
  const NamedGrid clouds[] = {{"density", &cloud, true}}, plumes[] = {{"density", &plume, true}};
  const NamedGrid flames[] = {{"density", &flame.density, true}, {"temperature", &flame.temperature, true}};
  expect_shipped("cloud.vdb", clouds);
  expect_shipped("plume.vdb", plumes);
  expect_shipped("flame.vdb", flames);
}

TEST(LibraryVolumes, AreWithinTheBoundsTheyState) {
  for (const Grid& grid : {cloud_volume(), plume_volume(), flame_volume().density}) {
    for (const float x : grid.values) ASSERT_TRUE(x >= 0 && x <= 1) << x;
  }
  for (const float kelvin : flame_volume().temperature.values) ASSERT_TRUE(kelvin >= 0 && kelvin <= 1950) << kelvin;
}

}  // namespace
}  // namespace metamer
