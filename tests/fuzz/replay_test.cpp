// The kept corpora: hand-written files for every directive and kind, what once broke a reader, and what libFuzzer found
// to take new ways through them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/targets.h"

namespace metamer {
namespace {

class FuzzCorpus : public testing::TestWithParam<fuzz::Target> {};

void PrintTo(const fuzz::Target& target, std::ostream* out) { *out << target.name; }

TEST_P(FuzzCorpus, IsReadWithoutACrash) {
  const auto folder = std::filesystem::path(METAMER_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    SCOPED_TRACE(entry.path());
    GetParam().read(bytes);
    ++count;
  }
  EXPECT_GT(count, 0u) << folder;
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(fuzz::targets),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace metamer
