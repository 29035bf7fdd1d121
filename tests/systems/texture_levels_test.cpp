// Which level of an image a lookup takes, and what comes of it.
#include <gmock/gmock.h>

#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

constexpr uint32_t side = 8;
constexpr double texel = 1.0 / side;  // metres, on a unit square

// Columns of 1 and 0: on level 1 and all above everything is 1/2.
Texture columns(TexturedScene& s, TextureFilter filter) {
  std::vector<float> greys;
  for (uint32_t i = 0; i < side * side; ++i) greys.push_back(i % 2 == 0 ? 1.0f : 0.0f);
  Texture texture = s.greys(side, side, greys);
  texture.filter = filter;
  texture.is_number = 1;
  return texture;
}

// The number in the middle of a texel of value 1 of the unit square around the origin.
double at_texel(TexturedScene& s, const Texture& texture) {
  s.b.add(rectangle(1, 1), s.b.diffuse(0.5));
  RayHit hit;
  hit.origin[0] = static_cast<float>(0.5 * texel);
  hit.origin[1] = static_cast<float>(0.5 * texel);
  hit.origin[2] = 1;
  hit.direction[2] = -1;
  hit.primitive = 0;
  const TextureId id = s.add(texture);
  return double{number_at_hit(*s.b.freeze(), id, hit)};
}

// Seen by parallel light in pixels so wide that a lookup, a quarter of one, is `texels` wide.
double seen_from_above(double texels, TextureFilter filter, const glm::dvec3& from = {0, 0, 1},
                       float most_anisotropy = 8) {
  TexturedScene s;
  s.b.look_at(from, {0, 0, 0}, orthographic(static_cast<float>(texels * texel * 4 * 4)));
  Texture texture = columns(s, filter);
  texture.most_anisotropy = most_anisotropy;
  return at_texel(s, texture);
}

TEST(TextureLevels, ALookupAsWideAsATexelTakesTheImageItself) {
  EXPECT_NEAR(seen_from_above(1, TextureFilter::trilinear), 1, 1e-6);
  EXPECT_NEAR(seen_from_above(0.01, TextureFilter::trilinear), 1, 1e-6);
}

TEST(TextureLevels, BetweenLevelsNumbersAreLinearInTheLogarithmOfTheWidth) {
  EXPECT_NEAR(seen_from_above(2, TextureFilter::trilinear), 0.5, 1e-5);
  EXPECT_NEAR(seen_from_above(std::sqrt(2.0), TextureFilter::trilinear), 0.75, 1e-5);
  EXPECT_NEAR(seen_from_above(1e6, TextureFilter::trilinear), 0.5, 1e-6);
}

TEST(TextureLevels, LinearAndNearestStayWithTheImageItself) {
  EXPECT_NEAR(seen_from_above(4, TextureFilter::linear), 1, 1e-6);
  EXPECT_NEAR(seen_from_above(4, TextureFilter::nearest), 1, 1e-6);
}

// cos 60 degrees is 1/2: what is as wide as a texel is two texels long.
TEST(TextureLevels, ObliquelyTrilinearGoesByTheLengthAnisotropicByTheWidth) {
  for (const glm::dvec3& from : {glm::dvec3{std::sqrt(0.75), 0, 0.5}, glm::dvec3{0.5, -std::sqrt(0.5), 0.5}}) {
    EXPECT_NEAR(seen_from_above(1, TextureFilter::trilinear, from), 0.5, 1e-5);
    EXPECT_NEAR(seen_from_above(1, TextureFilter::anisotropic, from), 1, 1e-5);
    EXPECT_NEAR(seen_from_above(std::sqrt(2.0), TextureFilter::anisotropic, from), 0.75, 1e-5);
  }
}

