// Media that vary in space: what rays lose, gain and scatter on their way through grids, on each wavelength.
#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/systems/support/lumpy_volumes.h"

namespace metamer {
namespace {

// Grey, so that four wavelengths are one number: a million paths through thin smoke tell 0.1 %.
TEST(GridVolumes, FollowBeerAndLambertToAThousandth) {
  SceneBuilder b = beam(4096, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  MediumGrid grid = unit_box();
  grid.density = lumpy_grid(b);
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, b.constant(0.5), zero_spectrum, grid));
  const double expected = std::exp(-0.5 * beam_depth(b.scene, grid.density));
  EXPECT_LT(expected, 0.7);
  double sum = 0;
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  for (const PathRadiance& path : paths) sum += path.radiance[0];
  EXPECT_NEAR(sum / double(paths.size()) / expected, 1, 0.001);
}

TEST(GridVolumes, LoseWhatTheyAbsorbAndScatterAtEveryLevel) {
  for (const GridLookup lookup : {GridLookup::trilinear, GridLookup::stochastic})
    for (const Integrator integrator : all_levels) {
      SceneBuilder b = beam(1024, 0, integrator);
      b.light(LightKind::environment, unit_spectrum, 1);
      MediumGrid grid = unit_box();
      grid.density = lumpy_grid(b);
      grid.lookup = lookup;
      b.scene.meshes.push_back(cube_mesh());
      b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)),
                 grid_medium(b, slope(b, 0.2, 2), b.constant(0.5), grid));
      const double depth = beam_depth(b.scene, grid.density);
      expect_mean(
          trace_radiances(*b.freeze()), [=](double nm) { return std::exp(-depth * (0.5 + slope_at(nm, 0.2, 2))); },
          0.07);
    }
}

// A medium turned, sheared, mirrored and moved in its surface; and two entities that share one grid.
TEST(GridVolumes, FollowTheirTransforms) {
  glm::dmat4 shear(1);
  shear[1][0] = 0.4, shear[2][1] = -0.3;
  const glm::dmat4 first = moved(0.1, 0, 2) * turned(33, 1, 2, 0.5) * shear * stretched(0.8, -0.7, 0.9);
  const glm::dmat4 second = moved(0, -0.1, -2) * turned(70, 0, 1, 1) * stretched(1, 0.8, 1.5);
  SceneBuilder b = beam(1024, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  MediumGrid grid = unit_box();
  grid.density = lumpy_grid(b);
  b.scene.meshes.push_back(cube_mesh());
  double depth = 0;
  for (const glm::dmat4& m : {first, second}) {
    b.separate(b.add(mesh(0), b.interface(), m * stretched(2, 2, 2)),
               grid_medium(b, slope(b, 0.5, 1.5), zero_spectrum, grid, 0, m));
    const glm::dmat4 to_local = glm::inverse(m);
    depth += along_beam(
        [&](double z) {
          const glm::dvec3 p(to_local * glm::dvec4(0.01, 0.02, z, 1));
          const bool inside = std::abs(p.x) < 1 && std::abs(p.y) < 1 && std::abs(p.z) < 1;
          return inside ? value_at(b.scene.grids[grid.density], p).x : 0.0;
        },
        -5, 5, 200000);
  }
  const std::unique_ptr<World> world = b.freeze();
  EXPECT_EQ(world->grids.rows.size(), 1u);
  expect_mean(
      trace_radiances(*world), [=](double nm) { return std::exp(-depth * slope_at(nm, 0.5, 1.5)); }, 0.05);
}

// The camera in the middle of a medium without a surface, which ends at the box, and a lamp within it.
TEST(GridVolumes, BeginAtTheCameraAndEndAtSurfaces) {
  SceneBuilder b(16, 16, 1024, 0);
  const Entity camera = b.look_at({0.01, 0.02, 0.3}, {0.01, 0.02, 0}, orthographic(1e-3f), {0, 1, 0});
  b.emit(b.add(rectangle(4, 4), b.diffuse(0.0), moved(0, 0, -0.5)), unit_spectrum, 1);
  MediumGrid grid = unit_box();
  grid.density = lumpy_grid(b);
  b.separate(camera, {}, grid_medium(b, slope(b, 1, 3), b.constant(0.5), grid));
  const double depth = along_beam(
      [&](double z) {
        return value_at(b.scene.grids[grid.density], {0.01, 0.02, z}).x;
      },
      -0.5, 0.3);
  expect_mean(
      trace_radiances(*b.freeze()), [=](double nm) { return std::exp(-depth * (0.5 + slope_at(nm, 1, 3))); }, 0.03);
}

// Light samples are dimmed on their way, too, and so are lamps behind smoke that nothing is scattered by.
TEST(GridVolumes, DimLightSamples) {
  for (const Integrator integrator : {Integrator::local, Integrator::path}) {
    SceneBuilder b(16, 16, 1024, 1);
    b.scene.settings.integrator = integrator;
    b.look_at({0.01, 0.3, 3}, {0.01, 0, 0.02}, orthographic(1e-3f));
    b.add(rectangle(8, 8), b.diffuse(0.5), turned(-90, 1, 0, 0));
    b.light(LightKind::directional, unit_spectrum, 1, turned(-90, 1, 0, 0));
    MediumGrid grid = unit_box();
    grid.density = lumpy_grid(b);
    b.scene.meshes.push_back(cube_mesh());
    const glm::dmat4 m = moved(0, 2, 0);
    b.separate(b.add(mesh(0), b.interface(), m * stretched(2, 2, 2)),
               grid_medium(b, slope(b, 0.5, 3), b.constant(0.1), grid, 0, m));
    const double depth = along_beam(
        [&](double y) {
          return value_at(b.scene.grids[grid.density], {0.01, y, 0.02}).x;
        },
        -1, 1);
    expect_mean(
        trace_radiances(*b.freeze()),
        [&](double nm) { return 0.5 / pi * std::exp(-depth * (0.1 + slope_at(nm, 0.5, 3))); }, 0.035);
  }
}

TEST(GridVolumes, ThatOnlyScatterVanishInAFurnace) {
  for (const Variation variation : {Variation::grey, Variation::chromatic, Variation::coloured}) {
    SceneBuilder b(16, 16, 512, many_events);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
    b.scene.meshes.push_back(cube_mesh());
    b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), white_smoke(b, variation, 0.5f));
    const std::unique_ptr<World> world = b.freeze();
    EXPECT_EQ(world->shares_paths, variation != Variation::grey);
    expect_mean(
        trace_radiances(*world), [](double) { return 1.0; }, variation == Variation::coloured ? 0.045 : 0.03);
  }
}

