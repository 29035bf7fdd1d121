// A pixel is a function of the scene, the seed and itself: not of threads, tiles, batches, dead lanes, or what lay in
// memory before; and of the instruction set only to rounding.
#include <cstring>

#include "engine/simd/instruction_set.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

// Every kind of material and light, in a picture whose sides are no multiples of anything.
SceneBuilder everything(Integrator integrator = Integrator::path) {
  SceneBuilder b(37, 29, 16, 8);
  b.scene.settings.integrator = integrator;
  b.scene.settings.filter = {FilterKind::gaussian, 1.5f, 1.5f, 0.5f};
  b.scene.meshes.push_back(cube_mesh());
  b.add(rectangle(6, 6), b.diffuse(b.named("colorchecker.green")), moved(0, -1, 0) * turned(-90, 1, 0, 0));
  b.add(sphere(0.5f), b.dielectric(b.named("SF11")), moved(-0.9, -0.4, 0.3));
  b.add(sphere(0.4f), b.conductor(b.named("Au.n"), b.named("Au.k"), 0.2f, 0.4f), moved(0.9, -0.5, 0.2));
  b.add(disk(0.6f), b.conductor(b.named("Ag.n"), b.named("Ag.k")), moved(0, 0, -0.8));
  b.add(mesh(0), b.diffuse(0.0), moved(1.4, 0.3, -1));
  b.add(mesh(0), b.diffuse(b.named("colorchecker.red")), moved(-1.4, 0, -1) * turned(30, 0, 1, 0));
  b.emit(b.add(sphere(0.2f), b.diffuse(0.3), moved(0, 1, 0.5)), b.named("A"), 0.1f);
  b.emit(b.add(rectangle(0.5f, 0.5f), b.diffuse(0.3), moved(-1, 1, 0) * turned(90, 1, 0, 0)), b.named("D65"), 0.1f);
  b.emit(b.add(disk(0.3f), b.diffuse(0.3), moved(1, 1, 0)), b.named("D50"), 0.1f, true);
  Curves fibre;
  for (const glm::vec4& p :
       {glm::vec4(-1.5f, -0.8f, 1, 0.05f), {-0.5f, 1, 1, 0.05f}, {0.5f, -1, 1, 0.03f}, {1.5f, 0.6f, 1, 0}}) {
    fibre.points.push_back(p);
    fibre.normals.push_back({p.y, 0, 1});
  }
  fibre.segments.push_back(0);
  b.scene.curves.push_back(fibre);
  b.add({.kind = ShapeKind::round_curves, .curves = 0}, b.diffuse(0.4));
  b.add({.kind = ShapeKind::ribbons, .curves = 0}, b.diffuse(0.6), moved(0, 0.4, 0) * stretched(1, -0.6, 1));
  const Entity haze = b.medium(b.named("colorchecker.red"), b.named("colorchecker.green"), 0.4f);
  b.separate(b.add(mesh(0), b.interface(), moved(0.2, 0.2, 0.8)), haze);
  b.separate(b.add(sphere(0.2f), b.interface(), moved(0.2, 0.2, 0.8)), {}, haze);
  b.light(LightKind::point, b.named("E"), 0.05f, moved(0, 0.3, 2));
  b.light(LightKind::environment, b.named("D65"), 0.005f);
  Camera camera = perspective(45);
  camera.lens_radius = 0.05f;
  camera.focal_distance = 3.5f;
  b.look_at({0, 0.3, 4}, {0, 0, 0}, camera);
  return b;
}

TEST(Arrangement, ThreadsAndTilesDoNotChangeABit) {
  for (const Integrator integrator : {Integrator::path, Integrator::recursive, Integrator::local}) {
    SCOPED_TRACE(integrator_name(integrator));
    const std::unique_ptr<World> world = everything(integrator).freeze();
    const Film film = render_film(*world, {1, 32});
    EXPECT_EQ(film.invalid_samples(), 0u);
    EXPECT_TRUE(film == render_film(*world, {1, 32})) << "from run to run";
    EXPECT_TRUE(film == render_film(*world, {2, 32})) << "two threads";
    EXPECT_TRUE(film == render_film(*world, {1, 16})) << "tiles of 16";
    EXPECT_TRUE(film == render_film(*world, {3, 64})) << "tiles of 64, three threads";
    EXPECT_TRUE(film == render_film(*world, {1, 4})) << "tiles of 4";
    EXPECT_TRUE(film == render_film(*everything(integrator).freeze(), {1, 32})) << "frozen again";
    SceneBuilder other = everything(integrator);
    other.scene.settings.seed = 1;
    EXPECT_FALSE(film == render_film(*other.freeze(), {1, 32})) << "another seed";
  }
}