// cos = 1/4: four times as long as wide; at most twice is allowed, so the width counts as half the length.
TEST(TextureLevels, AnisotropyIsBounded) {
  const glm::dvec3 from = {std::sqrt(15.0) / 4, 0, 0.25};
  EXPECT_NEAR(seen_from_above(0.5, TextureFilter::anisotropic, from, 2), 1, 1e-5);
  EXPECT_NEAR(seen_from_above(1, TextureFilter::anisotropic, from, 2), 0.5, 1e-5);
  EXPECT_NEAR(seen_from_above(1, TextureFilter::anisotropic, from, 4), 1, 1e-5);
}

// A pixel at the centre of 4 x 4 over 2 atan(1 / 2) is 1/4 wide at distance 1: a lookup 1/16, half a texel.
TEST(TextureLevels, PerspectiveLookupsGrowWithTheDistance) {
  const auto seen_at = [](double distance) {
    TexturedScene s;
    const double x = 0.5 * texel;
    s.b.look_at({x, x, distance}, {x, x, 0}, perspective(static_cast<float>(2 * std::atan(0.5) * 180 / pi)));
    return at_texel(s, columns(s, TextureFilter::trilinear));
  };
  EXPECT_NEAR(seen_at(2), 1, 1e-4);
  EXPECT_NEAR(seen_at(2 * std::sqrt(2.0)), 0.75, 1e-4);
  EXPECT_NEAR(seen_at(4), 0.5, 1e-4);
}

// The same place by other mappings: u = x + 1/2 as a plane's coordinate, twice as fast by the surface's own.
TEST(TextureLevels, MappingsCountInTheWidth) {
  const auto seen = [](const TextureMapping& mapping) {
    TexturedScene s;
    s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(static_cast<float>(std::sqrt(2.0) * texel * 16)));
    Texture texture = columns(s, TextureFilter::trilinear);
    texture.mapping = mapping;
    return at_texel(s, texture);
  };
  TextureMapping plane;
  plane.kind = TextureMapping::Kind::planar;
  plane.u_offset = plane.v_offset = 0.5f;
  EXPECT_NEAR(seen(plane), 0.75, 1e-4);
  TextureMapping fast;
  fast.u_scale = fast.v_scale = 2;
  fast.u_offset = fast.v_offset = static_cast<float>(-0.5 * texel);
  EXPECT_NEAR(seen(fast), 0.5, 1e-4);
}

// On a cylinder of radius 1 / (2 pi) seen across the line where the azimuth starts again nothing is wide.
TEST(TextureLevels, WhereATurnBeginsAgainLookupsAreNotWide) {
  for (const double degrees : {0.0, 179.9, -179.9, 45.0}) {
    TexturedScene s;
    Geometry tube;
    tube.kind = ShapeKind::cylinder;
    tube.radius = static_cast<float>(1 / (2 * pi));
    tube.z_min = -1;
    tube.z_max = 1;
    s.b.add(tube, s.b.diffuse(0.5));
    const glm::dvec3 outwards = {std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0};
    s.b.look_at(outwards, {0, 0, 0}, orthographic(static_cast<float>(0.5 * texel * 16)), {0, 0, 1});
    Texture texture = columns(s, TextureFilter::trilinear);
    texture.mapping.kind = TextureMapping::Kind::cylindrical;
    RayHit hit;
    for (int i = 0; i < 3; ++i) {
      hit.origin[i] = static_cast<float>(outwards[i]);
      hit.direction[i] = static_cast<float>(-outwards[i]);
    }
    hit.distance = static_cast<float>(1 - 1 / (2 * pi));
    const TextureId id = s.add(texture);
    Texture exact = texture;
    exact.filter = TextureFilter::linear;
    const TextureId linear = s.add(exact);
    const auto world = s.b.freeze();
    EXPECT_EQ(number_at_hit(*world, id, hit), number_at_hit(*world, linear, hit)) << degrees;
  }
}

