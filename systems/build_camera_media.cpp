#include <algorithm>

#include "systems/freeze.h"
#include "systems/systems.h"

namespace metamer {
namespace {

// Along the axes, a little off so as not to run along edges of what is aligned with them.
constexpr float probes[][3] = {{0.99985f, 0.0139f, 0.0107f}, {-0.99985f, -0.0107f, 0.0139f},
                               {0.0107f, 0.99985f, 0.0139f}, {0.0139f, -0.99985f, -0.0107f},
                               {0.0139f, 0.0107f, 0.99985f}, {-0.0107f, 0.0139f, -0.99985f}};
constexpr uint32_t probe_count = std::size(probes);
constexpr int most_surfaces = 256;  // per probe

using Media = std::vector<uint32_t>;

uint32_t medium_of(const World& world, ShadeKind kind, uint32_t material) {
  const bool enters = kind == ShadeKind::dielectric || kind == ShadeKind::rough_dielectric;
  return enters ? world.dielectric.medium[material] : 0;
}

// The probe meets a surface from one of its sides.
void cross(uint32_t medium, bool from_inside, Media& entered, Media& found) {
  if (medium == 0) return;
  if (!from_inside) return entered.push_back(medium);
  const auto at = std::find(entered.begin(), entered.end(), medium);
  if (at != entered.end()) {
    entered.erase(at);
  } else if (std::find(found.begin(), found.end(), medium) == found.end()) {
    found.push_back(medium);
  }
}

void start_probes(const World& world, PathStream& paths) {
  const CameraRow& camera = world.camera;
  const bool flat = camera.kind == CameraKind::orthographic;
  const float x = flat ? 0.5f * static_cast<float>(world.settings.width) : 0;
  const float y = flat ? 0.5f * static_cast<float>(world.settings.height) : 0;
  paths.size = probe_count;
  for (uint32_t i = 0; i < column_lanes; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      paths.origin[c][i] = camera.origin[c] + x * camera.right[c] + y * camera.down[c];
      paths.direction[c][i] = probes[i % probe_count][c];
    }
    for (size_t j = 0; j < 4; ++j) paths.lambda_nm[j][i] = 550, paths.throughput[j][i] = 1;
    paths.pdf_direction[i] = 0, paths.eta_scale[i] = 1;
    paths.pixel_seed[i] = paths.index[i] = 0, paths.slot[i] = i;
    paths.media[0][i] = paths.media[1][i] = paths.volume[i] = 0;
    paths.time[i] = 0;
  }
}

// One surface further along every probe that is left; rays go straight on behind it.
void advance(const World& world, Batch& batch, std::vector<Media>& entered, Media& found) {
  double seconds = 0;
  intersect_bounce(world, batch.paths, batch.hits, &seconds);
  ShadeStream& shade = batch.shade;
  sort_hits(world, 0, batch.paths, batch.hits, batch.order, shade.groups);
  shade.size = shade.groups.back().padded_end();
  surface(world, batch.paths, batch.hits, batch.order, shade);
  batch.next.size = 0;
  for (uint32_t kind = 0; kind < static_cast<uint32_t>(ShadeKind::miss); ++kind) {
    for (uint32_t lane = shade.groups[kind].begin; lane < shade.groups[kind].end; ++lane) {
      float along = 0;
      for (size_t c = 0; c < 3; ++c) along -= shade.wo[c][lane] * shade.normal[c][lane];
      const uint32_t medium = medium_of(world, static_cast<ShadeKind>(kind), shade.material[lane]);
      cross(medium, along > 0, entered[shade.slot[lane]], found);
      const uint32_t next = batch.next.size++;
      const float offset = along > 0 ? shade.offset[lane] : -shade.offset[lane];
      for (size_t c = 0; c < 3; ++c) {
        batch.next.origin[c][next] = shade.position[c][lane] + offset * shade.normal[c][lane];
        batch.next.direction[c][next] = -shade.wo[c][lane];
      }
      batch.next.slot[next] = shade.slot[lane];
    }
  }
  // Columns that probes have no use for are the same in all.
  for (size_t c = 0; c < 3; ++c) {
    std::copy_n(batch.next.origin[c], batch.next.size, batch.paths.origin[c]);
    std::copy_n(batch.next.direction[c], batch.next.size, batch.paths.direction[c]);
  }
  std::copy_n(batch.next.slot, batch.next.size, batch.paths.slot);
  batch.paths.size = batch.next.size;
}

}  // namespace

void build_camera_media(World& world) {
  if (!world.has_interiors) return;
  Batch batch;
  start_probes(world, batch.paths);
  std::vector<Media> entered(probe_count);
  Media found;
  for (int i = 0; i < most_surfaces && batch.paths.size > 0; ++i) advance(world, batch, entered, found);
  std::stable_sort(found.begin(), found.end(),
                   [&](uint32_t a, uint32_t b) { return world.media.priority[a] > world.media.priority[b]; });
  found.resize(media_stack_size, 0);
  if (world.camera_volume == 0 && world.media.volume[found[0]] != keeps_volume)
    world.camera_volume = world.media.volume[found[0]];
  world.camera_media[0] = found[0] | found[1] << 16;
  world.camera_media[1] = found[2] | found[3] << 16;
}

}  // namespace metamer