TEST(GridVolumes, ThatScatterInGlassVanishInAFurnace) {
  for (const float alpha : {0.0f, 0.3f}) {
    SceneBuilder b(16, 16, 256, many_events);
    const Entity camera = b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
    b.separate(camera, {}, {});
    b.light(LightKind::environment, unit_spectrum, 1);
    const float roughness = alpha > 0 ? 0.001f : 0;  // wide lobes lose light by themselves
    b.separate(b.add(sphere(1), b.rough_glass(b.constant(1.3), roughness, roughness)),
               white_smoke(b, Variation::chromatic, 0.3f));
    expect_mean(
        trace_radiances(*b.freeze()), [](double) { return 1.0; }, 0.03);
  }
}

// A ball of radial density lit from above at a right angle to the beam.
TEST(GridVolumes, ScatterOnceAsTheIntegralSays) {
  constexpr double g = 0.4, sigma_a = 0.3;
  SceneBuilder b = beam(2048, 1);
  b.light(LightKind::directional, unit_spectrum, 1, turned(-90, 1, 0, 0));
  MediumGrid grid = unit_box();
  grid.density = add_grid(b, glm::ivec3(side), voxels_in_box(glm::ivec3(side), glm::dvec3(-1), glm::dvec3(1)),
                          [](int i, int j, int k) {
                            const glm::dvec3 p = glm::dvec3(i, j, k) / 9.5 - 1.0;
                            return std::max(0.0, 2 - 2.2 * glm::length(p));
                          });
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)),
             grid_medium(b, b.constant(sigma_a), slope(b, 0.5, 4), grid, float(g)));
  const Grid& density = b.scene.grids[grid.density];
  const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g, 1.5));
  constexpr int steps = 200;
  std::vector<double> value(steps), towards_light(steps);
  for (int i = 0; i < steps; ++i) {
    const double z = 1 - (i + 0.5) * 2 / steps;
    value[i] = value_at(density, {0.01, 0.02, z}).x;
    towards_light[i] = along_beam([&](double y) { return value_at(density, {0.01, y, z}).x; }, 0.02, 1, 200);
  }
  Samples expected;  // by the nanometre
  for (size_t k = 0; k < expected.size(); ++k) {
    const double nm = lambda_min_nm + double(k);
    const double sigma_s = slope_at(nm, 0.5, 4), sigma_t = sigma_a + sigma_s;
    double sum = 0, depth = 0;
    for (int i = 0; i < steps; ++i) {
      const double h = 2.0 / steps;
      sum += value[i] * std::exp(-sigma_t * (depth + 0.5 * value[i] * h + towards_light[i])) * h;
      depth += value[i] * h;
    }
    expected[k] = sigma_s * phase * sum;
  }
  expect_mean(
      trace_radiances(*b.freeze()), [&](double nm) { return interpolate(expected, nm); }, 0.025);
}

