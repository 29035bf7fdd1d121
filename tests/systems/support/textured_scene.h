// A unit square with a texture under a directional light: its radiance is the texture's value.
#pragma once
#include <cmath>
#include <vector>

#include "tests/systems/support/radiances.h"

namespace metamer {

inline constexpr double pi = 3.14159265358979323846;

inline double mean(const std::vector<PathRadiance>& paths) {
  double sum = 0;
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) sum += radiance / 4;
  return sum / static_cast<double>(paths.size());
}

struct TexturedScene {
  SceneBuilder b{4, 4, 4, 1};

  TexturedScene() { b.scene.settings.integrator = Integrator::local; }

  TextureId add(const Texture& texture) {
    b.scene.textures.push_back(texture);
    return static_cast<TextureId>(b.scene.textures.size() - 1);
  }
  TextureId spectrum(double value) {
    Texture texture;
    texture.spectrum = b.constant(value);
    return add(texture);
  }
  TextureId number(float value) {
    Texture texture;
    texture.is_number = 1;
    texture.value = value;
    return add(texture);
  }
  Texture image(uint32_t width, uint32_t height, const std::vector<float>& rgb) {
    Image pixels;
    pixels.width = width;
    pixels.height = height;
    pixels.rgb = rgb;
    b.scene.images.push_back(pixels);
    Texture texture;
    texture.kind = TextureKind::image;
    texture.image = static_cast<ImageId>(b.scene.images.size() - 1);
    texture.filter = TextureFilter::nearest;
    return texture;
  }
  // Greys from the top row down.
  Texture greys(uint32_t width, uint32_t height, const std::vector<float>& values) {
    std::vector<float> rgb;
    for (const float value : values) rgb.insert(rgb.end(), 3, value);
    return image(width, height, rgb);
  }
  Texture combination(TextureKind kind, TextureId a, TextureId second, TextureId amount = 0) {
    Texture texture;
    texture.kind = kind;
    texture.a = a;
    texture.b = second;
    texture.amount = amount;
    return texture;
  }
  // The paths of a unit square's point (u, v) under light of irradiance pi: they carry its albedo.
  std::vector<PathRadiance> look(TextureId texture, double u, double v) {
    Material material = b.diffuse(0.123);
    material.reflectance_texture = texture;
    b.add(rectangle(1, 1), material);
    b.light(LightKind::directional, b.constant(pi), 1);
    Camera camera;
    camera.kind = CameraKind::orthographic;
    camera.screen_height = 1e-5f;
    b.look_at({u - 0.5, v - 0.5, 1}, {u - 0.5, v - 0.5, 0}, camera);
    return trace_radiances(*b.freeze());
  }
  void expect(const Texture& texture, double u, double v, double albedo) {
    if (albedo == 0) {
      EXPECT_EQ(mean(look(add(texture), u, v)), 0);
      return;
    }
    expect_every_path(
        look(add(texture), u, v), [&](double) { return albedo; }, 1e-4);
  }
};

}  // namespace metamer
