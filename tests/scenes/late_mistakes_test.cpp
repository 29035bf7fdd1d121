// All mistakes of a file in one go: also those that only building the world finds, where reading has found others.
#include "scenes/late_mistakes.h"

#include <gmock/gmock.h>

#include "scenes/read_scene.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string mistakes_of(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  folder.write(name, text);
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(read_scene((folder.path() / name).string(), scene, diagnostics)) << text;
  add_late_mistakes(scene, diagnostics);
  std::string messages = format_diagnostics(diagnostics);
  const std::string prefix = folder.path().string() + "/";
  for (size_t at; (at = messages.find(prefix)) != std::string::npos;) messages.erase(at, prefix.size());
  return messages;
}

TEST(LateMistakes, AreReportedBesideThoseOfReading) {
  EXPECT_THAT(
      mistakes_of("a.json", R"({ "metamer": 1, "entities": [
    { "camera": { "type": "perspective" } },
    { "geometry": { "type": "sphere", "radiusx": 1 } },
    { "geometry": { "type": "sphere", "radius": 1e30 } },
    { "geometry": { "type": "triangles", "positions": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "indices": [[0, 1, 2]] },
      "light": { "type": "area", "radiance": 1 } },
    { "light": { "type": "environment", "radiance": 1 } }
  ] })"),
      AllOf(HasSubstr("a.json:3: error: unknown key 'radiusx'"), HasSubstr("a.json:4: error: entity 2 is too large")));
  EXPECT_THAT(mistakes_of("a.pbrt", R"(Camera "perspective"
WorldBegin
LightSource "infinite" "float sale" 1
Translate 1e25 0 0
Shape "sphere"
Shape "sphere" "float radius" -1
)"),
              AllOf(HasSubstr("a.pbrt:3: error:"), HasSubstr("a.pbrt:6: error:"), HasSubstr("a.pbrt:5: error:"),
                    HasSubstr("is too large")));
}

// A scene without a camera because its camera has a mistake, a ball that is as large as its other mistake lets it be.
TEST(LateMistakes, LeaveOutWhatMayFollowFromOthers) {
  EXPECT_THAT(mistakes_of("a.json", R"({ "metamer": 1, "entities": [
    { "camera": { "type": "perspectiv" } },
    { "geometry": { "type": "sphere",
                    "radius": 1e30 },
      "material": { "type": "difuse" } },
    { "light": { "type": "environment", "radiance": 1 } }
  ] })"),
              AllOf(HasSubstr("a.json:2: error:"), HasSubstr("a.json:5: error:"), Not(HasSubstr("too large")),
                    Not(HasSubstr("no camera"))));
}

TEST(LateMistakes, OfFilesThatCannotBeReadAtAllAreNone) {
  EXPECT_THAT(mistakes_of("a.json", "{ \"metamer\": 1,\n"), Not(HasSubstr("camera")));
  EXPECT_THAT(mistakes_of("a.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"none.ply\"\n"),
              AllOf(HasSubstr("a.pbrt:2: error:"), Not(HasSubstr("error: the scene has no camera"))));
}

}  // namespace
}  // namespace metamer
