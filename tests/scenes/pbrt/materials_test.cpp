#include <cmath>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

constexpr const char* sphere = " Shape \"sphere\"\n";

struct MaterialRead : ReadScene {
  Material m;
  explicit MaterialRead(const std::string& text) : ReadScene(read_world(text + sphere)), m(material()) {
    EXPECT_TRUE(ok) << text << "\n" << format_diagnostics(diagnostics);
  }
  double value(SpectrumId id, double lambda_nm) const { return scene.spectra.value(id, lambda_nm); }
};

TEST(PbrtMaterials, WithoutAMaterialAShapeHasNoSlot) {
  EXPECT_EQ(read_world(sphere).count<MaterialSlot>(), 0u) << "the scene's default is pbrt's: diffuse 0.5";
}

TEST(PbrtMaterials, DiffuseReflectanceComesAsRgbTableOrName) {
  MaterialRead standard("Material \"diffuse\"");
  EXPECT_EQ(standard.m.kind, MaterialKind::diffuse);
  EXPECT_NEAR(standard.value(standard.m.reflectance, 550), 0.5, 1e-6);
  MaterialRead grey("Material \"diffuse\" \"rgb reflectance\" [.2 .2 .2]");
  EXPECT_NEAR(grey.value(grey.m.reflectance, 610), 0.2, 1e-6);
  MaterialRead table("Material \"diffuse\" \"spectrum reflectance\" [400 .1 500 .2 600 .6]");
  EXPECT_NEAR(table.value(table.m.reflectance, 450), 0.15, 1e-6);
  EXPECT_NEAR(table.value(table.m.reflectance, 550), 0.4, 1e-6);
  EXPECT_EQ(table.value(table.m.reflectance, 700), 0.0) << "as in pbrt, zero outside the table";
}

TEST(PbrtMaterials, RgbIsOfTheColourSpaceInForce) {
  // A wide gamut's red is more saturated: less green light comes back.
  MaterialRead srgb("Material \"diffuse\" \"rgb reflectance\" [.5 .1 .1]");
  MaterialRead rec2020("ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [.5 .1 .1]");
  EXPECT_LT(rec2020.value(rec2020.m.reflectance, 530), srgb.value(srgb.m.reflectance, 530));
}

TEST(PbrtMaterials, SpectrumFilesAreRead) {
  const TemporaryFolder folder;
  folder.write("paint.spd", "# nm value\n400 0.25\n 700 0.5\n");
  const ReadScene read = read_scene_at(folder.write(
      "scene", std::string("WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"paint.spd\"") + sphere));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_NEAR(read.scene.spectra.value(read.material().reflectance, 550), 0.375, 1e-6);
}

