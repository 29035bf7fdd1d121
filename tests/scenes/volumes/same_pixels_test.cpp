// One volume in different files gives the same picture, to the last bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/scenes/native/converted.h"
#include "tests/scenes/support/volume_files.h"

namespace metamer {
namespace {

// A cube of smoke in an interface under an even sky.
std::unique_ptr<Film> film_of(const TemporaryFolder& folder, const std::string& file, const std::string& grid) {
  const std::string path = folder.write(
      "scene.json", fmt::format(R"({{"metamer": 1, "media": {{"smoke": {{"type": "grid", "sigma_a": 0.3, "sigma_s": 2,
        "density": {{"file": "{}", "grid": "{}"}}}}}},
        "entities": [{{"camera": {{"type": "perspective"}}, "transform": {{"look_at": {{"from": [4, -3, 8], "to": [3, -2, 0]}}}}}},
        {{"geometry": {{"type": "sphere", "radius": 5}}, "transform": {{"translate": [3, -2, 0]}},
          "material": {{"type": "interface"}}, "media": {{"inside": "smoke"}}}},
        {{"light": {{"type": "environment", "radiance": 1}}}}]}})",
                                file, grid));
  return tiny_film(read_without_remarks(path));
}

TEST(VolumePixels, AreTheSameFromOpenVdbAndNanoVdb) {
  const TemporaryFolder folder;
  const std::string vdb = (folder.path() / "a.vdb").string();
  write_test_vdb(vdb);
  const std::unique_ptr<Film> expected = film_of(folder, "a.vdb", "density");
  ASSERT_NE(expected, nullptr);
  EXPECT_FALSE(*expected == *film_of(folder, "a.vdb", "sharer")) << "another transform is another picture";
  for (const char* codec : {"none", "zip", "blosc"}) {
    write_nvdb(vdb, (folder.path() / "a.nvdb").string(), "float", codec);
    EXPECT_TRUE(*expected == *film_of(folder, "a.nvdb", "density")) << codec;
  }
  EXPECT_TRUE(*expected == *film_of(folder, "a.vdb", "half")) << "its values are halves";
}

}  // namespace
}  // namespace metamer
