// Lights with images, several environments, and portals: against closed forms, and against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <random>

#include "systems/light_rows.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

// Greys, so that the light's spectrum stays what it is.
Image grey_image(uint32_t width, uint32_t height, ImageMapping mapping, uint32_t seed) {
  Image image;
  image.width = width;
  image.height = height;
  image.mapping = mapping;
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.1f, 2);
  for (uint32_t i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), 3, uniform(generator));
  return image;
}

Entity add_image_light(SceneBuilder& b, LightKind kind, const Image& image, const glm::dmat4& matrix,
                       float fov_deg = 90) {
  b.scene.images.push_back(image);
  Light light;
  light.kind = kind;
  light.spectrum = unit_spectrum;
  light.scale = 3;
  light.fov_deg = fov_deg;
  light.image = static_cast<ImageId>(b.scene.images.size() - 1);
  const Entity entity = b.place(matrix);
  b.scene.registry.set(entity, light);
  return entity;
}

// What the origin of the floor z = 0 of albedo 0.5 receives from a light that is added by `add`, by its radiance.
template <class Add>
double irradiance_at_origin(const Add& add, Integrator integrator = Integrator::path) {
  SceneBuilder b(4, 4, 1, 1);
  b.scene.settings.integrator = integrator;
  b.add(rectangle(20, 20), b.diffuse(0.5));
  add(b);
  b.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-5f));
  double sum = 0, count = 0;
  for (const PathRadiance& path : trace_radiances(*b.freeze()))
    for (const double radiance : path.radiance) sum += radiance, count += 1;
  return sum / count * pi / 0.5;
}

// The grey at a point of an image, texel by texel.
double texel(const Image& image, const glm::dvec2& uv) {
  const auto x = std::min(static_cast<uint32_t>(uv.x * image.width), image.width - 1);
  const auto y = std::min(static_cast<uint32_t>(uv.y * image.height), image.height - 1);
  return double{image.rgb[3 * (size_t{y} * image.width + x)]};
}

// E = I(direction) cos theta / d^2, with the image's +z along the light's own: as directions are read by environments.
TEST(GoniometricLight, LightsAPlaneByTheImageOfItsDirection) {
  const Image image = grey_image(16, 16, ImageMapping::equal_area, 3);
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 at(2 * uniform(generator), 2 * uniform(generator), 1.5 + uniform(generator));
    const glm::dmat4 place = moved(at.x, at.y, at.z) * turned(180 * uniform(generator), 1, uniform(generator), 0.3) *
                             stretched(i % 2 == 0 ? 1 : -1, 1, 1);
    const glm::dvec3 local = glm::normalize(glm::inverse(glm::dmat3(place)) * -at);
    const double wanted = 3 * texel(image, image_point(image.mapping, local)) * at.z / std::pow(glm::length(at), 3);
    for (const Integrator integrator : {Integrator::path, Integrator::local, Integrator::recursive})
      EXPECT_NEAR(irradiance_at_origin(
                      [&](SceneBuilder& b) { add_image_light(b, LightKind::goniometric, image, place); }, integrator) /
                      wanted,
                  1, 2e-5)
          << i;
  }
}

// A bright pole and a dark one: which is which, and where a quarter turn leads.
TEST(GoniometricLight, StandsWithItsZAxisUp) {
  for (const ImageMapping mapping : {ImageMapping::equal_area, ImageMapping::latitude_longitude}) {
    Image image;
    image.mapping = mapping;
    image.width = mapping == ImageMapping::equal_area ? 32 : 64;
    image.height = 32;
    for (uint32_t y = 0; y < image.height; ++y)
      for (uint32_t x = 0; x < image.width; ++x) {
        // Brighter by z: 1 - v of latitude and longitude, 1 - |u| - |v| of the octahedron.
        const double u = std::abs(2 * (x + 0.5) / image.width - 1), v = std::abs(2 * (y + 0.5) / image.height - 1);
        const double up = mapping == ImageMapping::equal_area ? 1 - (u + v) / 2 : 1 - (y + 0.5) / image.height;
        image.rgb.insert(image.rgb.end(), 3, static_cast<float>(up));
      }
    const auto below = [&](const glm::dmat4& turn) {
      return irradiance_at_origin(
          [&](SceneBuilder& b) { add_image_light(b, LightKind::goniometric, image, moved(0, 0, 1) * turn); });
    };
    EXPECT_NEAR(below(glm::dmat4(1)), 0, 3 * 0.05) << "the floor lies along -z";
    EXPECT_NEAR(below(turned(180, 1, 0, 0)), 3, 3 * 0.05);
    EXPECT_NEAR(below(turned(90, 0, 1, 0)), 1.5, 3 * 0.05);
  }
}

