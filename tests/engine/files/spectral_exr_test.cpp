// Spectral OpenEXR files: what others find in ours, and what we find in others'.
#include "engine/files/spectral_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <half.h>

#include <random>

#include "tests/engine/files/support.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

using SpectralExr = FolderTest;

constexpr uint32_t width = 9, height = 70;  // more rows than are written at one time

Film some_film(uint32_t band_count) {
  Film film(width, height, band_count);
  std::mt19937 random(2);
  for (PixelCounts& counts : film.counts()) counts.replicate[0] = 100;
  for (BandSum& sum : film.bands()) {
    if (random() % 8 == 0) continue;  // a band that got nothing
    sum.add_weight(random());
    sum.add_radiance(static_cast<int32_t>(random()) * (FixedSum{1} << 40));
  }
  return film;
}

Picture some_picture() {
  constexpr size_t pixels = width * height;
  return {width, height, Column<float>(pixels), Column<float>(pixels), Column<float>(pixels)};
}

std::vector<std::vector<float>> means_of(const Film& film) {
  std::vector<std::vector<float>> means(film.band_count(), std::vector<float>(film.pixel_count()));
  std::vector<float*> columns;
  for (auto& column : means) columns.push_back(column.data());
  band_means(film, 0, film.pixel_count(), columns);
  return means;
}

TEST_F(SpectralExr, OthersFindTheBandsOfThePublishedLayout) {
  const Film film = some_film(36);
  ASSERT_EQ(write_exr(path("a.exr"), some_picture(), {}, {}, nullptr, &film), std::nullopt);
  const OIIO::ImageBuf image(path("a.exr"));
  ASSERT_EQ(image.nsubimages(), 1);
  const OIIO::ImageSpec& spec = image.spec();
  ASSERT_EQ(spec.nchannels, 39);
  EXPECT_EQ(spec.channelnames[2], "B");
  EXPECT_EQ(spec.channelnames[3], "S0.385,000nm");
  EXPECT_EQ(spec.channelnames[38], "S0.735,000nm");
  EXPECT_EQ(spec.get_string_attribute("spectralLayoutVersion"), "1.0");
  EXPECT_EQ(spec.get_string_attribute("emissiveUnits"), "W.m^-2.sr^-1.nm^-1");
  std::vector<float> pixels(width * height * 39);
  ASSERT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeFloat, pixels.data()));
  const std::vector<std::vector<float>> means = means_of(film);
  for (size_t p = 0; p < film.pixel_count(); ++p)
    for (size_t b = 0; b < 36; ++b) ASSERT_EQ(pixels[39 * p + 3 + b], means[b][p]) << p << " " << b;
}

TEST_F(SpectralExr, OursReturnEveryBandWithItsEdges) {
  for (const uint32_t band_count : {1u, 2u, 7u, 360u}) {
    const Film film = some_film(band_count);
    FrameHeader header;
    header.scene = "bands";
    header.seed = 5;
    ASSERT_EQ(write_exr(path("a.exr"), some_picture(), header, {}, &film, &film), std::nullopt);
    SpectralPicture read;
    FrameHeader read_header;
    ASSERT_EQ(read_spectral_picture(path("a.exr"), read, read_header), std::nullopt);
    EXPECT_EQ(read_header.scene, "bands");
    EXPECT_EQ(read_header.seed, 5u);
    ASSERT_EQ(read.edges_nm.size(), band_count + 1);
    for (uint32_t i = 0; i <= band_count; ++i) EXPECT_NEAR(read.edges_nm[i], 380.0 + 360.0 * i / band_count, 4e-5);
    const std::vector<std::vector<float>> means = means_of(film);
    for (uint32_t b = 0; b < band_count; ++b)
      for (size_t p = 0; p < film.pixel_count(); ++p) ASSERT_EQ(read.bands[b][p], means[b][p]);
    ExrContents contents;
    ASSERT_EQ(look_into_exr(path("a.exr"), contents), std::nullopt);
    EXPECT_TRUE(contents.has_film && contents.has_bands);
  }
}

TEST_F(SpectralExr, CheckpointsReturnTheSumsOfTheBands) {
  Film film = some_film(12);
  film.bands()[5].add_radiance(-to_units<band_unit_log2>(band_sample_limit));
  for (const char* name : {"a.exr", "b.exr"})
    ASSERT_EQ(write_exr(path(name), some_picture(), {}, {}, &film, &film), std::nullopt);
  EXPECT_EQ(bytes_of(path("a.exr")), bytes_of(path("b.exr")));
  Film read;
  FrameHeader header;
  ASSERT_EQ(read_film(path("a.exr"), read, header), std::nullopt);
  EXPECT_TRUE(read == film);
  ASSERT_EQ(read_film(path("a.exr"), read, header, FilmBands::left_out), std::nullopt);
  EXPECT_EQ(read.band_count(), 0u);
  EXPECT_EQ(read.counts()[3].replicate[0], 100u);
}

TEST_F(SpectralExr, DamagedBandsAreRefused) {
  Film film = some_film(12);
  film.counts()[11].replicate[0] = 0;
  ASSERT_EQ(write_exr(path("a.exr"), some_picture(), {}, {}, &film, &film), std::nullopt);
  Film read(2, 2);
  FrameHeader header;
  EXPECT_THAT(read_film(path("a.exr"), read, header),
              Optional(HasSubstr("is damaged at pixel 2,1: its sums and the sample counts do not agree")));
  EXPECT_EQ(read.width(), 2u);
  const std::string whole = bytes_of(path("a.exr"));
  for (size_t length = 0; length < whole.size(); length += 1 + length / 3) {
    write_bytes(path("cut.exr"), whole.substr(0, length));
    SpectralPicture picture;
    EXPECT_TRUE(read_film(path("cut.exr"), read, header).has_value()) << length;
    if (length >= whole.size() / 4) continue;
    EXPECT_THAT(read_spectral_picture(path("cut.exr"), picture, header), Optional(HasSubstr("cut.exr: "))) << length;
  }
}

