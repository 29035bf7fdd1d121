#include "scenes/program/stats.h"

#include <json/json.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

#include "engine/simd/instruction_set.h"

namespace metamer {
namespace {

// In the order of SystemId.
constexpr std::array system_names = {"camera_rays", "intersect", "volumes",      "sort",  "surface",
                                     "media",       "emission",  "light_sample", "shade", "shadow",
                                     "roulette",    "nodes",     "accumulate"};
static_assert(system_names.size() == system_count);

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

Json::Value count(uint64_t value) { return Json::Value(static_cast<Json::UInt64>(value)); }

Json::Value to_json(const FrameReport& report) {
  const Counters& counters = report.render.counters;
  Json::Value json;
  json["version"] = METAMER_VERSION;
  json["isa"] = std::string(chosen_isa_name());
  json["scene"] = report.scene;
  json["width"] = report.settings.width;
  json["height"] = report.settings.height;
  json["seed"] = report.settings.seed;
  json["bands"] = report.settings.band_count;
  json["max_depth"] = report.settings.max_depth;
  json["integrator"] = std::string(integrator_name(report.settings.integrator));
  json["shadows"] = report.settings.shadows;
  json["color"] = std::string(color_mode_name(report.settings.color));
  json["samples_per_pixel"] = report.settings.samples_per_pixel;
  json["fewest_samples_per_pixel"] = count(report.samples.fewest);
  json["most_samples_per_pixel"] = count(report.samples.most);
  json["interrupted"] = report.is_interrupted;
  json["threads"] = report.render.threads;
  json["tile"] = report.tile_size;
  json["samples"] = count(report.samples.total);
  json["invalid_samples"] = count(report.invalid_samples);
  json["lost_media"] = count(counters.lost_media);
  json["lost_rays"] = count(counters.lost_rays);
  json["grids"]["lookups"] = count(counters.grids.lookups);
  json["grids"]["steps"] = count(counters.grids.steps);
  json["grids"]["unfinished_rays"] = count(counters.grids.unfinished);
  json["rays"]["camera"] = count(counters.camera_rays);
  json["rays"]["bounce"] = count(counters.bounce_rays);
  json["rays"]["shadow"] = count(counters.shadow_rays);
  json["lane_fill"] = ratio(static_cast<double>(counters.live_lanes), static_cast<double>(counters.lanes));
  json["load_seconds"] = report.load_seconds;
  json["build_seconds"] = report.build_seconds;
  json["render_seconds"] = report.render.render_seconds;
  json["first_ray_seconds"] = report.first_ray_seconds;
  json["first_pixel_seconds"] = report.first_pixel_seconds;
  json["cpu_seconds"] = report.render.cpu_seconds;
  json["embree_seconds"] = counters.embree_seconds;
  json["embree_share"] = ratio(counters.embree_seconds, report.render.cpu_seconds);
  for (size_t i = 0; i < system_count; ++i) json["systems"][system_names[i]] = counters.seconds[i];
  json["peak_rss_bytes"] = count(peak_rss_bytes());
  json["batch_bytes"] = count(report.render.batch_bytes);
  json["film_bytes"] = count(report.film_bytes);
  json["world_bytes"] = count(report.world_bytes);
  json["textures"]["bytes"] = count(report.texture_bytes);
  const ImageCacheStats& cache = report.texture_cache;
  json["textures"]["files"] = count(cache.files);
  json["textures"]["file_bytes"] = count(cache.file_bytes);
  json["textures"]["cache_limit_bytes"] = count(cache.limit_bytes);
  json["textures"]["cache_bytes"] = count(cache.held_bytes);
  json["textures"]["cache_tiles_read"] = count(cache.tiles_read);
  json["textures"]["cache_bytes_read"] = count(cache.read_bytes);
  json["volumes"] = to_json(report.grids);
  return json;
}

}  // namespace

size_t peak_rss_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (size_t kibibytes = 0; word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  return 0;
}

double process_age_seconds() {
  std::ifstream file("/proc/self/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The program's name, field 2, may hold blanks. The time of the start is field 22, in clock ticks since the boot.
  std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string skipped;
  for (int i = 3; i < 22; ++i) fields >> skipped;
  double start_ticks = 0;
  if (!(fields >> start_ticks)) return 0;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         start_ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

FileError write_stats(const std::string& path, const FrameReport& report) {
  Json::StreamWriterBuilder builder;
  builder["indentation"] = "  ";
  builder["precision"] = 9;
  const std::string text = Json::writeString(builder, to_json(report)) + "\n";
  AtomicFile file;
  if (FileError error = file.open(path)) return error;
  if (FileError error = file.write(text.data(), text.size())) return error;
  return file.commit();
}

}  // namespace metamer
