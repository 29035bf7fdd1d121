#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "engine/files/exr_file.h"
#include "engine/files/png_file.h"
#include "tests/engine/files/support.h"

namespace metamer {
namespace {

using testing::HasSubstr;
using testing::Optional;

class PictureFiles : public FolderTest {};

constexpr uint32_t width = 19, height = 37;  // more than two blocks of 16 rows, the last one partial

Picture some_picture() {
  Picture picture{width, height, Column<float>(width * height), Column<float>(width * height),
                  Column<float>(width * height)};
  std::mt19937 random(1);
  for (Column<float>* column : {&picture.r, &picture.g, &picture.b})
    for (float& value : *column) value = std::ldexp(static_cast<float>(static_cast<int>(random())), -30);
  picture.r[3] = -0.0f;
  picture.g[3] = std::numeric_limits<float>::max();
  picture.b[3] = std::numeric_limits<float>::denorm_min();
  return picture;
}

Film some_film() {
  Film film(width, height);
  std::mt19937 random(2);
  for (size_t p = 0; p < film.pixel_count(); ++p)
    for (uint32_t r = 0; r < replicate_count; ++r) {
      film.counts()[p].replicate[r] = 1 + static_cast<uint32_t>(random()) % 1000;
      for (FixedSum& sum : film.sums()[p].xyz[r])
        sum = (FixedSum{static_cast<int32_t>(random())} << 64 | FixedSum{random()} << 32 | random());
    }
  film.sums()[0].xyz[0][0] = to_fixed(-sample_limit) * film.counts()[0].replicate[0];
  film.set_invalid_samples((1ull << 40) + 3);
  return film;
}

FrameHeader some_header() {
  FrameHeader header;
  header.software = "metamer 0.1.0";
  header.scene = "cornell \xc3\xb6";
  header.seed = 0xffffffffffffffffull;
  header.settings = {{"depth", "7"}, {"filter", "gaussian"}};
  return header;
}

TEST_F(PictureFiles, ExrReturnsEveryBitThroughAnotherReader) {
  const Picture picture = some_picture();
  const Film film = some_film();
  for (const Film* checkpoint : {static_cast<const Film*>(nullptr), &film}) {
    const std::string file = path(checkpoint == nullptr ? "preview.exr" : "full.exr");
    ASSERT_EQ(write_exr(file, picture, some_header(), sample_totals(film), checkpoint), std::nullopt);
    const OIIO::ImageBuf image(file);
    ASSERT_EQ(image.spec().channelnames, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(image.spec().format, OIIO::TypeFloat);
    EXPECT_EQ(image.nsubimages(), checkpoint == nullptr ? 1 : 2);
    ASSERT_EQ(image.spec().width, static_cast<int>(width));
    ASSERT_EQ(image.spec().height, static_cast<int>(height));
    std::vector<float> pixels(width * height * 3);
    ASSERT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeFloat, pixels.data()));
    for (size_t p = 0; p < width * height; ++p) {
      const float expected[3] = {picture.r[p], picture.g[p], picture.b[p]};
      ASSERT_EQ(std::memcmp(&pixels[3 * p], expected, sizeof expected), 0) << p;
    }
  }
}

TEST_F(PictureFiles, ExrSaysWhatItsNumbersMean) {
  FrameHeader header = some_header();
  header.chromaticities = {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}};
  ASSERT_EQ(write_exr(path("a.exr"), some_picture(), header, {.total = 99, .fewest = 3, .most = 64}, nullptr),
            std::nullopt);
  const OIIO::ImageBuf image(path("a.exr"));
  const OIIO::ImageSpec& spec = image.spec();
  float c[8] = {};
  ASSERT_TRUE(spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), c));
  EXPECT_EQ(c[0], 0.7347f);
  EXPECT_EQ(c[5], -0.077f);
  EXPECT_EQ(c[7], 0.33767f);
  EXPECT_EQ(spec.get_float_attribute("whiteLuminance"), 1.0f);
  EXPECT_EQ(spec.get_int_attribute("samples"), 64);
  EXPECT_EQ(spec.get_int_attribute("samplesFewest"), 3);
  EXPECT_EQ(spec.get_string_attribute("seed"), "18446744073709551615");
  EXPECT_EQ(spec.get_string_attribute("scene"), header.scene);
  EXPECT_EQ(spec.get_string_attribute("Software"), "metamer 0.1.0");
  EXPECT_EQ(spec.get_string_attribute("metamer:filter"), "gaussian");
  EXPECT_EQ(spec.get_string_attribute("checkpoint"), "left out (preview only)");
  EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
}