// A file as other programs write it, through OpenEXR itself: channels of any type, a window that starts anywhere.
struct Foreign {
  std::vector<std::string> channels;
  Imf::PixelType type = Imf::FLOAT;
  const char* units = "W.m^-2.sr^-1";
  int sampling = 1;
  bool tiled = false;
};
void write_foreign(const std::string& path, const Foreign& file) {
  const Imath::Box2i window({-4, 6}, {-1, 9});
  Imf::Header header(Imath::Box2i({0, 0}, {9, 9}), window);
  header.compression() = Imf::PIZ_COMPRESSION;
  header.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
  if (file.units != nullptr) header.insert("emissiveUnits", Imf::StringAttribute(file.units));
  if (file.tiled) header.setTileDescription(Imf::TileDescription(2, 2, Imf::ONE_LEVEL));
  std::vector<std::vector<float>> floats(file.channels.size(), std::vector<float>(16));
  std::vector<std::vector<half>> halves(file.channels.size(), std::vector<half>(16));
  Imf::FrameBuffer buffer;
  for (size_t c = 0; c < file.channels.size(); ++c) {
    header.channels().insert(file.channels[c], Imf::Channel(file.type, file.sampling, file.sampling));
    for (size_t p = 0; p < 16; ++p) {
      floats[c][p] = static_cast<float>(c + 1) + static_cast<float>(p) / 16;
      halves[c][p] = half(floats[c][p]);
    }
    void* values = file.type == Imf::HALF ? static_cast<void*>(halves[c].data()) : floats[c].data();
    const size_t size = file.type == Imf::HALF ? sizeof(half) : sizeof(float);
    buffer.insert(file.channels[c],
                  Imf::Slice::Make(file.type, values, window, size, 4 * size, file.sampling, file.sampling));
  }
  if (file.tiled) {
    Imf::TiledOutputFile output(path.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
  } else {
    Imf::OutputFile output(path.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(4);
  }
}

TEST_F(SpectralExr, OthersAreReadWhateverTheyHoldBeside) {
  // In the order of names, that is not of wavelengths; 6 PHz is 50 nm.
  const std::vector<std::string> channels = {"R",       "S0.1,0000E3nm", "S0.400,5nm", "S0.500,0nm", "S0.0,6um",
                                             "S0.6PHz", "S1.500,0nm",    "T.500,0nm",  "Y"};
  for (const Foreign& file : {Foreign{channels}, Foreign{channels, Imf::HALF, nullptr},
                              Foreign{channels, Imf::FLOAT, "W.m^-2.sr^-1.nm^-1", 1, true}}) {
    write_foreign(path("a.exr"), file);
    SpectralPicture picture;
    FrameHeader header;
    ASSERT_EQ(read_spectral_picture(path("a.exr"), picture, header), std::nullopt);
    EXPECT_EQ(picture.width, 4u);
    EXPECT_EQ(picture.height, 4u);
    ASSERT_EQ(picture.bands.size(), 5u);
    const std::array<double, 5> wavelengths_nm = {49.9654097, 400.5, 500, 600, 1000};
    for (size_t b = 0; b < 4; ++b)
      EXPECT_NEAR(picture.edges_nm[b + 1], (wavelengths_nm[b] + wavelengths_nm[b + 1]) / 2, 1e-6);
    EXPECT_NEAR(picture.edges_nm[5], 1200, 1e-6);
    const std::array<float, 5> first = {6, 3, 4, 5, 2};
    for (size_t b = 0; b < 5; ++b)
      for (size_t p = 0; p < 16; ++p) ASSERT_EQ(picture.bands[b][p], first[b] + static_cast<float>(p) / 16) << b;
    EXPECT_EQ(header.seed, 0u);
    ExrContents contents;
    ASSERT_EQ(look_into_exr(path("a.exr"), contents), std::nullopt);
    EXPECT_TRUE(contents.has_bands);
    EXPECT_FALSE(contents.has_film);
  }
}

TEST_F(SpectralExr, WhatCannotBeDevelopedIsSaid) {
  SpectralPicture picture;
  FrameHeader header;
  const auto error_of = [&](const Foreign& file) {
    write_foreign(path("a.exr"), file);
    return read_spectral_picture(path("a.exr"), picture, header);
  };
  EXPECT_THAT(error_of({{"R", "G", "B"}}),
              Optional(HasSubstr("holds no bands of light (channels such as S0.550,000nm)")));
  EXPECT_THAT(error_of({{"T.500nm"}}), Optional(HasSubstr("only reflectances")));
  EXPECT_THAT(error_of({{"S0.500nm", "S0.0,5um"}}), Optional(HasSubstr("are of one wavelength")));
  EXPECT_THAT(error_of({{"S0.500nm"}, Imf::FLOAT, "lux"}), Optional(HasSubstr("its emissiveUnits are 'lux'")));
  EXPECT_THAT(error_of({{"S0.500nm"}, Imf::FLOAT, "W.m^-2.sr^-1", 2}),
              Optional(HasSubstr("does not have every pixel")));
  for (const char* name :
       {"S0.nm", "S0.-5nm", "S0.0nm", "S0.500", "S0.500ft", "S0.500xm", "S0.infnm", "S.500nm", "S0.5e400nm"})
    EXPECT_THAT(error_of({{name}}), Optional(HasSubstr("holds no bands"))) << name;
  EXPECT_EQ(picture.width, 0u);
}

}  // namespace
}  // namespace metamer
