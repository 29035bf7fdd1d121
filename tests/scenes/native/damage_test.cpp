// Files cut short and overwritten: never a crash, and always a message.
#include <gmock/gmock.h>

#include <array>

#include "tests/scenes/support/native_messages.h"

namespace metamer {
namespace {

using testing::HasSubstr;

TEST(NativeDamage, SurvivesBeingCutAtEveryByte) {
  std::string text = text_of_file(native_folder + "every_key.json");
  while (text.back() != '}') text.pop_back();
  for (size_t length = 0; length < text.size(); ++length)
    EXPECT_THAT(messages_of(text.substr(0, length)), HasSubstr("scene.json:")) << length;
}

TEST(NativeDamage, SurvivesEveryByteBeingReplaced) {
  std::string text = text_of_file(native_folder + "every_key.json");
  // Volumes that are not there: reading them tens of thousands of times would take minutes.
  for (size_t at; (at = text.find("puff.vdb")) != std::string::npos;) text.replace(at, 8, "none.vdb");
  for (size_t i = 0; i < text.size(); ++i) {
    for (const char garbage : i % 2 == 0 ? std::array{'\0', '"', '}'} : std::array{'\xff', '[', '9'}) {
      std::string damaged = text;
      damaged[i] = garbage;
      messages_of(damaged);  // checks that it says something exactly when it fails
    }
  }
}

}  // namespace
}  // namespace metamer
