// Directions that light_sample draws, against the density that emission believes in: the two sides of multiple
// importance sampling. Emission's side is read off its weight: a ray that claims to be drawn with density 1 and meets a
// light of radiance L adds L / (1 + p^2).
#include <algorithm>
#include <random>
#include <span>
#include <utility>

#include "tests/support/chi_square.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Probe {
  glm::dvec3 direction;
  double density = 0;   // per solid angle, emission's
  double distance = 0;  // of what was met
  double radiance = 0;  // of the light, unweighted
};

// What emission believes of directions from one point.
class Emission {
 public:
  Emission(const World& world, const glm::dvec3& from) : world_(world), from_(from) {}

  // At most batch_capacity directions.
  void probe(std::span<Probe> probes) {
    PathStream& paths = batch_.paths;
    paths.size = batch_.slots.size = static_cast<uint32_t>(probes.size());
    for (uint32_t i = 0; i < padded_to_lanes(paths.size); ++i) {
      const glm::dvec3 direction = probes[std::min<size_t>(i, probes.size() - 1)].direction;
      for (int c = 0; c < 3; ++c) {
        paths.origin[c][i] = static_cast<float>(from_[c]);
        paths.direction[c][i] = static_cast<float>(direction[c]);
      }
      for (size_t j = 0; j < 4; ++j) {
        paths.lambda_nm[j][i] = 550;
        paths.throughput[j][i] = 1;
        batch_.slots.radiance[j][i] = 0;
      }
      paths.pdf_direction[i] = 0;
      paths.eta_scale[i] = 1;
      paths.pixel_seed[i] = paths.index[i] = 0;
      paths.slot[i] = i;
    }
    double seconds = 0;
    intersect_bounce(world_, paths, batch_.hits, &seconds);
    sort_hits(world_, 0, paths, batch_.hits, batch_.order, batch_.shade.groups);
    batch_.shade.size = batch_.shade.groups.back().padded_end();
    surface(world_, paths, batch_.hits, batch_.order, batch_.shade);
    emission(world_, batch_.shade, batch_.slots);
    for (uint32_t i = 0; i < paths.size; ++i) {
      probes[i].radiance = std::exchange(batch_.slots.radiance[0][i], 0.0f);
    }
    // Once more as if the directions had been sampled with density 1: the weight tells the light's own density.
    for (uint32_t i = 0; i < batch_.shade.size; ++i) batch_.shade.pdf_direction[i] = 1;
    emission(world_, batch_.shade, batch_.slots);
    for (uint32_t i = 0; i < paths.size; ++i) {
      const double weight = probes[i].radiance > 0 ? double{batch_.slots.radiance[0][i]} / probes[i].radiance : 0;
      probes[i].density = weight > 0 ? std::sqrt(std::max(0.0, 1 / weight - 1)) : 0;
      probes[i].distance = batch_.hits.object[i] == no_index ? INFINITY : double{batch_.hits.distance[i]};
    }
  }

 private:
  const World& world_;
  glm::dvec3 from_;
  Batch batch_;
};

struct Draw {
  glm::dvec3 direction;
  double density, distance, radiance;
};

std::vector<Draw> draw_lights(const World& world, const glm::dvec3& from, uint32_t count) {
  std::vector<Draw> draws;
  Batch batch;
  ShadeStream& shade = batch.shade;
  for (Group& group : shade.groups) group = {0, 0};
  for (uint32_t first = 0; first < count; first += batch_capacity) {
    shade.size = batch_capacity;
    shade.groups[0] = {0, batch_capacity};
    for (uint32_t i = 0; i < batch_capacity; ++i) {
      const uint32_t k = first + i;
      const PointKeyScalar key = make_point_key(k & 0xff, k >> 8, 0, 5);  // a pixel each: independent draws
      shade.pixel_seed[i] = key.pixel_seed;
      shade.index[i] = key.index_reversed;
      for (int c = 0; c < 3; ++c) shade.position[c][i] = static_cast<float>(from[c]);
      for (size_t j = 0; j < 4; ++j) shade.lambda_nm[j][i] = 550;
      shade.slot[i] = i;
    }
    light_sample(world, 0, shade);
    for (uint32_t i = 0; i < batch_capacity; ++i)
      draws.push_back({{shade.light_direction[0][i], shade.light_direction[1][i], shade.light_direction[2][i]},
                       double{shade.light_pdf[i]},
                       double{shade.light_distance[i]},
                       double{shade.light_radiance[0][i]}});
  }
  return draws;
}

size_t direction_bin(const glm::dvec3& d, int bins) {
  const auto cell = [&](double t) { return std::clamp(static_cast<int>(t * bins), 0, bins - 1); };
  return static_cast<size_t>(cell((d.z + 1) / 2) * bins + cell((std::atan2(d.y, d.x) + pi) / (2 * pi)));
}

