// Chi-square of what a camera ray draws, in the rays that the stage makes: the wavelengths, the point of the lens, the
// place in the pixel.
#include <gtest/gtest.h>

#include "engine/spectrum/wavelengths.h"
#include "tests/support/chi_square.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr uint32_t side = 512;

// visit(paths, i) of one sample of every pixel: draws that do not know of each other.
template <class Visit>
void each_camera_ray(const World& world, const Visit& visit) {
  const TileRect picture{0, 0, side, side};
  std::vector<RayPacket> packets;
  Batch batch;
  for (uint32_t y = 0; y < side; y += 4)
    for (uint32_t x = 0; x < side; x += 4) {
      packets.push_back({x, y, 0});
      if (packets.size() < batch_capacity / column_lanes) continue;
      camera_rays(world, packets, picture, batch.paths, batch.slots);
      for (uint32_t i = 0; i < batch.paths.size; ++i) visit(batch.paths, i);
      packets.clear();
    }
}

TEST(CameraSampling, TheHeroFollowsTheDensityOfWavelengths) {
  SceneBuilder b(side, side, 1, 1);
  b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1));
  constexpr size_t bins = 94;  // of 5 nm
  std::vector<double> observed(bins, 0.0), expected(bins, 0.0);
  each_camera_ray(*b.freeze(), [&](const PathStream& paths, uint32_t i) {
    const double t = (double{paths.lambda_nm[0][i]} - 360) / 5;
    ASSERT_TRUE(t >= 0 && t <= double(bins));
    observed[std::min(bins - 1, static_cast<size_t>(t))] += 1;
  });
  for (size_t bin = 0; bin < bins; ++bin)
    for (int k = 0; k < 20; ++k)
      expected[bin] += wavelength_pdf(360 + 5 * (double(bin) + (k + 0.5) / 20)) * 0.25 * side * side;
  const ChiSquare result = chi_square_test(observed, expected);
  EXPECT_GT(result.p_value, chi_square_level);
  EXPECT_GT(result.degrees_of_freedom, 60);
}

// Bins of equal area: annuli of equal r^2, equal angles.
TEST(CameraSampling, PointsOfTheLensAreUniform) {
  SceneBuilder b(side, side, 1, 1);
  Camera camera = perspective(40);
  camera.lens_radius = 0.5f;
  camera.focal_distance = 2;
  b.look_at({0, 0, 1}, {0, 0, 0}, camera);
  std::vector<double> observed(16 * 24, 0.0), expected(16 * 24, double{side} * side / (16 * 24));
  each_camera_ray(*b.freeze(), [&](const PathStream& paths, uint32_t i) {
    const double x = double{paths.origin[0][i]} / 0.5, y = double{paths.origin[1][i]} / 0.5;
    const double r2 = x * x + y * y, phi = std::atan2(y, x) / (2 * pi) + 0.5;
    ASSERT_LT(r2, 1 + 1e-5);
    observed[std::min<size_t>(15, static_cast<size_t>(r2 * 16)) * 24 +
             std::min<size_t>(23, static_cast<size_t>(phi * 24))] += 1;
  });
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

// The box filter of one pixel: the origins of an orthographic view of 512 m are uniform within their square metre.
TEST(CameraSampling, PlacesInAPixelFollowItsFilter) {
  SceneBuilder b(side, side, 1, 1);
  b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(side));
  std::vector<double> observed(12 * 12, 0.0), expected(12 * 12, double{side} * side / 144);
  each_camera_ray(*b.freeze(), [&](const PathStream& paths, uint32_t i) {
    const double x = double{paths.origin[0][i]} + side, y = double{paths.origin[1][i]} + side;
    observed[static_cast<size_t>((x - std::floor(x)) * 12) * 12 + static_cast<size_t>((y - std::floor(y)) * 12)] += 1;
  });
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

// Through the centres of the pixels; in camera axes, with pbrt's spherical camera's formulas.
TEST(CameraSampling, SphericalCamerasSeeAllDirectionsByLatitudeAndLongitude) {
  SceneBuilder b(side, side, 1, 1);
  b.scene.settings.pixel_jitter = false;
  Camera camera;
  camera.kind = CameraKind::spherical;
  const glm::dmat4 place = moved(1, 2, 3) * turned(50, 1, 2, 3) * stretched(1, 1, -1);
  const Entity entity = b.place(place);
  b.scene.registry.set(entity, camera);
  std::vector<int> seen(side * side, 0);
  each_camera_ray(*b.freeze(), [&](const PathStream& paths, uint32_t i) {
    const glm::dvec3 d(paths.direction[0][i], paths.direction[1][i], paths.direction[2][i]);
    const glm::dvec3 local = glm::inverse(glm::dmat3(place)) * d;
    EXPECT_NEAR(paths.origin[1][i], 2, 1e-6);
    const double theta = std::acos(std::clamp(local.y, -1.0, 1.0));
    double phi = std::atan2(local.z, local.x);
    if (phi < 0) phi += 2 * pi;
    const double x = phi / (2 * pi) * side - 0.5, y = theta / pi * side - 0.5;
    ASSERT_NEAR(x, std::round(x), 0.02);
    ASSERT_NEAR(y, std::round(y), 0.02);
    seen[static_cast<size_t>(std::round(y) * side + std::round(x))] += 1;
  });
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), side * side) << "each pixel its own direction";
}

// Directions are uniform on the sphere: bins of equal height and longitude. The centre looks up, as in pbrt's images.
TEST(CameraSampling, SphericalCamerasSeeEqualAreas) {
  SceneBuilder b(side, side, 1, 1);
  b.scene.settings.filter = {FilterKind::gaussian, 1.5f, 1.5f, 0.5f};
  Camera camera;
  camera.kind = CameraKind::spherical;
  camera.mapping = ImageMapping::equal_area;
  const Entity entity = b.place();
  b.scene.registry.set(entity, camera);
  std::vector<double> observed(12 * 16, 0.0), expected(12 * 16, double{side} * side / (12 * 16));
  glm::dvec3 centre(0), right(0), lower(0);
  uint32_t n = 0;
  each_camera_ray(*b.freeze(), [&](const PathStream& paths, uint32_t i) {
    const glm::dvec3 d(paths.direction[0][i], paths.direction[1][i], paths.direction[2][i]);
    EXPECT_NEAR(glm::length(d), 1, 1e-5);
    const double height = (d.y + 1) / 2, phi = std::atan2(d.z, d.x) / (2 * pi) + 0.5;
    observed[std::min<size_t>(11, static_cast<size_t>(height * 12)) * 16 +
             std::min<size_t>(15, static_cast<size_t>(phi * 16))] += 1;
    const uint32_t packet = n / 16, x = packet % (side / 4) * 4 + n % 4, y = packet / (side / 4) * 4 + n % 16 / 4;
    if (x == side / 2 && y == side / 2) centre = d;
    if (x == side - 1 && y == side / 2) right = d;
    if (x == side / 2 && y == side - 1) lower = d;
    ++n;
  });
  EXPECT_GT(centre.y, 0.99);
  EXPECT_GT(right.x, 0.99);
  EXPECT_GT(lower.z, 0.99) << "the lower edge's middle looks ahead";
  EXPECT_GT(chi_square_test(observed, expected).p_value, chi_square_level);
}

}  // namespace
}  // namespace metamer
