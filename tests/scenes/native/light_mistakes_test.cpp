// What is said about lights that are wrong: each mistake with its line.
#include <gmock/gmock.h>

#include "scenes/native/read_native.h"

namespace metamer {
namespace {

using testing::HasSubstr;

// The messages about the light of a ball, whose keys stand on line 2 and further down.
std::string messages_of_light(const std::string& keys) {
  Scene scene;
  Diagnostics diagnostics;
  const std::string text =
      "{\"metamer\": 1, \"entities\": [\n{\"geometry\": {\"type\": \"sphere\"}, \"light\": {" + keys + "}}]}";
  EXPECT_FALSE(read_native("scene.json", copy_bytes(text), scene, diagnostics));
  return format_diagnostics(diagnostics);
}

TEST(NativeLightMistakes, AreNamedWithWhatWasExpected) {
  EXPECT_EQ(messages_of_light(R"("type": "area", "nits": 3, "cosine_power": -1)"),
            "scene.json:2: error: 'cosine_power' is the number -1; expected a number from 0 to 1000000\n");
  EXPECT_EQ(messages_of_light(R"("type": "area", "nits": 3, "lumens": 1)"),
            "scene.json:2: error: 'nits' and 'lumens' exclude each other\n");
  EXPECT_EQ(messages_of_light(R"("type": "area", "power": 3, "spectrum": "D65")"),
            "scene.json:2: error: 'spectrum' is the shape for 'luminance'; a spectrum in absolute units goes to "
            "'power'\n");
  EXPECT_EQ(messages_of_light(R"("type": "spot", "candela": -3, "cone_angle": 181)"),
            "scene.json:2: error: 'cone_angle' is the number 181; expected a number above 0 and of at most 180\n"
            "scene.json:2: error: 'candela' is the number -3; expected a number of at least 0\n");
  EXPECT_EQ(messages_of_light(R"("type": "spot", "candela": 3, "cone_angle": 0)"),
            "scene.json:2: error: 'cone_angle' is the number 0; expected a number above 0 and of at most 180\n");
  EXPECT_EQ(messages_of_light(R"("type": "spot", "candela": 3, "cone_angle": 20, "falloff_start": 21)"),
            "scene.json:2: error: 'falloff_start' is 21; expected at most the 'cone_angle', 20\n");
  EXPECT_THAT(messages_of_light(R"("type": "spt", "candela": 3)"), HasSubstr("did you mean 'spot'"));
  EXPECT_THAT(messages_of_light(R"("type": "spot", "candela": 3, "cone_angel": 3)"),
              HasSubstr("did you mean 'cone_angle'"));
  EXPECT_EQ(
      messages_of_light(R"("type": "directional", "lux": 3, "angular_diameter": 180)"),
      "scene.json:2: error: 'angular_diameter' is the number 180; expected a number of at least 0 and below 180\n");
  EXPECT_EQ(
      messages_of_light(R"("type": "sky", "turbidity": 1.5, "sun_elevation": -4, "ground_albedo": 2, "resolution": 9,
                           "up": "x", "scale": -1)"),
      "scene.json:2: error: 'turbidity' is the number 1.5; expected a number from 2 to 10\n"
      "scene.json:2: error: 'sun_elevation' is the number -4; expected a number above 0 and of at most 90\n"
      "scene.json:2: error: 'ground_albedo' is the number 2; expected a number from 0 to 1\n"
      "scene.json:2: error: 'resolution' is 9; expected an even number, so that the horizon falls between two rows\n"
      "scene.json:3: error: 'up' is the string \"x\"; expected 'y' or 'z' (did you mean 'y'?)\n"
      "scene.json:3: error: 'scale' is the number -1; expected a number of at least 0\n");
  EXPECT_EQ(messages_of_light(R"("type": "environment", "nits": 3, "portal": [[0, 0, 0], [1, 0, 0]])"),
            "scene.json:2: error: 'portal' has 2 points; expected 4\n");
  EXPECT_EQ(
      messages_of_light(R"("type": "environment", "nits": 3, "portal": [[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]])"),
      "scene.json:2: error: 'portal': its corners are not those of a rectangle, one after the other\n");
  EXPECT_THAT(messages_of_light(R"("type": "environment", "nits": 3, "portal": 4)"),
              HasSubstr("four points [x, y, z]"));
  EXPECT_EQ(messages_of_light(R"("type": "projection", "candela": 3, "fov": 180)"),
            "scene.json:2: error: light of type 'projection' lacks the required key 'image'\n"
            "scene.json:2: error: 'fov' is the number 180; expected a number above 0 and below 180\n");
  EXPECT_THAT(messages_of_light(R"("type": "gonometric", "candela": 3)"), HasSubstr("did you mean 'goniometric'"));
  EXPECT_THAT(messages_of_light(R"("type": "sky", "turbidty": 3)"), HasSubstr("did you mean 'turbidity'"));
}

}  // namespace
}  // namespace metamer