// Checks the world's lights from `from`: every draw that reaches its light carries radiance / density, emission states
// the same radiance and density for it, the histogram of directions is that density, which integrates to `seen` (1:
// all of the light's points are in sight).
void expect_sides_agree(SceneBuilder& b, const glm::dvec3& from, double seen) {
  b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
  const std::unique_ptr<World> world = b.freeze();
  constexpr uint32_t draws_wanted = 20 * batch_capacity;
  const std::vector<Draw> draws = draw_lights(*world, from, draws_wanted);
  Emission emission(*world, from);
  constexpr int bins = 24, cells = 24;
  std::vector<double> expected(bins * bins, 0.0), observed(bins * bins, 0.0);
  size_t compared = 0, differ = 0, reached_all = 0;
  std::vector<Probe> probes(batch_capacity);
  for (size_t first = 0; first < draws.size(); first += probes.size()) {
    for (size_t i = 0; i < probes.size(); ++i) probes[i].direction = draws[first + i].direction;
    emission.probe(probes);
    for (size_t i = 0; i < probes.size(); ++i) {
      const Draw& draw = draws[first + i];
      const bool reached = draw.radiance > 0 && (probes[i].distance >= 0.999 * draw.distance);
      if (!reached) {
        continue;
      }
      ++reached_all;
      observed[direction_bin(draw.direction, bins)] += 1;
      EXPECT_NEAR(draw.radiance * draw.density, probes[i].radiance, 1e-3);
      // Towards a silhouette the two find slightly different points, with quite different densities.
      if (draw.density > 50 || draw.density < 0.02) continue;
      ++compared;
      differ += std::abs(probes[i].density / draw.density - 1) > 0.01;
    }
  }
  EXPECT_GT(compared, 0.5 * double(reached_all));
  EXPECT_LE(double(differ), 0.002 * double(compared)) << "densities differ";
  // Expected counts by a random point in each of 24 x 24 cells of each bin.
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  size_t filled = 0;
  std::vector<size_t> bin_of(batch_capacity);
  double total = 0;
  const auto flush_probes = [&] {
    if (filled == 0) return;
    emission.probe({probes.data(), filled});
    for (size_t i = 0; i < filled; ++i) {
      const double share = probes[i].density * 4 * pi / (bins * bins * cells * cells);
      expected[bin_of[i]] += share * draws_wanted;
      total += share;
    }
    filled = 0;
  };
  for (int i = 0; i < bins * cells; ++i)
    for (int j = 0; j < bins * cells; ++j) {
      const double z = -1 + 2 * (i + uniform(generator)) / (bins * cells);
      const double phi = -pi + 2 * pi * (j + uniform(generator)) / (bins * cells), r = std::sqrt(1 - z * z);
      probes[filled].direction = {r * std::cos(phi), r * std::sin(phi), z};
      bin_of[filled] = direction_bin(probes[filled].direction, bins);
      ++filled;
      if (filled == probes.size()) flush_probes();
    }
  flush_probes();
  EXPECT_NEAR(total, seen, 0.01);
  EXPECT_NEAR(double(reached_all) / draws_wanted, seen, 0.015);
  // Of a bin that a sharp edge cuts off to less than its points can see, some draws come to nothing here.
  double unseen = 0;
  for (size_t bin = 0; bin < observed.size(); ++bin)
    if (expected[bin] == 0) unseen += std::exchange(observed[bin], 0.0);
  EXPECT_LE(unseen, 1e-4 * draws_wanted);
  observed.push_back(draws_wanted - double(reached_all));
  expected.push_back(std::max(0.0, (1 - total) * draws_wanted));
  if (seen == 1) observed.pop_back(), expected.pop_back();
  EXPECT_GT(chi_square_test(observed, expected, 100).p_value, chi_square_level);
}

SceneBuilder empty() { return {4, 4, 1, 1}; }

TEST(LightSample, TrianglesOfARectangle) {
  SceneBuilder b = empty();
  b.emit(b.add(rectangle(2, 1.5f), b.diffuse(0.0), moved(0.3, 0, 1) * turned(160, 1, 0.3, 0)), unit_spectrum, 1);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, ARectangleFromBehindIsDarkUnlessTwoSided) {
  for (const bool two_sided : {false, true}) {
    SceneBuilder b = empty();
    b.emit(b.add(rectangle(2, 1.5f), b.diffuse(0.0), moved(0.3, 0, 1)), unit_spectrum, 1, two_sided);
    if (two_sided) {
      expect_sides_agree(b, {0, 0, 0}, 1);
    } else {
      b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
      for (const Draw& draw : draw_lights(*b.freeze(), {0, 0, 0}, batch_capacity)) EXPECT_EQ(draw.radiance, 0);
    }
  }
}

