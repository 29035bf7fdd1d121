// Every scene there is, converted: the same pixels to the last bit.
#include "scenes/library.h"
#include "tests/scenes/native/converted.h"

namespace metamer {
namespace {

namespace fs = std::filesystem;

const fs::path source_folder = METAMER_SOURCE_DIR;

std::vector<fs::path> files_below(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> paths;
  if (!fs::exists(folder)) return paths;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ending) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string test_name(const testing::TestParamInfo<fs::path>& each) {
  std::string name = fs::relative(each.param, source_folder).string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

class LibraryScene : public testing::TestWithParam<fs::path> {};

TEST_P(LibraryScene, ShowsTheSamePixelsConverted) {
  Scene scene;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_scene(GetParam().string(), scene, diagnostics)) << format_diagnostics(diagnostics);
  expect_converts(scene);
}

INSTANTIATE_TEST_SUITE_P(Convert, LibraryScene,
                         testing::ValuesIn(files_below(source_folder / "scenes/library", ".json")), test_name);

// The files of the readers' tests; those that fuzzing found (tests/fuzz) mostly cannot be read.
class CorpusScene : public testing::TestWithParam<fs::path> {};

TEST_P(CorpusScene, ShowsTheSamePixelsConverted) {
  Scene scene;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_scene(GetParam().string(), scene, diagnostics)) << format_diagnostics(diagnostics);
  expect_converts(scene);
}

std::vector<fs::path> corpus() {
  std::vector<fs::path> paths = files_below(source_folder / "tests/scenes", ".pbrt");
  paths.push_back(source_folder / "tests/scenes/native/every_key.json");
  return paths;
}
INSTANTIATE_TEST_SUITE_P(Convert, CorpusScene, testing::ValuesIn(corpus()), test_name);

TEST(Convert, SharedScenesShowTheSamePixels) {
  const fs::path shared = source_folder / "../shared/scenes";
  if (!fs::exists(shared)) GTEST_SKIP() << "no " << shared;
  for (const fs::directory_entry& entry : fs::directory_iterator(shared)) {
    const fs::path path = entry.path() / "scene.pbrt";
    if (!fs::exists(path)) continue;
    SCOPED_TRACE(path.string());
    Scene scene;
    Diagnostics diagnostics;
    ASSERT_TRUE(read_scene(path.string(), scene, diagnostics)) << format_diagnostics(diagnostics);
    expect_converts(scene);
  }
}

}  // namespace
}  // namespace metamer
