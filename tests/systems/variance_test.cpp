// The variance that a film predicts from its replicates against the one that is observed over 200 seeds.
#include <gtest/gtest.h>

#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

// Both are sums over the pixels of a picture. With 199 degrees of freedom for each of 64 pixels the observed sum is
// known to about 1.3 % where pixels are alike, 4 % where a tenth of them dominates: 10 % is more than two of those.
void expect_predicted_variance(World& world) {
  constexpr uint32_t seeds = 200;
  const size_t pixels = size_t{world.settings.width} * world.settings.height;
  std::vector<double> sum(3 * pixels), squares(3 * pixels);
  double predicted[3] = {};
  for (uint32_t seed = 0; seed < seeds; ++seed) {
    world.settings.seed = seed;
    const Film film = render_film(world, {1, 16});
    for (size_t pixel = 0; pixel < pixels; ++pixel)
      for (size_t c = 0; c < 3; ++c) {
        const double value = mean_xyz(film, pixel)[c];
        sum[3 * pixel + c] += value;
        squares[3 * pixel + c] += value * value;
        predicted[c] += variance_of_mean_xyz(film, pixel)[c] / seeds;
      }
  }
  for (size_t c = 0; c < 3; ++c) {
    double observed = 0;
    for (size_t i = c; i < 3 * pixels; i += 3) observed += (squares[i] - sum[i] * sum[i] / seeds) / (seeds - 1);
    EXPECT_GT(observed, 0);
    EXPECT_NEAR(predicted[c] / observed, 1, 0.1) << "channel " << c;
  }
}

TEST(Variance, IsPredictedOnASmoothScene) {
  SceneBuilder b(8, 8, 64, 3);
  b.scene.settings.filter = {FilterKind::gaussian, 1.5f, 1.5f, 0.5f};
  b.add(rectangle(20, 20), b.diffuse(b.named("colorchecker.foliage")), turned(-90, 1, 0, 0));
  b.add(sphere(1), b.diffuse(0.5), moved(0, 1, 0));
  b.light(LightKind::environment, b.named("D65"), 0.01f);
  b.look_at({0, 2, 4}, {0, 0.6, 0}, perspective(40));
  expect_predicted_variance(*b.freeze());
}

TEST(Variance, IsPredictedOnARoughScene) {
  SceneBuilder b(8, 8, 64, 6);
  b.add(rectangle(6, 6), b.diffuse(0.6), turned(-90, 1, 0, 0));
  b.add(sphere(0.7f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.1f, 0.1f), moved(-0.8, 0.7, 0));
  b.add(sphere(0.6f), b.dielectric(b.constant(1.5)), moved(0.8, 0.6, 0.4));
  b.emit(b.add(rectangle(0.7f, 0.7f), b.diffuse(0.1), moved(0, 2.4, 0) * turned(90, 1, 0, 0)), b.named("A"), 0.1f);
  b.look_at({0, 1.5, 4.5}, {0, 0.7, 0}, perspective(45));
  expect_predicted_variance(*b.freeze());
}

}  // namespace
}  // namespace metamer
