// Textures that are numbers: roughness, amounts, and the conductor whose reflectance varies.
#include <gmock/gmock.h>

#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

// What a number's program is at (u, v) of a unit square, by the path that alpha and mixtures take.
double number_at(TexturedScene& s, TextureId texture, double u, double v) {
  s.b.add(rectangle(1, 1), s.b.diffuse(0.5));
  s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1));
  RayHit hit;
  hit.origin[0] = static_cast<float>(u - 0.5);
  hit.origin[1] = static_cast<float>(v - 0.5);
  hit.origin[2] = 1;
  hit.direction[2] = -1;
  hit.primitive = v > u ? 1 : 0;
  return double{number_at_hit(*s.b.freeze(), texture, hit)};
}

Texture as_number(Texture texture) {
  texture.is_number = 1;
  return texture;
}

TEST(NumberTextures, ImagesAreLinearBetweenTexelsExactly) {
  for (const double u : {0.3, 0.5, 0.6}) {
    TexturedScene s;
    Texture texture = as_number(s.greys(2, 2, {0.0f, 1.0f, 0.2f, 0.6f}));
    texture.filter = TextureFilter::linear;
    texture.scale = 3;
    const double right = (u - 0.25) / 0.5, upper = (0.4 - 0.25) / 0.5;
    const double wanted = 3 * (upper * right + (1 - upper) * (0.2 * (1 - right) + 0.6 * right));
    EXPECT_NEAR(number_at(s, s.add(texture), u, 0.4), wanted, 1e-5) << u;
  }
}

TEST(NumberTextures, MayBeAboveOneAndBelowZero) {
  TexturedScene s;
  EXPECT_NEAR(number_at(s, s.add(as_number(s.greys(1, 1, {-4.5f}))), 0.5, 0.5), -4.5, 1e-6);
  TexturedScene inverted;
  Texture texture = as_number(inverted.greys(1, 1, {0.25f}));
  texture.invert = 1;
  EXPECT_NEAR(number_at(inverted, inverted.add(texture), 0.5, 0.5), 0.75, 1e-6);
}

TEST(NumberTextures, AreOneChannelOfThePixelOrTheMean) {
  for (const auto& [channel, wanted] : {std::pair{TextureChannel::average, 0.5},
                                        {TextureChannel::red, 0.2},
                                        {TextureChannel::green, 0.4},
                                        {TextureChannel::blue, 0.9},
                                        {TextureChannel::alpha, 0.7}}) {
    TexturedScene s;
    Texture texture = as_number(s.image(1, 1, {0.2f, 0.4f, 0.9f}));
    s.b.scene.images[0].alpha = {0.7f};
    texture.channel = channel;
    EXPECT_NEAR(number_at(s, s.add(texture), 0.5, 0.5), wanted, 1e-6);
  }
}

TEST(NumberTextures, SquareRootsAndMixtures) {
  TexturedScene s;
  Texture root = as_number(s.combination(TextureKind::square_root, s.number(0.09f), 0));
  const TextureId a = s.add(root), b = s.number(2), amount = s.number(0.25f);
  EXPECT_NEAR(number_at(s, s.add(as_number(s.combination(TextureKind::mix, a, b, amount))), 0.5, 0.5),
              0.75 * 0.3 + 0.25 * 2, 1e-6);
  TexturedScene negative;
  EXPECT_EQ(number_at(negative,
                      negative.add(as_number(negative.combination(TextureKind::square_root, negative.number(-1), 0))),
                      0.5, 0.5),
            0);
}

// A square of the material at 45 degrees to light and view, and its mean radiance.
double glossy(TexturedScene& s, const Material& material) {
  s.b.scene.settings.samples_per_pixel = 1;
  s.b.add(rectangle(1, 1), material);
  s.b.light(LightKind::directional, s.b.constant(1), 1, turned(30, 1, 0, 0));
  s.b.look_at({0, 1, 2}, {0, 0, 0}, orthographic(1e-5f));
  return mean(trace_radiances(*s.b.freeze()));
}

TEST(NumberTextures, RoughnessOfATextureIsThatOfANumber) {
  for (const bool metal : {true, false}) {
    const auto material = [&](TexturedScene& s, float alpha_x, float alpha_y) {
      if (!metal) return s.b.rough_glass(s.b.constant(1.5), alpha_x, alpha_y);
      return s.b.conductor(s.b.constant(0.2), s.b.constant(3.9), alpha_x, alpha_y);
    };
    TexturedScene plain, textured, swapped;
    const double wanted = glossy(plain, material(plain, 0.3f, 0.15f));
    EXPECT_GT(wanted, 1e-3);
    Material varying = material(textured, 0, 0);
    varying.alpha_x_texture = textured.number(0.3f);
    varying.alpha_y_texture = textured.number(0.15f);
    EXPECT_NEAR(glossy(textured, varying), wanted, 1e-5 * wanted);
    varying = material(swapped, 0.3f, 0.15f);
    varying.alpha_x_texture = swapped.number(0.15f);
    varying.alpha_y_texture = swapped.number(0.3f);
    EXPECT_GT(std::abs(glossy(swapped, varying) - wanted), 0.01 * wanted);
  }
}

TEST(NumberTextures, AConductorsReflectanceIsWhatItReflectsAlongTheNormal) {
  TexturedScene s;
  s.b.scene.settings.integrator = Integrator::path;
  Material mirror = s.b.conductor(unit_spectrum, zero_spectrum);
  mirror.reflectance_texture = s.add(s.greys(1, 1, {0.37f}));
  s.b.add(rectangle(1, 1), mirror);
  s.b.light(LightKind::environment, s.b.constant(1), 1);
  s.b.look_at({0, 0, 1}, {0, 0, 0}, orthographic(1e-5f));
  expect_every_path(
      trace_radiances(*s.b.freeze()), [](double) { return 0.37; }, 1e-4);
}

TEST(NumberTextures, TheAmountOfAMixtureMayBeATexture) {
  TexturedScene s;
  s.b.scene.settings.samples_per_pixel = 256;
  const auto part = [&](double reflectance) {
    const Entity entity = s.b.scene.registry.create();
    s.b.scene.registry.set(entity, s.b.diffuse(reflectance));
    return entity;
  };
  Material mix;
  mix.kind = MaterialKind::mix;
  mix.mix.first = part(0.2);
  mix.mix.second = part(0.8);
  mix.mix.amount = 0;
  mix.mix.amount_texture = s.add(as_number(s.greys(2, 1, {0.25f, 0.75f})));
  s.b.add(rectangle(1, 1), mix);
  s.b.light(LightKind::directional, s.b.constant(pi), 1);
  s.b.look_at({0.25, 0, 1}, {0.25, 0, 0}, orthographic(1e-5f));
  // Low-discrepancy points choose: a standard error far below 0.3 / sqrt(4096).
  EXPECT_NEAR(mean(trace_radiances(*s.b.freeze())), 0.25 * 0.2 + 0.75 * 0.8, 0.01);
}

}  // namespace
}  // namespace metamer