TEST(LightSample, ASphereFromOutside) {
  SceneBuilder b = empty();
  b.emit(b.add(sphere(1), b.diffuse(0.0), moved(0.4, 1.2, -0.5)), unit_spectrum, 1);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, ASphereFromInside) {
  SceneBuilder b = empty();
  Geometry shell = sphere(1);
  shell.flip_normal = 1;
  b.emit(b.add(shell, b.diffuse(0.0), moved(0.4, 0.3, -0.2)), unit_spectrum, 1);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, AnEllipsoidFromInside) {
  SceneBuilder b = empty();
  const glm::dmat4 place = moved(0.2, 0.3, -0.2) * turned(50, 1, 0.2, 0.5) * stretched(1, -1.8, 0.7);
  b.emit(b.add(sphere(1), b.diffuse(0.0), place), unit_spectrum, 1, true);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, PartsOfQuadrics) {
  Geometry zone = sphere(1), pipe = sphere(1), sector = disk(1, 0.4f);
  pipe.kind = ShapeKind::cylinder;
  zone.z_min = pipe.z_min = -0.7f;
  zone.z_max = pipe.z_max = 0.4f;
  zone.phi_max_deg = pipe.phi_max_deg = sector.phi_max_deg = 250;
  for (const Geometry& shape : {zone, pipe, sector})
    for (const glm::dvec3& scale : {glm::dvec3(1, 1, 1), {1, -1.8, 0.7}}) {
      SceneBuilder b = empty();
      const glm::dmat4 place = moved(0.1, shape.kind == ShapeKind::disk ? 0.9 : 0.1, -0.1) * turned(50, 1, 0.2, 0.5);
      b.emit(b.add(shape, b.diffuse(0.0), place * stretched(scale.x, scale.y, scale.z)), unit_spectrum, 1, true);
      expect_sides_agree(b, {0, 0, 0}, 1);
    }
}

TEST(LightSample, ADiskWithAHole) {
  SceneBuilder b = empty();
  const glm::dmat4 place = moved(0.2, 0.9, -0.2) * turned(110, 1, 0.2, 0.5) * stretched(1, 1.8, 1);
  b.emit(b.add(disk(1, 0.4f), b.diffuse(0.0), place), unit_spectrum, 1, true);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, AConstantSkyBesideALamp) {
  SceneBuilder b = empty();
  b.light(LightKind::environment, unit_spectrum, 1);
  // The lamp hides a part of the sky.
  b.emit(b.add(sphere(1), b.diffuse(0.0), moved(0.5, 1.6, 0)), unit_spectrum, 1);
  b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
  const std::unique_ptr<World> world = b.freeze();
  const double sky = world->lights[world->environments[0].light].choice_probability;
  const double hidden = (1 - std::sqrt(1 - 1 / (0.25 + 2.56))) / 2;
  SceneBuilder again = empty();
  again.light(LightKind::environment, unit_spectrum, 1);
  again.emit(again.add(sphere(1), again.diffuse(0.0), moved(0.5, 1.6, 0)), unit_spectrum, 1);
  expect_sides_agree(again, {0, 0, 0}, 1 - sky * hidden);
}

TEST(LightSample, ShapesWithACosinePower) {
  for (const bool inside : {false, true}) {
    for (Geometry shape : {sphere(1), rectangle(2, 1.5f), disk(1, 0.4f)}) {
      const bool round = shape.kind == ShapeKind::sphere;
      if (inside && !round) continue;
      SceneBuilder b = empty();
      shape.flip_normal = inside ? 1 : 0;
      const glm::dmat4 place = inside  ? moved(0.4, 0.3, -0.2)
                               : round ? moved(0.4, 1.2, -0.5)
                                       : moved(0.3, 0, 1) * turned(160, 1, 0.3, 0);
      const Entity lamp = b.add(shape, b.diffuse(0.0), place);
      Light light;
      light.spectrum = unit_spectrum;
      light.cosine_power = 2.5f;
      b.scene.registry.set(lamp, light);
      expect_sides_agree(b, {0, 0, 0}, 1);
    }
  }
}

