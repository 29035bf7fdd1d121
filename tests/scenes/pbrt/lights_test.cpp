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

TEST(PbrtLights, AnImageTwiceAsWideAsHighIsReadInLatitudeAndLongitude) {
  const TemporaryFolder folder;
  folder.write("sky.pfm", pfm(64, 32, {1, 1, 1}));
  const std::string light = "LightSource \"infinite\" \"string filename\" \"sky.pfm\" ";
  const ReadScene read = read_scene_at(
      folder.write("scene", "Camera \"perspective\" WorldBegin\n" + light + "\n" + light + "\"float illuminance\" 10"));
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.count<Light>(), 2u);
  EXPECT_EQ(read.scene.images[0].mapping, ImageMapping::latitude_longitude);
  EXPECT_THAT(
      read.messages,
      testing::ElementsAre("scene:2: note: 'sky.pfm' is twice as wide as high: it is read as a latitude-longitude "
                           "map with +z up, as imgtool makeequiarea does; pbrt only takes square equal-area maps"));
  const Light measured = read.get<Light>(1);
  EXPECT_NEAR(read.scene.spectra.luminance(measured.spectrum) * measured.scale, 10 / (pi / 2), 0.02)
      << "as if converted";
}

TEST(PbrtLights, AnImageOfAnotherShapeOrMissingIsAnError) {
  const TemporaryFolder folder;
  folder.write("wide.pfm", pfm(8, 5, {1, 1, 1}));
  const std::string light = "LightSource \"infinite\" \"string filename\" ";
  const ReadScene read =
      read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + light + "\"wide.pfm\"\n" + light +
                                              "\"none.pfm\"\n" + light + "\"wide.pfm\" \"rgb L\" [1 1 1]"));
  EXPECT_EQ(read.diagnostics.error_count(), 4u);
  EXPECT_EQ(
      read.messages[0],
      "scene:2: error: LightSource \"infinite\": 'wide.pfm' has 8 x 5 pixels; expected a square (an equal-area map) or "
      "twice as wide as high (a latitude-longitude map)");
  EXPECT_EQ(read.diagnostics.all()[1].line, 3u);
  EXPECT_EQ(read.diagnostics.all()[2].message, "LightSource \"infinite\": 'L' and 'filename' exclude each other");
  EXPECT_EQ(read.count<Light>(), 0u);
}

TEST(PbrtLights, ThereMayBeSeveralEnvironments) {
  const ReadScene read =
      read_world("LightSource \"infinite\" Rotate 30 1 0 0 LightSource \"infinite\" \"float scale\" 3");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages, testing::IsEmpty());
  EXPECT_EQ(read.count<Light>(), 2u);
}

TEST(PbrtLights, APortalStandsInWorldSpace) {
  const std::string portal = "\"point3 portal\" [1 0 0 1 2 0 1 2 3 1 0 3]";
  const ReadScene read = read_world("Translate 5 0 0 LightSource \"infinite\" \"float scale\" 2 " + portal);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_THAT(read.messages, testing::IsEmpty());
  const Light light = read.get<Light>();
  EXPECT_EQ(light.has_portal, 1u);
  EXPECT_EQ(light.portal_corner, glm::vec3(1, 0, 0));
  EXPECT_EQ(light.portal_x, glm::vec3(0, 0, 3)) << "pbrt's frame has the edge to the last point first";
  EXPECT_EQ(light.portal_y, glm::vec3(0, 2, 0));
  EXPECT_NEAR(luminance(read), 2, 1e-5);
  const std::string with = "LightSource \"infinite\" " + portal;
  EXPECT_NEAR(luminance_of(with + " \"rgb L\" [.5 .5 .5] \"float illuminance\" 10"), 10 / (2 * pi), 1e-4);
  // The mean of the constant spectrum's luminance: its own against 683 times the integral of ybar.
  EXPECT_NEAR(luminance_of(with + " \"spectrum L\" [200 0.5 1000 0.5]"), 0.5, 1e-4);
}

TEST(PbrtLights, BadPortalsAreErrors) {
  const std::string light = "LightSource \"infinite\" \"point3 portal\" ";
  const ReadScene read = read_world(light + "[0 0 0 1 0 0 1 1 0]\n" + light + "[0 0 0 1 0 0 2 1 0 1 1 0]\n" + light +
                                    "[0 0 0 1 0 0 1 1 0 0 1 1]\n" + light + "[0 0 0 0 0 0 1 1 0 0 1 0]");
  EXPECT_EQ(read.diagnostics.error_count(), 4u);
  EXPECT_EQ(read.messages[0], "scene:2: error: LightSource \"infinite\": 'portal' has 3 points; expected 4");
  EXPECT_EQ(
      read.messages[1],
      "scene:3: error: LightSource \"infinite\": 'portal': its corners are not those of a rectangle, one after the "
      "other");
  EXPECT_EQ(read.diagnostics.all()[2].line, 4u);
  EXPECT_EQ(read.messages[3], "scene:5: error: LightSource \"infinite\": 'portal': two of its corners coincide");
}

