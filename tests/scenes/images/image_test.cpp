#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cstring>

#include "scenes/images/read_image.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::HasSubstr;

struct ImageResult {
  bool ok = false;
  Image image;
  std::string messages;
};

ImageResult read(const std::string& path) {
  ImageResult result;
  Diagnostics diagnostics;
  result.ok = read_image(path, {"scene.json", 7}, result.image, diagnostics);
  EXPECT_NE(result.ok, diagnostics.has_errors());
  result.messages = format_diagnostics(diagnostics);
  return result;
}

// A picture of 2 x 2 pixels in that format: the values of the top row first, channel by channel.
template <class T>
std::string write(const TemporaryFolder& folder, const std::string& name, std::vector<std::string> channels,
                  const std::vector<T>& values, OIIO::TypeDesc type) {
  const std::string path = (folder.path() / name).string();
  OIIO::ImageSpec spec(2, 2, static_cast<int>(channels.size()), type);
  spec.channelnames = channels;
  const auto out = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(out && out->open(path, spec) && out->write_image(OIIO::TypeDescFromC<T>::value(), values.data()) &&
              out->close())
      << name;
  return path;
}

std::string pfm(std::string_view header, const std::vector<float>& values) {
  std::string bytes(header);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return bytes;
}

TEST(Images, ChromaticitiesNameTheColourSpace) {
  const TemporaryFolder folder;
  const auto space_of = [&](const std::array<float, 8>& named) {
    const std::string path = (folder.path() / "named.exr").string();
    OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::HALF);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), named.data());
    const std::vector<float> values(12, 0.5f);
    const auto out = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values.data()) && out->close());
    return read(path);
  };
  // ITU-R BT.2020-2; SMPTE ST 2065-1 with the white of Academy's TB-2014-004.
  EXPECT_EQ(space_of({0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f}).image.color_space,
            ColorSpace::rec2020);
  EXPECT_EQ(space_of({0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f}).image.color_space,
            ColorSpace::aces2065_1);
  EXPECT_EQ(space_of({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}).messages, "");
  const ImageResult other = space_of({0.6f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f});
  EXPECT_EQ(other.image.color_space, ColorSpace::srgb);
  EXPECT_THAT(other.messages, HasSubstr("no known colour space"));
}

TEST(Images, RowsRunFromTheTopInEveryFormat) {
  const TemporaryFolder folder;
  const std::vector<float> rgb = {1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1};  // red above blue
  for (const char* name : {"a.exr", "a.hdr", "a.tif"}) {
    const ImageResult r = read(write(folder, name, {"R", "G", "B"}, rgb, OIIO::TypeDesc::FLOAT));
    ASSERT_TRUE(r.ok) << r.messages;
    EXPECT_EQ(r.image.rgb, rgb) << name;
  }
  for (const char* name : {"a.png", "a.tga", "a.bmp"}) {
    const ImageResult r = read(write(folder, name, {"R", "G", "B"}, rgb, OIIO::TypeDesc::UINT8));
    ASSERT_TRUE(r.ok) << r.messages;
    EXPECT_EQ(r.image.rgb, rgb) << name;
  }
  // A PFM file holds its bottom row first.
  const ImageResult r = read(folder.write("a.pfm", pfm("PF\n2 2\n-1.0\n", {0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0})));
  ASSERT_TRUE(r.ok) << r.messages;
  EXPECT_EQ(r.image.rgb, rgb);
}

TEST(Images, EightBitsAreDecodedFromSrgb) {
  const TemporaryFolder folder;
  const ImageResult r = read(write<uint8_t>(folder, "a.png", {"R", "G", "B"},
                                            {0, 128, 255, 10, 188, 1, 0, 0, 0, 0, 0, 0}, OIIO::TypeDesc::UINT8));
  ASSERT_TRUE(r.ok) << r.messages;
  // IEC 61966-2-1: 128 / 255 is 0.2158605, 188 / 255 is 0.5028865, 10 / 255 lies on the straight part.
  EXPECT_NEAR(r.image.rgb[1], 0.2158605, 1e-6);
  EXPECT_EQ(r.image.rgb[2], 1);
  EXPECT_NEAR(r.image.rgb[3], 10 / 255.0 / 12.92, 1e-8);
  EXPECT_NEAR(r.image.rgb[4], 0.5028865, 1e-6);
}

