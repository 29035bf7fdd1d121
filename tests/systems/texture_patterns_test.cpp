// Mappings and computed textures through the whole pipeline: a point under a directional light shows the texture's
// value.
#include "systems/noise.h"
#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

using Kind = TextureMapping::Kind;

// The value of a number texture at (u, v) of the unit square in the plane z = 0, as a share between black and white.
double value_at(Texture texture, double u, double v) {
  TexturedScene s;
  texture.is_number = 1;
  const TextureId black = s.spectrum(0), white = s.spectrum(1);
  return mean(s.look(s.add(s.combination(TextureKind::mix, black, white, s.add(texture))), u, v));
}

Texture coordinate(Kind kind, uint32_t axis) {
  Texture texture;
  texture.kind = TextureKind::coordinate;
  texture.mapping.kind = kind;
  texture.axis = axis;
  return texture;
}

// p' = p + by
void shift(Texture& texture, double x, double y, double z) {
  texture.mapping.to_texture[3] = static_cast<float>(x);
  texture.mapping.to_texture[7] = static_cast<float>(y);
  texture.mapping.to_texture[11] = static_cast<float>(z);
}

TEST(TexturePatterns, UvMappingScalesAndShifts) {
  Texture u = coordinate(Kind::uv, 0);
  u.mapping.u_scale = 0.5f;
  u.mapping.u_offset = 0.25f;
  EXPECT_NEAR(value_at(u, 0.6, 0.1), 0.55, 1e-4);
  EXPECT_NEAR(value_at(coordinate(Kind::uv, 1), 0.6, 0.1), 0.1, 1e-4);
}

TEST(TexturePatterns, SphericalMappingGivesPolarAngleAndAzimuth) {
  // The square's point (u, v) lies at (u - 1/2, v - 1/2, 0); texture space is one lower, so that z = 1 there.
  for (const auto& [u, v] : {std::pair{0.9, 0.7}, {0.2, 0.8}, {0.3, 0.1}, {0.7, 0.2}}) {
    const double x = u - 0.5, y = v - 0.5;
    const double azimuth = std::atan2(y, x);
    Texture theta = coordinate(Kind::spherical, 0), phi = coordinate(Kind::spherical, 1);
    shift(theta, 0, 0, 1);
    shift(phi, 0, 0, 1);
    EXPECT_NEAR(value_at(theta, u, v), std::acos(1 / std::sqrt(1 + x * x + y * y)) / pi, 1e-4);
    EXPECT_NEAR(value_at(phi, u, v), (azimuth < 0 ? azimuth + 2 * pi : azimuth) / (2 * pi), 1e-4);
  }
}

TEST(TexturePatterns, CylindricalMappingGivesAzimuthAndHeight) {
  for (const auto& [u, v] : {std::pair{0.9, 0.7}, {0.2, 0.8}, {0.3, 0.1}}) {
    Texture phi = coordinate(Kind::cylindrical, 0), height = coordinate(Kind::cylindrical, 1);
    shift(height, 0, 0, 0.625);
    EXPECT_NEAR(value_at(phi, u, v), (pi + std::atan2(v - 0.5, u - 0.5)) / (2 * pi), 1e-4);
    EXPECT_NEAR(value_at(height, u, v), 0.625, 1e-4);
  }
}

TEST(TexturePatterns, PlanarMappingMeasuresAlongItsAxes) {
  Texture across = coordinate(Kind::planar, 0), up = coordinate(Kind::planar, 1);
  for (Texture* t : {&across, &up}) {
    t->mapping.u_axis[1] = 0.5f;  // (1, 0.5, 0)
    t->mapping.v_axis[1] = 0.25f;
    t->mapping.u_offset = 0.5f;
    t->mapping.v_offset = 0.125f;
  }
  EXPECT_NEAR(value_at(across, 0.6, 0.9), 0.1 + 0.5 * 0.4 + 0.5, 1e-4);
  EXPECT_NEAR(value_at(up, 0.6, 0.9), 0.25 * 0.4 + 0.125, 1e-4);
}

TEST(TexturePatterns, FacingIsTheCosineOfTheNormal) {
  Texture facing;
  facing.kind = TextureKind::facing;
  facing.axis_direction[0] = 0;
  facing.axis_direction[1] = -0.8f;
  facing.axis_direction[2] = -0.6f;
  EXPECT_NEAR(value_at(facing, 0.3, 0.3), 0.6, 1e-5);
}

TEST(TexturePatterns, ABoardOfThreeDimensionsAlternatesAlongAllOfThem) {
  for (const auto& [z, wanted] : {std::pair{0.25, 0.3}, {1.25, 0.7}, {2.25, 0.3}}) {
    TexturedScene s;
    Texture board = s.combination(TextureKind::checkerboard, s.spectrum(0.3), s.spectrum(0.7));
    board.mapping.kind = Kind::point;
    shift(board, 0, 0, z);
    s.expect(board, 0.75, 0.75, wanted);
    TexturedScene other;
    board = other.combination(TextureKind::checkerboard, other.spectrum(0.3), other.spectrum(0.7));
    board.mapping.kind = Kind::point;
    shift(board, 0, 0, z);
    other.expect(board, 0.25, 0.75, 1 - wanted);
  }
}

