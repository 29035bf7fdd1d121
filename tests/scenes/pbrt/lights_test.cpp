#include <cmath>
#include <numbers>

#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

constexpr double pi = std::numbers::pi;
constexpr const char* sphere = " Shape \"sphere\"\n";

// What the light's spectrum and scale amount to: cd/m^2, cd or lx by kind.
double luminance(const ReadScene& read) {
  const Light light = read.get<Light>();
  return read.scene.spectra.luminance(light.spectrum) * light.scale;
}
double luminance_of(const std::string& world) {
  const ReadScene read = read_world(world);
  EXPECT_TRUE(read.ok) << world << "\n" << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Light>(), 1u);
  return luminance(read);
}
double area_luminance(const std::string& parameters, const std::string& shape = sphere) {
  return luminance_of("AreaLightSource \"diffuse\" " + parameters + " " + shape);
}

TEST(PbrtLights, RgbOfOneIsOneCandelaPerSquareMetreInEveryColourSpace) {
  EXPECT_NEAR(area_luminance("\"rgb L\" [1 1 1]"), 1, 1e-5);
  EXPECT_NEAR(area_luminance("\"rgb L\" [5 5 5] \"float scale\" 3"), 15, 1e-4);
  for (const char* space : {"srgb", "dci-p3", "rec2020", "aces2065-1"}) {
    EXPECT_NEAR(luminance_of(std::string("ColorSpace \"") + space + "\" AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]" +
                             sphere),
                1, 1e-5)
        << space;
  }
  // A coloured light keeps its own luminance: sRGB's Y of pure red.
  EXPECT_NEAR(area_luminance("\"rgb L\" [1 0 0]"), 0.2126, 1e-3);
}

TEST(PbrtLights, OtherSpectraHaveTheLuminanceOfTheirScale) {
  EXPECT_NEAR(area_luminance("\"blackbody L\" 3000"), 1, 1e-5);
  EXPECT_NEAR(area_luminance("\"blackbody L\" [6500] \"float scale\" 20"), 20, 1e-4);
  EXPECT_NEAR(area_luminance("\"spectrum L\" [400 3 700 9]"), 1, 1e-5);
  EXPECT_NEAR(area_luminance("\"spectrum L\" \"stdillum-A\" \"float scale\" 2"), 2, 1e-5);
  EXPECT_NEAR(area_luminance(""), 1, 1e-5) << "by default the white of the colour space";
}

TEST(PbrtLights, PowerIsSpreadOverTheShapeAsInPbrt) {
  EXPECT_NEAR(area_luminance("\"rgb L\" [1 1 1] \"float power\" 100"), 100 / (4 * pi * pi), 1e-4);
  EXPECT_NEAR(area_luminance("\"rgb L\" [1 1 1] \"float power\" 100 \"bool twosided\" true"), 50 / (4 * pi * pi), 1e-4);
  EXPECT_NEAR(area_luminance("\"float power\" 100", "Shape \"disk\" \"float radius\" 3 \"float innerradius\" 1"),
              100 / (8 * pi * pi), 1e-4);
  // Every triangle (here of 2 m^2 in the world) is a light of its own there.
  const std::string square =
      "Scale 2 2 2 Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer indices\" [0 1 2 0 2 3]";
  EXPECT_NEAR(area_luminance("\"float power\" 100", square), 100 / (2 * pi), 1e-3);
  const std::string patch = "Scale 2 2 2 Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]";
  EXPECT_NEAR(area_luminance("\"float power\" 100", patch), 100 / (4 * pi), 1e-3);
}

TEST(PbrtLights, AreaLightsBelongToTheShapesThatFollowInTheBlock) {
  const ReadScene read =
      read_world(std::string(sphere) + "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true" + sphere +
                 sphere + "AttributeEnd" + sphere);
  ASSERT_EQ(read.count<Light>(), 2u);
  EXPECT_FALSE(read.scene.registry.has<Light>(read.entity<Geometry>(0)));
  EXPECT_TRUE(read.scene.registry.has<Light>(read.entity<Geometry>(1)));
  EXPECT_FALSE(read.scene.registry.has<Light>(read.entity<Geometry>(3)));
  EXPECT_EQ(read.get<Light>().kind, LightKind::area);
  EXPECT_EQ(read.get<Light>().two_sided, 1u);
}

