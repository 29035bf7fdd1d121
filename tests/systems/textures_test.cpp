// Textures through the whole pipeline: a point of a textured surface under a directional light shows its albedo on
// each wavelength, free of noise.
#include <gmock/gmock.h>

#include "engine/spectrum/rgb_fit.h"
#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

TEST(Textures, ATexelShowsTheSpectrumOfItsColourOnEachWavelength) {
  const std::vector<float> colours = {0.8f, 0.1f, 0.1f, 0.1f, 0.7f, 0.2f, 0.2f, 0.2f, 0.9f,
                                      0.5f, 0.5f, 0.5f, 0,    0,    0,    1,    1,    1};  // three columns, two rows
  for (const uint32_t texel : {0u, 1u, 2u, 3u, 4u, 5u}) {
    TexturedScene s;
    const TextureId texture = s.add(s.image(3, 2, colours));
    const double u = (texel % 3 + 0.5) / 3, v = texel < 3 ? 0.75 : 0.25;  // v = 1 is the first row
    const auto paths = s.look(texture, u, v);
    const float* rgb = colours.data() + 3 * texel;
    const SigmoidFit fit = fit_sigmoid(ColorSpace::srgb, {rgb[0], rgb[1], rgb[2]});
    for (const PathRadiance& path : paths)
      for (size_t j = 0; j < 4; ++j)
        EXPECT_NEAR(path.radiance[j], sigmoid_polynomial(fit.c, path.lambda_nm[j]), 3e-3) << texel;
  }
}

TEST(Textures, BetweenTexelsTheMeanIsLinear) {
  for (const double u : {0.3, 0.5, 0.6}) {
    TexturedScene s;
    s.b.scene.settings.samples_per_pixel = 256;
    Texture texture = s.greys(2, 2, {0.0f, 1.0f, 0.2f, 0.6f});
    texture.filter = TextureFilter::linear;
    const double right = (u - 0.25) / 0.5, v = 0.4, upper = (v - 0.25) / 0.5;
    const double wanted = upper * right + (1 - upper) * (0.2 * (1 - right) + 0.6 * right);
    // 4096 samples of a standard deviation of at most 0.5, independent: 5 sigma are 0.04; low-discrepancy far less.
    EXPECT_NEAR(mean(s.look(s.add(texture), u, v)), wanted, 0.01) << u;
  }
}

TEST(Textures, OutsideTheImageItRepeatsStaysOrIsBlack) {
  const auto seen = [](TextureWrap wrap, float u_offset, double albedo) {
    TexturedScene s;
    Texture texture = s.greys(2, 1, {0.2f, 0.8f});
    texture.wrap = wrap;
    texture.mapping.u_offset = u_offset;
    s.expect(texture, 0.25, 0.5, albedo);
  };
  seen(TextureWrap::repeat, 0, 0.2);
  seen(TextureWrap::repeat, 1.5f, 0.8);
  seen(TextureWrap::repeat, -0.5f, 0.8);
  seen(TextureWrap::clamp, 1.5f, 0.8);
  seen(TextureWrap::clamp, -0.5f, 0.2);
  seen(TextureWrap::black, -0.5f, 0);
  seen(TextureWrap::black, 0.5f, 0.8);
}

TEST(Textures, ScaleAndInvertActOnTheImage) {
  TexturedScene half;
  Texture texture = half.greys(1, 1, {0.6f});
  texture.scale = 0.5f;
  half.expect(texture, 0.5, 0.5, 0.3);
  TexturedScene inverted;
  texture = inverted.greys(1, 1, {0.6f});
  texture.scale = 0.5f;
  texture.invert = 1;
  inverted.expect(texture, 0.5, 0.5, 0.7);
  TexturedScene bright;  // no surface reflects more than it gets
  texture = bright.greys(1, 1, {0.6f});
  texture.scale = 3;
  bright.expect(texture, 0.5, 0.5, 1);
}

