// What the shipped scenes claim to show, measured in their pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "scenes/library.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"
#include "systems/render.h"
#include "systems/write_frame.h"

namespace metamer {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

struct View {
  uint32_t width, height, samples_per_pixel;
  glm::vec4 screen_window{0, 0, 0, 0};  // of the camera; all 0: the scene's
};

// XYZ in cd/m^2 in the columns r, g, b.
Picture render_view(const std::string& name, const View& view) {
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene(shipped_scene(name + ".json"), scene, diagnostics)) << format_diagnostics(diagnostics);
  scene.settings.width = view.width;
  scene.settings.height = view.height;
  scene.settings.samples_per_pixel = view.samples_per_pixel;
  const glm::vec4& window = view.screen_window;
  if (window[0] != window[1]) {
    scene.registry.each<Camera>([&](Entity entity, uint32_t) {
      Camera camera = scene.registry.get<Camera>(entity);
      camera.screen_window = window;
      scene.registry.set(entity, camera);
    });
  }
  const std::unique_ptr<World> world = freeze(scene, diagnostics);
  Film film(view.width, view.height);
  if (world == nullptr) {
    ADD_FAILURE() << format_diagnostics(diagnostics);
  } else {
    const Cancellation cancellation;
    RenderProgress progress;
    render(*world, {}, cancellation, progress, film);
  }
  return develop(observe(film, Observer::cie1931, 0), ColourMatrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
}

double fresnel_into_air(double n, double cos_inside) {
  const double sin2 = n * n * (1 - cos_inside * cos_inside);
  if (sin2 >= 1) return 1;
  const double c = std::sqrt(1 - sin2);
  const double s = (n * cos_inside - c) / (n * cos_inside + c), p = (cos_inside - n * c) / (cos_inside + n * c);
  return (s * s + p * p) / 2;
}

// The middle rows of the picture: a line from the zenith to the right, where nothing stands in the way of the sky.
// Looking straight up out of water of n = 1.333 under a sky of 1 cd/m^2: (1 - F) 1.777 at the zenith, and up to the
// critical angle arcsin(1 / 1.333) = 48.61 degrees; beyond, the pool alone.
TEST(LibraryPhysics, TheSwimmerSeesSnellsWindow) {
  constexpr uint32_t width = 512, height = 8;
  constexpr double n = 1.333, half_width = 58;  // degrees
  const float aspect = float(height) / float(width);
  const Picture xyz = render_view("swimmer", {width, height, 256, {-1, 1, -aspect, aspect}});
  std::vector<double> angle, luminance;
  for (uint32_t x = width / 2; x < width; ++x) {
    const double place = (2 * (x + 0.5) / width - 1) * std::tan(half_width * degree);
    double sum = 0;
    for (uint32_t y = 0; y < height; ++y) sum += double{xyz.g[size_t{y} * width + x]} / height;
    angle.push_back(std::atan(place) / degree);
    luminance.push_back(sum);
  }
  const auto mean = [&](double from, double to) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < angle.size(); ++i)
      if (angle[i] >= from && angle[i] < to) sum += luminance[i], count += 1;
    return sum / count;
  };
  // The pool adds F = 2 % of its own brightness to the zenith.
  const double pool = mean(49.5, 52);
  EXPECT_NEAR(mean(0, 3), (1 - fresnel_into_air(n, 1)) * n * n, 0.02);
  EXPECT_NEAR((1 - fresnel_into_air(n, 1)) * n * n, 0.9796 * 1.777, 1e-3);
  for (const double theta : {20.0, 35.0, 44.0}) {
    const double f = fresnel_into_air(n, std::cos(theta * degree));
    EXPECT_NEAR(mean(theta - 0.5, theta + 0.5), (1 - f) * n * n + f * pool, 0.025) << theta;
  }
  EXPECT_LT(pool, 1);
  // Where the last tenth of the sky's light goes: 1 - F falls from 0.1 to 0 in a hundredth of a degree.
  double critical = 0;
  for (size_t i = 1; i < angle.size(); ++i) {
    const double before = (luminance[i - 1] - pool) / (n * n - pool), here = (luminance[i] - pool) / (n * n - pool);
    if (angle[i] > 40 && before >= 0.1 && here < 0.1)
      critical = angle[i - 1] + (angle[i] - angle[i - 1]) * (before - 0.1) / (before - here);
  }
  EXPECT_NEAR(critical, std::asin(1 / n) / degree, 0.2);
}

// Light of 630 to 650 nm lies outside every display's gamut: red, and less than no green and blue.
TEST(LibraryPhysics, InTheMonochromaticRoomThereIsOnlyRed) {
  const Picture xyz = render_view("monochromatic-room", {90, 66, 64});
  size_t lit = 0;
  for (size_t i = 0; i < xyz.pixel_count(); ++i) {
    const double x = double{xyz.r[i]}, y = double{xyz.g[i]}, z = double{xyz.b[i]};
    if (x + y + z == 0) continue;
    ++lit;
    // The chromaticities of 630 and 650 nm: x = 0.7079 and 0.7260; x + y = 1 to 1e-4.
    EXPECT_GT(x / (x + y + z), 0.7075) << i;
    EXPECT_LT(x / (x + y + z), 0.7265) << i;
    EXPECT_LT(z, 2e-4 * y) << i;
    EXPECT_GT(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, 0) << i;
    EXPECT_LT(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z, 0) << i;
    EXPECT_LT(0.0556434 * x - 0.2040259 * y + 1.0572252 * z, 0) << i;
  }
  EXPECT_GT(lit, xyz.pixel_count() * 9 / 10);
}

}  // namespace
}  // namespace metamer