// u along +x from left to right, v down from +y, `fov_deg` over the shorter side.
TEST(ProjectionLight, ThrowsItsImageAsACameraWouldTakeIt) {
  for (const auto& [width, height] : {std::pair{8u, 4u}, {4u, 8u}, {6u, 6u}}) {
    const Image image = grey_image(width, height, ImageMapping::latitude_longitude, width);
    const double shorter = std::tan(pi / 180 * 50 / 2), aspect = double(width) / height;
    const glm::dvec2 half(shorter * std::max(1.0, aspect), shorter * std::max(1.0, 1 / aspect));
    for (int k = 0; k < 16; ++k) {
      // Where the origin is to lie in the picture; beyond 1 it is outside.
      const glm::dvec2 in_picture(-1.1 + 2.2 * (k % 4) / 3.01, -1.05 + 2.1 * (k / 4) / 3.02);
      // From (x, y, 2) down: +z ahead is -z of the world, +y up its +y, so +x is to the right seen along the light.
      const glm::dvec3 at(in_picture.x * half.x * 2, -in_picture.y * half.y * 2, 2);
      const glm::dmat4 place = moved(at.x, at.y, at.z) * turned(180, 0, 1, 0);
      const bool inside = std::abs(in_picture.x) < 1 && std::abs(in_picture.y) < 1;
      const double value = inside ? texel(image, {(1 + in_picture.x) / 2, (1 - in_picture.y) / 2}) : 0;
      EXPECT_NEAR(
          irradiance_at_origin([&](SceneBuilder& b) { add_image_light(b, LightKind::projection, image, place, 50); }),
          3 * value * at.z / std::pow(glm::length(at), 3), 2e-5)
          << width << " " << k;
    }
  }
}

TEST(ProjectionLight, ShinesAheadOnly) {
  const Image image = grey_image(2, 2, ImageMapping::latitude_longitude, 1);
  const auto below = [&](double degrees) {
    return irradiance_at_origin([&](SceneBuilder& b) {
      add_image_light(b, LightKind::projection, image, moved(0, 0, 2) * turned(degrees, 1, 0, 0));
    });
  };
  EXPECT_GT(below(180), 0);
  EXPECT_EQ(below(0), 0);
}

// The weights by which lights are chosen and lumens divided: of a sphere of white 4 pi, of a window its solid angle,
// 4 asin(sin^2 (fov / 2)) for a square one (the pyramid's).
TEST(ImageLights, WeighTheirImagesBySolidAngle) {
  Light light;
  Image white = grey_image(64, 64, ImageMapping::equal_area, 1);
  white.rgb.assign(white.rgb.size(), 1.0f);
  light.kind = LightKind::goniometric;
  EXPECT_NEAR(image_weight(light, white), 4 * pi, 1e-4);
  white.mapping = ImageMapping::latitude_longitude;
  EXPECT_NEAR(image_weight(light, white), 4 * pi, 1e-4);
  light.kind = LightKind::projection;
  EXPECT_NEAR(image_weight(light, white), 4 * std::asin(0.5), 1e-3);
  light.fov_deg = 40;
  EXPECT_NEAR(image_weight(light, white), 4 * std::asin(std::pow(std::sin(20 * pi / 180), 2)), 1e-4);
  light.kind = LightKind::area;
  EXPECT_NEAR(image_weight(light, white), 1, 1e-5);
}

// Between the centres of the pixels, clamped; (u, v) with v up, as surfaces have it.
double emitted(const Image& image, double u, double v) {
  const double x = u * image.width - 0.5, y = (1 - v) * image.height - 0.5;
  const double right = x - std::floor(x), lower = y - std::floor(y);
  const auto at = [&](double column, double row) {
    const double i = std::clamp(column, 0.0, image.width - 1.0), j = std::clamp(row, 0.0, image.height - 1.0);
    return double{image.rgb[3 * (static_cast<size_t>(j) * image.width + static_cast<size_t>(i))]};
  };
  const double i = std::floor(x), j = std::floor(y);
  return (at(i, j) * (1 - right) + at(i + 1, j) * right) * (1 - lower) +
         (at(i, j + 1) * (1 - right) + at(i + 1, j + 1) * right) * lower;
}