TEST(PbrtMaterials, ConductorsAreCopperUnlessTheySayOtherwise) {
  MaterialRead copper("Material \"conductor\"");
  EXPECT_EQ(copper.m.kind, MaterialKind::conductor);
  EXPECT_NEAR(copper.value(copper.m.kappa, 650), 3.6, 0.4);  // Cu at 650 nm, Johnson & Christy 1972: 0.21 + 3.67 i
  EXPECT_EQ(copper.m.alpha_x, 0.0f);
  MaterialRead gold("Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"");
  EXPECT_NEAR(gold.value(gold.m.eta, 600), 0.23, 0.05);  // Au at 600 nm: 0.23 + 3.0 i
  MaterialRead rgb("Material \"conductor\" \"rgb eta\" [2 2 2] \"rgb k\" [3 3 3]");
  EXPECT_NEAR(rgb.value(rgb.m.eta, 500), 2.0, 1e-5);
  EXPECT_NEAR(rgb.value(rgb.m.kappa, 500), 3.0, 1e-5);
}

TEST(PbrtMaterials, AConductorsReflectanceIsItsReflectanceAtNormalIncidence) {
  MaterialRead read("Material \"conductor\" \"rgb reflectance\" [.64 .64 .64]");
  const double n = read.value(read.m.eta, 550), k = read.value(read.m.kappa, 550);
  EXPECT_EQ(n, 1.0);
  EXPECT_NEAR(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 0.64, 1e-5);
}

TEST(PbrtMaterials, RoughnessIsRemappedByASquareRootUnlessSwitchedOff) {
  EXPECT_FLOAT_EQ(MaterialRead("Material \"conductor\" \"float roughness\" .25").m.alpha_x, 0.5f);
  EXPECT_FLOAT_EQ(
      MaterialRead("Material \"conductor\" \"float roughness\" .25 \"bool remaproughness\" false").m.alpha_y, 0.25f);
  EXPECT_FLOAT_EQ(
      MaterialRead("Material \"conductor\" \"float roughness\" .25 \"bool remaproughness\" \"false\"").m.alpha_y,
      0.25f);
  const Material m = MaterialRead("Material \"conductor\" \"float uroughness\" .04 \"float roughness\" .09").m;
  EXPECT_FLOAT_EQ(m.alpha_x, 0.2f);
  EXPECT_FLOAT_EQ(m.alpha_y, 0.3f);
}

TEST(PbrtMaterials, DielectricsTakeANumberATableOrAGlass) {
  MaterialRead standard("Material \"dielectric\"");
  EXPECT_EQ(standard.m.kind, MaterialKind::dielectric);
  EXPECT_EQ(standard.value(standard.m.eta, 500), 1.5);
  MaterialRead diamond("Material \"dielectric\" \"float eta\" 2.4");
  EXPECT_NEAR(diamond.value(diamond.m.eta, 500), 2.4, 1e-6);
  MaterialRead bk7("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"");
  EXPECT_NEAR(bk7.value(bk7.m.eta, 587.56), 1.5168, 1e-4);  // n_d of Schott N-BK7
  MaterialRead sf11("Material \"dielectric\" \"spectrum eta\" \"glass-F11\"");
  EXPECT_NEAR(sf11.value(sf11.m.eta, 587.56), 1.7847, 1e-3);  // n_d of Schott SF11
  MaterialRead table("Material \"dielectric\" \"spectrum eta\" [500 1.4 600 1.3]");
  EXPECT_NEAR(table.value(table.m.eta, 400), 1.4, 1e-6) << "an index keeps its last value";
}

TEST(PbrtMaterials, DielectricsMayBeRoughOrThin) {
  MaterialRead frosted("Material \"dielectric\" \"float roughness\" .25");
  EXPECT_EQ(frosted.m.kind, MaterialKind::dielectric);
  EXPECT_EQ(frosted.m.alpha_x, 0.5f) << "remapped by the square root";
  EXPECT_EQ(frosted.m.alpha_y, 0.5f);
  EXPECT_TRUE(frosted.messages.empty());
  MaterialRead brushed(
      "Material \"dielectric\" \"float uroughness\" .1 \"float vroughness\" .3 \"bool remaproughness\" false");
  EXPECT_EQ(brushed.m.alpha_x, 0.1f);
  EXPECT_EQ(brushed.m.alpha_y, 0.3f);
  MaterialRead pane("Material \"thindielectric\" \"float eta\" 1.7");
  EXPECT_EQ(pane.m.kind, MaterialKind::dielectric);
  EXPECT_EQ(pane.m.thin, 1u);
  EXPECT_NEAR(pane.value(pane.m.eta, 500), 1.7, 1e-6);
  EXPECT_TRUE(pane.messages.empty());
}

TEST(PbrtMaterials, NamedMaterialsMayBeUsedBeforeTheyAreMadeAndAreShared) {
  const ReadScene read = read_world(
      std::string("NamedMaterial \"red\"") + sphere + sphere +
      "MakeNamedMaterial \"red\" \"string type\" \"conductor\"\nAttributeBegin Material \"diffuse\" AttributeEnd" +
      sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.material(0).kind, MaterialKind::conductor);
  EXPECT_EQ(read.get<MaterialSlot>(0).material, read.get<MaterialSlot>(2).material);
  EXPECT_EQ(read.scene.describe(read.get<MaterialSlot>(0).material), "'red'");
}

TEST(PbrtMaterials, AttributeSetsDefaultsUntilItsBlockEnds) {
  const ReadScene read =
      read_world(std::string("AttributeBegin Attribute \"material\" \"rgb reflectance\" [.3 .3 .3] Attribute \"shape\" "
                             "\"float radius\" 4\n") +
                 "Material \"diffuse\"" + sphere +
                 "Material \"diffuse\" \"rgb reflectance\" [.1 .1 .1] Shape \"sphere\" \"float radius\" 2\n" +
                 "AttributeEnd Material \"diffuse\"" + sphere);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_NEAR(read.scene.spectra.value(read.material(0).reflectance, 500), 0.3, 1e-6);
  EXPECT_NEAR(read.scene.spectra.value(read.material(1).reflectance, 500), 0.1, 1e-6);
  EXPECT_NEAR(read.scene.spectra.value(read.material(2).reflectance, 500), 0.5, 1e-6);
  EXPECT_EQ(read.get<Geometry>(0).radius, 4.0f);
  EXPECT_EQ(read.get<Geometry>(1).radius, 2.0f);
  EXPECT_EQ(read.get<Geometry>(2).radius, 1.0f);
}

TEST(PbrtMaterials, ReflectancesAboveOneAreClampedWithAWarning) {
  MaterialRead read("Material \"diffuse\" \"rgb reflectance\" [2 1 1]");
  EXPECT_NEAR(read.value(read.m.reflectance, 600), 1.0, 1e-6);
  EXPECT_THAT(read.messages, testing::ElementsAre("scene:2: warning: Material \"diffuse\": 'reflectance' exceeds 1, "
                                                  "which no passive surface does; it is clamped to 1"));
  MaterialRead table("Material \"diffuse\" \"spectrum reflectance\" [300 .5 600 1.5 900 .5]");
  EXPECT_NEAR(table.value(table.m.reflectance, 600), 1.0, 1e-6);
  EXPECT_LT(table.value(table.m.reflectance, 400), 1.0);
}

TEST(PbrtMaterials, WhatReplacesTheUnsupportedIsSaidOncePerKind) {
  const ReadScene read =
      read_world(std::string("Texture \"wood\" \"spectrum\" \"ptex\" Texture \"glass\" \"spectrum\" \"ptex\"\n") +
                 "Material \"dielectric\" \"texture eta\" \"glass\"" + sphere +
                 "Material \"diffuse\" \"texture reflectance\" \"wood\"" + sphere +
                 "Material \"subsurface\" \"float g\" 1" + sphere + "Material \"subsurface\" \"float g\" 1" + sphere);
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages,
              testing::ElementsAre(
                  "scene:2: warning: texture \"ptex\" is not supported; what it would colour gets its default value",
                  "scene:3: warning: textures for 'eta' are not supported yet; it gets its default value",
                  "scene:5: warning: material \"subsurface\" is not supported; it is rendered as diffuse with "
                  "reflectance 0.5"));
}

TEST(PbrtMaterials, ShapesOfAnInterfaceThatSeparateNothingAreLeftOut) {
  const ReadScene read =
      read_world(std::string("MakeNamedMaterial \"gap\" \"string type\" \"interface\"\nNamedMaterial \"gap\"") +
                 sphere + "Material \"diffuse\"" + sphere);
  EXPECT_TRUE(read.ok);
  EXPECT_EQ(read.count<Geometry>(), 1u);
  EXPECT_EQ(read.scene.location(read.entity<Geometry>()).line, 4u);
  EXPECT_TRUE(read.messages.empty());
}

}  // namespace
}  // namespace metamer
