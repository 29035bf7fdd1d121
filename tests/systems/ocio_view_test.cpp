#include "systems/ocio_view.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "systems/display_colour.h"
#include "tests/scenes/support/files.h"
#include "tests/systems/support/pictures.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Optional;

// Computed in Python from the splines of the Academy's CTL (RRT and ODT of 48 cd/m^2, ACES 1.x; for a dim surround the
// luminance to the power 0.9811), which do nothing else to greys.
TEST(Aces, OfGreysMeetsFiveValuesComputedIndependently) {
  const std::vector<std::pair<float, double>> greys = {{0.01f, 0.00099334496},
                                                       {0.18f, 0.10406351816},
                                                       {0.5f, 0.37644641938},
                                                       {1.0f, 0.62431640320},
                                                       {4.0f, 0.90126843527}};
  for (const ColorSpace display : {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::lamps})
    for (const auto& [grey, expected] : greys) {
      const Color3 white = white_amounts(display);
      Picture picture = picture_of({{static_cast<float>(grey * white[0]), static_cast<float>(grey * white[1]),
                                     static_cast<float>(grey * white[2])}});
      ASSERT_EQ(apply_aces(picture, display, 1), std::nullopt);
      EXPECT_NEAR(picture.r[0] / white[0], expected, 2e-5) << grey;
      EXPECT_NEAR(picture.g[0] / white[1], expected, 2e-5) << grey;
      EXPECT_NEAR(picture.b[0] / white[2], expected, 2e-5) << grey;
    }
}

// The library itself, fed with ACES2065-1 by matrices of its own.
TEST(Aces, OfColoursIsWhatOpenColorIOMakesOfThem) {
  namespace ocio = OCIO_NAMESPACE;
  const auto builtin = [](const char* style, ocio::TransformDirection direction) {
    ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
    transform->setStyle(style);
    transform->setDirection(direction);
    return ocio::Config::CreateRaw()->getProcessor(transform)->getDefaultCPUProcessor();
  };
  const auto to_ap1 = builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE);
  const auto to_xyz = builtin("UTILITY - ACES-AP1_to_CIE-XYZ-D65_BFD", ocio::TRANSFORM_DIR_FORWARD);
  const auto to_ap0 = builtin("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD", ocio::TRANSFORM_DIR_INVERSE);
  const auto aces = builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0", ocio::TRANSFORM_DIR_FORWARD);
  for (const std::array<float, 3>& rgb : std::vector<std::array<float, 3>>{
           {1, 0.2f, 0.05f}, {0.1f, 0.6f, 0.2f}, {0.02f, 0.03f, 0.5f}, {5, 4, 1}, {0, 0, 8}}) {
    Picture picture = picture_of({rgb});
    ASSERT_EQ(apply_aces(picture, ColorSpace::srgb, 1), std::nullopt);
    float pixel[3] = {rgb[0], rgb[1], rgb[2]};
    for (const auto& step : {to_ap1, to_xyz, to_ap0, aces}) step->applyRGB(pixel);
    for (const auto& step : {builtin("UTILITY - ACES-AP1_to_CIE-XYZ-D65_BFD", ocio::TRANSFORM_DIR_INVERSE),
                             builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_FORWARD)})
      step->applyRGB(pixel);
    EXPECT_NEAR(picture.r[0], pixel[0], 1e-3);
    EXPECT_NEAR(picture.g[0], pixel[1], 1e-3);
    EXPECT_NEAR(picture.b[0], pixel[2], 1e-3);
  }
}

TEST(Aces, IsOneForAllThreadsAndSurvivesWildValues) {
  std::vector<std::array<float, 3>> colours = {
      {HUGE_VALF, 1, 0}, {-HUGE_VALF, 0, 1}, {std::nanf(""), 1, 1}, {3e38f, 3e38f, 3e38f}, {-5, 0.1f, 0.1f}};
  for (int i = 0; i < 50000; ++i) colours.push_back({static_cast<float>(i) * 1e-4f, 0.5f, 0.1f});
  Picture one = picture_of(colours), three = one;
  ASSERT_EQ(apply_aces(one, ColorSpace::srgb, 1), std::nullopt);
  ASSERT_EQ(apply_aces(three, ColorSpace::srgb, 3), std::nullopt);
  for (size_t i = 0; i < colours.size(); ++i) {
    ASSERT_TRUE(std::isfinite(one.r[i]) && std::isfinite(one.g[i]) && std::isfinite(one.b[i])) << i;
    ASSERT_EQ(one.r[i], three.r[i]);
  }
}

