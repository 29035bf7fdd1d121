// Rays given one by one, and what `intersect` and `surface` say they met.
#pragma once
#include <span>
#include <vector>

#include "tests/systems/support/scene_builder.h"

namespace metamer {

struct TestRay {
  glm::dvec3 origin, direction;
};
struct TestHit {
  bool met = false;
  uint32_t object = no_index;
  double distance = 0, offset = 0, u = 0, v = 0;
  glm::dvec3 position, normal, shading_normal, tangent;
};

inline glm::dvec3 read_columns(const Columns<float, 3>& columns, uint32_t i) {
  return {columns[0][i], columns[1][i], columns[2][i]};
}

inline std::vector<TestHit> trace(const World& world, std::span<const TestRay> rays) {
  std::vector<TestHit> hits(rays.size());
  Batch batch;
  PathStream& paths = batch.paths;
  for (size_t first = 0; first < rays.size(); first += batch_capacity) {
    paths.size = static_cast<uint32_t>(std::min<size_t>(batch_capacity, rays.size() - first));
    for (uint32_t i = 0; i < padded_to_lanes(paths.size); ++i) {
      const TestRay& ray = rays[first + std::min(i, paths.size - 1)];
      for (int c = 0; c < 3; ++c) {
        paths.origin[size_t(c)][i] = static_cast<float>(ray.origin[c]);
        paths.direction[size_t(c)][i] = static_cast<float>(ray.direction[c]);
      }
      for (size_t j = 0; j < 4; ++j) paths.lambda_nm[j][i] = 550, paths.throughput[j][i] = 1;
      paths.pdf_direction[i] = paths.eta_scale[i] = 1;
      paths.pixel_seed[i] = paths.index[i] = 0;
      paths.slot[i] = i;
      if (world.has_motion) paths.time[i] = 0;
    }
    double seconds = 0;
    intersect_bounce(world, paths, batch.hits, &seconds);
    sort_hits(world, 0, paths, batch.hits, batch.order, batch.shade.groups);
    ShadeStream& shade = batch.shade;
    shade.size = shade.groups.back().padded_end();
    surface(world, paths, batch.hits, batch.order, shade);
    for (uint32_t i = 0; i < shade.groups[static_cast<size_t>(ShadeKind::miss)].begin; ++i) {
      if (shade.slot[i] == dead_lane) continue;
      TestHit& hit = hits[first + shade.slot[i]];
      hit.met = true;
      hit.object = batch.hits.object[shade.slot[i]];
      hit.distance = double{shade.distance[i]};
      hit.offset = double{shade.offset[i]};
      hit.position = read_columns(shade.position, i);
      hit.normal = read_columns(shade.normal, i);
      hit.shading_normal = read_columns(shade.shading_normal, i);
      if (world.needs_uvs()) hit.u = double{shade.uv[0][i]}, hit.v = double{shade.uv[1][i]};
      if (world.needs_tangents) hit.tangent = glm::normalize(read_columns(shade.tangent, i));
    }
  }
  return hits;
}

inline TestHit trace(const World& world, const glm::dvec3& origin, const glm::dvec3& direction) {
  const TestRay ray{origin, glm::normalize(direction)};
  return trace(world, {&ray, 1})[0];
}

}  // namespace metamer
