#include "engine/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>

namespace metamer {
namespace {

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "metamer: broken invariant in the film: {}\n", message);
  std::abort();
}

class RowLock {
 public:
  explicit RowLock(std::atomic_flag& flag) : flag_(flag) {
    while (flag_.test_and_set(std::memory_order_acquire)) flag_.wait(true, std::memory_order_relaxed);
  }
  ~RowLock() {
    flag_.clear(std::memory_order_release);
    flag_.notify_one();
  }
  RowLock(const RowLock&) = delete;
  RowLock& operator=(const RowLock&) = delete;

 private:
  std::atomic_flag& flag_;
};

// How many k in [0, end) have k mod 4 == replicate.
uint32_t samples_before(uint32_t end, uint32_t replicate) {
  return end / replicate_count + (end % replicate_count > replicate ? 1 : 0);
}

template <class T>
T* zeroed(size_t count) {
  // calloc leaves large blocks untouched: pages appear where and when a thread first writes them.
  void* memory = std::calloc(std::max<size_t>(count, 1), sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

void add_pixel(PixelSums& sums, PixelCounts& counts, const PixelSums& more_sums, const PixelCounts& more_counts) {
  for (uint32_t r = 0; r < replicate_count; ++r) {
    if (more_counts.replicate[r] == 0) continue;
    counts.replicate[r] += more_counts.replicate[r];
    for (int c = 0; c < 3; ++c) sums.xyz[r][c] += more_sums.xyz[r][c];
  }
}

void add_bands(std::span<BandSum> bands, std::span<const BandSum> more) {
  for (size_t b = 0; b < bands.size(); ++b)
    if (more[b].weight_units() != 0) bands[b].add(more[b]);
}

}  // namespace

uint64_t film_bytes(uint64_t width, uint64_t height, uint32_t band_count) {
  const uint64_t pixel_bytes = film_bytes_per_pixel + band_count * sizeof(BandSum);
  uint64_t pixels = 0, bytes = 0, locks = 0;
  const bool overflow = __builtin_mul_overflow(width, height, &pixels) ||
                        __builtin_mul_overflow(pixels, pixel_bytes, &bytes) ||
                        __builtin_mul_overflow(height, uint64_t{sizeof(std::atomic_flag)}, &locks) ||
                        __builtin_add_overflow(bytes, locks + sizeof(std::atomic_flag), &bytes);
  return overflow ? std::numeric_limits<uint64_t>::max() : bytes;
}

Film::Film(uint32_t width, uint32_t height, uint32_t band_count)
    : width_(width),
      height_(height),
      band_count_(band_count),
      sums_(zeroed<PixelSums>(pixel_count())),
      counts_(zeroed<PixelCounts>(pixel_count())),
      bands_(zeroed<BandSum>(pixel_count() * band_count)),
      locks_(new std::atomic_flag[size_t{height} + 1]) {}

void TileFilm::reset(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint32_t sample_begin,
                     uint32_t sample_end, uint32_t band_count) {
  if (sample_end < sample_begin) stop(fmt::format("samples from {} to {}", sample_begin, sample_end));
  x_ = x;
  y_ = y;
  width_ = width;
  height_ = height;
  band_count_ = band_count;
  invalid_samples_ = 0;
  for (uint32_t r = 0; r < replicate_count; ++r)
    counts_.replicate[r] = samples_before(sample_end, r) - samples_before(sample_begin, r);
  sums_.clear();
  sums_.resize(size_t{width} * height);
  bands_.clear();
  bands_.resize(size_t{width} * height * band_count);
}

void add_samples(TileFilm& tile, std::span<const uint32_t> pixel, std::span<const uint32_t> sample, const float* X,
                 const float* Y, const float* Z, std::span<const uint8_t> live) {
  const size_t count = pixel.size();
  if (sample.size() < count || (!live.empty() && live.size() < count))
    stop(fmt::format("columns of {} pixels, {} samples, {} masks", count, sample.size(), live.size()));
  PixelSums* sums = tile.sums_.data();
  const size_t pixels = tile.sums_.size();
  uint64_t invalid = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!live.empty() && live[i] == 0) continue;
    const uint32_t replicate = sample[i] % replicate_count;
    if (pixel[i] >= pixels || tile.counts_.replicate[replicate] == 0) [[unlikely]]
      stop(fmt::format("sample {} of pixel {} in a tile of {} pixels", sample[i], pixel[i], pixels));
    if (!(is_recordable(X[i]) & is_recordable(Y[i]) & is_recordable(Z[i]))) [[unlikely]] {
      ++invalid;
      continue;
    }
    FixedSum* xyz = sums[pixel[i]].xyz[replicate];
    xyz[0] += to_fixed(X[i]);
    xyz[1] += to_fixed(Y[i]);
    xyz[2] += to_fixed(Z[i]);
  }
  tile.invalid_samples_ += invalid;
}