TEST(Images, ChannelsAreFoundByNameGreyIsSpreadAlphaDropped) {
  const TemporaryFolder folder;
  const std::vector<float> abgr = {1, 3, 2, 1, 1, 3, 2, 1, 1, 3, 2, 1, 1, 3, 2, 1};
  const ImageResult named = read(write(folder, "a.exr", {"A", "B", "G", "R"}, abgr, OIIO::TypeDesc::FLOAT));
  ASSERT_TRUE(named.ok) << named.messages;
  EXPECT_THAT(std::vector<float>(named.image.rgb.begin(), named.image.rgb.begin() + 3), testing::ElementsAre(1, 2, 3));
  const ImageResult grey = read(write<float>(folder, "g.exr", {"Y"}, {0.5f, 1, 2, 3}, OIIO::TypeDesc::FLOAT));
  ASSERT_TRUE(grey.ok) << grey.messages;
  EXPECT_THAT(std::vector<float>(grey.image.rgb.begin(), grey.image.rgb.begin() + 4),
              testing::ElementsAre(0.5f, 0.5f, 0.5f, 1));
  // Straight alpha: the colour of a transparent pixel is kept as it is.
  const ImageResult alpha =
      read(write<uint8_t>(folder, "t.png", {"R", "G", "B", "A"},
                          {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, OIIO::TypeDesc::UINT8));
  ASSERT_TRUE(alpha.ok) << alpha.messages;
  EXPECT_EQ(alpha.image.rgb[0], 1);
  EXPECT_THAT(alpha.image.alpha, testing::ElementsAre(0, 0, 0, 0));
  const ImageResult opaque =
      read(write<uint8_t>(folder, "o.png", {"R", "G", "B", "A"},
                          {255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255}, OIIO::TypeDesc::UINT8));
  EXPECT_TRUE(opaque.ok && opaque.image.alpha.empty());
}

TEST(Images, AlphaIsLinearUnlessAskedFor) {
  const TemporaryFolder folder;
  const std::string path =
      write<uint8_t>(folder, "t.png", {"R", "G", "B", "A"}, {0, 0, 0, 128, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 128},
                     OIIO::TypeDesc::UINT8);
  for (const bool decodes : {false, true}) {
    Image image;
    Diagnostics diagnostics;
    ImageEncoding encoding;
    encoding.decodes_alpha = decodes;
    ASSERT_TRUE(read_image(path, {}, image, diagnostics, encoding));
    ASSERT_EQ(image.alpha.size(), 4u);
    EXPECT_NEAR(image.alpha[0], decodes ? 0.21586 : 128.0 / 255, 1e-5);  // IEC 61966-2-1
    EXPECT_EQ(image.alpha[1], 1);
    EXPECT_EQ(image.alpha[2], 0);
  }
}

TEST(Images, MayBeNegativeWhereTheyAreNoLight) {
  const TemporaryFolder folder;
  Image image;
  Diagnostics diagnostics;
  ImageEncoding encoding;
  encoding.allows_negative = true;
  EXPECT_TRUE(
      read_image(folder.write("a.pfm", pfm("Pf\n2 2\n-1.0\n", {1, 1, 1, -2})), {}, image, diagnostics, encoding));
  EXPECT_EQ(image.rgb[3], -2);
}

TEST(Images, RefusesWhatIsNoLight) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const ImageResult r = read(folder.write("a.pfm", pfm("Pf\n2 2\n-1.0\n", {1, 1, 1, -2})));
  EXPECT_THAT(r.messages,
              HasSubstr("a.pfm: error: pixel (1, 0) holds -2; expected finite values of at least 0 (3 such"));
  EXPECT_THAT(read(folder.write("b.pfm", pfm("Pf\n2 2\n-1.0\n", {nan, 1, 1, 1}))).messages,
              HasSubstr("pixel (0, 1) holds nan"));
  EXPECT_THAT(read(folder.write("c.pfm", pfm("Pf\n2 2\n-1.0\n", {1, infinity, 1, 1}))).messages,
              HasSubstr("holds inf"));
}

TEST(Images, SaysWhyAFileCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(read("/nowhere/a.exr").messages,
            "scene.json:7: error: cannot read '/nowhere/a.exr': No such file or directory\n");
  EXPECT_THAT(read(folder.write("a.exr", "")).messages, HasSubstr("a.exr: error: cannot read this as an image: "));
  EXPECT_THAT(read(folder.write("b.png", "no picture")).messages, HasSubstr("cannot read this as an image: "));
  EXPECT_THAT(read(folder.write("c.xyz", "no picture")).messages, HasSubstr("cannot read this as an image: "));
  EXPECT_THAT(read(folder.write("d.pfm", "PF\n1000000 1000000\n-1.0\n")).messages,
              HasSubstr("1000000 x 1000000 pixels"));
}

TEST(Images, SurviveBeingCut) {
  const TemporaryFolder folder;
  const std::vector<float> rgb(12, 0.5f);
  // No PNG: libpng leaves OpenImageIO by longjmp when a file ends early, which the leak sanitizer holds against us.
  for (const char* name : {"a.exr", "a.hdr", "a.tga"}) {
    const std::string path =
        write(folder, name, {"R", "G", "B"}, rgb, name[2] == 't' ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    const auto size = std::filesystem::file_size(path);
    for (uintmax_t length = 0; length < size; length += 1 + size / 64) {
      std::filesystem::resize_file(path, length);
      read(path);  // checks that it says something exactly when it fails
      write(folder, name, {"R", "G", "B"}, rgb, name[2] == 't' ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    }
  }
}

}  // namespace
}  // namespace metamer
