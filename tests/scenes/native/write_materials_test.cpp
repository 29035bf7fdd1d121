// What the writer makes of images, textures and materials, read back.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include "tests/scenes/native/converted.h"
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

std::string image_file(const TemporaryFolder& folder, const std::string& name, bool is_float, int width = 4,
                       int height = 2) {
  const std::string path = (folder.path() / name).string();
  const auto output = OIIO::ImageOutput::create(path);
  const OIIO::ImageSpec spec(width, height, 3, is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  std::vector<float> pixels;
  for (int i = 0; i < 3 * width * height; ++i) pixels.push_back(float(i) / 64);
  EXPECT_TRUE(output->open(path, spec) && output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
  return path;
}

TEST(NativeWriter, ImagesOfLightsAndPortalsAreKept) {
  const TemporaryFolder images;
  const std::string file = "\"string filename\" \"" + image_file(images, "glow.exr", true, 4, 4) + "\"";
  const ReadScene read = read_world(
      "LightSource \"infinite\" " + file +
      " \"float scale\" 0.3\n"
      "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.3] \"point3 portal\" [0.1 0 1  0.1 1.5 1  1.3 1.5 1  1.3 0 1]\n"
      "Rotate 20 1 2 3 LightSource \"goniometric\" " +
      file +
      " \"float power\" 20 Translate 0.3 0 0\n"
      "LightSource \"projection\" " +
      file +
      " \"float fov\" 33\n"
      "Translate 0 0 3 AreaLightSource \"diffuse\" " +
      file +
      " Shape \"bilinearmesh\"\n"
      "  \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] \"point2 uv\" [0 0 1 0 0 1 1 1]\n");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.count<Light>(), 5u);
  const Scene back = converted(read.scene);
  for (uint32_t row = 0; row < 5; ++row) {
    const Light a = read.scene.registry.table<Light>().get(row), b = back.registry.table<Light>().get(row);
    EXPECT_EQ(a.kind, b.kind) << row;
    EXPECT_EQ(a.scale, b.scale) << row;
    EXPECT_EQ(a.fov_deg, b.fov_deg) << row;
    EXPECT_EQ(a.has_portal, b.has_portal) << row;
    EXPECT_TRUE(a.portal_corner == b.portal_corner && a.portal_x == b.portal_x && a.portal_y == b.portal_y) << row;
    EXPECT_EQ(a.image == no_index, b.image == no_index) << row;
  }
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

TEST(NativeWriter, TexturesAreKeptAndTheirImagesCopied) {
  const TemporaryFolder images;
  const std::string png = image_file(images, "wood.png", false), exr = image_file(images, "wood.exr", true);
  const ReadScene read = read_world(
      "LightSource \"infinite\"\n"
      "Texture \"wood\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
      png +
      "\" \"string wrap\" \"clamp\"\n"
      "Texture \"raw\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
      png +
      "\" \"string encoding\" \"linear\"\n"
      "Texture \"odd\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
      png +
      "\" \"string encoding\" \"gamma 1.7\"\n"
      "Texture \"half\" \"float\" \"imagemap\" \"string filename\" \"" +
      exr +
      "\" \"string filter\" \"point\"\n"
      "Texture \"mixed\" \"spectrum\" \"mix\" \"texture tex1\" \"wood\" \"texture tex2\" \"odd\" \"texture amount\" "
      "\"half\"\n"
      "Texture \"board\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"mixed\" \"texture tex2\" \"raw\"\n"
      "  \"float uscale\" 3 \"float vdelta\" 0.5\n"
      "Texture \"all\" \"spectrum\" \"scale\" \"texture tex\" \"board\" \"float scale\" 0.9\n"
      "Material \"diffuse\" \"texture reflectance\" \"all\" Translate 0 0 3 Shape \"sphere\"\n"
      "Material \"coateddiffuse\" \"texture reflectance\" \"wood\" Translate 1 0 0 Shape \"sphere\"\n");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_NE(tiny_film(read.scene), nullptr);
  const TemporaryFolder folder;
  write_scene(read.scene, folder.path());
  const auto files = files_in(folder.path());
  const auto original = files_in(images.path());
  EXPECT_EQ(files.size(), 5u);
  EXPECT_TRUE(files.at("scene-files/wood.png") == original.at("wood.png"));
  EXPECT_TRUE(files.contains("scene-files/wood-2.exr")) << "of an encoding that is not tried: its pixels";
  EXPECT_TRUE(files.at("scene-files/wood-3.exr") == original.at("wood.exr"));
  EXPECT_TRUE(files.at("scene-files/wood-4.png") == original.at("wood.png")) << "linear";
  expect_converts(read.scene);
}

TEST(NativeWriter, PatternsAndMappingsAreKept) {
  const ReadScene read = read_world(R"(LightSource "infinite"  Translate 0.5 0.1 3 Rotate 20 1 1 0
    Texture "clouds" "float" "fbm" "integer octaves" 3 "float roughness" 0.7
    Texture "folds" "float" "wrinkled"
    Texture "waves" "float" "windy"
    Texture "stone" "spectrum" "marble" "float variation" 0.6 "float scale" 2.5
    Texture "dots" "spectrum" "dots" "rgb inside" [0.1 0.2 0.9] "spectrum outside" [400 0.1 700 0.9]
      "string mapping" "planar" "vector3 v1" [2 0 0.1] "vector3 v2" [0 3 0] "float udelta" 0.2
    Texture "board" "spectrum" "checkerboard" "integer dimension" 3 "texture tex1" "stone" "texture tex2" "dots"
    Texture "ramp" "spectrum" "bilerp" "rgb v00" [1 0 0] "rgb v11" [0 0 1] "string mapping" "spherical"
    Texture "side" "spectrum" "directionmix" "texture tex1" "board" "texture tex2" "ramp" "vector3 dir" [1 2 3]
    Texture "cloudy" "spectrum" "mix" "texture tex1" "side" "texture tex2" "stone" "texture amount" "clouds"
    Texture "folded" "spectrum" "scale" "texture tex" "cloudy" "texture scale" "folds"
    Texture "round" "spectrum" "checkerboard" "string mapping" "cylindrical" "texture tex1" "folded"
    Material "diffuse" "texture reflectance" "round" Shape "sphere"
    Material "diffusetransmission" "texture reflectance" "stone" "rgb transmittance" [0.1 0.3 0.2]
    Translate 1.5 0 0 Shape "sphere")");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

TEST(NativeWriter, MaterialsOfOthersAreKept) {
  const ReadScene read = read_world(R"(LightSource "infinite" Translate 0 0 4
    MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [0.8 0.1 0.1]
    MakeNamedMaterial "coat" "string type" "coateddiffuse" "float roughness" 0.2 "float thickness" 0.3
    MakeNamedMaterial "both" "string type" "mix" "string materials" ["red" "coat"] "float amount" 0.3
    NamedMaterial "both" Shape "sphere" Translate 1 0 0
    Material "coatedconductor" "float thickness" 0.2 "spectrum conductor.eta" "metal-Au-eta" "float g" 0.4
      "spectrum conductor.k" "metal-Au-k" "rgb albedo" [0.3 0.2 0.1] "integer nsamples" 3 Shape "sphere"
    Translate 1 0 0 Material "hair" "float eumelanin" 0.8 "float beta_m" 0.2 "float alpha" 3
    Shape "curve" "point3 P" [0 -1 0 0.3 0 0 0.4 0.2 0 0.1 1 0] "float width" 0.3
    Translate 0 0 -3 Shape "cylinder" "float phimax" 200 "float zmin" -0.3 Shape "sphere" "float zmax" 0.2)");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

TEST(NativeWriter, TexturesOfCoatsAndHairAndFiltersAreKept) {
  const TemporaryFolder images;
  const std::string file = "\"imagemap\" \"string filename\" \"" + image_file(images, "wood.png", false, 8, 8) + "\"";
  const ReadScene read = read_world(
      "LightSource \"infinite\" Translate 0 0 4\n"
      "Texture \"n\" \"float\" " +
      file +
      " \"string filter\" \"trilinear\"\n"
      "Texture \"c\" \"spectrum\" " +
      file +
      " \"string filter\" \"EWA\" \"float maxanisotropy\" 3\n"
      "Texture \"p\" \"spectrum\" " +
      file +
      " \"string filter\" \"point\"\n"
      R"(Material "coateddiffuse" "texture reflectance" "c" "texture uroughness" "n" "float vroughness" 0.1
      "texture thickness" "n" "texture g" "n" "texture albedo" "p" Shape "sphere" Translate 1 0 0
    Material "coatedconductor" "texture interface.roughness" "n" "texture reflectance" "c"
      "texture conductor.vroughness" "n" Shape "sphere" Translate 1 0 0
    Material "hair" "texture color" "p" Shape "sphere")");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.messages.size(), 0u);
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

// What is rendered of grids is what is written; that the rest is lost is said.

}  // namespace
}  // namespace metamer