TEST(Textures, ProductsAndMixturesOfTextures) {
  TexturedScene product;
  product.expect(product.combination(TextureKind::scale, product.spectrum(0.8), product.number(0.25f)), 0.5, 0.5, 0.2);
  TexturedScene mixture;
  const TextureId a = mixture.spectrum(0.2), b = mixture.add(mixture.greys(1, 1, {0.9f}));
  const TextureId amount = mixture.number(0.25f);
  mixture.expect(mixture.combination(TextureKind::mix, a, b, amount), 0.5, 0.5, 0.2 * 0.75 + 0.9 * 0.25);
  TexturedScene nested;  // (1 - 0.5) 0.4 + 0.5 (0.8 x 0.5)
  const TextureId inner = nested.add(nested.combination(TextureKind::scale, nested.spectrum(0.8), nested.number(0.5f)));
  const TextureId grey = nested.spectrum(0.4);
  nested.expect(nested.combination(TextureKind::mix, grey, inner, nested.number(0.5f)), 0.5, 0.5, 0.4);
}

// Linear lookups draw one texel: were both factors drawn with one point, the mean would be 1/2.
TEST(Textures, AProductOfTwoImagesIsTheProductOfTheirMeans) {
  TexturedScene s;
  s.b.scene.settings.samples_per_pixel = 256;
  Texture texture = s.greys(2, 1, {0, 1});
  texture.filter = TextureFilter::linear;
  const TextureId a = s.add(texture), b = s.add(texture);
  EXPECT_NEAR(mean(s.look(s.add(s.combination(TextureKind::scale, a, b)), 0.5, 0.5)), 0.25, 0.02);
}

TEST(Textures, ACheckerboardAlternates) {
  for (const auto& [u, v, albedo] :
       {std::array{0.1, 0.1, 0.3}, {0.3, 0.1, 0.7}, {0.1, 0.3, 0.7}, {0.3, 0.3, 0.3}, {0.6, 0.9, 0.7}}) {
    TexturedScene s;
    Texture board = s.combination(TextureKind::checkerboard, s.spectrum(0.3), s.spectrum(0.7));
    board.mapping.u_scale = board.mapping.v_scale = 4;
    s.expect(board, u, v, albedo);
  }
}

// Around a sphere: u grows with the angle around z, v from the lower pole to the upper one.
TEST(Textures, SpheresAndDisksHaveCoordinates) {
  const auto seen = [](const Geometry& geometry, const glm::dvec3& from, const glm::dvec3& to) {
    TexturedScene s;
    s.b.scene.settings.shadows = false;
    Texture columns = s.greys(4, 1, {0.1f, 0.3f, 0.5f, 0.7f});
    Texture rows = s.greys(1, 4, {0.2f, 0.4f, 0.6f, 0.8f});
    Material material = s.b.diffuse(0.5);
    material.reflectance_texture = s.add(s.combination(TextureKind::scale, s.add(columns), s.add(rows)));
    s.b.add(geometry, material);
    Camera camera;
    camera.kind = CameraKind::orthographic;
    camera.screen_height = 1e-5f;
    s.b.look_at(from, to, camera, {0.1, 0.2, 1});
    // Shines along the view: irradiance pi cos(theta).
    const glm::dvec3 z = glm::normalize(from - to), x = glm::normalize(glm::cross({0.1, 0.2, 1}, z));
    s.b.light(LightKind::directional, s.b.constant(pi), 1,
              glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1)));
    return mean(trace_radiances(*s.b.freeze()));
  };
  // 45 degrees up: v = 0.75 is the seam of two rows, so 60: v = 5/6.
  const double c = std::cos(glm::radians(60.0)), up = std::sin(glm::radians(60.0));
  const auto on_sphere = [&](double degrees, double sign) {
    const double a = glm::radians(degrees);
    const glm::dvec3 p = {c * std::cos(a), c * std::sin(a), sign * up};
    return seen(sphere(1), p * 2.0, p);
  };
  EXPECT_NEAR(on_sphere(30, 1), 0.1 * 0.2, 1e-4);
  EXPECT_NEAR(on_sphere(120, 1), 0.3 * 0.2, 1e-4);
  EXPECT_NEAR(on_sphere(210, -1), 0.5 * 0.8, 1e-4);
  EXPECT_NEAR(on_sphere(300, -1), 0.7 * 0.8, 1e-4);
  // On a disk v is 0 at the rim: half-way in, the second row from below meets the third.
  const auto on_disk = [&](double degrees, double radius) {
    const double a = glm::radians(degrees);
    const glm::dvec3 p = {radius * std::cos(a), radius * std::sin(a), 0};
    return seen(disk(1), p + glm::dvec3(0, 0, 1), p);
  };
  EXPECT_NEAR(on_disk(30, 0.9), 0.1 * 0.8, 1e-4);
  EXPECT_NEAR(on_disk(200, 0.6), 0.5 * 0.6, 1e-4);
  EXPECT_NEAR(on_disk(350, 0.1), 0.7 * 0.2, 1e-4);
}