// Values of noise may be negative; shown are 0.5 + 0.5 value, a mix of two constants.
double shown(Texture texture, double u, double v) {
  TexturedScene s;
  texture.is_number = 1;
  const TextureId grey = s.spectrum(0.5), white = s.spectrum(1);
  return 2 * mean(s.look(s.add(s.combination(TextureKind::mix, grey, white, s.add(texture))), u, v)) - 1;
}

TEST(TexturePatterns, NoisesAreSumsOfOctaves) {
  for (const auto& [u, v] : {std::pair{0.9, 0.7}, {0.2, 0.8}, {0.31, 0.17}}) {
    const glm::dvec3 p(u - 0.5 + 3.25, v - 0.5 - 7.125, 2.375);
    Texture texture;
    texture.mapping.kind = Kind::point;
    shift(texture, 3.25, -7.125, 2.375);
    texture.octaves = 4;
    texture.roughness = 0.4f;
    texture.kind = TextureKind::fbm;
    EXPECT_NEAR(shown(texture, u, v), reference::fbm(p, 0.4, 4), 1e-3);
    texture.kind = TextureKind::wrinkled;
    EXPECT_NEAR(shown(texture, u, v), reference::turbulence(p, 0.4, 4), 1e-3);
    texture.kind = TextureKind::windy;
    EXPECT_NEAR(shown(texture, u, v), std::abs(reference::fbm(0.1 * p, 0.5, 3)) * reference::fbm(p, 0.5, 6), 1e-3);
  }
}

// By the definition: one dot of radius 0.35 in the cell around an integer point, where noise is positive there.
bool is_in_dot(double s, double t) {
  const double cell_s = std::floor(s + 0.5), cell_t = std::floor(t + 0.5);
  if (reference::noise({cell_s + 0.5, cell_t + 0.5, 0.5}) <= 0) return false;
  const double center_s = cell_s + 0.15 * reference::noise({cell_s + 1.5, cell_t + 2.8, 0.5});
  const double center_t = cell_t + 0.15 * reference::noise({cell_s + 4.5, cell_t + 9.8, 0.5});
  return std::hypot(s - center_s, t - center_t) < 0.35;
}

TEST(TexturePatterns, DotsLieInTheirCells) {
  int inside = 0;
  for (int i = 0; i < 60; ++i) {
    const double u = std::fmod(i * 0.6180339887, 1.0), v = std::fmod(i * 0.7548776662, 1.0);
    Texture texture;
    texture.kind = TextureKind::dots;
    texture.mapping.u_scale = texture.mapping.v_scale = 12;
    const double value = value_at(texture, u, v);
    EXPECT_EQ(value > 0.5, is_in_dot(12 * u, 12 * v)) << u << ' ' << v;
    inside += value > 0.5;
  }
  EXPECT_GT(inside, 5);
  EXPECT_LT(inside, 40);
}

TEST(TexturePatterns, MarbleIsItsColourCurve) {
  // Without noise and at y = 0 the phase is 1/2: the middle of the knots, the fourth segment's begin, 0.5 (times 1.5).
  TexturedScene s;
  Texture marble;
  marble.kind = TextureKind::marble;
  marble.mapping.kind = Kind::point;
  marble.variation = 0;
  marble.scale = 1;
  shift(marble, 0, 1e-3, 0);
  EXPECT_NEAR(mean(s.look(s.add(marble), 0.5, 0.5)), 0.75, 5e-3);
  // A quarter turn up the phase is 1: the last segment's end.
  TexturedScene top;
  shift(marble, 0, pi / 2, 0);
  EXPECT_NEAR(mean(top.look(top.add(marble), 0.5, 0.5)), 1.5 * 0.587, 0.02);
}

TEST(TexturePatterns, OverTheEdgeOfAnUnfoldedSphereLieTheTexelsThatTouchIt) {
  // 4 x 4 greys. Left of column 0 in row 1 lies column 0 of row 2, and above row 0 in column 1 row 0 of column 2.
  std::vector<float> values;
  for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(i + 1) / 20);
  const auto seen = [&](double column, double row, int wanted) {
    TexturedScene s;
    Texture texture = s.greys(4, 4, values);
    texture.wrap = TextureWrap::octahedral;
    texture.mapping.u_offset = static_cast<float>((column + 0.5) / 4 - 0.5);
    texture.mapping.v_offset = static_cast<float>(1 - (row + 0.5) / 4 - 0.5);
    s.expect(texture, 0.5, 0.5, values[static_cast<size_t>(wanted)]);
  };
  seen(1, 1, 5);
  seen(-1, 1, 8);  // row 2, column 0
  seen(4, 0, 15);  // row 3, column 3
  seen(1, -1, 2);  // row 0, column 2
  seen(2, 4, 13);  // row 3, column 1
}

}  // namespace
}  // namespace metamer