void add_band_samples(TileFilm& tile, std::span<const uint32_t> pixel, const BandSamples& samples,
                      std::span<const uint8_t> live, std::span<const uint8_t> recorded) {
  const uint32_t band_count = tile.band_count_;
  const float bands_per_nm = static_cast<float>(band_count) / (band_max_nm - band_min_nm);
  const size_t pixels = size_t{tile.width_} * tile.height_;
  uint64_t invalid = 0;
  for (size_t i = 0; i < pixel.size(); ++i) {
    if (live[i] == 0) continue;
    if (pixel[i] >= pixels) [[unlikely]]
      stop(fmt::format("bands of pixel {} in a tile of {} pixels", pixel[i], pixels));
    BandSum* bands = tile.bands_.data() + size_t{pixel[i]} * band_count;
    for (size_t j = 0; j < 4; ++j) {
      const float lambda_nm = samples.lambda_nm[j][i], weight = samples.inv_pdf_nm[j][i];
      if (!(lambda_nm >= band_min_nm && lambda_nm < band_max_nm)) continue;
      const auto band = static_cast<uint32_t>((lambda_nm - band_min_nm) * bands_per_nm);
      BandSum& sum = bands[std::min(band, band_count - 1)];
      if (samples.adds_weights) sum.add_weight(static_cast<uint64_t>(weight * 0x1p20f));
      if (recorded[i] == 0) continue;
      const float row_scale = samples.row_scale == nullptr ? 1 : samples.row_scale[i];
      const float radiance = samples.radiance[j][i] * samples.scale * weight * row_scale;
      if (std::abs(radiance) <= band_sample_limit) [[likely]]
        sum.add_radiance(to_units<band_unit_log2>(radiance));
      else
        ++invalid;
    }
  }
  tile.invalid_samples_ += invalid;
}

void flush(Film& film, const TileFilm& tile) {
  if (uint64_t{tile.x()} + tile.width() > film.width_ || uint64_t{tile.y()} + tile.height() > film.height_)
    stop(fmt::format("tile {}x{} at {},{} in a film of {}x{}", tile.width(), tile.height(), tile.x(), tile.y(),
                     film.width_, film.height_));
  if (tile.band_count() != film.band_count_)
    stop(fmt::format("a tile of {} bands in a film of {}", tile.band_count(), film.band_count_));
  const PixelCounts& counts = tile.counts();
  for (uint32_t row = 0; row < tile.height(); ++row) {
    const size_t first = size_t{tile.y() + row} * film.width_ + tile.x();
    const PixelSums* source = tile.sums().data() + size_t{row} * tile.width();
    const RowLock lock(film.locks_[tile.y() + row]);
    for (uint32_t i = 0; i < tile.width(); ++i) {
      PixelCounts& target = film.counts_[first + i];
      if (target.total() + counts.total() > max_samples_per_pixel)
        stop(fmt::format("{} samples more in a pixel that has {}, the limit is {}", counts.total(), target.total(),
                         max_samples_per_pixel));
      add_pixel(film.sums_[first + i], target, source[i], counts);
    }
    const size_t row_bands = size_t{tile.width()} * film.band_count_;
    add_bands({film.bands_.get() + first * film.band_count_, row_bands},
              tile.bands().subspan(row * row_bands, row_bands));
  }
  if (tile.invalid_samples() > 0) {
    const RowLock lock(film.locks_[film.height_]);
    film.invalid_samples_ += tile.invalid_samples();
  }
}

