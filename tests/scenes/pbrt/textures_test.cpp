// pbrt's Texture directive: what the scene then holds, and every message.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string use = "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"";

// 2 x 1 texels of 8 bits: code 128 and white.
void write_image(const TemporaryFolder& folder, const std::string& name) {
  const std::vector<unsigned char> codes = {128, 128, 128, 255, 255, 255};
  const std::string path = (folder.path() / name).string();
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out && out->open(path, OIIO::ImageSpec(2, 1, 3, OIIO::TypeDesc::UINT8)) &&
              out->write_image(OIIO::TypeDesc::UINT8, codes.data()) && out->close());
}

struct TextureRead {
  TemporaryFolder folder;
  ReadScene read;
  explicit TextureRead(const std::string& world) {
    write_image(folder, "i.png");
    read = read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + world));
  }
  // The texture of the only shape.
  Texture texture() const { return read.scene.textures.at(read.material().reflectance_texture); }
  Texture at(TextureId id) const { return read.scene.textures.at(id); }
  double spectrum(TextureId id) const { return read.scene.spectra.value(at(id).spectrum, 550); }
};

TEST(PbrtTextures, AnImageMap) {
  const TextureRead r("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\"\n" + use);
  ASSERT_THAT(r.read.messages, ElementsAre());
  const Texture t = r.texture();
  EXPECT_EQ(t.kind, TextureKind::image);
  EXPECT_EQ(t.wrap, TextureWrap::repeat);
  EXPECT_EQ(t.filter, TextureFilter::linear);
  EXPECT_EQ(t.invert, 0u);
  EXPECT_EQ(t.scale, 1);
  const Image& image = r.read.scene.images.at(t.image);
  EXPECT_EQ(image.width, 2u);
  EXPECT_NEAR(image.rgb[0], 0.21586, 1e-5);  // IEC 61966-2-1 of 128 / 255
  EXPECT_EQ(image.rgb[3], 1);
}

TEST(PbrtTextures, EveryParameterOfAnImageMap) {
  const TextureRead r(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\" \"string wrap\" \"clamp\" \"string "
      "filter\" "
      "\"point\" \"float scale\" .5 \"bool invert\" true \"float uscale\" 2 \"float vscale\" 3 \"float udelta\" .25 "
      "\"float vdelta\" .75 \"float maxanisotropy\" 4 \"string encoding\" \"linear\" \"string mapping\" \"uv\"\n" +
      use);
  ASSERT_THAT(r.read.messages, ElementsAre());
  const Texture t = r.texture();
  EXPECT_EQ(t.wrap, TextureWrap::clamp);
  EXPECT_EQ(t.filter, TextureFilter::nearest);
  EXPECT_EQ(t.invert, 1u);
  EXPECT_EQ(t.scale, 0.5f);
  EXPECT_EQ(t.mapping.u_scale, 2);
  EXPECT_EQ(t.mapping.v_scale, 3);
  EXPECT_EQ(t.mapping.u_offset, 0.25f);
  EXPECT_EQ(t.mapping.v_offset, 0.75f);
  EXPECT_NEAR(r.read.scene.images.at(t.image).rgb[0], 128.0 / 255, 1e-6);
}

TEST(PbrtTextures, AGammaEncoding) {
  const TextureRead r(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\" \"string encoding\" \"gamma 2\" \"string "
      "wrap\" \"black\"\n" +
      use);
  ASSERT_THAT(r.read.messages, ElementsAre());
  EXPECT_EQ(r.texture().wrap, TextureWrap::black);
  EXPECT_NEAR(r.read.scene.images.at(0).rgb[0], (128.0 / 255) * (128.0 / 255), 1e-6);
}

TEST(PbrtTextures, OneImageIsReadOncePerEncoding) {
  const std::string map = " \"spectrum\" \"imagemap\" \"string filename\" \"i.png\"";
  const TextureRead r("Texture \"a\"" + map + " Texture \"b\"" + map + " \"float scale\" .5 Texture \"t\"" + map +
                      " \"string encoding\" \"linear\"" + use);
  EXPECT_THAT(r.read.messages, ElementsAre());
  EXPECT_EQ(r.read.scene.images.size(), 2u);
}