// A shape that emits an image, and where it has its (u, v), in its own space.
struct Emitter {
  Geometry geometry;
  glm::dmat4 place;
  glm::dvec3 (*point)(double u, double v);
};
constexpr double hole = 0.3f;
const Emitter emitters[] = {
    {rectangle(2, 1.5f), moved(0.2, 0.1, 1.2) * turned(160, 1, 0.2, 0.3),
     [](double u, double v) { return glm::dvec3(2 * u - 1, 1.5 * (v - 0.5), 0); }},
    {disk(1, 0.3f), moved(0.3, -0.2, 1.4) * turned(150, 1, 0.4, 0) * stretched(1, 1.5, 1),
     [](double u, double v) {
       const double r = 1 - (1 - hole) * v;
       return glm::dvec3(r * std::cos(2 * pi * u), r * std::sin(2 * pi * u), 0);
     }},
    {sphere(0.5f), moved(0.4, 0.3, 1) * turned(70, 1, 0.5, 0),
     [](double u, double v) {
       return 0.5 * glm::dvec3(std::sin(pi * v) * std::cos(2 * pi * u), std::sin(pi * v) * std::sin(2 * pi * u),
                               -std::cos(pi * v));
     }},
    {sphere(0.5f), moved(0.4, 0.3, 1) * turned(70, 1, 0.5, 0) * stretched(1, 0.6, 1.3), [](double u, double v) {
       return 0.5 * glm::dvec3(std::sin(pi * v) * std::cos(2 * pi * u), std::sin(pi * v) * std::sin(2 * pi * u),
                               -std::cos(pi * v));
     }}};

void add_emitter(SceneBuilder& b, const Emitter& emitter, const Image& image) {
  b.scene.images.push_back(image);
  Light light;
  light.spectrum = unit_spectrum;
  light.scale = 3;
  light.image = static_cast<ImageId>(b.scene.images.size() - 1);
  b.scene.registry.set(b.add(emitter.geometry, b.diffuse(0.0), emitter.place), light);
}

// E = integral of L cos cos' / d^2 over the surface, from its (u, v); by light samples and BSDF samples together, and
// by light samples alone (without shadows).
TEST(ImageOfAShape, LightsAPlaneByTheImageOfItsPoints) {
  const Image image = grey_image(7, 4, ImageMapping::latitude_longitude, 8);
  for (const Emitter& emitter : emitters) {
    constexpr int n = 600;
    double wanted = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double u = (i + 0.5) / n, v = (j + 0.5) / n, h = 1e-5;
        const auto at = [&](double s, double t) {
          return glm::dvec3(emitter.place * glm::dvec4(emitter.point(s, t), 1.0));
        };
        const glm::dvec3 p = at(u, v);
        const glm::dvec3 area = glm::cross(at(u + h, v) - at(u - h, v), at(u, v + h) - at(u, v - h)) / (4 * h * h);
        const double d2 = glm::dot(p, p), cos_floor = p.z / std::sqrt(d2);
        const double towards = -glm::dot(area, p) / std::sqrt(d2);
        if (cos_floor > 0 && towards > 0) wanted += 3 * emitted(image, u, v) * cos_floor * towards / d2 / (n * n);
      }
    for (const bool shadows : {true, false}) {
      SceneBuilder b(16, 16, 1024, 1);
      b.scene.settings.shadows = shadows;
      b.add(rectangle(20, 20), b.diffuse(0.5));
      add_emitter(b, emitter, image);
      Camera camera = orthographic(1e-5f);
      b.look_at({0, 0, 0.05}, {0, 0, 0}, camera);  // below the shapes
      expect_mean(
          trace_radiances(*b.freeze()), [&](double) { return wanted * 0.5 / pi; }, 0.06);
    }
  }
}