// Two displays. A gamma of 2 makes the numbers simple.
constexpr const char* config = R"(ocio_profile_version: 2
roles:
  default: raw
  scene_linear: lin
  ENTRANCE: lin
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  desk:
    - !<View> {name: square root, colorspace: root}
    - !<View> {name: linear, colorspace: lin}
  wall:
    - !<View> {name: linear, colorspace: lin}
active_displays: [desk, wall]
active_views: []
colorspaces:
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: root
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)";

std::string config_with(const std::string& entrance) {
  std::string text = config;
  text.replace(text.find("ENTRANCE"), 8, entrance);
  return text;
}

TEST(OcioView, DefaultsAreTheConfigurationsOwn) {
  const TemporaryFile file("config.ocio", config_with("rendering"));
  OcioView view{file.path(), "", ""};
  EXPECT_EQ(resolve(view), std::nullopt);
  EXPECT_EQ(view, (OcioView{file.path(), "desk", "square root"}));
  OcioView wall{file.path(), "wall", ""};
  EXPECT_EQ(resolve(wall), std::nullopt);
  EXPECT_EQ(wall.view, "linear");
}

TEST(OcioView, WithoutAnInterchangeRoleTakesLinearRec709) {
  const TemporaryFile file("config.ocio", config_with("rendering"));
  Picture picture = picture_of({{0.25f, 0.64f, 1}});
  ASSERT_EQ(apply_view(picture, ColorSpace::srgb, {file.path(), "desk", "square root"}, 1), std::nullopt);
  EXPECT_NEAR(picture.r[0], 0.5, 1e-5);
  EXPECT_NEAR(picture.g[0], 0.8, 1e-5);
  EXPECT_NEAR(picture.b[0], 1.0, 1e-5);
}

// sRGB's red in ACES2065-1, adapted by Bradford: 0.439633, 0.089777, 0.017541 (Academy TB-2014-004 and others).
TEST(OcioView, WithTheRoleTakesAces) {
  const TemporaryFile file("config.ocio", config_with("aces_interchange"));
  Picture picture = picture_of({{1, 0, 0}, {1, 1, 1}});
  ASSERT_EQ(apply_view(picture, ColorSpace::srgb, {file.path(), "desk", "linear"}, 1), std::nullopt);
  EXPECT_NEAR(picture.r[0], 0.4396, 5e-4);
  EXPECT_NEAR(picture.g[0], 0.0898, 5e-4);
  EXPECT_NEAR(picture.b[0], 0.0175, 5e-4);
  EXPECT_NEAR(picture.g[1], 1.0, 1e-5);
}

TEST(OcioView, MistakesNameWhatThereIs) {
  const TemporaryFile file("config.ocio", config_with("rendering")), broken("broken.ocio", "ocio_profile_version: x\n");
  OcioView view{file.path(), "dask", ""};
  EXPECT_THAT(resolve(view), Optional(AllOf(HasSubstr("--ocio-display: "), HasSubstr("did you mean 'desk'?"),
                                            HasSubstr("there are desk, wall"))));
  view = {file.path(), "desk", "linaer"};
  EXPECT_THAT(resolve(view), Optional(AllOf(HasSubstr("--ocio-view: "), HasSubstr("did you mean 'linear'?"),
                                            HasSubstr("there are square root, linear"))));
  view = {broken.path(), "", ""};
  EXPECT_THAT(resolve(view), Optional(HasSubstr("broken.ocio: ")));
  view = {"/none.ocio", "", ""};
  EXPECT_THAT(resolve(view), Optional(HasSubstr("/none.ocio: ")));
}

}  // namespace
}  // namespace metamer
