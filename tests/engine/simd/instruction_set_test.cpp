#include "engine/simd/instruction_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cfloat>
#include <cstdlib>
#include <thread>

namespace metamer {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

class InstructionSet : public testing::Test {
 protected:
  ~InstructionSet() override {
    unsetenv("METAMER_ISA");
    apply_isa("native");
  }
};

TEST_F(InstructionSet, EveryAvailableOneCanBeChosenInAnyOrder) {
  std::vector<std::string_view> names = available_isa_names();
  ASSERT_FALSE(names.empty());
  names.insert(names.end(), names.rbegin(), names.rend());
  for (const std::string_view name : names) {
    EXPECT_EQ(apply_isa(name), "");
    EXPECT_EQ(chosen_isa_name(), name);
    EXPECT_THAT(compiled_isa_names(), Contains(name));
  }
  EXPECT_EQ(available_isa_names().size() * 2, names.size());
}

TEST_F(InstructionSet, NativeIsTheBestAvailable) {
  EXPECT_EQ(apply_isa("native"), "");
  EXPECT_EQ(chosen_isa_name(), available_isa_names().back());
}

#if HWY_ARCH_X86
TEST_F(InstructionSet, OnX86ThreeAreCompiledAndEmbreeKnowsEach) {
  EXPECT_THAT(compiled_isa_names(), testing::ElementsAre("sse4", "avx2", "avx512"));
  EXPECT_EQ(apply_isa("sse4"), "");
  EXPECT_EQ(embree_isa_name(), "sse4.2");
  if (apply_isa("avx2").empty()) {
    EXPECT_EQ(embree_isa_name(), "avx2");
  }
  if (apply_isa("avx512").empty()) {
    EXPECT_EQ(embree_isa_name(), "avx512");
  }
}

TEST_F(InstructionSet, TheEnvironmentChoosesAndItsMistakesNameTheNearestWord) {
  setenv("METAMER_ISA", "sse4", 1);
  EXPECT_EQ(apply_isa_environment(), "");
  EXPECT_EQ(chosen_isa_name(), "sse4");
  setenv("METAMER_ISA", "sse5", 1);
  EXPECT_THAT(apply_isa_environment(), AllOf(HasSubstr("METAMER_ISA"), HasSubstr("'sse5'"), HasSubstr("'sse4'")));
  EXPECT_EQ(chosen_isa_name(), "sse4") << "an error changes nothing";
  setenv("METAMER_ISA", "", 1);
  EXPECT_EQ(apply_isa_environment(), "");
  EXPECT_EQ(chosen_isa_name(), available_isa_names().back());
}
#endif

TEST_F(InstructionSet, FlushDenormalsActsOnItsThreadAndEndsWithItsScope) {
  volatile float smallest = FLT_MIN;
  volatile float subnormal = FLT_MIN / 4;
  {
    const FlushDenormals flush;
    EXPECT_EQ(smallest / 4, 0.0f) << "results";
    EXPECT_EQ(subnormal * 8, 0.0f) << "operands";
  }
  EXPECT_GT(smallest / 4, 0.0f);
  std::thread([&] {
    const FlushDenormals flush;
    EXPECT_EQ(smallest / 4, 0.0f);
  }).join();
  EXPECT_GT(smallest / 4, 0.0f);
}

}  // namespace
}  // namespace metamer