TEST(PbrtLights, APointLightHasIntensityPlaceAndPower) {
  const ReadScene read =
      read_world("Translate 1 0 0 Scale 2 2 2 LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [0 1 0]");
  ASSERT_TRUE(read.ok);
  EXPECT_EQ(read.get<Light>().kind, LightKind::point);
  EXPECT_NEAR(luminance(read), 3, 1e-5);
  const auto m = read.scene.registry.get<Transform>(read.entity<Light>());
  EXPECT_EQ(glm::vec3(m.row0.w, m.row1.w, m.row2.w), glm::vec3(1, 2, 0));
  EXPECT_NEAR(luminance_of("LightSource \"point\" \"float power\" 100 \"float scale\" 2"), 200 / (4 * pi), 1e-4);
}

TEST(PbrtLights, ADistantLightShinesFromFromToTo) {
  const ReadScene read =
      read_world("LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 5 0] \"point3 to\" [0 0 0]");
  ASSERT_TRUE(read.ok);
  EXPECT_EQ(read.get<Light>().kind, LightKind::directional);
  EXPECT_NEAR(luminance(read), 2, 1e-5);
  const auto m = read.scene.registry.get<Transform>(read.entity<Light>());
  EXPECT_EQ(glm::vec3(m.row0.z, m.row1.z, m.row2.z), glm::vec3(0, 1, 0)) << "light travels along -z";
  EXPECT_NEAR(luminance_of("LightSource \"distant\" \"blackbody L\" 5000 \"float illuminance\" 80000"), 80000, 1);
}

TEST(PbrtLights, ASpotShinesFromFromToToWithinItsCone) {
  const ReadScene read = read_world(
      "Translate 1 0 0 LightSource \"spot\" \"rgb I\" [2 2 2] \"point3 from\" [0 5 0] \"point3 to\" [0 0 0] "
      "\"float coneangle\" 20 \"float conedeltaangle\" 8");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Light light = read.get<Light>();
  EXPECT_EQ(light.kind, LightKind::spot);
  EXPECT_EQ(light.cone_deg, 20);
  EXPECT_EQ(light.falloff_deg, 12);
  EXPECT_NEAR(luminance(read), 2, 1e-5);
  const auto m = read.scene.registry.get<Transform>(read.entity<Light>());
  EXPECT_EQ(glm::vec3(m.row0.z, m.row1.z, m.row2.z), glm::vec3(0, 1, 0)) << "light travels along -z";
  EXPECT_EQ(glm::vec3(m.row0.w, m.row1.w, m.row2.w), glm::vec3(1, 5, 0));
  const ReadScene plain = read_world("LightSource \"spot\"");
  EXPECT_EQ(plain.get<Light>().cone_deg, 30);
  EXPECT_EQ(plain.get<Light>().falloff_deg, 25);
  const auto towards = plain.scene.registry.get<Transform>(plain.entity<Light>());
  EXPECT_EQ(glm::vec3(towards.row0.z, towards.row1.z, towards.row2.z), glm::vec3(0, 0, -1)) << "it looks along +z";
  EXPECT_EQ(read_world("LightSource \"spot\" \"float coneangle\" 3").get<Light>().falloff_deg, 2);
}

// 2 pi ((1 - cos 12) + (cos 12 - cos 20) / 2), as pbrt divides it.
TEST(PbrtLights, ThePowerOfASpotIsThatOfItsCone) {
  const double flux =
      2 * pi * ((1 - std::cos(12 * pi / 180)) + (std::cos(12 * pi / 180) - std::cos(20 * pi / 180)) / 2);
  EXPECT_NEAR(luminance_of("LightSource \"spot\" \"float power\" 100 \"float scale\" 2 \"float coneangle\" 20 "
                           "\"float conedeltaangle\" 8"),
              200 / flux, 0.01);
}

TEST(PbrtLights, BadConesAreErrors) {
  const ReadScene read = read_world(
      "LightSource \"spot\" \"float coneangle\" 190\nLightSource \"spot\" \"float coneangle\" -3\n"
      "LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 21\n"
      "LightSource \"spot\" \"float conedeltaangle\" -1\n"
      "LightSource \"spot\" \"point3 from\" [1 2 3] \"point3 to\" [1 2 3]\n");
  EXPECT_EQ(read.diagnostics.error_count(), 5u);
  EXPECT_EQ(read.messages[0], "scene:2: error: LightSource \"spot\": 'coneangle' is 190; expected at most 180 degrees");
  EXPECT_EQ(read.diagnostics.all()[1].line, 3u);
  EXPECT_EQ(read.messages[2],
            "scene:4: error: LightSource \"spot\": 'conedeltaangle' is 21; expected at most twice the 'coneangle', 10");
  EXPECT_EQ(read.diagnostics.all()[3].line, 5u);
  EXPECT_EQ(read.messages[4], "scene:6: error: LightSource \"spot\": 'from' and 'to' coincide");
}