// Three numbers per voxel: red, green and blue add up to their share on each wavelength, whatever they are.
TEST(GridVolumes, OfThreeEqualNumbersAreGrey) {
  SceneBuilder b = beam(1024, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  MediumGrid grid = unit_box();
  grid.sigma_a = add_grid(b, glm::ivec3(side), voxels_in_box(glm::ivec3(side), glm::dvec3(-1), glm::dvec3(1)),
                          [](int i, int j, int k) { return glm::vec3(float(lumps(i, j, k))); });
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, slope(b, 0.5, 1), zero_spectrum, grid));
  const double depth = beam_depth(b.scene, grid.sigma_a);
  expect_mean(
      trace_radiances(*b.freeze()), [=](double nm) { return std::exp(-depth * slope_at(nm, 0.5, 1)); }, 0.02);
}

// A red voxel absorbs red.
TEST(GridVolumes, OfColoursAbsorbThem) {
  SceneBuilder b = beam(64, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  MediumGrid grid = unit_box();
  grid.sigma_a = add_grid(b, glm::ivec3(8), voxels_in_box(glm::ivec3(8), glm::dvec3(-2), glm::dvec3(2)),
                          [](int, int, int) { return glm::vec3(2, 0, 0); });
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, unit_spectrum, zero_spectrum, grid));
  double red = 0, blue = 0, reds = 0, blues = 0;
  for (const PathRadiance& path : trace_radiances(*b.freeze()))
    for (size_t j = 0; j < 4; ++j) {
      if (path.lambda_nm[j] > 620) red += path.radiance[j], reds += 1;
      if (path.lambda_nm[j] < 480) blue += path.radiance[j], blues += 1;
    }
  EXPECT_LT(red / reds, 0.08);
  EXPECT_GT(blue / blues, 0.9);
}

// One that collides again and again is given up and counted, and brings nothing.
TEST(GridVolumes, GiveUpRaysThatNeverEnd) {
  SceneBuilder b(4, 4, 1, 0);
  b.look_at({0.01, 0.02, 5}, {0.01, 0.02, 0}, orthographic(1e-3f), {0, 1, 0});
  b.light(LightKind::environment, unit_spectrum, 1);
  b.scene.meshes.push_back(cube_mesh());
  MediumGrid grid = unit_box();
  grid.density = lumpy_grid(b);
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, unit_spectrum, zero_spectrum, grid));
  const std::unique_ptr<World> world = b.freeze();
  for (size_t i = 0; i < world->majorants.size(); i += 2) world->majorants[i] *= 1e9f;
  RenderStats stats;
  const Film film = render_film(*world, {1, 16}, &stats);
  EXPECT_EQ(stats.counters.grids.unfinished, 16u);
  EXPECT_EQ(mean_xyz(film, 5)[1], 0);
}

// Smaller majorants save lookups: the same cloud with one for all of it.
TEST(GridVolumes, SaveLookupsByTheirMajorants) {
  uint64_t lookups[2];
  for (const bool has_cells : {false, true}) {
    SceneBuilder b(16, 16, 16, 4);
    b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
    b.light(LightKind::environment, unit_spectrum, 1);
    MediumGrid grid = unit_box();
    grid.density = add_grid(b, glm::ivec3(64), voxels_in_box(glm::ivec3(64), glm::dvec3(-1), glm::dvec3(1)),
                            [](int i, int j, int k) {
                              const double r = glm::length(glm::dvec3(i, j, k) / 31.5 - 1.0);
                              return std::max(0.0, 1 - 1.5 * r);
                            });
    b.scene.meshes.push_back(cube_mesh());
    b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, zero_spectrum, b.constant(20), grid));
    const std::unique_ptr<World> world = b.freeze();
    Column<float>& majorants = world->majorants;
    const float most = *std::max_element(majorants.begin(), majorants.end());
    for (size_t i = 0; i < majorants.size() && !has_cells; i += 2) majorants[i] = most, majorants[i + 1] = 0;
    RenderStats stats;
    render_film(*world, {1, 16}, &stats);
    lookups[has_cells] = stats.counters.grids.lookups;
  }
  EXPECT_GT(lookups[false], 2 * lookups[true]);
}

