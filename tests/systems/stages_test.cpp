// Single systems on columns filled by hand.
#include <random>

#include "tests/reference_scene.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

std::unique_ptr<World> empty_world() {
  SceneBuilder b(4, 4, 1, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  return b.freeze();
}

TEST(SortHits, GroupsByKindInOrderAndPads) {
  SceneBuilder b(4, 4, 1, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  b.add(sphere(1), b.diffuse(0.5));
  b.add(sphere(1), b.dielectric(b.constant(1.5)));
  b.add(sphere(1), b.diffuse(0.0));
  const std::unique_ptr<World> world = b.freeze();
  Batch batch;
  constexpr uint32_t size = 100;
  for (uint32_t i = 0; i < size; ++i) batch.hits.object[i] = i % 4 == 3 ? no_index : i % 4;
  Groups groups;
  batch.paths.size = size;
  sort_hits(*world, 0, batch.paths, batch.hits, batch.order, groups);
  std::vector<int> seen(size);
  uint32_t begin = 0;
  for (uint32_t kind = 0; kind < shade_kind_count; ++kind) {
    const Group& group = groups[kind];
    EXPECT_EQ(group.begin, begin);
    EXPECT_EQ(group.begin % 16, 0u);
    for (uint32_t lane = group.begin; lane < group.end; ++lane) {
      const uint32_t path = batch.order[lane];
      ASSERT_LT(path, size);
      ++seen[path];
      const uint32_t object = batch.hits.object[path];
      EXPECT_EQ(kind, object == no_index ? static_cast<uint32_t>(ShadeKind::miss) : world->objects.shade_kind[object]);
      EXPECT_TRUE(lane == group.begin || batch.order[lane - 1] < path) << "stable";
    }
    for (uint32_t lane = group.end; lane < group.padded_end(); ++lane) EXPECT_EQ(batch.order[lane], dead_lane);
    begin = group.padded_end();
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
}

// Against the oracle's intersection in double precision: the object, the point to the rounding of coordinates, normals.
TEST(Surface, IsWhereDoublePrecisionFindsIt) {
  SceneBuilder b(4, 4, 1, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  Mesh smooth = cube_mesh();
  for (const glm::vec3 p : smooth.positions) smooth.normals.push_back(p);
  b.scene.meshes = {cube_mesh(), smooth};
  const Material grey = b.diffuse(0.5);
  b.add(mesh(0), grey, moved(1.5, 0, 0) * turned(40, 1, 2, 3));
  b.add(mesh(1), grey, moved(-1.5, 0, 0) * turned(40, 3, 2, 1) * stretched(1, -1.5, 0.7));
  b.add(mesh(1), grey, moved(0, 1.5, 0) * turned(70, 3, 0, 1));
  b.add(sphere(0.5f), grey, moved(0, -1.5, 0) * turned(70, 3, 0, 1) * stretched(1, 1.5, -0.5));
  b.add(disk(0.8f, 0.2f), grey, moved(0, 0, 1.5) * turned(20, 1, 0, 1));
  const std::unique_ptr<World> world = b.freeze();
  const ReferenceScene reference(*world);
  Batch batch;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  const auto random_vector = [&] { return Vector(normal(generator), normal(generator), normal(generator)); };
  PathStream& paths = batch.paths;
  paths.size = batch_capacity;
  for (uint32_t i = 0; i < paths.size; ++i) {
    const Vector origin = glm::normalize(random_vector()) * 4.0, target = random_vector() * 0.8;
    const Vector direction = glm::normalize(target - origin);
    for (int c = 0; c < 3; ++c) {
      paths.origin[c][i] = static_cast<float>(origin[c]);
      paths.direction[c][i] = static_cast<float>(direction[c]);
    }
    paths.slot[i] = i;
  }
  double seconds = 0;
  intersect_bounce(*world, paths, batch.hits, &seconds);
  sort_hits(*world, 0, paths, batch.hits, batch.order, batch.shade.groups);
  batch.shade.size = batch.shade.groups.back().padded_end();
  surface(*world, paths, batch.hits, batch.order, batch.shade);
  size_t hits = 0, other_object = 0;
  const ShadeStream& shade = batch.shade;
  for (uint32_t lane = 0; lane < shade.size; ++lane) {
    if (shade.slot[lane] == dead_lane) continue;
    const uint32_t path = batch.order[lane];
    const auto read = [&](const Columns<float, 3>& c, uint32_t i) { return Vector(c[0][i], c[1][i], c[2][i]); };
    const ReferenceHit hit =
        reference.intersect(read(paths.origin, path), read(paths.direction, path), visible_to_bounces);
    if (hit.object != batch.hits.object[path]) {
      ++other_object;  // an edge or silhouette
      continue;
    }
    if (hit.object == no_index) continue;
    ++hits;
    const Vector direction = read(paths.direction, path);
    const double grazing = std::abs(glm::dot(direction, hit.outside));
    if (grazing < 0.05) continue;
    EXPECT_LT(glm::length(read(shade.position, lane) - hit.position), 2e-6 / grazing);
    EXPECT_LT(glm::length(read(shade.normal, lane) - hit.outside), 1e-5);
    EXPECT_LT(glm::length(read(shade.shading_normal, lane) - hit.shading), 1e-4 / grazing);
    EXPECT_NEAR(double{shade.distance[lane]}, hit.t, 2e-6 / grazing);
    EXPECT_LT(glm::length(read(shade.wo, lane) + direction), 1e-7);
    EXPECT_GT(shade.offset[lane], 0);
    EXPECT_LT(shade.offset[lane], 1e-5);
  }
  EXPECT_GT(hits, 800u);
  EXPECT_LE(other_object, 2u);
}

// Lanes of a stream that only roulette reads: throughput times weight 0.3, in a medium or not.
TEST(Roulette, KeepsTheExpectationAndTheBrightPaths) {
  Batch batch;
  ShadeStream& shade = batch.shade;
  const auto run = [&](float throughput, float eta_scale, uint32_t depth) {
    for (Group& group : shade.groups) group = {batch_capacity, batch_capacity};
    shade.groups[0] = {0, batch_capacity};
    shade.size = batch_capacity;
    for (uint32_t i = 0; i < batch_capacity; ++i) {
      const PointKeyScalar key = make_point_key(i, depth, 0, 9);
      shade.pixel_seed[i] = key.pixel_seed;
      shade.index[i] = key.index_reversed;
      shade.slot[i] = i;
      shade.eta_scale[i] = eta_scale;
      shade.next_eta_scale[i] = 1;
      shade.next_pdf[i] = 0.5f;
      shade.offset[i] = 0;
      for (int c = 0; c < 3; ++c) shade.next_direction[c][i] = shade.normal[c][i] = shade.position[c][i] = 0.5f;
      for (size_t j = 0; j < 4; ++j) {
        shade.throughput[j][i] = throughput * (1 - 0.2f * static_cast<float>(j));
        shade.next_weight[j][i] = 0.3f;
        shade.lambda_nm[j][i] = 500;
      }
    }
    roulette(depth, shade, batch.next);
    double sum = 0;
    for (uint32_t i = 0; i < batch.next.size; ++i) sum += double{batch.next.throughput[1][i]};
    return sum / batch_capacity / (0.8 * 0.3 * double{throughput});
  };
  EXPECT_NEAR(run(1, 1, 0), 1, 1e-6);
  EXPECT_EQ(batch.next.size, batch_capacity) << "nothing ends at the first vertex";
  // Binomial: the ratio's standard error is sqrt((1 - p) / (p n)) = 0.034 for p = 0.3, n = 2048.
  EXPECT_NEAR(run(1, 1, 20), 1, 0.15);
  EXPECT_LT(batch.next.size, batch_capacity / 2);
  EXPECT_GT(batch.next.size, batch_capacity / 5);
  EXPECT_NEAR(run(1, 4, 20), 1, 1e-6);
  EXPECT_EQ(batch.next.size, batch_capacity) << "radiance that refraction scaled down comes back";
  EXPECT_NEAR(run(0.1f, 1, 20), 1, 0.6);
  run(0, 1, 0);
  EXPECT_EQ(batch.next.size, 0u) << "black paths end";
}

TEST(Shadow, AddsWhatIsNotHidden) {
  SceneBuilder b(4, 4, 1, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  b.add(rectangle(1, 1), b.diffuse(0.5), moved(0, 0, 1));
  const std::unique_ptr<World> world = b.freeze();
  Batch batch;
  struct Ray {
    float x, t_far;
    bool seen;
  };
  const Ray rays[] = {{0, INFINITY, false}, {2, INFINITY, true}, {0, 0.9f, true}, {0, 1.1f, false}};
  batch.slots.size = batch.shadow.size = 4;
  for (uint32_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) batch.shadow.origin[c][i] = batch.shadow.direction[c][i] = 0;
    batch.shadow.origin[0][i] = rays[i].x;
    batch.shadow.direction[2][i] = 1;
    batch.shadow.t_far[i] = rays[i].t_far;
    batch.shadow.slot[i] = 3 - i;
    for (size_t j = 0; j < 4; ++j) {
      batch.shadow.contribution[j][i] = static_cast<float>(i + 1);
      batch.slots.radiance[j][i] = 10;
    }
  }
  double seconds = 0;
  shadow(*world, batch.shadow, batch.slots, &seconds);
  for (uint32_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      EXPECT_EQ(batch.slots.radiance[j][3 - i], rays[i].seen ? 10 + static_cast<float>(i + 1) : 10) << i;
}

// The equal-energy spectrum of radiance 1 has X = Y = Z = 683 times the integral of ybar, 106.86 nm (CIE 15).
TEST(Accumulate, GivesTheTristimulusValuesOfASpectrum) {
  for (const float sensor_scale : {1.0f, 0.25f}) {
    SceneBuilder b(16, 16, 1024, 0);
    b.scene.settings.sensor_scale = sensor_scale;
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
    const Film film = render_film(*b.freeze());
    double mean[3] = {};
    for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
      for (size_t c = 0; c < 3; ++c) mean[c] += mean_xyz(film, pixel)[c] / double(film.pixel_count());
    for (const double value : mean) EXPECT_NEAR(value / (683 * 106.86 * double{sensor_scale}), 1, 1e-3);
  }
}

TEST(Accumulate, LeavesOutTheLanesWithoutAPixel) {
  const std::unique_ptr<World> world = empty_world();
  Batch batch;
  TileFilm film;
  film.reset(0, 0, 4, 4, 0, 1);
  batch.slots.size = 16;
  for (uint32_t i = 0; i < 16; ++i) {
    batch.slots.pixel[i] = i % 2 == 0 ? i : dead_lane;
    batch.slots.sample[i] = 0;
    batch.slots.weight[i] = 1;
    for (size_t j = 0; j < 4; ++j) {
      batch.slots.lambda_nm[j][i] = 555;
      batch.slots.inv_pdf_nm[j][i] = 1;
      batch.slots.radiance[j][i] = i % 2 == 0 ? 1 : NAN;
    }
  }
  accumulate(*world, batch.slots, film);
  EXPECT_EQ(film.invalid_samples(), 0u);
  Film picture(4, 4);
  flush(picture, film);
  for (size_t pixel = 0; pixel < 16; ++pixel) EXPECT_NEAR(mean_xyz(picture, pixel)[1], pixel % 2 == 0 ? 683 : 0, 0.01);
}

TEST(Render, CountsWhatItDoes) {
  SceneBuilder b(20, 12, 7, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  const std::unique_ptr<World> world = b.freeze();
  Film film(20, 12);
  Cancellation cancellation;
  RenderProgress progress;
  const RenderStats stats = render(*world, {2, 16}, cancellation, progress, film);
  EXPECT_EQ(stats.counters.samples, 20u * 12 * 7);
  EXPECT_EQ(progress.samples_done, 20u * 12 * 7);
  EXPECT_EQ(progress.samples_total, 20u * 12 * 7);
  EXPECT_EQ(sample_totals(film).fewest, 7u);
  EXPECT_EQ(sample_totals(film).most, 7u);
  EXPECT_GE(stats.counters.camera_rays, stats.counters.samples);
  EXPECT_EQ(stats.counters.bounce_rays + stats.counters.shadow_rays, 0u);
  EXPECT_EQ(stats.threads, 2u);
  EXPECT_GT(stats.render_seconds, 0);
  EXPECT_GE(stats.render_seconds, stats.first_pixel_seconds);
}

TEST(Render, ACancelledFilmHoldsWholePasses) {
  const std::unique_ptr<World> world = empty_world();
  Film film(4, 4);
  Cancellation cancellation;
  cancellation.request();
  RenderProgress progress;
  const RenderStats stats = render(*world, {1, 16}, cancellation, progress, film);
  EXPECT_EQ(stats.counters.samples, 0u);
  EXPECT_EQ(sample_totals(film).total, 0u);
  EXPECT_LT(progress.samples_done, progress.samples_total);
}

}  // namespace
}  // namespace metamer
