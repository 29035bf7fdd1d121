// pbrt's coats, sheets and mixes as the registry then holds them.
#include <gmock/gmock.h>

#include <cmath>

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

TEST(PbrtLayeredMaterials, CoatedConductorHasPbrtsDefaults) {
  MaterialRead read("Material \"coatedconductor\"");
  EXPECT_EQ(read.m.kind, MaterialKind::layered);
  const Layer& layer = read.m.layer;
  EXPECT_EQ(layer.base, LayerBase::conductor);
  EXPECT_NEAR(read.value(read.m.eta), 1.5, 1e-6);
  EXPECT_NEAR(read.value(layer.base_kappa, 650), 3.6, 0.4) << "copper";
  EXPECT_EQ(read.m.alpha_x, 0);
  EXPECT_EQ(layer.base_alpha_x, 0);
  EXPECT_EQ(layer.thickness, 0.01f);
  EXPECT_EQ(layer.max_depth, 10u);
  EXPECT_EQ(layer.asymmetry, 0);
  EXPECT_EQ(read.value(layer.albedo), 0);
}

TEST(PbrtLayeredMaterials, CoatedConductorTakesAllOfItsParameters) {
  MaterialRead read(
      "Material \"coatedconductor\" \"float interface.eta\" 1.7 \"float interface.roughness\" .04 "
      "\"spectrum conductor.eta\" \"metal-Au-eta\" \"spectrum conductor.k\" \"metal-Au-k\" "
      "\"float conductor.uroughness\" .09 \"float conductor.vroughness\" .16 \"float thickness\" .2 \"float g\" -.3 "
      "\"rgb albedo\" [.5 .5 .5] \"integer maxdepth\" 20 \"integer nsamples\" 3");
  const Layer& layer = read.m.layer;
  EXPECT_NEAR(read.value(read.m.eta), 1.7, 1e-6);
  EXPECT_NEAR(read.m.alpha_x, 0.2, 1e-6);
  EXPECT_NEAR(read.m.alpha_y, 0.2, 1e-6);
  EXPECT_NEAR(read.value(layer.base_eta, 600), 0.23, 0.05);
  EXPECT_NEAR(layer.base_alpha_x, 0.3, 1e-6);
  EXPECT_NEAR(layer.base_alpha_y, 0.4, 1e-6);
  EXPECT_EQ(layer.thickness, 0.2f);
  EXPECT_EQ(layer.asymmetry, -0.3f);
  EXPECT_NEAR(read.value(layer.albedo), 0.5, 1e-5);
  EXPECT_EQ(layer.max_depth, 20u);
  EXPECT_EQ(layer.walks, 3u);
  MaterialRead white(
      "Material \"coatedconductor\" \"rgb reflectance\" [.8 .8 .8] \"bool remaproughness\" false "
      "\"float conductor.roughness\" .3");
  EXPECT_NEAR(white.value(white.m.layer.base_kappa), 2 * std::sqrt(0.8) / std::sqrt(0.2), 1e-3);
  EXPECT_EQ(white.m.layer.base_alpha_y, 0.3f);
  EXPECT_THAT(messages_of("Material \"coatedconductor\" \"float g\" 1"),
              ElementsAre("scene:2: error: Material \"coatedconductor\": 'g' must be between -1 and 1"));
}

TEST(PbrtLayeredMaterials, HairIsBrownUnlessItSaysOtherwise) {
  MaterialRead brown("Material \"hair\"");
  EXPECT_EQ(brown.m.kind, MaterialKind::hair);
  EXPECT_EQ(brown.m.hair.beta_m, 0.3f);
  EXPECT_EQ(brown.m.hair.beta_n, 0.3f);
  EXPECT_EQ(brown.m.hair.tilt_deg, 2);
  EXPECT_NEAR(brown.value(brown.m.eta), 1.55, 1e-6);
  EXPECT_GT(brown.value(brown.m.hair.sigma_a, 450), 2 * brown.value(brown.m.hair.sigma_a, 620)) << "red passes best";
  MaterialRead grey(
      "Material \"hair\" \"rgb sigma_a\" [.5 .5 .5] \"float eta\" 1.6 \"float beta_m\" .2 "
      "\"float beta_n\" .4 \"float alpha\" 3");
  EXPECT_NEAR(grey.value(grey.m.hair.sigma_a), 0.5, 1e-4);
  EXPECT_NEAR(grey.value(grey.m.eta), 1.6, 1e-6);
  EXPECT_EQ(grey.m.hair.beta_m, 0.2f);
  EXPECT_EQ(grey.m.hair.beta_n, 0.4f);
  EXPECT_EQ(grey.m.hair.tilt_deg, 3);
  MaterialRead coloured("Material \"hair\" \"rgb reflectance\" [.5 .5 .5]");
  EXPECT_NEAR(coloured.value(coloured.m.hair.sigma_a), std::pow(std::log(0.5) / 5.88842, 2), 1e-4);
  MaterialRead same("Material \"hair\" \"rgb color\" [.5 .5 .5]");
  EXPECT_NEAR(same.value(same.m.hair.sigma_a), coloured.value(coloured.m.hair.sigma_a), 1e-9);
  MaterialRead red("Material \"hair\" \"float pheomelanin\" 1");
  MaterialRead black("Material \"hair\" \"float eumelanin\" 8");
  EXPECT_LT(red.value(red.m.hair.sigma_a, 600), 0.5);
  EXPECT_GT(black.value(black.m.hair.sigma_a, 600), 3);
}

TEST(PbrtLayeredMaterials, HairHasItsMistakesNamed) {
  EXPECT_THAT(messages_of("Material \"hair\" \"float beta_m\" 2"),
              ElementsAre("scene:2: error: Material \"hair\": beta_m must be from 0 to 1"));
  EXPECT_THAT(
      messages_of("Material \"hair\" \"float eumelanin\" 1 \"rgb color\" [.5 .5 .5]"),
      ElementsAre("scene:2: warning: material \"hair\": of 'sigma_a', 'reflectance' or 'color', and pigments the "
                  "first counts"));
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
