// Free paths and transmittance through a cloud of 160^3 voxels, on every instruction set this machine has: rays through
// its box, one batch after the other. An item is a ray. "one_majorant": the same with one majorant for the whole cloud.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "bench/scene_fixture.h"
#include "engine/sampling/hash.h"
#include "engine/simd/instruction_set.h"
#include "systems/grid_track.h"
#include "systems/noise.h"

namespace metamer::bench {
namespace {

constexpr int side = 160;

// Billows: a ball whose surface noise moves.
Grid cloud() {
  std::vector<float> values;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const glm::dvec3 p = (glm::dvec3(i, j, k) + 0.5) * (2.0 / side) - 1.0;
        double sum = 0, weight = 0.5;
        for (int octave = 0, frequency = 3; octave < 5; ++octave, frequency *= 2, weight *= 0.5)
          sum += weight * reference::noise(p * double(frequency));
        values.push_back(static_cast<float>(std::clamp(3 * (0.7 - glm::length(p) + 0.6 * sum), 0.0, 1.0)));
      }
  Grid grid;
  grid.name = "cloud";
  grid.lower = glm::ivec3(0), grid.upper = glm::ivec3(side);
  grid.index_to_local = glm::dmat4(2.0 / side);
  grid.index_to_local[3] = glm::dvec4(1.0 / side - 1, 1.0 / side - 1, 1.0 / side - 1, 1);
  set_dense_values(grid, glm::ivec3(side), values);
  return grid;
}

struct Sky {
  std::unique_ptr<World> world;
  uint32_t volume = 0;
};

Sky make_sky(bool has_cells, bool is_chromatic, GridLookup lookup) {
  Scene scene;
  scene.grids.push_back(cloud());
  const Entity medium = scene.registry.create(), camera = scene.registry.create();
  Medium coefficients;
  const std::vector<double> lambda_nm = {360, 830}, values = {20, 40};
  coefficients.sigma_s = is_chromatic ? scene.spectra.add_table(lambda_nm, values, Extend::constant).id
                                      : scene.spectra.add_constant(30).id;
  scene.registry.set(medium, coefficients);
  MediumGrid grid;
  grid.density = 0;
  grid.lower = glm::vec3(-1);
  grid.lookup = lookup;
  scene.registry.set(medium, grid);
  scene.registry.set(camera, Camera{});
  scene.registry.set(camera, MediumSlot{{}, medium});
  Sky sky{frozen(scene), 0};
  sky.volume = sky.world->camera_volume;
  if (has_cells) return sky;
  Column<float>& majorants = sky.world->majorants;
  const float most = *std::max_element(majorants.begin(), majorants.end());
  for (size_t i = 0; i < majorants.size(); i += 2) majorants[i] = most, majorants[i + 1] = 0;
  return sky;
}

// Rays from a sphere around the cloud to places in it.
void aim(Batch& batch) {
  auto random = [n = 0u]() mutable { return 2 * double{unit_float(hash_u32(++n))} - 1; };
  PathStream& paths = batch.paths;
  paths.size = batch_capacity;
  const auto in_cube = [&] {
    glm::dvec3 p;
    for (int c = 0; c < 3; ++c) p[c] = random();
    return p;
  };
  for (uint32_t i = 0; i < paths.size; ++i) {
    const glm::dvec3 origin = 2.0 * glm::normalize(in_cube());
    const glm::dvec3 direction = glm::normalize(0.6 * in_cube() - origin);
    for (int c = 0; c < 3; ++c) {
      paths.origin[static_cast<size_t>(c)][i] = static_cast<float>(origin[c]);
      paths.direction[static_cast<size_t>(c)][i] = static_cast<float>(direction[c]);
    }
    for (size_t j = 0; j < 4; ++j) paths.lambda_nm[j][i] = 450 + 60 * static_cast<float>(j), paths.share[j][i] = 1;
    paths.pixel_seed[i] = hash_u32(i), paths.index[i] = i, paths.slot[i] = i;
    batch.order[i] = i;
  }
}

void bench_cloud(benchmark::State& state, std::string_view isa, bool scatters, const Sky& sky) {
  apply_isa(isa);
  Batch batch;
  aim(batch);
  VolumeRays rays{batch.paths, batch.hits, nullptr, scatters, batch.order, batch_capacity};
  GridWork work;
  for (auto _ : state) {
    ++rays.key;
    for (uint32_t i = 0; i < batch_capacity; ++i) {
      for (size_t j = 0; j < 4; ++j) batch.paths.throughput[j][i] = 1;
      batch.hits.passed[i] = 0, batch.hits.distance[i] = INFINITY, batch.hits.object[i] = no_index;
      batch.hits.depth_left[i] = -std::log(1 - unit_float(hash_combine(rays.key, i)));
    }
    track_grid(*sky.world, sky.volume, rays, batch.order, batch_capacity, work);
  }
  const double count = static_cast<double>(state.iterations()) * batch_capacity;
  state.SetItemsProcessed(state.iterations() * batch_capacity);
  state.counters["lookups_per_ray"] = static_cast<double>(work.lookups) / count;
  state.counters["steps_per_ray"] = static_cast<double>(work.steps) / count;
  apply_isa("native");
}

struct Kind {
  const char* name;
  bool has_cells, is_chromatic;
  GridLookup lookup;
};
constexpr Kind kinds[] = {{"grey", true, false, GridLookup::trilinear},
                          {"chromatic", true, true, GridLookup::trilinear},
                          {"grey_stochastic", true, false, GridLookup::stochastic},
                          {"grey_one_majorant", false, false, GridLookup::trilinear}};

// Built when first asked for.
const Sky& sky(size_t kind) {
  static Sky skies[std::size(kinds)];
  if (!skies[kind].world) skies[kind] = make_sky(kinds[kind].has_cells, kinds[kind].is_chromatic, kinds[kind].lookup);
  return skies[kind];
}

const bool registered = [] {
  for (const std::string_view isa : available_isa_names())
    for (size_t kind = 0; kind < std::size(kinds); ++kind)
      for (const bool scatters : {true, false}) {
        std::string name = scatters ? "Cloud/free_path/" : "Cloud/transmittance/";
        name.append(kinds[kind].name).append("/").append(isa);
        benchmark::RegisterBenchmark(name.c_str(), [isa, scatters, kind](benchmark::State& state) {
          bench_cloud(state, isa, scatters, sky(kind));
        });
      }
  return true;
}();

}  // namespace
}  // namespace metamer::bench