// However many nodes wait at once, the film gets the same: here one packet's trees at a time against a batch's.
TEST(Arrangement, BatchesOfNodesDoNotChangeABit) {
  const std::unique_ptr<World> world = everything(Integrator::recursive).freeze();
  Batch batch;
  TileFilm all, one;
  Counters counters;
  Film at_once(37, 29), in_packets(37, 29);
  trace_tile(*world, {0, 0, 37, 29}, 0, 4, batch, all, counters);
  flush(at_once, all);
  for (uint32_t y = 0; y < 29; y += 4)
    for (uint32_t x = 0; x < 37; x += 4)
      for (uint32_t sample = 0; sample < 4; ++sample) {
        trace_tile(*world, {x, y, std::min(x + 4, 37u), std::min(y + 4, 29u)}, sample, sample + 1, batch, one,
                   counters);
        flush(in_packets, one);
      }
  EXPECT_TRUE(at_once == in_packets);
  EXPECT_TRUE(batch.nodes.levels.empty());
  EXPECT_EQ(batch.nodes.rays.size, 0u);
}

class ArrangementOf : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Each, ArrangementOf,
                         testing::Values(Integrator::local, Integrator::recursive, Integrator::path),
                         [](const auto& tested) { return std::string(integrator_name(tested.param)); });

TEST_P(ArrangementOf, ACropHoldsTheSamePixels) {
  const std::unique_ptr<World> world = everything(GetParam()).freeze();
  const TileRect whole{0, 0, 37, 29};
  Batch batch;
  TileFilm film, crop;
  Counters counters;
  trace_tile(*world, whole, 3, 9, batch, film, counters);
  for (const TileRect& rect : {TileRect{5, 3, 22, 18}, {0, 0, 1, 1}, {36, 28, 37, 29}, {17, 0, 20, 29}}) {
    trace_tile(*world, rect, 3, 9, batch, crop, counters);
    for (uint32_t y = rect.y0; y < rect.y1; ++y)
      for (uint32_t x = rect.x0; x < rect.x1; ++x)
        EXPECT_EQ(std::memcmp(&crop.sums()[(y - rect.y0) * rect.width() + x - rect.x0],
                              &film.sums()[y * whole.width() + x], sizeof(PixelSums)),
                  0)
            << x << ", " << y;
  }
}

// All columns of a batch lie in one arena, from the first that was taken to the last.
void fill(Batch& batch, int byte) {
  auto* first = reinterpret_cast<std::byte*>(batch.paths.origin[0]);
  auto* last = reinterpret_cast<std::byte*>(batch.order + sorted_capacity + column_lanes);
  std::memset(first, byte, static_cast<size_t>(last - first));
}

TEST_P(ArrangementOf, WhatLayInABatchBeforeDoesNotMatter) {
  const std::unique_ptr<World> world = everything(GetParam()).freeze();
  const TileRect rect{3, 2, 36, 27};
  Batch batch;
  TileFilm clean, dirty;
  Counters counters;
  trace_tile(*world, rect, 0, 5, batch, clean, counters);
  // Bytes 0xff are NaN and the largest index, 0x7f a huge number and index, 0x80 tiny negative ones, 0 zeros.
  for (const int byte : {0xff, 0x7f, 0x80, 0x00}) {
    fill(batch, byte);
    std::memset(batch.nodes.memory.data(), byte, batch.nodes.memory.bytes());
    trace_tile(*world, rect, 0, 5, batch, dirty, counters);
    ASSERT_EQ(dirty.sums().size(), clean.sums().size());
    EXPECT_EQ(std::memcmp(dirty.sums().data(), clean.sums().data(), clean.sums().size_bytes()), 0) << byte;
  }
  EXPECT_EQ(counters.invalid_samples, 0u);
}

// The sums of samples [0, n) do not depend on how the range was cut.
TEST_P(ArrangementOf, RangesOfSamplesAddUpExactly) {
  const std::unique_ptr<World> world = everything(GetParam()).freeze();
  const TileRect rect{0, 0, 37, 29};
  Batch batch;
  TileFilm tile;
  Counters counters;
  Film at_once(37, 29), in_parts(37, 29);
  trace_tile(*world, rect, 0, 11, batch, tile, counters);
  flush(at_once, tile);
  for (const SampleRange& range : {SampleRange{7, 11}, {0, 2}, {2, 7}}) {
    trace_tile(*world, rect, range.begin, range.end, batch, tile, counters);
    flush(in_parts, tile);
  }
  EXPECT_TRUE(at_once == in_parts);
}

TEST(Arrangement, InstructionSetsAgreeToRounding) {
  const std::vector<std::string_view> names = available_isa_names();
  std::vector<Film> films;
  for (const std::string_view name : names) {
    ASSERT_EQ(apply_isa(name), "");
    films.push_back(render_film(*everything().freeze(), {2, 32}));
  }
  ASSERT_EQ(apply_isa("native"), "");
  for (size_t i = 1; i < films.size(); ++i) {
    size_t same = 0;
    double mean[2] = {};
    for (size_t pixel = 0; pixel < films[0].pixel_count(); ++pixel) {
      const double a = mean_xyz(films[0], pixel)[1], b = mean_xyz(films[i], pixel)[1];
      same += std::abs(a - b) <= 1e-4 * a;
      mean[0] += a;
      mean[1] += b;
    }
    // Rounding sends a rare path another way: through glass, past an edge.
    EXPECT_GT(double(same), 0.95 * double(films[0].pixel_count())) << names[i];
    EXPECT_NEAR(mean[1] / mean[0], 1, 2e-3) << names[i];
  }
}

}  // namespace
}  // namespace metamer
