// What is said about statements that are understood but done otherwise, each with its line.
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

struct Remark {
  const char* statements;  // in front of WorldBegin, from line 2 on
  const char* expected;    // the only message
};

void PrintTo(const Remark& remark, std::ostream* out) { *out << remark.statements; }

class PbrtRemarks : public testing::TestWithParam<Remark> {};

TEST_P(PbrtRemarks, AreMadeAtTheirLine) {
  const bool has_camera = std::string(GetParam().statements).find("Camera") != std::string::npos;
  const ReadScene read = read_text(std::string(has_camera ? "" : "Camera \"perspective\"") + "\n" +
                                   GetParam().statements + "\nWorldBegin");
  EXPECT_THAT(read.messages, testing::ElementsAre(std::string("scene:") + GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Settings, PbrtRemarks,
    testing::ValuesIn(std::vector<Remark>{
        {"\nFilm \"rgb\" \"integer pixelbounds\" [0 9 0 9] \"float cropwindow\" [0 1 0 1]",
         "3: warning: both 'pixelbounds' and 'cropwindow' are given; the former counts"},
        {"Option \"disablewavelengthjitter\" true",
         "2: note: Option \"disablewavelengthjitter\" is not supported; wavelengths are sampled"},
        {"Option \"displacementedgescale\" 2",
         "2: note: Option \"displacementedgescale\" is not supported; displacement is not tessellated by it"},
        {"Option \"msereferenceimage\" \"x.exr\"",
         "2: note: Option \"msereferenceimage\" is not supported; errors are measured with 'metamer compare'"},
        {"Option \"pixelstats\" true",
         "2: note: Option \"pixelstats\" is not supported; costs are measured with --stats"},
        {"Option \"rendercoordsys\" \"world\"",
         "2: note: Option \"rendercoordsys\" is not supported; the coordinates of calculation are always the world's"},
        {"\nCamera \"realistic\" \"string lensfile\" \"x\"",
         "3: warning: Camera \"realistic\" is not supported; a perspective camera of 90 degrees is used: give it the "
         "lens's 'fov' instead"},
        {"\nCamera \"perspectiv\"", "3: error: there is no Camera \"perspectiv\" (did you mean 'perspective'?)"},
        {"Integrator \"path\"\n\"bool regularize\" true",
         "3: warning: Integrator \"path\": 'regularize' is not supported yet; paths are not regularized"},
        {"Integrator \"function\"", "2: warning: Integrator \"function\" is not supported; path tracing is used"},
        {"\nTransformTimes 1 0", "3: error: the motion ends at 0 s but starts at 1 s"},
    }));

TEST(PbrtWorldRemarks, MotionThatHasNoPlaceThereIsSaid) {
  EXPECT_THAT(read_world("TransformTimes 0 1").messages,
              testing::ElementsAre("scene:2: error: TransformTimes must stand before WorldBegin"));
  EXPECT_THAT(read_world("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nLightSource \"point\"").messages,
              testing::ElementsAre("scene:3: warning: lights that move are not supported; they stand as at the start "
                                   "of their motion, as in pbrt"));
  EXPECT_THAT(
      read_world("Shape \"plymesh\" \"string filename\" \"none.ply\"\n\"texture displacement\" \"waves\"").messages,
      testing::Contains("scene:3: warning: Shape \"plymesh\": 'displacement' is not supported yet; the surface "
                        "stays as it is"));
}

}  // namespace
}  // namespace metamer
