// Whether a frame fits into the memory there is, asked before the first ray.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "engine/film/film.h"

namespace metamer {
namespace {

constexpr uint64_t largest_side = 1u << 20;          // pixels
constexpr uint64_t developed_bytes = 2 * 3 * 4 + 4;  // XYZ and RGB as float, and 8-bit codes, per pixel

// A number in the first line of a file, as the kernel writes limits; nothing for "max" or no such file.
std::optional<uint64_t> number_in(const char* path) {
  std::ifstream file(path);
  uint64_t value = 0;
  return file >> value ? std::optional(value) : std::nullopt;
}

// Bytes that can still be had: what the kernel calls available, at most a container's limit.
uint64_t available_memory() {
  uint64_t available = std::numeric_limits<uint64_t>::max();
  std::ifstream meminfo("/proc/meminfo");
  for (std::string word; meminfo >> word;)
    if (uint64_t kibibytes = 0; word == "MemAvailable:" && meminfo >> kibibytes) available = kibibytes * 1024;
  for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (const std::optional<uint64_t> limit = number_in(path)) available = std::min(available, *limit);
  return available;
}

double gibibytes(uint64_t bytes) { return static_cast<double>(bytes) * 0x1p-30; }

std::optional<std::string> check_size(uint64_t width, uint64_t height, uint64_t bytes_per_pixel,
                                      std::string_view what) {
  if (width == 0 || height == 0) return fmt::format("a frame of {}x{} has no pixels", width, height);
  if (width > largest_side || height > largest_side)
    return fmt::format("a frame of {}x{} is too large: a side has at most {} pixels", width, height, largest_side);
  const uint64_t pixel_bytes = bytes_per_pixel + developed_bytes;
  const uint64_t available = available_memory();
  // Two sides and a pixel's bytes: at most 2^40 times 2^20.
  if (const uint64_t needed = width * height * pixel_bytes; needed > available)
    return fmt::format(
        "a frame of {}x{}{} does not fit in memory: it needs {:.1f} GiB ({} bytes a pixel), {:.1f} GiB "
        "are available",
        width, height, what, gibibytes(needed), pixel_bytes, gibibytes(available));
  return std::nullopt;
}

std::string bands_text(uint64_t band_count) { return band_count > 0 ? fmt::format(" with {} bands", band_count) : ""; }

}  // namespace

std::optional<std::string> check_frame_size(uint64_t width, uint64_t height, uint32_t band_count) {
  return check_size(width, height, film_bytes_per_pixel + band_count * sizeof(BandSum), bands_text(band_count));
}

std::optional<std::string> check_spectral_picture_size(uint64_t width, uint64_t height, uint64_t band_count) {
  return check_size(width, height, band_count * sizeof(float), bands_text(band_count));
}

}  // namespace metamer