TEST(GridVolumes, VanishInTheFurnaceOfRgbMode) {
  SceneBuilder b(16, 16, 512, many_events);
  b.scene.settings.color = ColorMode::rgb;
  b.light(LightKind::environment, b.named("D65"), static_cast<float>(1 / b.scene.spectra.luminance(b.named("D65"))));
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), white_smoke(b, Variation::coloured, 0.3f));
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  for (const double primary_nm : {611.0, 549.0, 464.0}) {  // which take the lead in turn
    double sum = 0, squares = 0;
    const double count = double(paths.size());
    for (const PathRadiance& path : paths)
      for (size_t j = 0; j < 3; ++j)
        if (std::abs(path.lambda_nm[j] - primary_nm) < 1)
          sum += path.radiance[j], squares += path.radiance[j] * path.radiance[j];
    const double deviation = std::sqrt(squares / count - sum / count * sum / count) / std::sqrt(count);
    EXPECT_NEAR(sum / count, 1, 5 * deviation) << primary_nm;
    EXPECT_LT(deviation, 0.008);
  }
}

// What a cell holds at least is taken out without chance.
TEST(GridVolumes, OfOneValueTransmitExactly) {
  SceneBuilder b = beam(16, 0);
  b.light(LightKind::environment, unit_spectrum, 1);
  MediumGrid grid = unit_box();
  const glm::ivec3 size(40);
  grid.density =
      add_grid(b, size, voxels_in_box(size, glm::dvec3(-2), glm::dvec3(2)), [](int, int, int) { return 1.5; });
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), grid_medium(b, slope(b, 0.2, 2), zero_spectrum, grid));
  expect_every_path(
      trace_radiances(*b.freeze()), [](double nm) { return std::exp(-3 * slope_at(nm, 0.2, 2)); }, 1e-5);
}

// A grid with the same number everywhere is a homogeneous medium: both against each other, band by band.
TEST(GridVolumes, OfOneValueAreHomogeneous) {
  for (const bool chromatic : {false, true}) {
    const auto trace = [&](bool varies) {
      SceneBuilder b(16, 16, 512, 20);
      b.light(LightKind::environment, unit_spectrum, 1);
      b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
      b.scene.meshes.push_back(cube_mesh());
      const SpectrumId sigma_a = b.constant(0.2), sigma_s = chromatic ? slope(b, 1, 3) : b.constant(2);
      MediumGrid grid = unit_box();
      const glm::ivec3 size(40);
      grid.density =
          add_grid(b, size, voxels_in_box(size, glm::dvec3(-2), glm::dvec3(2)), [](int, int, int) { return 1.5; });
      const Entity medium = varies ? grid_medium(b, sigma_a, sigma_s, grid, 0.3f) : b.medium(sigma_a, sigma_s, 0.3f);
      if (!varies) {
        Medium m = b.scene.registry.get<Medium>(medium);
        m.scale = 1.5f;
        b.scene.registry.set(medium, m);
      }
      b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), medium);
      return trace_radiances(*b.freeze());
    };
    double mean[2][4] = {}, variance[2][4] = {};
    for (const bool varies : {false, true}) {
      const std::vector<PathRadiance> paths = trace(varies);
      double sum[4] = {}, squares[4] = {}, count[4] = {};
      for (const PathRadiance& path : paths)
        for (size_t j = 0; j < 4; ++j) {
          if (path.lambda_nm[j] < 440 || path.lambda_nm[j] >= 640) continue;
          const size_t band = static_cast<size_t>((path.lambda_nm[j] - 440) / 50);
          sum[band] += path.radiance[j], squares[band] += path.radiance[j] * path.radiance[j], count[band] += 1;
        }
      for (size_t band = 0; band < 4; ++band) {
        mean[varies][band] = sum[band] / count[band];
        variance[varies][band] = (squares[band] / count[band] - mean[varies][band] * mean[varies][band]) / count[band];
      }
    }
    for (size_t band = 0; band < 4; ++band) {
      const double deviation = std::sqrt(variance[0][band] + variance[1][band]);
      EXPECT_NEAR(mean[0][band], mean[1][band], 5 * deviation) << chromatic;
      EXPECT_LT(7 * deviation, 0.025 * mean[0][band]);
    }
  }
}

TEST(GridVolumes, AreTheSameForAnyThreadsAndTiles) {
  SceneBuilder b(32, 32, 4, 20);
  b.look_at({0, 0, 4}, {0, 0, 0}, perspective(40));
  b.light(LightKind::environment, unit_spectrum, 1);
  b.light(LightKind::point, unit_spectrum, 1, moved(0, 2, 0));
  b.scene.meshes.push_back(cube_mesh());
  b.separate(b.add(mesh(0), b.interface(), stretched(2, 2, 2)), white_smoke(b, Variation::coloured, 0.5f));
  const std::unique_ptr<World> world = b.freeze();
  const Film film = render_film(*world, {1, 32});
  for (const RenderOptions& options : {RenderOptions{2, 32}, RenderOptions{2, 8}, RenderOptions{1, 20}})
    EXPECT_EQ(render_film(*world, options), film);
}

}  // namespace
}  // namespace metamer
