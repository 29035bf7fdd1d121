// Radiance by wavelength, before colour matching: the pipeline's systems on whole batches, and what the slots hold.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "systems/dimensions.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {

struct PathRadiance {
  std::array<double, 4> lambda_nm{}, radiance{};
};

inline void trace_paths(const World& world, Batch& batch) {
  double seconds = 0;
  for (uint32_t depth = 0; depth <= world.settings.max_depth && batch.paths.size > 0; ++depth) {
    (depth == 0 ? intersect_camera : intersect_bounce)(world, batch.paths, batch.hits, &seconds);
    sort_hits(world, batch.paths.size, batch.hits, batch.order, batch.shade.groups);
    batch.shade.size = batch.shade.groups.back().padded_end();
    surface(world, batch.paths, batch.hits, batch.order, batch.shade);
    emission(world, batch.shade, batch.slots);
    if (depth == world.settings.max_depth) return;
    if (!world.lights.empty()) light_sample(world, depth, batch.shade);
    batch.shadow.size = 0;
    shade_diffuse(world, depth, batch.shade, batch.shadow);
    shade_rough(world, depth, batch.shade, batch.shadow);
    shade_rough_conductor(world, depth, batch.shade, batch.shadow);
    shade_smooth_conductor(world, batch.shade);
    shade_dielectric(world, depth, batch.shade);
    shadow(world, batch.shadow, batch.slots, &seconds);
    roulette(depth, batch.shade, batch.next);
    std::swap(batch.paths, batch.next);
  }
}

// Every sample of every pixel; the picture's sides are multiples of 4.
inline std::vector<PathRadiance> trace_radiances(const World& world) {
  const TileRect picture{0, 0, world.settings.width, world.settings.height};
  std::vector<RayPacket> packets;
  for (uint32_t sample = 0; sample < world.settings.samples_per_pixel; ++sample)
    for (uint32_t y = 0; y < picture.y1; y += 4)
      for (uint32_t x = 0; x < picture.x1; x += 4) packets.push_back({x, y, sample});
  std::vector<PathRadiance> result;
  Batch batch;
  constexpr size_t step = batch_capacity / column_lanes;
  for (size_t first = 0; first < packets.size(); first += step) {
    const size_t count = std::min(step, packets.size() - first);
    camera_rays(world, {packets.data() + first, count}, picture, batch.paths, batch.slots);
    trace_paths(world, batch);
    for (uint32_t i = 0; i < batch.slots.size; ++i) {
      PathRadiance path;
      for (size_t j = 0; j < 4; ++j) {
        path.lambda_nm[j] = double{batch.slots.lambda_nm[j][i]};
        path.radiance[j] = double{batch.slots.radiance[j][i]};
      }
      result.push_back(path);
    }
  }
  return result;
}

// Every path carries expected(lambda) on each of its wavelengths, to a relative tolerance.
template <class Expected>
void expect_every_path(const std::vector<PathRadiance>& paths, const Expected& expected, double tolerance) {
  double worst = 0;
  for (const PathRadiance& path : paths)
    for (size_t j = 0; j < 4; ++j) {
      const double wanted = expected(path.lambda_nm[j]);
      const double error = std::abs(path.radiance[j] / wanted - 1);
      worst = error <= worst ? worst : error;  // NaN stays
    }
  EXPECT_GT(paths.size(), 0u);
  EXPECT_LE(worst, tolerance);
}

// The mean over paths is expected(lambda) in each band of wavelengths. A z beyond 5 comes by chance once in 1.7 million
// bands. `visible`: a relative bias of this size in a well-filled band stands two standard errors beyond that.
template <class Expected>
void expect_mean(const std::vector<PathRadiance>& paths, const Expected& expected, double visible) {
  constexpr size_t bands = 6;
  constexpr double width = 40, start = 430;
  for (size_t band = 0; band < bands; ++band) {
    const double low = start + width * double(band), high = low + width;
    double difference = 0, squares = 0, wanted = 0;
    for (const PathRadiance& path : paths) {
      double residual = 0;
      for (size_t j = 0; j < 4; ++j) {
        if (path.lambda_nm[j] < low || path.lambda_nm[j] >= high) continue;
        residual += path.radiance[j] - expected(path.lambda_nm[j]);
        wanted += expected(path.lambda_nm[j]);
      }
      difference += residual;
      squares += residual * residual;
    }
    // Rounding of float is no bias.
    const double deviation = std::sqrt(squares) + 1e-6 * wanted;
    EXPECT_GT(wanted, 0);
    EXPECT_LT(std::abs(difference), 5 * deviation)
        << low << " nm: " << 1 + difference / wanted << " of what is expected";
    EXPECT_LT(7 * deviation, visible * wanted) << low << " nm: too few samples";
  }
}

}  // namespace metamer
