// Layered materials, sheets and mixes in our own format: what is read, and what is said about mistakes.
#include <gmock/gmock.h>

#include "scenes/native/read_native.h"
#include "scenes/read_scene.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct MaterialsRead {
  Scene scene;
  std::string messages;
  explicit MaterialsRead(const std::string& materials) {
    Diagnostics diagnostics;
    const std::string text = "{\"metamer\": 1, \"materials\": {\n" + materials + "\n}, \"entities\": []}";
    const bool ok = read_native("scene.json", copy_bytes(text), scene, diagnostics);
    EXPECT_NE(ok, diagnostics.has_errors());
    messages = format_diagnostics(diagnostics);
  }
  Material at(uint32_t n) const { return scene.registry.table<Material>().get(n); }
};

TEST(NativeLayeredMaterials, LayersAreRead) {
  const MaterialsRead read(
      "\"m\": {\"type\": \"layered\", \"reflectance\": 0.3, \"eta\": 1.6, \"roughness\": [0.1, 0.2], "
      "\"optical_thickness\": 0.5, \"max_depth\": 7}");
  EXPECT_EQ(read.messages, "");
  const Material m = read.at(0);
  EXPECT_EQ(m.kind, MaterialKind::layered);
  EXPECT_NEAR(read.scene.spectra.value(m.reflectance, 550), 0.3, 1e-6);
  EXPECT_NEAR(read.scene.spectra.value(m.eta, 550), 1.6, 1e-6);
  EXPECT_EQ(m.alpha_x, 0.1f);
  EXPECT_EQ(m.alpha_y, 0.2f);
  EXPECT_EQ(m.layer.thickness, 0.5f);
  EXPECT_EQ(m.layer.max_depth, 7u);
}

TEST(NativeLayeredMaterials, EveryKeyOfLayersIsChecked) {
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"layered\", \"eta\": 1.5}").messages,
              AllOf(HasSubstr("'reflectance'"), HasSubstr("'base_metal'"), HasSubstr("'base_eta'")));
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"layered\", \"reflectance\": 0.5}").messages, HasSubstr("'glass'"));
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"layered\", \"reflectance\": 2, \"eta\": 1.5, \"roughness\": -1,\n"
                            "\"optical_thickness\": -1, \"max_depth\": 0.5}")
                  .messages,
              AllOf(HasSubstr("'reflectance' is the number 2; expected a number from 0 to 1"),
                    HasSubstr("'roughness' is the number -1"),
                    HasSubstr("scene.json:3: error: 'optical_thickness' is the number -1"),
                    HasSubstr("'max_depth' is the number 0.5")));
}

TEST(NativeLayeredMaterials, BasesMayBeMetals) {
  const MaterialsRead read(
      "\"m\": {\"type\": \"layered\", \"base_metal\": \"Au\", \"base_roughness\": [0.1, 0.2], \"eta\": 1.5, "
      "\"albedo\": 0.3, \"asymmetry\": -0.5, \"walks\": 3}");
  EXPECT_EQ(read.messages, "");
  const Layer layer = read.at(0).layer;
  EXPECT_EQ(layer.base, LayerBase::conductor);
  EXPECT_NEAR(read.scene.spectra.value(layer.base_eta, 600), 0.23, 0.05);
  EXPECT_EQ(layer.base_alpha_x, 0.1f);
  EXPECT_EQ(layer.base_alpha_y, 0.2f);
  EXPECT_NEAR(read.scene.spectra.value(layer.albedo, 600), 0.3, 1e-6);
  EXPECT_EQ(layer.asymmetry, -0.5f);
  EXPECT_EQ(layer.walks, 3u);
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"layered\", \"base_eta\": 2, \"eta\": 1.5}").messages,
              HasSubstr("lacks the required key 'base_kappa'"));
  EXPECT_THAT(
      MaterialsRead("\"m\": {\"type\": \"layered\", \"base_metal\": \"Au\", \"base_kappa\": 2, \"eta\": 1.5,\n"
                    "\"asymmetry\": 1}")
          .messages,
      AllOf(HasSubstr("'base_metal' and 'base_kappa' exclude each other"), HasSubstr("'asymmetry' is the number 1")));
  EXPECT_THAT(
      MaterialsRead("\"m\": {\"type\": \"layered\", \"reflectance\": 0.5, \"base_roughness\": 0.2, \"eta\": 1.5}")
          .messages,
      HasSubstr("'reflectance' and 'base_roughness' exclude each other"));
}

TEST(NativeLayeredMaterials, HairIsRead) {
  const MaterialsRead read(
      "\"m\": {\"type\": \"hair\", \"sigma_a\": 0.7, \"beta_m\": 0.2, \"beta_n\": 0.4, \"tilt\": 3, \"eta\": 1.6}");
  EXPECT_EQ(read.messages, "");
  const Material m = read.at(0);
  EXPECT_EQ(m.kind, MaterialKind::hair);
  EXPECT_NEAR(read.scene.spectra.value(m.hair.sigma_a, 500), 0.7, 1e-6);
  EXPECT_EQ(m.hair.beta_m, 0.2f);
  EXPECT_EQ(m.hair.beta_n, 0.4f);
  EXPECT_EQ(m.hair.tilt_deg, 3);
  EXPECT_NEAR(read.scene.spectra.value(m.eta, 500), 1.6, 1e-6);
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"hair\", \"beta_m\": 2}").messages,
              AllOf(HasSubstr("expected 'sigma_a' or 'reflectance'"), HasSubstr("'beta_m' is the number 2")));
}

TEST(NativeLayeredMaterials, SheetsHaveTwoAlbedos) {
  const MaterialsRead read("\"m\": {\"type\": \"diffuse_transmission\", \"reflectance\": 0.3, \"transmittance\": 0.6}");
  EXPECT_EQ(read.messages, "");
  EXPECT_EQ(read.at(0).kind, MaterialKind::diffuse_transmission);
  EXPECT_NEAR(read.scene.spectra.value(read.at(0).transmittance, 550), 0.6, 1e-6);
  EXPECT_THAT(MaterialsRead("\"m\": {\"type\": \"diffuse_transmission\", \"reflectance\": 0.3}").messages,
              HasSubstr("lacks the required key 'transmittance'"));
}

TEST(NativeLayeredMaterials, MixesNameAnyOtherMaterials) {
  const MaterialsRead read(
      "\"a\": {\"type\": \"mix\", \"first\": \"b\", \"second\": \"c\", \"amount\": 0.25},\n"
      "\"b\": {\"type\": \"mirror\"}, \"c\": {\"type\": \"diffuse\", \"reflectance\": 0.5}");
  EXPECT_EQ(read.messages, "");
  const Material m = read.at(0);
  EXPECT_EQ(m.kind, MaterialKind::mix);
  EXPECT_EQ(m.mix.amount, 0.25f);
  EXPECT_EQ(read.scene.registry.get<Material>(m.mix.first).kind, MaterialKind::conductor);
  EXPECT_EQ(read.scene.registry.get<Material>(m.mix.second).kind, MaterialKind::diffuse);
  EXPECT_THAT(MaterialsRead("\"copper\": {\"type\": \"mirror\"},\n\"m\": {\"type\": \"mix\", \"first\": \"coper\", "
                            "\"second\": 3, \"amount\": 2}")
                  .messages,
              AllOf(HasSubstr("scene.json:3: error: unknown material 'coper' (did you mean 'copper'?)"),
                    HasSubstr("'second' is the number 3"), HasSubstr("'amount' is the number 2")));
}

}  // namespace
}  // namespace metamer