TEST(PbrtLights, AConstantEnvironmentHasRadianceOrIlluminance) {
  const ReadScene read = read_world("LightSource \"infinite\" \"rgb L\" [.5 .5 .5] \"float scale\" 4");
  ASSERT_TRUE(read.ok);
  EXPECT_EQ(read.get<Light>().kind, LightKind::environment);
  EXPECT_EQ(read.get<Light>().image, no_index);
  EXPECT_NEAR(luminance(read), 2, 1e-5);
  EXPECT_NEAR(luminance_of("LightSource \"infinite\" \"float illuminance\" 10"), 10 / pi, 1e-4);
}

// A square PFM of one colour. Its height is negative for rows from the bottom up; here it does not matter.
std::string pfm(int width, int height, const float (&rgb)[3]) {
  std::string text = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  for (int i = 0; i < width * height; ++i) text.append(reinterpret_cast<const char*>(rgb), sizeof(rgb));
  return text;
}

TEST(PbrtLights, AnImageEnvironmentIsEqualAreaAndScaledByItsWhiteAlone) {
  const TemporaryFolder folder;
  folder.write("sky.pfm", pfm(8, 8, {1, 2, 3}));
  const ReadScene read = read_scene_at(folder.write(
      "scene",
      "Camera \"perspective\" WorldBegin LightSource \"infinite\" \"string filename\" \"sky.pfm\" \"float scale\" 5"));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.get<Light>().image, 0u);
  EXPECT_EQ(read.scene.images[0].mapping, ImageMapping::equal_area);
  EXPECT_EQ(read.scene.images[0].rgb[2], 3.0f);
  EXPECT_NEAR(luminance(read), 5, 1e-4) << "what a white pixel of 1 shines with";
}

TEST(PbrtLights, AnImagesIlluminanceIsMeasuredAsPbrtDoes) {
  const TemporaryFolder folder;
  folder.write("sky.pfm", pfm(64, 64, {1, 1, 1}));
  const ReadScene read = read_scene_at(folder.write("scene",
                                                    "Camera \"perspective\" WorldBegin LightSource \"infinite\" "
                                                    "\"string filename\" \"sky.pfm\" \"float illuminance\" 10"));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_NEAR(luminance(read), 10 / (pi / 2), 0.01) << "pbrt measures half of pi for a sky of 1";
}

TEST(PbrtLights, AnImageThatIsNotSquareOrMissingIsAnError) {
  const TemporaryFolder folder;
  folder.write("wide.pfm", pfm(8, 4, {1, 1, 1}));
  const std::string light = "LightSource \"infinite\" \"string filename\" ";
  const ReadScene read =
      read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + light + "\"wide.pfm\"\n" + light +
                                              "\"none.pfm\"\n" + light + "\"wide.pfm\" \"rgb L\" [1 1 1]"));
  EXPECT_EQ(read.diagnostics.error_count(), 4u);
  EXPECT_EQ(
      read.messages[0],
      "scene:2: error: LightSource \"infinite\": 'wide.pfm' has 8 x 4 pixels; pbrt's equal-area images are square");
  EXPECT_EQ(read.diagnostics.all()[1].line, 3u);
  EXPECT_EQ(read.diagnostics.all()[2].message, "LightSource \"infinite\": 'L' and 'filename' exclude each other");
  EXPECT_EQ(read.count<Light>(), 0u);
}

TEST(PbrtLights, WhatIsLeftOutIsSaid) {
  const ReadScene read =
      read_world(std::string("LightSource \"projection\" \"float fov\" 10\nLightSource \"projection\"\nLightSource ") +
                 "\"goniometric\"\n" + "LightSource \"infinite\" \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 1 0]\n" +
                 "ObjectBegin \"lamp\" AreaLightSource \"diffuse\"" + sphere + "ObjectEnd ObjectInstance \"lamp\"");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(
      read.messages,
      testing::ElementsAre(
          "scene:2: warning: light source \"projection\" is not supported yet; it is left out",
          "scene:4: warning: light source \"goniometric\" is not supported yet; it is left out",
          "scene:5: warning: LightSource \"infinite\": 'portal' is not supported yet; the light is not restricted to "
          "it",
          "scene:6: warning: shapes of an object emit no light, as in pbrt; this AreaLightSource does nothing"));
  EXPECT_EQ(read.count<Light>(), 1u);
}

}  // namespace
}  // namespace metamer