TEST(Textures, ThousandsOfThemAreSortedByTheirNumber) {
  TexturedScene s;
  s.b.scene.settings.width = s.b.scene.settings.height = 32;
  constexpr uint32_t count = 700;  // more than one byte
  Geometry small = rectangle(1, 1);
  for (uint32_t i = 0; i < count; ++i) {
    Material material = s.b.diffuse(0.5);
    material.reflectance_texture = s.number(static_cast<float>(i + 1) / 1024);
    s.b.add(small, material, glm::translate(glm::dmat4(1), glm::dvec3(i % 32, -double(i / 32), 0)));
  }
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  Camera camera;
  camera.kind = CameraKind::orthographic;
  camera.screen_height = 32;
  s.b.look_at({15.5, -15.5, 1}, {15.5, -15.5, 0}, camera);
  s.b.scene.settings.samples_per_pixel = 1;
  const auto paths = trace_radiances(*s.b.freeze());
  for (uint32_t i = 0; i < count; ++i) EXPECT_NEAR(paths[i].radiance[0], (i + 1) / 1024.0, 1e-5) << i;
}

TEST(Textures, InRgbModeATexelIsItsThreeCoefficients) {
  TexturedScene s;
  s.b.scene.settings.color = ColorMode::rgb;
  const std::array<float, 3> rgb = {0.8f, 0.1f, 0.3f};
  const auto paths = s.look(s.add(s.image(1, 1, {rgb[0], rgb[1], rgb[2]})), 0.5, 0.5);
  TexturedScene white;
  white.b.scene.settings.color = ColorMode::rgb;
  const auto full = white.look(white.add(white.image(1, 1, {1, 1, 1})), 0.5, 0.5);
  for (size_t i = 0; i < paths.size(); ++i)
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(paths[i].radiance[c] / full[i].radiance[c], rgb[c], 1e-5);
}

TEST(Textures, TheBodyUnderACoatTakesItsReflectanceFromATexture) {
  for (const float alpha : {0.0f, 0.3f}) {
    const auto radiances = [&](bool textured) {
      TexturedScene s;
      Material material = s.b.coated(s.b.constant(textured ? 0.9 : 0.4), s.b.constant(1.5), alpha);
      if (textured) material.reflectance_texture = s.add(s.greys(1, 1, {0.4f}));
      s.b.add(rectangle(1, 1), material);
      s.b.light(LightKind::directional, s.b.constant(pi), 1, turned(30, 1, 0, 0));
      s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-5f));
      return mean(trace_radiances(*s.b.freeze()));
    };
    EXPECT_NEAR(radiances(true), radiances(false), 1e-4) << alpha;
    EXPECT_GT(radiances(true), 0.1) << alpha;
  }
}

TEST(Textures, NestedTooDeepAreAnError) {
  TexturedScene s;
  TextureId texture = s.number(0.5f);
  for (int i = 0; i < 20; ++i) {
    const TextureId other = s.number(0.5f);
    texture = s.add(s.combination(TextureKind::scale, other, texture));
  }
  Diagnostics diagnostics;
  EXPECT_EQ(freeze(s.b.scene, diagnostics), nullptr);
  EXPECT_THAT(format_diagnostics(diagnostics), testing::HasSubstr("nested more than 16 deep"));
}

}  // namespace
}  // namespace metamer