TEST(PbrtLights, AGoniometricLightTakesTheMeanOfItsImagesChannels) {
  const TemporaryFolder folder;
  folder.write("lamp.pfm", pfm(8, 8, {1, 2, 6}));
  const std::string light = "LightSource \"goniometric\" \"string filename\" \"lamp.pfm\" ";
  const auto at = [&](const std::string& parameters) {
    return read_scene_at(
        folder.write("scene", "Camera \"perspective\" WorldBegin Translate 1 2 3\n" + light + parameters));
  };
  const ReadScene read = at("\"rgb I\" [2 2 2] \"float scale\" 3");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Light light_of = read.get<Light>();
  EXPECT_EQ(light_of.kind, LightKind::goniometric);
  EXPECT_NEAR(luminance(read), 6, 1e-4);
  EXPECT_EQ(read.scene.images[light_of.image].mapping, ImageMapping::equal_area);
  for (const float value : read.scene.images[light_of.image].rgb) EXPECT_EQ(value, 3);
  const auto m = read.scene.registry.get<Transform>(read.entity<Light>());
  EXPECT_EQ(glm::vec3(m.row0.w, m.row1.w, m.row2.w), glm::vec3(1, 2, 3));
  EXPECT_EQ(glm::vec3(m.row0.z, m.row1.z, m.row2.z), glm::vec3(0, 1, 0)) << "the image's +z along +y";
  EXPECT_EQ(glm::vec3(m.row0.y, m.row1.y, m.row2.y), glm::vec3(0, 0, 1));
  // 4 pi times the mean of 3.
  EXPECT_NEAR(luminance(at("\"float power\" 100 \"float scale\" 2")), 200 / (12 * pi), 1e-4);
  const ReadScene without = read_world("LightSource \"goniometric\" \"float power\" 100");
  EXPECT_EQ(without.get<Light>().kind, LightKind::point);
  EXPECT_NEAR(luminance(without), 100 / (4 * pi), 1e-4);
  EXPECT_EQ(without.messages.at(0),
            "scene:2: warning: LightSource \"goniometric\": there is no 'filename'; it shines alike in all directions");
}

TEST(PbrtLights, AProjectionHasItsImageFieldOfViewAndPower) {
  const TemporaryFolder folder;
  folder.write("slide.pfm", pfm(16, 8, {1, 1, 1}));
  const std::string light = "LightSource \"projection\" \"string filename\" \"slide.pfm\" ";
  const auto at = [&](const std::string& parameters) {
    return read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin\n" + light + parameters));
  };
  const ReadScene read = at("\"float scale\" 3 \"float fov\" 40");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.get<Light>().kind, LightKind::projection);
  EXPECT_EQ(read.get<Light>().fov_deg, 40);
  EXPECT_NEAR(luminance(read), 3, 1e-4);
  EXPECT_EQ(at("").get<Light>().fov_deg, 90);
  // The solid angle of a pyramid with half tangents a = 2 and b = 1: 4 asin(a b / sqrt((1 + a^2) (1 + b^2))); pbrt sums
  // the middles of the pixels.
  EXPECT_NEAR(luminance(at("\"float power\" 100")) * 4 * std::asin(2 / std::sqrt(10.0)), 100, 0.5);
  const ReadScene bad = read_world("LightSource \"projection\"\nLightSource \"projection\" \"float fov\" 180");
  EXPECT_EQ(bad.messages.at(0), "scene:2: error: LightSource \"projection\": a projection needs a 'filename'");
  EXPECT_EQ(bad.messages.at(1),
            "scene:3: error: LightSource \"projection\": 'fov' is 180; expected less than 180 degrees");
}

TEST(PbrtLights, AShapeMayEmitAnImage) {
  const TemporaryFolder folder;
  folder.write("screen.pfm", pfm(4, 2, {2, 2, 2}));
  const auto at = [&](const std::string& parameters) {
    return read_scene_at(folder.write(
        "scene", "Camera \"perspective\" WorldBegin\nAreaLightSource \"diffuse\" \"string filename\" \"screen.pfm\" " +
                     parameters + sphere));
  };
  const ReadScene read = at("\"float scale\" 3 \"bool twosided\" true");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_THAT(read.messages, testing::IsEmpty());
  EXPECT_EQ(read.get<Light>().kind, LightKind::area);
  ASSERT_EQ(read.get<Light>().image, 0u);
  EXPECT_EQ(read.get<Light>().two_sided, 1u);
  EXPECT_NEAR(luminance(read), 3, 1e-4);
  // Half of what the scale would be for a white of 1.
  EXPECT_NEAR(luminance(at("\"float power\" 100")), 100 / (4 * pi * pi) / 2, 1e-4);
  EXPECT_EQ(at("\"rgb L\" [1 1 1]").messages.at(0),
            "scene:2: error: AreaLightSource \"diffuse\": 'L' and 'filename' exclude each other");
}

TEST(PbrtLights, LampsOfObjectsAreLeftOut) {
  const ReadScene read = read_world(std::string("ObjectBegin \"lamp\" AreaLightSource \"diffuse\"") + sphere +
                                    "ObjectEnd ObjectInstance \"lamp\"");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages,
              testing::ElementsAre("scene:2: warning: shapes of an object emit no light, as in pbrt; this "
                                   "AreaLightSource does nothing"));
  EXPECT_EQ(read.count<Light>(), 0u);
}

}  // namespace
}  // namespace metamer
