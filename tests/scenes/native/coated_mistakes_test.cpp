// What is said about wrong coated materials.
#include <gmock/gmock.h>

#include "scenes/native/read_native.h"
#include "scenes/read_scene.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string messages_of_material(const std::string& material) {
  Scene scene;
  Diagnostics diagnostics;
  const std::string text = "{\"metamer\": 1, \"materials\": {\n\"m\": " + material + "\n}, \"entities\": []}";
  const bool ok = read_native("scene.json", copy_bytes(text), scene, diagnostics);
  EXPECT_NE(ok, diagnostics.has_errors());
  return format_diagnostics(diagnostics);
}

TEST(NativeCoatedMistakes, EveryKeyIsChecked) {
  const auto messages = [](const std::string& keys) {
    return messages_of_material("{\"type\": \"coated\", " + keys + "}");
  };
  EXPECT_EQ(messages("\"reflectance\": 0.3, \"eta\": 1.5"), "");
  EXPECT_EQ(messages("\"reflectance\": {\"rgb\": [0.3, 0.2, 0.1]}, \"glass\": \"BK7\", \"roughness\": 1"), "");
  EXPECT_THAT(messages("\"eta\": 1.5"), HasSubstr("lacks the required key 'reflectance'"));
  EXPECT_THAT(messages("\"reflectance\": 0.3"), HasSubstr("'glass'"));
  EXPECT_THAT(messages("\"reflectance\": 0.3, \"eta\": 1.5, \"glass\": \"BK7\""), HasSubstr("'glass'"));
  EXPECT_THAT(messages("\"reflectance\": 1.3, \"eta\": 0, \"roughness\": -1"),
              AllOf(HasSubstr("'reflectance' is the number 1.3; expected a number from 0 to 1"),
                    HasSubstr("'eta' is the number 0; expected a number above 0"),
                    HasSubstr("'roughness' is the number -1; expected a number of at least 0")));
  EXPECT_THAT(messages("\"reflectance\": 0.3, \"eta\": 1.5, \"roughness\": [0.1, 0.2]"),
              HasSubstr("'roughness' is an array of 2; expected a number of at least 0"));
  EXPECT_THAT(messages("\"reflectance\": 0.3, \"glass\": \"BK8\""), HasSubstr("did you mean 'BK7'"));
  EXPECT_THAT(messages("\"reflectance\": 0.3, \"eta\": 1.5, \"rougness\": 0"), HasSubstr("did you mean 'roughness'"));
}

}  // namespace
}  // namespace metamer