TEST(ImageOfAShape, IsSeenByItsUv) {
  const Image image = grey_image(5, 4, ImageMapping::latitude_longitude, 8);
  for (const Emitter& emitter : emitters)
    for (const double u : {0.13, 0.52, 0.9})
      for (const double v : {0.2, 0.77}) {
        SceneBuilder b(4, 4, 1, 0);
        add_emitter(b, emitter, image);
        const glm::dvec3 p(emitter.place * glm::dvec4(emitter.point(u, v), 1.0));
        const auto side = [&](double t) {
          return glm::dvec3(emitter.place * glm::dvec4(emitter.point(u, t), 1.0)) - p;
        };
        const glm::dvec3 along(glm::dvec3(emitter.place * glm::dvec4(emitter.point(u + 1e-4, v), 1.0)) - p);
        const glm::dvec3 normal = glm::normalize(glm::cross(along, side(v + 1e-4)));
        b.look_at(p + 0.02 * normal, p, orthographic(1e-5f), glm::normalize(along));
        for (const PathRadiance& path : trace_radiances(*b.freeze()))
          EXPECT_NEAR(path.radiance[0] / (3 * emitted(image, u, v)), 1, 1e-3) << u << " " << v;
      }
}

TEST(ImageOfAShape, SharesItsPowerByItsMean) {
  const Image image = grey_image(5, 4, ImageMapping::latitude_longitude, 8);
  SceneBuilder b(4, 4, 1, 0);
  b.scene.images.push_back(image);
  Light light;
  light.spectrum = unit_spectrum;
  light.scale = 100;
  light.is_power = 1;
  light.image = 0;
  b.scene.registry.set(b.add(rectangle(2, 3), b.diffuse(0.0)), light);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  double mean = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) mean += double{image.rgb[i]} / 20;
  const std::unique_ptr<World> world = b.freeze();
  EXPECT_NEAR(double{world->lights[0].scale} * pi * 6 * mean, 100, 1e-3);
}

// Mean radiance of a furnished floor under the environments that `add` makes.
template <class Add>
double mean_under(const Add& add) {
  SceneBuilder b(8, 8, 256, 3);
  b.add(rectangle(3, 3), b.diffuse(0.5));
  b.add(sphere(0.5f), b.conductor(b.constant(0.2), b.constant(3), 0.3f, 0.3f), moved(0.3, 0, 0.5));
  add(b);
  b.look_at({1, -2, 3}, {0, 0, 0}, perspective(30));
  double sum = 0, count = 0;
  for (const PathRadiance& path : trace_radiances(*b.freeze()))
    for (const double radiance : path.radiance) sum += radiance, count += 1;
  return sum / count;
}

TEST(Environments, AddUp) {
  const Image first = grey_image(8, 8, ImageMapping::equal_area, 1);
  const Image second = grey_image(8, 4, ImageMapping::latitude_longitude, 2);
  const auto add_first = [&](SceneBuilder& b) { b.environment(first, 1, turned(40, 1, 0.3, 0)); };
  const auto add_second = [&](SceneBuilder& b) { b.environment(second, 2, turned(70, 0, 1, 1) * stretched(1, -1, 1)); };
  const auto add_third = [&](SceneBuilder& b) { b.light(LightKind::environment, unit_spectrum, 0.5f); };
  const double apart = mean_under(add_first) + mean_under(add_second) + mean_under(add_third);
  const double together = mean_under([&](SceneBuilder& b) { add_first(b), add_second(b), add_third(b); });
  EXPECT_NEAR(together / apart, 1, 0.01);
}

Entity add_portal(SceneBuilder& b, const Image* image, const glm::dvec3& corner, const glm::dvec3& x,
                  const glm::dvec3& y) {
  const Entity entity = image != nullptr ? b.environment(*image, 1, turned(50, 0.2, 1, 0.3))
                                         : b.light(LightKind::environment, unit_spectrum, 1);
  Light light = b.scene.registry.get<Light>(entity);
  light.has_portal = 1;
  light.portal_corner = corner;
  light.portal_x = x;
  light.portal_y = y;
  b.scene.registry.set(entity, light);
  return entity;
}