// Reflectances draw a level and a texel of it; on average that is the number.
TEST(TextureLevels, ReflectancesAreRightOnAverage) {
  TexturedScene s;
  s.b.scene.settings.samples_per_pixel = 256;
  s.b.scene.settings.integrator = Integrator::local;
  Texture texture = columns(s, TextureFilter::trilinear);
  texture.is_number = 0;
  Material material = s.b.diffuse(0.5);
  material.reflectance_texture = s.add(texture);
  s.b.add(rectangle(1, 1), material);
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  // A lookup is sqrt(2) texels wide at this distance; all pixels see the middle of a texel of value 1.
  const double x = 0.5 * texel;
  Camera camera = orthographic(1e-5f);
  s.b.look_at({x, x, 1}, {x, x, 0}, camera);
  const auto world = s.b.freeze();
  world->camera.footprint_width = static_cast<float>(std::sqrt(2.0) * texel);
  const auto paths = trace_radiances(*world);
  EXPECT_NEAR(mean(paths), 0.75, 0.005);
  double halves = 0;
  for (const PathRadiance& path : paths) halves += path.radiance[0] < 0.75 ? 1 : 0;
  EXPECT_NEAR(halves / static_cast<double>(paths.size()), 0.5, 0.02);  // a level each time
}

// A board of 256 x 256 fields of which a pixel of the far end sees dozens: with levels every pixel is what very many
// samples of the file itself find, to 0.02 in reflectance (a lookup's width against a pixel filter of 1), and
// less noisy.
TEST(TextureLevels, AFarBoardIsWhatManySamplesOfTheImageFind) {
  constexpr uint32_t pixels = 16;
  const auto picture = [](TextureFilter filter, uint32_t samples, double* variance) {
    TexturedScene s;
    s.b.scene.settings.width = s.b.scene.settings.height = pixels;
    s.b.scene.settings.samples_per_pixel = samples;
    constexpr uint32_t fields = 256;
    std::vector<float> greys;
    for (uint32_t y = 0; y < fields; ++y)  // darker towards one side, so that pixels differ
      for (uint32_t x = 0; x < fields; ++x) greys.push_back((x + y) % 2 == 0 ? 0.1f : 0.2f + 0.6f * float(x) / fields);
    Texture texture = s.greys(fields, fields, greys);
    texture.filter = filter;
    Material material = s.b.diffuse(0.5);
    material.reflectance_texture = s.add(texture);
    s.b.add(rectangle(1, 1), material);
    s.b.light(LightKind::directional, s.b.constant(pi), 1);
    s.b.look_at({0, -0.9, 0.4}, {0, 0, 0}, perspective(30), {0, 0, 1});
    std::vector<double> sums(pixels * pixels), squares(sums.size());
    const auto paths = trace_radiances(*s.b.freeze());
    for (size_t i = 0; i < paths.size(); ++i) {
      const double r = paths[i].radiance[0];
      sums[i % sums.size()] += r / samples;
      squares[i % sums.size()] += r * r / samples;
    }
    *variance = 0;
    for (size_t i = 0; i < sums.size(); ++i)
      *variance += (squares[i] - sums[i] * sums[i]) / static_cast<double>(sums.size());
    return sums;
  };
  double variance = 0, plain_variance = 0;
  const std::vector<double> exact = picture(TextureFilter::linear, 4096, &plain_variance);
  for (const TextureFilter filter : {TextureFilter::trilinear, TextureFilter::anisotropic}) {
    const std::vector<double> found = picture(filter, 1024, &variance);
    double worst = 0, bias = 0;
    for (size_t i = 0; i < exact.size(); ++i) {
      worst = std::max(worst, std::abs(found[i] - exact[i]));
      bias += (found[i] - exact[i]) / static_cast<double>(exact.size());
    }
    EXPECT_LT(worst, 0.02) << static_cast<int>(filter);
    EXPECT_LT(std::abs(bias), 0.002);
    EXPECT_LT(variance, 0.7 * plain_variance);
  }
}

}  // namespace
}  // namespace metamer
