// Radiance by wavelength, before colour matching: the pipeline's systems on whole batches, and what the slots hold.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "tests/systems/support/scene_builder.h"

namespace metamer {

struct PathRadiance {
  std::array<double, 4> lambda_nm{}, radiance{};
};

// Every sample of every pixel, by the integrator of the scene; the picture's sides are multiples of 4.
inline std::vector<PathRadiance> trace_radiances(const World& world) {
  const TileRect picture{0, 0, world.settings.width, world.settings.height};
  std::vector<RayPacket> packets;
  for (uint32_t sample = 0; sample < world.settings.samples_per_pixel; ++sample)
    for (uint32_t y = 0; y < picture.y1; y += 4)
      for (uint32_t x = 0; x < picture.x1; x += 4) packets.push_back({x, y, sample});
  const size_t step = rays_per_batch(world) / column_lanes, pixels = size_t{picture.x1} * picture.y1;
  std::vector<PathRadiance> result(pixels * world.settings.samples_per_pixel);
  Batch batch;
  Counters counters;
  // The nodes of a ray tree carry the wavelengths of their root, in another order where they parted.
  const auto gather = [&](const Slots& slots) {
    for (uint32_t i = 0; i < slots.size; ++i) {
      PathRadiance& path = result[pixels * slots.sample[i] + slots.pixel[i]];
      for (size_t j = 0; j < 4; ++j) {
        const double lambda_nm = double{slots.lambda_nm[j][i]};
        if (slots.are_roots) path.lambda_nm[j] = lambda_nm;
        for (size_t k = 0; k < 4; ++k)
          if (path.lambda_nm[k] == lambda_nm) path.radiance[k] += double{slots.radiance[j][i]};
      }
    }
  };
  for (size_t first = 0; first < packets.size(); first += step) {
    camera_rays(world, {packets.data() + first, std::min(step, packets.size() - first)}, picture, batch.paths,
                batch.slots);
    uint32_t depth = 0;
    do {
      trace_rays(world, depth, batch, counters);
      gather(batch.slots);
    } while (pop_nodes(rays_per_batch(world), batch.nodes, &depth, batch.paths, batch.slots));
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