std::optional<std::string> merge(Film& into, const Film& from) {
  if (into.width() != from.width() || into.height() != from.height())
    return fmt::format("cannot merge a film of {}x{} with one of {}x{}", into.width(), into.height(), from.width(),
                       from.height());
  if (into.band_count() != from.band_count())
    return fmt::format("cannot merge a film of {} bands with one of {}", into.band_count(), from.band_count());
  for (size_t p = 0; p < into.pixel_count(); ++p)
    if (into.counts()[p].total() + from.counts()[p].total() > max_samples_per_pixel)
      return fmt::format("cannot merge {} and {} samples of a pixel: at most {} fit", into.counts()[p].total(),
                         from.counts()[p].total(), max_samples_per_pixel);
  for (size_t p = 0; p < into.pixel_count(); ++p)
    add_pixel(into.sums()[p], into.counts()[p], from.sums()[p], from.counts()[p]);
  add_bands(into.bands(), from.bands());
  into.set_invalid_samples(into.invalid_samples() + from.invalid_samples());
  return std::nullopt;
}

bool operator==(const Film& a, const Film& b) {
  return a.width() == b.width() && a.height() == b.height() && a.band_count() == b.band_count() &&
         a.invalid_samples() == b.invalid_samples() &&
         std::memcmp(a.sums().data(), b.sums().data(), a.sums().size_bytes()) == 0 &&
         std::memcmp(a.counts().data(), b.counts().data(), a.counts().size_bytes()) == 0 &&
         std::memcmp(a.bands().data(), b.bands().data(), a.bands().size_bytes()) == 0;
}

std::array<double, 3> mean_xyz(const Film& film, size_t pixel) {
  const PixelSums& sums = film.sums()[pixel];
  const uint64_t samples = film.counts()[pixel].total();
  std::array<double, 3> mean = {};
  if (samples == 0) return mean;
  for (int c = 0; c < 3; ++c) {
    FixedSum total = 0;
    for (uint32_t r = 0; r < replicate_count; ++r) total += sums.xyz[r][c];
    mean[c] = to_double(total) / static_cast<double>(samples);
  }
  return mean;
}

void mean_xyz(const Film& film, Column<float>& X, Column<float>& Y, Column<float>& Z) {
  Column<float>* columns[3] = {&X, &Y, &Z};
  for (Column<float>* column : columns) column->resize(film.pixel_count());
  for (size_t p = 0; p < film.pixel_count(); ++p) {
    const std::array<double, 3> mean = mean_xyz(film, p);
    for (int c = 0; c < 3; ++c) (*columns[c])[p] = static_cast<float>(mean[c]);
  }
}

std::array<double, 3> variance_of_mean_xyz(const Film& film, size_t pixel) {
  const PixelSums& sums = film.sums()[pixel];
  const PixelCounts& counts = film.counts()[pixel];
  const std::array<double, 3> mean = mean_xyz(film, pixel);
  std::array<double, 3> spread = {};
  int replicates = 0;
  for (uint32_t r = 0; r < replicate_count; ++r) {
    if (counts.replicate[r] == 0) continue;
    ++replicates;
    const double n = counts.replicate[r];
    for (int c = 0; c < 3; ++c) {
      const double deviation = to_double(sums.xyz[r][c]) / n - mean[c];
      spread[c] += n * deviation * deviation;
    }
  }
  if (replicates < 2) return {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  for (double& value : spread) value /= static_cast<double>(counts.total()) * (replicates - 1);
  return spread;
}

SampleTotals sample_totals(const Film& film) {
  SampleTotals totals;
  if (film.pixel_count() == 0) return totals;
  totals.fewest = film.counts()[0].total();
  for (const PixelCounts& counts : film.counts()) {
    totals.total += counts.total();
    totals.fewest = std::min(totals.fewest, counts.total());
    totals.most = std::max(totals.most, counts.total());
  }
  return totals;
}

}  // namespace metamer
