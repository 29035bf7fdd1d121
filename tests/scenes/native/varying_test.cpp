// What may vary beside colours: roughness, displacement, normal maps, alpha, amounts; and what is said where it is
// wrong.
#include <gmock/gmock.h>

#include <cmath>

#include "scenes/native/read_native.h"
#include "tests/scenes/support/files.h"

namespace metamer {
namespace {

using testing::HasSubstr;

struct VaryingScene {
  Scene scene;
  Diagnostics diagnostics;
  bool ok;
  explicit VaryingScene(const std::string& members, const std::string& units = "m") {
    const std::string text = "{\"metamer\": 1, \"units\": \"" + units + "\",\n\"textures\": {\n" +
                             "\"f\": {\"type\": \"constant\", \"value\": 0.25, \"number\": true},\n" +
                             "\"c\": {\"type\": \"constant\", \"value\": 0.5},\n" +
                             "\"r\": {\"type\": \"square_root\", \"a\": {\"texture\": \"f\"}}\n},\n" + members + "}";
    ok = read_native("scene.json", copy_bytes(text), scene, diagnostics);
  }
  std::string messages() const { return format_diagnostics(diagnostics); }
  Material material() const { return scene.registry.table<Material>().get(0); }
  Texture at(TextureId id) const { return scene.textures.at(id); }
};

VaryingScene material(const std::string& keys, const std::string& units = "m") {
  return VaryingScene("\"materials\": {\"m\": {" + keys + "}}, \"entities\": []", units);
}

TEST(NativeVarying, RoughnessMayBeATextureOrAPairOfThem) {
  const VaryingScene one = material("\"type\": \"conductor\", \"metal\": \"Au\", \"roughness\": {\"texture\": \"r\"}");
  ASSERT_TRUE(one.ok) << one.messages();
  EXPECT_EQ(one.material().alpha_x_texture, one.material().alpha_y_texture);
  EXPECT_EQ(one.at(one.material().alpha_x_texture).kind, TextureKind::square_root);
  const VaryingScene pair =
      material("\"type\": \"dielectric\", \"eta\": 1.5, \"roughness\": [0.125, {\"texture\": \"f\"}]");
  ASSERT_TRUE(pair.ok) << pair.messages();
  EXPECT_EQ(pair.material().alpha_x, 0.125f);
  EXPECT_EQ(pair.material().alpha_x_texture, no_index);
  EXPECT_EQ(pair.at(pair.material().alpha_y_texture).value, 0.25f);
}

TEST(NativeVarying, DisplacementsAreLengthsInTheFilesUnits) {
  const VaryingScene metres =
      material("\"type\": \"diffuse\", \"reflectance\": 0.5, \"displacement\": {\"texture\": \"f\"}");
  ASSERT_TRUE(metres.ok) << metres.messages();
  EXPECT_EQ(metres.at(metres.material().displacement).value, 0.25f);
  const VaryingScene cm =
      material("\"type\": \"diffuse\", \"reflectance\": 0.5, \"displacement\": {\"texture\": \"f\"}", "cm");
  const Texture scaled = cm.at(cm.material().displacement);
  EXPECT_EQ(scaled.kind, TextureKind::scale);
  EXPECT_EQ(cm.at(scaled.b).value, 0.01f);
}

TEST(NativeVarying, AConductorsReflectanceIsASpectrumOrATexture) {
  const VaryingScene spectrum = material("\"type\": \"conductor\", \"reflectance\": 0.5");
  ASSERT_TRUE(spectrum.ok) << spectrum.messages();
  EXPECT_NEAR(spectrum.scene.spectra.value(spectrum.material().kappa, 550), 2, 1e-5);  // 2 sqrt(R / (1 - R))
  EXPECT_EQ(spectrum.scene.spectra.value(spectrum.material().eta, 550), 1);
  const VaryingScene texture = material("\"type\": \"conductor\", \"reflectance\": {\"texture\": \"c\"}");
  ASSERT_TRUE(texture.ok) << texture.messages();
  EXPECT_EQ(texture.at(texture.material().reflectance_texture).is_number, 0u);
}

TEST(NativeVarying, EveryNumberOfALayer) {
  const VaryingScene r = material(
      "\"type\": \"layered\", \"base_reflectance\": {\"texture\": \"c\"}, \"eta\": 1.5, "
      "\"roughness\": {\"texture\": \"f\"}, \"base_roughness\": [{\"texture\": \"r\"}, 0.125], "
      "\"optical_thickness\": {\"texture\": \"f\"}, \"asymmetry\": {\"texture\": \"r\"}, "
      "\"albedo\": {\"texture\": \"c\"}");
  ASSERT_TRUE(r.ok) << r.messages();
  const Material m = r.material();
  EXPECT_EQ(m.layer.base, LayerBase::conductor);
  EXPECT_EQ(r.at(m.reflectance_texture).is_number, 0u);
  EXPECT_EQ(m.alpha_x_texture, m.alpha_y_texture);
  EXPECT_EQ(r.at(m.alpha_x_texture).value, 0.25f);
  EXPECT_EQ(r.at(m.layer.base_alpha_x_texture).kind, TextureKind::square_root);
  EXPECT_EQ(m.layer.base_alpha_y, 0.125f);
  EXPECT_EQ(m.layer.base_alpha_y_texture, no_index);
  EXPECT_EQ(r.at(m.layer.thickness_texture).value, 0.25f);
  EXPECT_EQ(r.at(m.layer.asymmetry_texture).kind, TextureKind::square_root);
  EXPECT_EQ(r.at(m.layer.albedo_texture).is_number, 0u);
  EXPECT_THAT(material("\"type\": \"layered\", \"base_reflectance\": 0.5, \"base_kappa\": 1, \"eta\": 1.5").messages(),
              HasSubstr("'base_reflectance' and 'base_kappa' exclude each other"));
}

TEST(NativeVarying, TheColourOfHair) {
  const VaryingScene spectrum = material("\"type\": \"hair\", \"reflectance\": 0.25");
  ASSERT_TRUE(spectrum.ok) << spectrum.messages();
  // Chiang et al., equation 9, at beta_n = 0.3: (ln 0.25 / 5.8586...)^2.
  const double b = 0.3;
  const double factor =
      5.969 - 0.215 * b + 2.532 * b * b - 10.73 * std::pow(b, 3) + 5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
  EXPECT_NEAR(spectrum.scene.spectra.value(spectrum.material().hair.sigma_a, 550), std::pow(std::log(0.25) / factor, 2),
              1e-5);
  const VaryingScene texture = material("\"type\": \"hair\", \"reflectance\": {\"texture\": \"c\"}");
  ASSERT_TRUE(texture.ok) << texture.messages();
  EXPECT_EQ(texture.at(texture.material().reflectance_texture).is_number, 0u);
}

TEST(NativeVarying, FiltersOfImages) {
  const auto image = [](const std::string& keys) {
    Scene scene;
    Diagnostics diagnostics;
    const TemporaryFolder folder;
    folder.write("grey.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0'));
    const std::string path = folder.write(
        "scene.json", "{\"metamer\": 1, \"textures\": {\"i\": {\"type\": \"image\", \"image\": \"grey.pfm\"" + keys +
                          "}}, \"entities\": []}");
    read_native(path, scene, diagnostics);
    return std::pair(scene.textures.empty() ? Texture() : scene.textures[0], format_diagnostics(diagnostics));
  };
  EXPECT_EQ(image("").first.filter, TextureFilter::anisotropic);
  EXPECT_EQ(image("").first.most_anisotropy, 8.0f);
  EXPECT_EQ(image(", \"filter\": \"trilinear\"").first.filter, TextureFilter::trilinear);
  EXPECT_EQ(image(", \"filter\": \"linear\"").first.filter, TextureFilter::linear);
  EXPECT_EQ(image(", \"filter\": \"nearest\"").first.filter, TextureFilter::nearest);
  EXPECT_EQ(image(", \"anisotropy\": 2.5").first.most_anisotropy, 2.5f);
  EXPECT_THAT(image(", \"anisotropy\": 0.5").second, HasSubstr("'anisotropy' is the number 0.5"));
  EXPECT_THAT(image(", \"filter\": \"linear\", \"anisotropy\": 2").second,
              HasSubstr("'anisotropy' goes with the filter 'anisotropic' only"));
  EXPECT_THAT(image(", \"filter\": \"trilinar\"").second, HasSubstr("did you mean 'trilinear'?"));
}

TEST(NativeVarying, AlphaOfShapes) {
  const auto alpha = [](const std::string& value) {
    return VaryingScene("\"entities\": [{\"geometry\": {\"type\": \"sphere\", \"alpha\": " + value + "}}]");
  };
  const auto texture_of = [](const VaryingScene& s) { return s.scene.registry.table<Geometry>().get(0).alpha_texture; };
  const VaryingScene half = alpha("0.5"), textured = alpha("{\"texture\": \"f\"}");
  ASSERT_TRUE(half.ok && textured.ok);
  EXPECT_EQ(half.at(texture_of(half)).value, 0.5f);
  EXPECT_EQ(textured.at(texture_of(textured)).value, 0.25f);
  EXPECT_EQ(texture_of(alpha("1")), no_index);
  EXPECT_THAT(alpha("1.5").messages(), HasSubstr("'alpha' is the number 1.5; expected a number from 0 to 1"));
}

TEST(NativeVarying, EveryMistakeIsSaid) {
  EXPECT_THAT(material("\"type\": \"conductor\", \"metal\": \"Au\", \"roughness\": {\"texture\": \"c\"}").messages(),
              HasSubstr("the texture is one of reflectances; expected one of numbers"));
  EXPECT_THAT(material("\"type\": \"diffuse\", \"reflectance\": 0.5, \"displacement\": 0.1").messages(),
              HasSubstr("'displacement' is the number 0.1; expected a texture of numbers"));
  EXPECT_THAT(material("\"type\": \"diffuse\", \"reflectance\": 0.5, \"normal_map\": \"none.png\"").messages(),
              HasSubstr("none.png"));
  EXPECT_THAT(material("\"type\": \"diffuse\", \"reflectance\": 0.5, \"normal_map\": \"n.png\", \"displacement\": "
                       "{\"texture\": \"f\"}")
                  .messages(),
              HasSubstr("'displacement' and 'normal_map' exclude each other"));
  EXPECT_THAT(material("\"type\": \"conductor\", \"reflectance\": 0.5, \"kappa\": 1").messages(),
              HasSubstr("'reflectance' and 'kappa' exclude each other"));
  EXPECT_THAT(material("\"type\": \"dielectric\", \"eta\": 1.5, \"thin\": true, \"roughness\": {\"texture\": \"f\"}")
                  .messages(),
              HasSubstr("'thin' and 'roughness' exclude each other"));
}

}  // namespace
}  // namespace metamer
