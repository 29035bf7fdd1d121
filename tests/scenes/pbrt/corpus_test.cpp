// Small files, one per directive or kind, that say in their last lines what must come of them:
//   #> 3: sphere radius 2      what the registry holds (registry_text.h), of the shape in line 3
//   #> settings 32 x 24 pixels
//   #! 3: error: ...           a message
#include <fmt/format.h>

#include "tests/scenes/pbrt/read_text.h"
#include "tests/scenes/support/registry_text.h"

namespace metamer {
namespace {

std::vector<std::filesystem::path> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(METAMER_SOURCE_DIR "/tests/scenes/pbrt/corpus"))
    if (entry.path().extension() == ".pbrt") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string expectations(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string text;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("#> ") || line.starts_with("#! ")) text += line + "\n";
  return text;
}

std::string outcome(const std::string& path) {
  const ReadScene read = read_scene_at(path);
  std::string text;
  for (const std::string& line : registry_text(read.scene)) text += "#> " + line + "\n";
  const std::string settings = settings_text(read.scene.settings);
  if (!settings.empty()) text += "#> " + settings + "\n";
  for (const std::string& message : read.messages) text += "#! " + message.substr(message.find(':') + 1) + "\n";
  return text;
}

class PbrtCorpus : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(PbrtCorpus, HoldsWhatItsLastLinesSay) {
  const std::string found = outcome(GetParam().string());
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(expectations(GetParam()), found);
}

INSTANTIATE_TEST_SUITE_P(Files, PbrtCorpus, testing::ValuesIn(corpus()),
                         [](const auto& instance) { return instance.param.stem().string(); });

}  // namespace
}  // namespace metamer
