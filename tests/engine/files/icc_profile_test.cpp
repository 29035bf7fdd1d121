#include "engine/files/icc_profile.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace metamer {
namespace {

constexpr Chromaticities display_p3 = {{0.680f, 0.320f}, {0.265f, 0.690f}, {0.150f, 0.060f}, {0.3127f, 0.3290f}};

uint32_t word(const std::vector<uint8_t>& bytes, size_t at) {
  return uint32_t{bytes.at(at)} << 24 | uint32_t{bytes.at(at + 1)} << 16 | uint32_t{bytes.at(at + 2)} << 8 |
         bytes.at(at + 3);
}

// Offset of a tag's data: ICC.1:2010, 7.3.
size_t tag_at(const std::vector<uint8_t>& profile, const char* name) {
  for (uint32_t i = 0; i < word(profile, 128); ++i)
    if (std::memcmp(profile.data() + 132 + 12 * i, name, 4) == 0) return word(profile, 132 + 12 * i + 4);
  ADD_FAILURE() << "no tag " << name;
  return 0;
}

double fixed(const std::vector<uint8_t>& profile, size_t at) {
  return static_cast<int32_t>(word(profile, at)) / 65536.0;
}

// The colorants that Apple's own "Display P3" profile has, adapted to D50 by Bradford.
TEST(IccProfile, OfDisplayP3HasItsPublishedColorants) {
  const std::vector<uint8_t> profile = icc_profile(display_p3, "Display P3");
  ASSERT_EQ(word(profile, 0), profile.size());
  EXPECT_EQ(std::memcmp(profile.data() + 36, "acsp", 4), 0);
  const double published[3][3] = {
      {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}};
  const char* tags[3] = {"rXYZ", "gXYZ", "bXYZ"};
  for (size_t i = 0; i < 3; ++i)
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(fixed(profile, tag_at(profile, tags[i]) + 8 + 4 * c), published[i][c], 3e-4) << tags[i] << c;
}

TEST(IccProfile, SaysTheSrgbCurve) {
  const std::vector<uint8_t> profile = icc_profile(display_p3, "Display P3");
  const size_t curve = tag_at(profile, "gTRC");
  EXPECT_EQ(std::memcmp(profile.data() + curve, "para", 4), 0);
  EXPECT_EQ(word(profile, curve + 8) >> 16, 3u);  // Y = (a X + b)^g above d, c X below
  const double parameters[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(fixed(profile, curve + 12 + 4 * i), parameters[i], 1e-5);
}

TEST(IccProfile, HasTheSameBytesWheneverItIsMade) {
  const std::vector<uint8_t> profile = icc_profile(display_p3, "Display P3");
  EXPECT_EQ(profile, icc_profile(display_p3, "Display P3"));
  EXPECT_EQ(word(profile, 24), 2000u << 16 | 1u);  // year and month
  EXPECT_EQ(word(profile, 28), 1u << 16);          // day and hour
  EXPECT_EQ(word(profile, 32), 0u);
}

TEST(IccProfile, RefusesWhatIsNoDisplay) {
  Chromaticities line = display_p3;
  line.green = line.red;
  EXPECT_THROW(icc_profile(line, "a line"), std::runtime_error);
}

}  // namespace
}  // namespace metamer
