// What of materials and shapes may be a texture: roughness, displacement, normal maps, alpha, amounts.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string sphere = " Shape \"sphere\"\n";
const std::string number = "Texture \"f\" \"float\" \"constant\" \"float value\" .25\n";

// One texel of 8 bits: code 128 in every colour, and that alpha.
void write_image(const TemporaryFolder& folder, const std::string& name, unsigned char alpha) {
  const std::vector<unsigned char> codes = {128, 128, 128, alpha};
  const std::string path = (folder.path() / name).string();
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out && out->open(path, OIIO::ImageSpec(1, 1, 4, OIIO::TypeDesc::UINT8)) &&
              out->write_image(OIIO::TypeDesc::UINT8, codes.data()) && out->close());
}

struct VaryingRead {
  TemporaryFolder folder;
  ReadScene read;
  Material m;
  explicit VaryingRead(const std::string& world) {
    write_image(folder, "i.png", 64);
    write_image(folder, "o.png", 255);
    write_image(folder, "i.tga", 64);
    read = read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + world));
    if (read.ok && read.count<Geometry>() > 0) m = read.material();
  }
  Texture at(TextureId id) const { return read.scene.textures.at(id); }
};

TEST(PbrtVarying, RoughnessIsRemappedByASquareRoot) {
  const VaryingRead both(number + "Material \"conductor\" \"texture roughness\" \"f\"" + sphere);
  EXPECT_THAT(both.read.messages, ElementsAre());
  EXPECT_EQ(both.m.alpha_x_texture, both.m.alpha_y_texture);
  EXPECT_EQ(both.at(both.m.alpha_x_texture).kind, TextureKind::square_root);
  EXPECT_EQ(both.at(both.at(both.m.alpha_x_texture).a).value, 0.25f);
}

TEST(PbrtVarying, RoughnessAlongUAndVOrOneOfThem) {
  const VaryingRead one(number +
                        "Material \"dielectric\" \"bool remaproughness\" false \"texture vroughness\" \"f\" \"float "
                        "uroughness\" .125" +
                        sphere);
  EXPECT_THAT(one.read.messages, ElementsAre());
  EXPECT_EQ(one.m.alpha_x, 0.125f);
  EXPECT_EQ(one.m.alpha_x_texture, no_index);
  EXPECT_EQ(one.at(one.m.alpha_y_texture).value, 0.25f);
}

TEST(PbrtVarying, ADisplacementOnAnyMaterial) {
  for (const std::string kind : {"diffuse", "conductor", "dielectric", "thindielectric", "coateddiffuse",
                                 "coatedconductor", "diffusetransmission"}) {
    const VaryingRead r(number + "Material \"" + kind + "\" \"texture displacement\" \"f\"" + sphere);
    EXPECT_THAT(r.read.messages, testing::Not(testing::Contains(HasSubstr("displacement")))) << kind;
    EXPECT_EQ(r.at(r.m.displacement).value, 0.25f) << kind;
  }
}

TEST(PbrtVarying, ANormalMapIsNotDecoded) {
  const VaryingRead r("Material \"diffuse\" \"string normalmap\" \"o.png\"" + sphere);
  EXPECT_THAT(r.read.messages, ElementsAre());
  EXPECT_NEAR(r.read.scene.images.at(r.m.normal_map).rgb[0], 128.0 / 255, 1e-6);
}

TEST(PbrtVarying, AConductorsReflectance) {
  const VaryingRead r(
      "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.3 .3 .3]\n"
      "Material \"conductor\" \"texture reflectance\" \"t\"" +
      sphere);
  EXPECT_THAT(r.read.messages, ElementsAre());
  EXPECT_EQ(r.m.kind, MaterialKind::conductor);
  EXPECT_NEAR(r.read.scene.spectra.value(r.at(r.m.reflectance_texture).spectrum, 550), 0.3, 1e-4);
  const VaryingRead wrong(
      "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.3 .3 .3]\n"
      "Material \"conductor\" \"texture reflectance\" \"t\" \"spectrum k\" \"metal-Cu-k\"" +
      sphere);
  EXPECT_THAT(wrong.read.messages, testing::Contains(HasSubstr("scene:3: error: Material \"conductor\": 'reflectance' "
                                                               "and 'k' exclude each other")));
}

TEST(PbrtVarying, TheAmountOfAMixture) {
  const VaryingRead r(
      number +
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMaterial \"mix\" \"string materials\" [\"a\" "
      "\"a\"] \"texture amount\" \"f\"" +
      sphere);
  EXPECT_THAT(r.read.messages, ElementsAre());
  EXPECT_EQ(r.at(r.m.mix.amount_texture).value, 0.25f);
}

TEST(PbrtVarying, AlphaOfShapes) {
  const auto geometry = [](const VaryingRead& r) { return r.read.scene.registry.table<Geometry>().get(0); };
  const VaryingRead half("Shape \"sphere\" \"float alpha\" .5");
  EXPECT_THAT(half.read.messages, ElementsAre());
  EXPECT_EQ(half.at(geometry(half).alpha_texture).value, 0.5f);
  const VaryingRead textured(number + "Shape \"disk\" \"texture alpha\" \"f\"");
  EXPECT_EQ(textured.at(geometry(textured).alpha_texture).value, 0.25f);
  EXPECT_EQ(geometry(VaryingRead("Shape \"sphere\"")).alpha_texture, no_index);
  EXPECT_EQ(geometry(VaryingRead("Shape \"sphere\" \"float alpha\" 1")).alpha_texture, no_index);
}

// pbrt's rule: a PNG's (or EXR's) alpha where it has one, decoded like the colours, else the mean of the colours.
TEST(PbrtVarying, WhatOfAnImageANumberIs) {
  const auto use = [](const std::string& file) {
    return VaryingRead("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"" + file +
                       "\"\nShape \"sphere\" \"texture alpha\" \"t\"");
  };
  const VaryingRead masked = use("i.png");
  ASSERT_THAT(masked.read.messages, ElementsAre());
  EXPECT_EQ(masked.at(0).is_number, 1u);
  EXPECT_EQ(masked.at(0).channel, TextureChannel::alpha);
  EXPECT_NEAR(masked.read.scene.images.at(0).alpha.at(0), 0.051269, 1e-5);  // IEC 61966-2-1 of 64 / 255
  EXPECT_EQ(use("o.png").at(0).channel, TextureChannel::average);
  EXPECT_EQ(use("i.tga").at(0).channel, TextureChannel::average);
}

TEST(PbrtVarying, EveryMistakeIsSaidWithItsLine) {
  const VaryingRead r(
      "Texture \"t\" \"spectrum\" \"constant\"\n"
      "Material \"conductor\" \"texture roughness\" \"t\"\n"
      "Material \"diffuse\" \"float displacement\" .5\n"
      "Material \"diffuse\" \"string normalmap\" \"none.png\"\n"
      "Shape \"sphere\" \"texture alpha\" \"u\"\n");
  EXPECT_THAT(r.read.messages,
              ElementsAre(HasSubstr("scene:3: error: Material \"conductor\": there is no texture 't'"),
                          HasSubstr("scene:4: error: Material \"diffuse\": 'float displacement' should be 'texture "
                                    "displacement'"),
                          testing::AllOf(HasSubstr("scene:5: error"), HasSubstr("none.png")),
                          HasSubstr("scene:6: error: Shape \"sphere\": there is no texture 'u'")));
}

}  // namespace
}  // namespace metamer
