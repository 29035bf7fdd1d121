// pbrt's coats, sheets and mixes as the registry then holds them.
#include <gmock/gmock.h>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using testing::ElementsAre;

constexpr const char* sphere = " Shape \"sphere\"\n";

struct MaterialRead : ReadScene {
  Material m;
  explicit MaterialRead(const std::string& text) : ReadScene(read_world(text + sphere)), m(material()) {
    EXPECT_TRUE(ok) << text << "\n" << format_diagnostics(diagnostics);
    EXPECT_THAT(messages, ElementsAre()) << text;
  }
  double value(SpectrumId id, double lambda_nm = 550) const { return scene.spectra.value(id, lambda_nm); }
};
std::vector<std::string> messages_of(const std::string& text) { return read_world(text + sphere).messages; }

TEST(PbrtLayeredMaterials, CoatedDiffuseHasPbrtsDefaults) {
  MaterialRead read("Material \"coateddiffuse\"");
  EXPECT_EQ(read.m.kind, MaterialKind::layered);
  EXPECT_EQ(read.m.layer.base, LayerBase::diffuse);
  EXPECT_NEAR(read.value(read.m.reflectance), 0.5, 1e-6);
  EXPECT_NEAR(read.value(read.m.eta), 1.5, 1e-6);
  EXPECT_EQ(read.m.alpha_x, 0);
  EXPECT_EQ(read.m.alpha_y, 0);
  EXPECT_EQ(read.m.layer.thickness, 0.01f);
  EXPECT_EQ(read.m.layer.max_depth, 10u);
  EXPECT_EQ(read.m.layer.walks, 1u);
}

TEST(PbrtLayeredMaterials, CoatedDiffuseTakesAllOfItsParameters) {
  MaterialRead read(
      "Material \"coateddiffuse\" \"rgb reflectance\" [.2 .2 .2] \"float eta\" 1.9 \"float uroughness\" .04 "
      "\"float vroughness\" .09 \"float thickness\" .5 \"integer maxdepth\" 100 \"integer nsamples\" 4");
  EXPECT_NEAR(read.value(read.m.reflectance), 0.2, 1e-6);
  EXPECT_NEAR(read.value(read.m.eta), 1.9, 1e-6);
  EXPECT_NEAR(read.m.alpha_x, 0.2, 1e-6) << "remapped by the square root";
  EXPECT_NEAR(read.m.alpha_y, 0.3, 1e-6);
  EXPECT_EQ(read.m.layer.thickness, 0.5f);
  EXPECT_EQ(read.m.layer.max_depth, 100u);
  EXPECT_EQ(read.m.layer.walks, 4u);
  MaterialRead plain("Material \"coateddiffuse\" \"float roughness\" .3 \"bool remaproughness\" false");
  EXPECT_EQ(plain.m.alpha_x, 0.3f);
  EXPECT_EQ(plain.m.alpha_y, 0.3f);
}

TEST(PbrtLayeredMaterials, CoatedDiffuseHasItsMistakesNamed) {
  EXPECT_THAT(messages_of("Material \"coateddiffuse\" \"float thickness\" -1"),
              ElementsAre("scene:2: error: Material \"coateddiffuse\": a layer's thickness must not be negative"));
  EXPECT_THAT(messages_of("\nMaterial \"coateddiffuse\" \"float eta\" 0"),
              ElementsAre("scene:3: error: Material \"coateddiffuse\": an index of refraction must be positive"));
  EXPECT_THAT(messages_of("Material \"coateddiffuse\" \"integer maxdepth\" -2"),
              ElementsAre(testing::HasSubstr("scene:2: error: Material \"coateddiffuse\": 'maxdepth'")));
}

TEST(PbrtLayeredMaterials, DiffuseTransmissionScalesBothOfItsAlbedos) {
  MaterialRead standard("Material \"diffusetransmission\"");
  EXPECT_EQ(standard.m.kind, MaterialKind::diffuse_transmission);
  EXPECT_NEAR(standard.value(standard.m.reflectance), 0.25, 1e-6);
  EXPECT_NEAR(standard.value(standard.m.transmittance), 0.25, 1e-6);
  MaterialRead read(
      "Material \"diffusetransmission\" \"rgb reflectance\" [.2 .2 .2] \"rgb transmittance\" [.6 .6 .6] "
      "\"float scale\" 2");
  EXPECT_NEAR(read.value(read.m.reflectance), 0.4, 1e-5);
  EXPECT_NEAR(read.value(read.m.transmittance), 1.0, 1e-5) << "at most 1";
  MaterialRead textured(
      "Texture \"leaf\" \"spectrum\" \"constant\" \"rgb value\" [.4 .4 .4]\nMaterial \"diffusetransmission\" "
      "\"texture reflectance\" \"leaf\" \"texture transmittance\" \"leaf\" \"float scale\" .5");
  const Texture& product = textured.scene.textures.at(textured.m.transmittance_texture);
  EXPECT_EQ(product.kind, TextureKind::scale);
  EXPECT_EQ(textured.scene.textures.at(product.b).value, 0.5f);
  EXPECT_EQ(textured.scene.textures.at(textured.m.reflectance_texture).a, product.a);
}

TEST(PbrtLayeredMaterials, MixNamesTwoMaterialsThatMayComeLater) {
  const ReadScene read = read_world(std::string("MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n") +
                                    "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .3" + sphere +
                                    "MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages, ElementsAre());
  const Material m = read.material();
  EXPECT_EQ(m.kind, MaterialKind::mix);
  EXPECT_EQ(m.mix.amount, 0.3f);
  EXPECT_EQ(read.scene.registry.get<Material>(m.mix.first).kind, MaterialKind::diffuse);
  EXPECT_EQ(read.scene.registry.get<Material>(m.mix.second).kind, MaterialKind::conductor);
  EXPECT_EQ(MaterialRead("MakeNamedMaterial \"a\" \"string type\" \"diffuse\" Material \"mix\" "
                         "\"string materials\" [\"a\" \"a\"]")
                .m.mix.amount,
            0.5f);
}

TEST(PbrtLayeredMaterials, MixHasItsMistakesNamed) {
  EXPECT_THAT(
      messages_of("Material \"mix\" \"float amount\" .3"),
      ElementsAre("scene:2: error: Material \"mix\": 'string materials' names the two materials that are mixed, "
                  "not 0"));
  EXPECT_THAT(
      messages_of("\nMaterial \"mix\" \"string materials\" [\"a\" \"b\" \"c\"]"),
      ElementsAre("scene:3: error: Material \"mix\": 'string materials' names the two materials that are mixed, "
                  "not 3"));
  EXPECT_THAT(messages_of("Material \"mix\" \"string materials\" [\"a\" \"b\"]"),
              ElementsAre("scene:2: error: there is no material 'a'", "scene:2: error: there is no material 'b'"));
}

}  // namespace
}  // namespace metamer