// From the axis of a rectangle of half sides a, b at the height h, E = 4 L times the corner's form factor, as in
// Howell's catalogue (C-3): (1 / 2 pi) (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + the same with A and B swapped), A =
// a / h.
TEST(Portal, LightsAFloorAsAPatchOfSkyInItsPlaceWould) {
  const double h = 1.5, a = 0.6, b = 0.4, big_a = a / h, big_b = b / h;
  const auto half = [](double s, double t) { return s / std::sqrt(1 + s * s) * std::atan(t / std::sqrt(1 + s * s)); };
  const double wanted = 4 * (half(big_a, big_b) + half(big_b, big_a)) / (2 * pi) * pi;
  const auto under = [&](double floor_samples, const glm::dvec3& x) {
    SceneBuilder builder(4, 4, static_cast<uint32_t>(floor_samples), 1);
    builder.add(rectangle(20, 20), builder.diffuse(0.5));
    add_portal(builder, nullptr, {-a * x.x, -b, h}, x * (2 * a), {0, 2 * b, 0});
    builder.look_at({0, 0, 5}, {0, 0, 0}, orthographic(1e-5f));
    double sum = 0, count = 0;
    for (const PathRadiance& path : trace_radiances(*builder.freeze()))
      for (const double radiance : path.radiance) sum += radiance, count += 1;
    return sum / count * pi / 0.5;
  };
  EXPECT_NEAR(under(256, {1, 0, 0}) / wanted, 1, 0.005) << "x cross y points up, to the sky";
  EXPECT_EQ(under(1, {-1, 0, 0}), 0) << "turned round, it lights what is above";
}

// A room whose one window is the portal: the same picture as under the environment itself.
TEST(Portal, IsTheEnvironmentSeenThroughTheWindow) {
  for (const bool has_image : {false, true}) {
    const Image image = grey_image(16, 16, ImageMapping::equal_area, 9);
    const auto room = [&](bool has_portal) {
      SceneBuilder b(8, 8, 4096, 4);
      const Material wall = b.diffuse(0.6);
      b.add(rectangle(2, 2), wall, moved(0, 0, -1));                                                    // floor
      b.add(rectangle(2, 2), wall, moved(0, 0, 1) * turned(180, 1, 0, 0));                              // ceiling
      b.add(rectangle(2, 2), wall, moved(0, 1, 0) * turned(90, 1, 0, 0));                               // back
      b.add(rectangle(2, 2), wall, moved(0, -1, 0) * turned(-90, 1, 0, 0));                             // front
      b.add(rectangle(2, 2), wall, moved(-1, 0, 0) * turned(90, 0, 1, 0));                              // left
      b.add(rectangle(2, 1.2f), wall, moved(1, 0, -0.4) * turned(-90, 0, 1, 0) * turned(90, 0, 0, 1));  // right, below
      if (has_portal) {
        // Seen from inside, along +x: y to the left, z up.
        add_portal(b, has_image ? &image : nullptr, {1, -1, 0.2}, {0, 2, 0}, {0, 0, 0.8});
      } else if (has_image) {
        b.environment(image, 1, turned(50, 0.2, 1, 0.3));
      } else {
        b.light(LightKind::environment, unit_spectrum, 1);
      }
      b.look_at({-0.9, 0, 0}, {1, 0.1, 0.05}, perspective(60), {0, 0, 1});
      std::vector<double> sums(4, 0.0);  // of quarters of the picture
      const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
      for (size_t i = 0; i < paths.size(); ++i)
        for (const double radiance : paths[i].radiance)
          sums[(i % 64) / 32 * 2 + i % 8 / 4] += radiance / double(paths.size());
      return sums;
    };
    const std::vector<double> plain = room(false), portal = room(true);
    for (size_t quarter = 0; quarter < plain.size(); ++quarter)
      EXPECT_NEAR(portal[quarter] / plain[quarter], 1, 0.04) << quarter << (has_image ? " image" : " constant");
  }
}

TEST(Portal, RaysThatLeaveElsewhereSeeNothingOfIt) {
  const auto seen = [&](double x) {
    SceneBuilder b(4, 4, 1, 0);
    add_portal(b, nullptr, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
    b.look_at({x, 0, 0}, {x, 0, 1}, orthographic(1e-3f));
    return trace_radiances(*b.freeze()).front().radiance[0];
  };
  EXPECT_EQ(seen(0), 1);
  EXPECT_EQ(seen(0.99), 1);
  EXPECT_EQ(seen(1.01), 0);
}

}  // namespace
}  // namespace metamer
