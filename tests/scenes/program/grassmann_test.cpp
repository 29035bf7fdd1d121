// H. Grassmann's laws (1853) through metamer render and metamer develop: twice a light and sums of lights become twice
// and sums.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>

#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

constexpr int width = 16, height = 12;

// A lamp seen directly, and by the light it sends to a red floor and a metal ball.
std::string scene_with(const std::string& table) {
  return R"({
  "metamer": 1,
  "settings": {"size": [16, 12], "samples": 8, "max_depth": 4, "filter": {"type": "box"}},
  "entities": [
    {"transform": {"look_at": {"from": [0, 1, 4], "to": [0, 0.8, 0]}}, "camera": {"type": "perspective", "fov": 60}},
    {"transform": {"rotate": {"axis": [1, 0, 0], "degrees": -90}},
     "geometry": {"type": "rectangle", "width": 10, "depth": 10},
     "material": {"type": "diffuse", "reflectance": {"rgb": [0.8, 0.3, 0.2]}}},
    {"transform": {"translate": [1, 0.5, 0]}, "geometry": {"type": "sphere", "radius": 0.5},
     "material": {"type": "conductor", "metal": "Cu", "roughness": 0.3}},
    {"transform": {"translate": [0, 2, -1]}, "geometry": {"type": "rectangle", "width": 2, "depth": 1},
     "light": {"type": "area", "radiance": {"table": )" +
         table + R"(}}}
  ]
})";
}

class Grassmann : public ProgramTest {
 protected:
  // Linear Rec. 2020, adapted to another white and exposed.
  std::vector<float> developed(const std::string& name, const std::string& table) const {
    folder_.write(name + ".json", scene_with(table));
    EXPECT_EQ(run({"render", name + ".json", "-q", "-o", name + ".exr"}).exit_code, 0);
    EXPECT_EQ(run({"develop", name + ".exr", "-q", "-o", name + "-light.exr", "--display", "rec2020", "--white", "d50",
                   "--exposure", "0.7"})
                  .exit_code,
              0);
    const auto file = OIIO::ImageInput::open((folder() / (name + "-light.exr")).string());
    std::vector<float> values(width * height * 3);
    EXPECT_TRUE(file && file->read_image(0, 0, 0, 3, OIIO::TypeFloat, values.data()));
    return values;
  }
};

TEST_F(Grassmann, TwiceALightAndSumsOfLightsDevelopToTwiceAndSums) {
  // Values that single precision holds, so that the sums are sums.
  const std::vector<float> a = developed("a", "[[360, 0.5], [500, 0.125], [600, 1], [830, 0.25]]"),
                           b = developed("b", "[[360, 0.25], [500, 1], [600, 0.25], [830, 0.5]]"),
                           sum = developed("sum", "[[360, 0.75], [500, 1.125], [600, 1.25], [830, 0.75]]"),
                           thrice = developed("thrice", "[[360, 1.5], [500, 0.375], [600, 3], [830, 0.75]]");
  int lit = 0;
  for (size_t pixel = 0; pixel < width * height; ++pixel) {
    // Components may nearly cancel: errors are relative to the pixel's largest.
    double size = 0;
    for (size_t c = 0; c < 3; ++c) size = std::max(size, double{std::fabs(sum[3 * pixel + c])});
    for (size_t c = 0; c < 3; ++c) {
      const size_t i = 3 * pixel + c;
      EXPECT_NEAR(sum[i], double{a[i]} + b[i], 1e-6 * size) << pixel;
      EXPECT_NEAR(thrice[i], 3 * double{a[i]}, 1e-6 * 3 * size) << pixel;
    }
    lit += size > 0;
  }
  EXPECT_GT(lit, 90);
}

}  // namespace
}  // namespace metamer