// A crop lies where it was cut out, as OpenEXR's data window within the display window.
TEST_F(PictureFiles, ExrOfACropKnowsItsPlaceInTheFrame) {
  FrameHeader header = some_header();
  header.window = {30, 7, 200, 100};
  const Picture picture = some_picture();
  const Film film = some_film();
  ASSERT_EQ(write_exr(path("a.exr"), picture, header, sample_totals(film), &film), std::nullopt);
  const OIIO::ImageBuf image(path("a.exr"));
  EXPECT_EQ(image.spec().x, 30);
  EXPECT_EQ(image.spec().y, 7);
  EXPECT_EQ(image.spec().width, static_cast<int>(width));
  EXPECT_EQ(image.spec().full_width, 200);
  EXPECT_EQ(image.spec().full_height, 100);
  float pixel[3] = {};
  image.getpixel(31, 9, pixel);
  EXPECT_EQ(pixel[1], picture.g[2 * width + 1]);
  Film read_film_back;
  FrameHeader read_header;
  ASSERT_EQ(read_film(path("a.exr"), read_film_back, read_header), std::nullopt);
  EXPECT_TRUE(read_film_back == film);
  EXPECT_EQ(read_header.window.x, 30u);
  EXPECT_EQ(read_header.window.y, 7u);
  EXPECT_EQ(read_header.window.full_width, 200u);
  EXPECT_EQ(read_header.window.full_height, 100u);
  Picture read_back;
  SampleTotals samples;
  ASSERT_EQ(read_picture(path("a.exr"), read_back, read_header, samples), std::nullopt);
  EXPECT_EQ(read_back.r[5], picture.r[5]);
}

TEST_F(PictureFiles, ExrHasTheSameBytesTwice) {
  const Film film = some_film();
  for (const char* name : {"a.exr", "b.exr"})
    ASSERT_EQ(write_exr(path(name), some_picture(), some_header(), sample_totals(film), &film), std::nullopt);
  EXPECT_EQ(bytes_of(path("a.exr")), bytes_of(path("b.exr")));
  EXPECT_EQ(bytes_of(path("a.exr")).find("capDate"), std::string::npos);
}

TEST_F(PictureFiles, CheckpointsReturnTheFilmAndItsHeader) {
  const Film film = some_film();
  ASSERT_EQ(write_exr(path("a.exr"), some_picture(), some_header(), sample_totals(film), &film), std::nullopt);
  Film read;
  FrameHeader header;
  ASSERT_EQ(read_film(path("a.exr"), read, header), std::nullopt);
  EXPECT_TRUE(read == film);
  EXPECT_EQ(header.software, "metamer 0.1.0");
  EXPECT_EQ(header.scene, some_header().scene);
  EXPECT_EQ(header.seed, some_header().seed);
  EXPECT_EQ(header.settings, some_header().settings);
  EXPECT_EQ(header.chromaticities, Chromaticities());
}

TEST_F(PictureFiles, DamagedCheckpointsAreRefusedAndChangeNothing) {
  Film film = some_film();
  ASSERT_EQ(write_exr(path("a.exr"), some_picture(), some_header(), sample_totals(film), &film), std::nullopt);
  const std::string whole = bytes_of(path("a.exr"));
  Film read(2, 2);
  FrameHeader header;
  for (size_t length = 0; length < whole.size(); length += 1 + length / 3) {
    write_bytes(path("cut.exr"), whole.substr(0, length));
    EXPECT_THAT(read_film(path("cut.exr"), read, header), Optional(HasSubstr("cut.exr: "))) << length;
  }
  EXPECT_THAT(read_film(path("none.exr"), read, header), Optional(HasSubstr("cannot be read")));
  ASSERT_EQ(write_exr(path("p.exr"), some_picture(), some_header(), sample_totals(film), nullptr), std::nullopt);
  EXPECT_THAT(read_film(path("p.exr"), read, header), Optional(HasSubstr("holds no film part")));
  film.sums()[width + 2].xyz[1][2] = to_fixed(sample_limit) * film.counts()[width + 2].replicate[1] + 1;
  ASSERT_EQ(write_exr(path("d.exr"), some_picture(), some_header(), sample_totals(film), &film), std::nullopt);
  EXPECT_THAT(read_film(path("d.exr"), read, header), Optional(HasSubstr("the film is damaged at pixel 2,1")));
  EXPECT_EQ(read.width(), 2u);
}

