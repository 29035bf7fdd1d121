// Usage: what is refused, with which words, and that nothing is left behind.
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

using CommandLine = ProgramTest;

struct BadValue {
  Arguments arguments;
  std::string words;
};

TEST_F(CommandLine, RefusesBadValuesWithOneLineEachAndExit2) {
  const std::vector<BadValue> cases = {
      {{"--size", "0x0"}, "--size: a frame of 0x0 has no pixels"},
      {{"--size", "12"}, "--size: expected WIDTHxHEIGHT in pixels, such as 640x360, not '12'"},
      {{"--size", "-3"}, "not '-3'"},
      {{"--size", "-3x4"}, "not '-3x4'"},
      {{"--size", "abc"}, "not 'abc'"},
      {{"--size", "4x4x4"}, "not '4x4x4'"},
      {{"--size", ""}, "--size: expected WIDTHxHEIGHT"},
      {{"--size", "1e9x1e9"}, "not '1e9x1e9'"},
      {{"--size", "99999999999x99999999999"}, "is too large"},
      {{"--size", "2000000x1"}, "too large"},
      {{"--size", "1000000x1000000"}, "does not fit in memory"},
      {{"--spp", "0"}, "--spp: expected a whole number from 1 to 4194304, not '0'"},
      {{"--spp", "1.5"}, "not '1.5'"},
      {{"--spp", "0x10"}, "not '0x10'"},
      {{"--spp", "4194305"}, "not '4194305'"},
      {{"--threads", "0"}, "--threads: expected a whole number from 1 to 1024, not '0'"},
      {{"--threads", "1000000"}, "--threads"},
      {{"--tile", "0"}, "--tile: expected a whole number"},
      {{"--seed", "-1"}, "--seed: expected a whole number from 0 to 4294967295, not '-1'"},
      {{"--max-depth", "-1"}, "--max-depth: expected a whole number"},
      {{"--integrator", "recusive"},
       "--integrator: unknown name 'recusive' (did you mean 'recursive'?); there are local, recursive, path"},
      {{"--integrator", ""}, "--integrator: unknown name ''"},
      {{"--integrator"}, "--integrator: a value was expected after it"},
      {{"--color", "lamp"}, "--color: unknown name 'lamp' (did you mean 'lamps'?)"},
      {{"--exposure", "nan"}, "--exposure: expected a number from -100 to 100 or auto, not 'nan'"},
      {{"--exposure", "inf"}, "not 'inf'"},
      {{"--exposure", "1e9"}, "not '1e9'"},
      {{"--spp"}, "--spp: a value was expected after it"},
      {{"--sppp", "3"}, "unknown flag '--sppp' (did you mean '--spp'?)"},
      {{"--treads=3"}, "unknown flag '--treads' (did you mean '--threads'?)"},
      {{"-z"}, "unknown flag '-z'"},
      {{"other.json"}, "unexpected argument 'other.json': one scene at a time, and 'small.json' was named already"},
      {{"-o", ""}, "--output: the file's name is empty"},
  };
  for (const BadValue& bad : cases) {
    Arguments arguments = {"render", "small.json"};
    arguments.insert(arguments.end(), bad.arguments.begin(), bad.arguments.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << bad.words;
    EXPECT_THAT(result.err, AllOf(StartsWith("metamer: error: "), HasSubstr(bad.words)));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }
  EXPECT_THAT(names_in(folder()), ElementsAre("small.json"));
}

TEST_F(CommandLine, ReportsAllMistakesInOneGo) {
  const ProgramResult result = run({"render", "small.json", "--spp", "0", "--size", "x", "--sed", "3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--spp: "), HasSubstr("--size: "), HasSubstr("did you mean '--seed'")));
}

TEST_F(CommandLine, KnowsItsCommands) {
  const ProgramResult nothing = run({});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("a command was expected"));
  const ProgramResult typo = run({"rendr", "small.json"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_THAT(typo.err, HasSubstr("unknown command 'rendr' (did you mean 'render'?)"));
  const ProgramResult scene = run({"small.json"});
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_THAT(scene.err, HasSubstr("did you mean 'metamer render small.json'?"));
  EXPECT_EQ(run({"--quiet", "render", "small.json"}).exit_code, 2);
}

TEST_F(CommandLine, HelpHasExamplesAndGoesToStandardOutput) {
  for (const Arguments& arguments : std::vector<Arguments>{
           {"--help"}, {"render", "--help"}, {"info", "--help"}, {"develop", "--help"}, {"render", "-h"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("Examples:\n  metamer "));
  }
  const std::string flags = run({"render", "--help"}).out;
  for (const char* flag :
       {"-o,--output", "--png", "--spp", "--size", "--threads", "--tile", "--seed", "--max-depth", "--exposure",
        "--display", "--white", "--adaptation", "--tonemap", "--stats", "--quiet", "--preview-only"})
    EXPECT_THAT(flags, HasSubstr(flag));
}

TEST_F(CommandLine, VersionNamesLibrariesAndInstructionSets) {
  const ProgramResult result = run({"--version"}, {{"METAMER_ISA", "sse4"}});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, StartsWith("metamer 0."));
  for (const char* library : {"Embree 3.", "oneTBB 20", "OpenEXR 3.", "OpenImageIO 2.", "Highway 1."})
    EXPECT_THAT(result.out, HasSubstr(library));
  EXPECT_THAT(result.out, HasSubstr("instruction sets compiled: "));
  EXPECT_THAT(result.out, EndsWith("instruction set chosen: sse4\n"));
}

TEST_F(CommandLine, RefusesAnUnknownInstructionSet) {
  const ProgramResult result = run({"render", "small.json"}, {{"METAMER_ISA", "axv2"}});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("METAMER_ISA: unknown instruction set 'axv2' (did you mean 'avx2'?)"));
  EXPECT_THAT(names_in(folder()), ElementsAre("small.json"));
}

TEST_F(CommandLine, ReportsStandardOutputThatCannotBeWritten) {
  const std::string command = std::string(METAMER_PROGRAM) + " --version > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

}  // namespace
}  // namespace metamer