TEST(LightSample, ADiscAtInfinityBesideALamp) {
  SceneBuilder b = empty();
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = b.constant(0.8);
  sun.angular_diameter_deg = 70;
  b.scene.registry.set(b.place(turned(40, 1, 0.3, 0)), sun);
  b.emit(b.add(rectangle(0.5f, 0.5f), b.diffuse(0.0), moved(0.3, 0, -1)), unit_spectrum, 1);
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, ImagesOfBothMappings) {
  for (const ImageMapping mapping : {ImageMapping::latitude_longitude, ImageMapping::equal_area}) {
    // Black or one grey: there are directions that must never be drawn.
    Image image;
    image.mapping = mapping;
    image.width = image.height = 8;
    for (uint32_t y = 0; y < 8; ++y)
      for (uint32_t x = 0; x < 8; ++x)
        for (int c = 0; c < 3; ++c) image.rgb.push_back((x * 5 + y * 3) % 7 < 3 ? 1.0f : 0.0f);
    SceneBuilder b = empty();
    b.environment(image, 1, turned(70, 0.3, 0.5, 1));
    expect_sides_agree(b, {0, 0, 0}, 1);
  }
}

// Two that share no direction, turned alike: what a ray meets is the one or the other.
TEST(LightSample, TwoEnvironments) {
  SceneBuilder b = empty();
  for (const bool upper : {false, true}) {
    Image image;
    image.mapping = upper ? ImageMapping::latitude_longitude : ImageMapping::equal_area;
    image.width = upper ? 16 : 8;
    image.height = 8;
    for (uint32_t y = 0; y < image.height; ++y)
      for (uint32_t x = 0; x < image.width; ++x) {
        // Latitudes well above the horizon; the corners of the octahedron, well below it.
        const double u = std::abs(2 * (x + 0.5) / image.width - 1), v = std::abs(2 * (y + 0.5) / image.height - 1);
        const bool lit = upper ? y < 3 : u + v > 1.3;
        for (int c = 0; c < 3; ++c) image.rgb.push_back(lit ? 1.0f + float(x % 3) : 0.0f);
      }
    b.environment(image, upper ? 1 : 2, turned(70, 0.3, 0.5, 1));
  }
  expect_sides_agree(b, {0, 0, 0}, 1);
}

TEST(LightSample, APortalFromAskew) {
  for (const bool has_image : {false, true}) {
    SceneBuilder b = empty();
    Image image;
    image.mapping = ImageMapping::equal_area;
    image.width = image.height = 8;
    for (uint32_t i = 0; i < 64; ++i) image.rgb.insert(image.rgb.end(), 3, 0.5f + float(i * 5 % 7));
    const Entity sky = has_image ? b.environment(image, 1, turned(70, 0.3, 0.5, 1))
                                 : b.light(LightKind::environment, unit_spectrum, 1);
    Light light = b.scene.registry.get<Light>(sky);
    light.has_portal = 1;
    const glm::dmat3 turn(turned(33, 1, 0.4, 0.2));
    light.portal_corner = glm::dvec3(-0.3, -1.2, 0.6);
    light.portal_x = turn * glm::dvec3(1.7, 0, 0);
    light.portal_y = turn * glm::dvec3(0, 2.1, 0);
    b.scene.registry.set(sky, light);
    expect_sides_agree(b, {0, 0, 0}, 1);
  }
}

// Which light it is, told by its distance: point, spot and directional lights have no more than that to draw.
TEST(LightSample, EachLightIsChosenWithItsProbability) {
  SceneBuilder b = empty();
  const std::vector<LightShape> shapes = {LightShape::point, LightShape::spot, LightShape::sphere,
                                          LightShape::directional, LightShape::environment};
  b.light(LightKind::point, unit_spectrum, 3, moved(1, 0, 0));
  b.light(LightKind::spot, unit_spectrum, 20, moved(0, 0, 2));  // shines along -z
  b.emit(b.add(sphere(0.5f), b.diffuse(0.0), moved(0, 5, 0)), unit_spectrum, 4);
  b.light(LightKind::directional, unit_spectrum, 0.5f);
  b.light(LightKind::environment, unit_spectrum, 0.1f);
  b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
  const std::unique_ptr<World> world = b.freeze();
  constexpr uint32_t count = 50 * batch_capacity;
  std::vector<double> observed(shapes.size(), 0.0), expected(shapes.size(), 0.0);
  for (const LightRow& light : world->lights) {
    const auto shape = std::find(shapes.begin(), shapes.end(), static_cast<LightShape>(light.shape));
    ASSERT_NE(shape, shapes.end());
    expected[size_t(shape - shapes.begin())] += double{light.choice_probability} * count;
  }
  for (const Draw& draw : draw_lights(*world, {0, 0, 0}, count)) {
    EXPECT_GT(draw.radiance, 0);
    const size_t finite = draw.distance < 1.5 ? 0 : draw.distance < 3 ? 1 : 2, endless = draw.density == 0 ? 3 : 4;
    observed[std::isinf(draw.distance) ? endless : finite] += 1;
  }
  const ChiSquare result = chi_square_test(observed, expected);
  EXPECT_GT(result.p_value, chi_square_level);
  EXPECT_EQ(result.degrees_of_freedom, double(shapes.size() - 1));
}

}  // namespace
}  // namespace metamer