// One bit of every seventh byte flipped in turn: an answer or an error, never a crash.
TEST_F(PictureFiles, FlippedBytesNeverCrashTheReader) {
  Film film(3, 2);
  Picture picture{3, 2, Column<float>(6), Column<float>(6), Column<float>(6)};
  ASSERT_EQ(write_exr(path("a.exr"), picture, some_header(), {}, &film), std::nullopt);
  const std::string whole = bytes_of(path("a.exr"));
  size_t refused = 0;
  for (size_t i = 0; i < whole.size(); i += 7) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << i / 7 % 8));
    write_bytes(path("b.exr"), bytes);
    Film read;
    FrameHeader header;
    refused += read_film(path("b.exr"), read, header).has_value();
  }
  EXPECT_GT(refused, whole.size() / 70);
}

TEST_F(PictureFiles, NothingIsLeftWhereWritingFails) {
  const Film film = some_film();
  EXPECT_THAT(write_exr(path("none/a.exr"), some_picture(), some_header(), {}, &film), Optional(HasSubstr("none")));
  EXPECT_THAT(write_png(path("none/a.png"), {1, 1, Column<uint32_t>(1)}, ""), Optional(HasSubstr("none")));
  EXPECT_EQ(file_count(), 0u);
}

// The chunks of a PNG (ISO/IEC 15948, 5.3): name and content.
std::vector<std::pair<std::string, std::string>> png_chunks(const std::string& bytes) {
  std::vector<std::pair<std::string, std::string>> chunks;
  for (size_t at = 8; at + 12 <= bytes.size();) {
    uint32_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(bytes[at + i]);
    chunks.emplace_back(bytes.substr(at + 4, 4), bytes.substr(at + 8, length));
    at += 12 + length;
  }
  return chunks;
}

TEST_F(PictureFiles, PngIsEightBitSrgbAndSaysSo) {
  CodedPicture picture{17, 3, Column<uint32_t>(17 * 3)};
  for (uint32_t p = 0; p < 51; ++p) picture.codes[p] = p | (p + 100) << 8 | (255 - p) << 16;
  ASSERT_EQ(write_png(path("a.png"), picture, "metamer 0.1.0"), std::nullopt);
  ASSERT_EQ(write_png(path("b.png"), picture, "metamer 0.1.0"), std::nullopt);
  EXPECT_EQ(bytes_of(path("a.png")), bytes_of(path("b.png")));
  int srgb = 0;
  for (const auto& [name, content] : png_chunks(bytes_of(path("a.png")))) {
    if (name == "IHDR") {
      EXPECT_EQ(content.substr(8), std::string("\x08\x02\x00\x00\x00", 5));
    }
    srgb += name == "sRGB";
    EXPECT_NE(name, "tIME");
    EXPECT_NE(name, "iCCP");
    if (name == "gAMA") {
      EXPECT_EQ(content, std::string("\x00\x00\xb1\x8f", 4)) << "45455, as the sRGB chunk demands";
    }
  }
  EXPECT_EQ(srgb, 1);
  const OIIO::ImageBuf image(path("a.png"));
  std::vector<uint8_t> pixels(51 * 3);
  ASSERT_EQ(image.spec().nchannels, 3);
  ASSERT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeUInt8, pixels.data()));
  for (uint32_t p = 0; p < 51; ++p) {
    EXPECT_EQ(pixels[3 * p], p);
    EXPECT_EQ(pixels[3 * p + 1], p + 100);
    EXPECT_EQ(pixels[3 * p + 2], 255 - p);
  }
}

}  // namespace
}  // namespace metamer