TEST(PbrtTextures, ConstantsProductsMixturesAndBoards) {
  const TextureRead constant("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.3 .3 .3]\n" + use);
  EXPECT_NEAR(constant.spectrum(constant.read.material().reflectance_texture), 0.3, 1e-4);

  const TextureRead scale(
      "Texture \"f\" \"float\" \"constant\" \"float value\" .25 Texture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [.8 "
      ".8 "
      ".8] \"texture scale\" \"f\"\n" +
      use);
  ASSERT_THAT(scale.read.messages, ElementsAre());
  EXPECT_EQ(scale.texture().kind, TextureKind::scale);
  EXPECT_NEAR(scale.spectrum(scale.texture().a), 0.8, 1e-4);
  EXPECT_EQ(scale.at(scale.texture().b).value, 0.25f);

  const TextureRead mix("Texture \"t\" \"spectrum\" \"mix\" \"rgb tex2\" [.5 .5 .5] \"float amount\" .1\n" + use);
  ASSERT_THAT(mix.read.messages, ElementsAre());
  EXPECT_EQ(mix.spectrum(mix.texture().a), 0);
  EXPECT_NEAR(mix.spectrum(mix.texture().b), 0.5, 1e-4);
  EXPECT_EQ(mix.at(mix.texture().amount).value, 0.1f);

  const TextureRead board(
      "Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\" Texture \"t\" \"spectrum\" "
      "\"checkerboard\" "
      "\"texture tex2\" \"i\" \"float uscale\" 8\n" +
      use);
  ASSERT_THAT(board.read.messages, ElementsAre());
  EXPECT_EQ(board.texture().kind, TextureKind::checkerboard);
  EXPECT_EQ(board.spectrum(board.texture().a), 1);
  EXPECT_EQ(board.at(board.texture().b).kind, TextureKind::image);
  EXPECT_EQ(board.texture().mapping.u_scale, 8);
}

TEST(PbrtTextures, EveryMistakeIsSaidWithItsLine) {
  const TextureRead r(
      "Texture \"a\" \"spectrum\" \"imagemap\"\n"
      "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\" \"string wrap\" \"clmp\"\n"
      "Texture \"c\" \"spectrum\" \"imagemap\" \"string filename\" \"i.png\" \"string encoding\" \"srgb\"\n"
      "Texture \"d\" \"spectrum\" \"imagemap\" \"string filename\" \"none.png\"\n"
      "Texture \"e\" \"spectrum\" \"scale\" \"texture tex\" \"nothing\"\n"
      "Texture \"f\" \"spectrum\" \"checkerboard\" \"float uscal\" 2\n"
      "Texture \"b\" \"spectrum\" \"constant\"");
  EXPECT_FALSE(r.read.ok);
  EXPECT_THAT(
      r.read.messages,
      ElementsAre(
          HasSubstr("scene:2: error: Texture \"imagemap\": 'string filename' is missing"),
          HasSubstr("scene:3: error: Texture \"imagemap\": there is no wrap \"clmp\" (did you mean 'clamp'?)"),
          HasSubstr(
              "scene:4: error: Texture \"imagemap\": expected \"sRGB\", \"linear\" or \"gamma\" and a number, not "
              "\"srgb\""),
          testing::AllOf(HasSubstr("scene:5: error"), HasSubstr("none.png")),
          HasSubstr("scene:6: error: Texture \"scale\": there is no texture 'nothing'"),
          HasSubstr("scene:7: error: Texture \"checkerboard\" has no parameter 'float uscal' (did you mean 'uscale'?)"),
          HasSubstr("scene:8: error: texture 'b' is defined twice")));
}

TEST(PbrtTextures, WhatIsNotSupportedIsSaidOncePerKind) {
  const TextureRead r(
      "Texture \"a\" \"spectrum\" \"ptex\" \"string filename\" \"x\"\nTexture \"t\" \"spectrum\" \"ptex\"\n" + use);
  EXPECT_TRUE(r.read.ok);
  EXPECT_THAT(r.read.messages,
              ElementsAre("scene:2: warning: texture \"ptex\" is not supported; what it would colour gets its "
                          "default value"));
  EXPECT_EQ(r.read.material().reflectance_texture, no_index);
  EXPECT_NEAR(r.read.scene.spectra.value(r.read.material().reflectance, 550), 0.5, 1e-6);
}

}  // namespace
}  // namespace metamer
