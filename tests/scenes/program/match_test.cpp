// metamer match and metamer metamers as their users see them.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::HasSubstr;

using MatchCommand = ProgramTest;

// The amount printed for the lamp of this name.
double printed_amount(const std::string& out, const std::string& lamp) {
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);)
    if (const size_t at = line.find("nm  " + lamp); at != std::string::npos) {
      std::istringstream rest(line.substr(at + 4 + lamp.size()));
      double amount = 0;
      rest >> amount;
      return amount;
    }
  ADD_FAILURE() << lamp << " in " << out;
  return 0;
}

TEST_F(MatchCommand, Of500NmAddsRedToTheOtherSide) {
  const ProgramResult result = run({"match", "500"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(printed_amount(result.out, "red"), -0.295);
  EXPECT_EQ(printed_amount(result.out, "green"), 0.4906);
  EXPECT_EQ(printed_amount(result.out, "blue"), 0.10749);
  EXPECT_THAT(result.out, HasSubstr("-0.295  negative: added to the other side"));
  EXPECT_EQ(run({"match", "500nm"}).out, result.out);
  EXPECT_EQ(run({"match", "500 NM"}).out, result.out);
  EXPECT_LT(printed_amount(run({"match", "500", "--observer", "cie1931"}).out, "red"), -0.2);
}

TEST_F(MatchCommand, OfAFileIsLinearInItsValues) {
  folder_.write("a.csv", "# a lamp\nnm,value\n500,1\n600,3\n700,1\n");
  folder_.write("twice.spd", "500\t2\n600\t6\n\n700\t2\n");
  const std::string once = run({"match", "a.csv"}).out, twice = run({"match", "twice.spd"}).out;
  for (const char* lamp : {"red", "green", "blue"})
    EXPECT_NEAR(printed_amount(twice, lamp), 2 * printed_amount(once, lamp),
                1e-3 * std::abs(printed_amount(once, lamp)));
  EXPECT_THAT(once, HasSubstr("dominant wavelength"));
}

TEST_F(MatchCommand, KnowsWhatIsWhite) {
  EXPECT_THAT(run({"match", "E"}).out, HasSubstr("x 0.3333, y 0.3333, white"));
  EXPECT_THAT(run({"match", "colorchecker.red"}).out, HasSubstr("dominant wavelength"));
  folder_.write("grey.csv", "360 0.5\n830 0.5\n");
  EXPECT_THAT(run({"match", "grey.csv", "--under", "A"}).out, HasSubstr("x 0.4476, y 0.4074, white"));
  EXPECT_THAT(run({"match", "colorchecker.magenta", "--under", "D65"}).out, HasSubstr("complementary wavelength"));
}

struct Pixel {
  int r, g, b;
};

class Field {
 public:
  explicit Field(const std::filesystem::path& path) {
    const auto file = OIIO::ImageInput::open(path.string());
    EXPECT_TRUE(file);
    if (!file) return;
    width_ = file->spec().width;
    bytes_.resize(static_cast<size_t>(width_ * file->spec().height * 3));
    EXPECT_TRUE(file->read_image(0, 0, 0, 3, OIIO::TypeUInt8, bytes_.data()));
  }
  Pixel at(int x, int y) const {
    const size_t first = static_cast<size_t>(3 * (y * width_ + x));
    return {bytes_[first], bytes_[first + 1], bytes_[first + 2]};
  }

 private:
  int width_ = 0;
  std::vector<uint8_t> bytes_;
};

TEST_F(MatchCommand, PaintsTwoHalvesAlikeAndTheLampsBelow) {
  ASSERT_EQ(run({"match", "500", "-o", "field.png"}).exit_code, 0);
  const Field field(folder() / "field.png");
  const Pixel left = field.at(180, 150), right = field.at(300, 150), between = field.at(240, 150);
  EXPECT_EQ(left.r, right.r);
  EXPECT_EQ(left.g, right.g);
  EXPECT_EQ(left.b, right.b);
  EXPECT_GT(left.g, 200);  // green and blue mixed
  EXPECT_GT(left.g, left.r + 50);
  EXPECT_EQ(between.g, 0);  // the line between
  const Pixel red_on_the_left = field.at(100, 388), green = field.at(330, 388), blue = field.at(380, 388);
  EXPECT_GT(red_on_the_left.r, red_on_the_left.g + 100);
  EXPECT_GT(green.g, green.r + 100);
  EXPECT_GT(blue.b, blue.g + 100);
  EXPECT_EQ(field.at(280, 388).r, 0);  // no red on the right
}

TEST_F(MatchCommand, RefusesWhatIsNoLight) {
  folder_.write("bad.csv", "500 1\n490 2\n510 x\n520 -1\n530 1 1\n");
  folder_.write("one.csv", "500 1\n");
  folder_.write("micrometres.csv", "0.5 1\n0.6 1\n");
  folder_.write("dark.csv", "500 0\n600 0\n");
  const std::set<std::string> before = names_in(folder());
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{}, "a light was expected"},
      {{"900"}, "900: expected a wavelength from 390 to 730 nm"},
      {{"-5"}, "-5"},
      {{"750"}, "from 390 to 730 nm, where the observer stiles-burch1955 was measured"},
      {{"850", "--observer", "cie1931"}, "from 360 to 830 nm"},
      {{"FL13"}, "unknown spectrum 'FL13' (did you mean 'FL1'?)"},
      {{"colorchecker.redd"}, "did you mean 'colorchecker.red'?"},
      {{"BK7"}, "refractive index"},
      {{"none.csv"}, "none.csv: error: cannot be opened"},
      {{"bad.csv"}, "bad.csv:2: error: wavelengths must ascend"},
      {{"bad.csv"}, "bad.csv:3: error: 'x': expected a number"},
      {{"bad.csv"}, "bad.csv:4: error: '-1'"},
      {{"bad.csv"}, "bad.csv:5: error: 3 values"},
      {{"one.csv"}, "two or more"},
      {{"micrometres.csv"}, "expected nm"},
      {{"dark.csv"}, "holds no light"},
      {{"500", "--under", "A"}, "--under"},
      {{"500", "--observer", "cie1932"}, "did you mean 'cie1931'?"},
      {{"500", "-o", "a.exr"}, "--output"},
      {{"500", "-o", "none/a.png"}, "none/a.png"},
      {{"500", "600"}, "one light at a time"},
  };
  for (const auto& [arguments, words] : cases) {
    Arguments all = {"match"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run(all);
    EXPECT_NE(result.exit_code, 0) << words;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(names_in(folder()), before);
}

using MetamersCommand = ProgramTest;

TEST_F(MetamersCommand, PrintsWhereTheyMatchAndWritesSpectraForAScene) {
  const ProgramResult result = run({"metamers", "colorchecker.light_skin", "-o", "pair.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("D65      cie1931"));
  EXPECT_THAT(result.out, HasSubstr("  0.000\n"));
  const Json::Value spectra = parse_json(bytes("pair.json"))["spectra"];
  ASSERT_EQ(spectra.size(), 2u);
  for (const char* name : {"colorchecker.light_skin 1", "colorchecker.light_skin 2"}) {
    const Json::Value table = spectra[name]["table"];
    ASSERT_EQ(table.size(), 41u);
    EXPECT_EQ(table[0][0].asDouble(), 380);
    EXPECT_EQ(table[40][0].asDouble(), 780);
    for (const Json::Value& row : table) {
      EXPECT_GE(row[1].asDouble(), 0);
      EXPECT_LE(row[1].asDouble(), 1);
    }
  }
}

TEST_F(MetamersCommand, RefusesWhatIsNoReflectance) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{}, "a reflectance was expected"},
      {{"1.5"}, "from 0 to 1"},
      {{"D65"}, "a reflectance, 0 to 1, was expected"},
      {{"0.5", "--same", "D66"}, "unknown spectrum 'D66' (did you mean 'D65'?)"},
      {{"0.5", "--observer", "stiles-burch1955"}, "unknown"},
      {{"0.5", "-o", "none/a.json"}, "none/a.json"}};
  for (const auto& [arguments, words] : cases) {
    Arguments all = {"metamers"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run(all);
    EXPECT_NE(result.exit_code, 0) << words;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
}

}  // namespace
}  // namespace metamer
