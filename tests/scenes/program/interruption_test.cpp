// Signals, and what is shown while rendering.
#include <sys/ioctl.h>

#include <array>

#include "engine/files/exr_file.h"
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

using Interruption = ProgramTest;

const Arguments endless = {"render", "small.json", "--spp", "4000000", "--stats", "stats.json"};

TEST_F(Interruption, WritesWhatWasRenderedSoFar) {
  RunningProgram program(endless, folder());
  ASSERT_TRUE(wait_until([&] { return program.err_so_far().find("samples/s") != std::string::npos; }));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("metamer: interrupted with "), HasSubstr(" of 4000000 samples per pixel")));
  EXPECT_THAT(result.out, HasSubstr("small.exr"));
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "small.exr", "small.png", "stats.json"));

  Film film;
  FrameHeader header;
  ASSERT_EQ(read_film((folder() / "small.exr").string(), film, header), std::nullopt);
  const SampleTotals samples = sample_totals(film);
  EXPECT_GE(samples.fewest, 1u);
  EXPECT_LT(samples.fewest, 4000000u);
  EXPECT_LE(samples.most, 4 * samples.fewest) << "passes cover the whole frame before the next begins";
  const Json::Value stats = parse_json(bytes("stats.json"));
  EXPECT_TRUE(stats["interrupted"].asBool());
  EXPECT_EQ(stats["samples"].asUInt64(), samples.total);
  EXPECT_EQ(stats["fewest_samples_per_pixel"].asUInt64(), samples.fewest);
}

TEST_F(Interruption, TerminationIsTreatedAlikeAndQuietStillSaysIt) {
  RunningProgram program({"render", "small.json", "--spp", "4000000", "--quiet"}, folder());
  ASSERT_TRUE(wait_until([&] { return program.catches(SIGTERM); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  program.send(SIGTERM);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("interrupted"));
  EXPECT_EQ(result.out, "");
}

TEST_F(Interruption, ASecondSignalStopsAtOnceAndLeavesNoFile) {
  // One tile of a million pixels: it takes long to finish what was begun.
  RunningProgram program({"render", "small.json", "--spp", "4000000", "--size", "1024x1024", "--tile", "1024"},
                         folder());
  ASSERT_TRUE(wait_until([&] { return program.err_so_far().find("%") != std::string::npos; }));
  program.send(SIGINT);
  program.send(SIGTERM);  // a second SIGINT might be merged with the first
  const ProgramResult result = program.wait();
  EXPECT_THAT(result.exit_code, AnyOf(128 + SIGTERM, 128 + SIGINT));
  EXPECT_THAT(result.err, HasSubstr("stopped at once"));
  EXPECT_THAT(names_in(folder()), ElementsAre("small.json"));
}

TEST_F(Interruption, BeforeTheFirstPixelNothingIsWritten) {
  // Many entities, so that reading takes a while.
  std::string scene(small_scene);
  std::string many;
  for (int i = 0; i < 40000; ++i) many += R"({"transform": {"translate": [0, 1, 2]}, "geometry": {"type": "sphere"}},)";
  scene.insert(scene.find("\"entities\": [") + 13, many);
  folder_.write("many.json", scene);
  RunningProgram program({"render", "many.json", "--spp", "4000000"}, folder());
  while (!program.catches(SIGHUP)) std::this_thread::yield();
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("interrupted before the first pixel; nothing was written"));
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "many.json"));
}

// A terminal of so many columns; what is printed on it can be read.
class Terminal {
 public:
  explicit Terminal(unsigned short columns) : master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    slave_ = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
    const winsize size = {24, columns, 0, 0};
    ::ioctl(slave_, TIOCSWINSZ, &size);
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    ::close(slave_);
    ::close(master_);
  }
  int slave() const { return slave_; }
  const std::string& read() {
    char buffer[4096];
    for (ssize_t n = 0; (n = ::read(master_, buffer, sizeof buffer)) > 0;) text_.append(buffer, static_cast<size_t>(n));
    return text_;
  }

 private:
  int master_ = -1, slave_ = -1;
  std::string text_;
};

TEST_F(Interruption, ATerminalShowsABarThatFitsItsWidth) {
  for (const unsigned short columns : std::array<unsigned short, 2>{30, 100}) {
    Terminal terminal(columns);
    ASSERT_GE(terminal.slave(), 0);
    RunningProgram program(endless, folder(), {{"TERM", "xterm"}}, terminal.slave());
    const auto redraws = [&] {
      const std::string& text = terminal.read();
      return std::count(text.begin(), text.end(), '\r');
    };
    ASSERT_TRUE(wait_until([&] { return redraws() >= 4; }));
    program.send(SIGINT);
    EXPECT_EQ(program.wait().exit_code, 1);
    const std::string text = terminal.read();
    EXPECT_THAT(text, AllOf(HasSubstr("\r["), HasSubstr(" %"), HasSubstr("\033[K")));
    EXPECT_EQ(text.find("samples/s") < text.find("interrupted"), columns == 100);
    const std::string bars = text.substr(0, text.find("metamer: "));
    for (size_t at = bars.find('\r'); at != std::string::npos; at = bars.find('\r', at + 1)) {
      const size_t end = std::min(bars.find('\033', at), bars.size());
      EXPECT_LT(end - at - 1, columns) << bars.substr(at + 1, end - at - 1);
    }
  }
}

TEST_F(Interruption, AllThreadsThatWereAskedForWork) {
  RunningProgram program({"render", "small.json", "--spp", "4000000", "--threads", "3", "-q"}, folder());
  EXPECT_TRUE(wait_until([&] { return program.threads_at_work() >= 3; }));
}

TEST_F(Interruption, ALogGetsPlainLines) {
  RunningProgram program(endless, folder());
  ASSERT_TRUE(wait_until([&] { return program.err_so_far().find("samples/s") != std::string::npos; }));
  program.send(SIGINT);
  EXPECT_THAT(program.wait().err, AllOf(HasSubstr(" left, "), Not(HasSubstr("\r")), Not(HasSubstr("\033"))));
}

}  // namespace
}  // namespace metamer
