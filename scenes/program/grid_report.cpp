#include "scenes/program/grid_report.h"

#include <fmt/format.h>
#include <json/json.h>

#include "scenes/program/progress.h"

namespace metamer {

std::vector<GridReport> report_grids(const Scene& scene) {
  std::vector<GridReport> reports;
  for (const Grid& grid : scene.grids) {
    const std::string type = grid.channels == 3 ? grid.stored_as + ", 3 channels" : grid.stored_as;
    reports.push_back({grid.name, type, grid.origins.size() * brick_voxels, grid.bytes(), grid.upper - grid.lower,
                       grid_mean(grid), grid.channels});
  }
  return reports;
}

Json::Value to_json(const std::vector<GridReport>& grids) {
  Json::Value json(Json::arrayValue);
  for (const GridReport& grid : grids) {
    Json::Value entry;
    entry["name"] = grid.name;
    entry["type"] = grid.type;
    entry["voxels"] = static_cast<Json::UInt64>(grid.voxels);
    entry["bytes"] = static_cast<Json::UInt64>(grid.bytes);
    for (int i = 0; i < 3; ++i) entry["extent"].append(grid.extent[i]);
    for (uint32_t c = 0; c < grid.channels; ++c) entry["mean"].append(grid.mean[static_cast<int>(c)]);
    json.append(entry);
  }
  return json;
}

std::string describe(const GridReport& grid) {
  return fmt::format("{}: {}, {}x{}x{}, {} voxels stored, {}, mean {:.4g}", grid.name, grid.type, grid.extent.x,
                     grid.extent.y, grid.extent.z, grid.voxels, short_bytes(static_cast<double>(grid.bytes)),
                     fmt::join(&grid.mean.x, &grid.mean.x + grid.channels, " "));
}

}  // namespace metamer
