// The film: for every pixel and replicate the exact sum of its samples' XYZ, so that threads, tiles, sample
// ranges, interruption and merging all end in the same bytes. Values are cd/m^2 (the 683 included).
//
// Sample k belongs to replicate k mod 4. Replicates are scrambled independently, so the variance of a pixel
// follows from the spread of its replicate means, which it does not from samples of one low-discrepancy net.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/film/bands.h"
#include "engine/film/fixed_point.h"
#include "engine/sampling/points.h"
#include "engine/simd/column.h"

namespace metamer {

// At the sample limit so many samples sum to 2^126 quanta: no sum of a pixel can overflow.
inline constexpr uint32_t max_samples_per_pixel = 1u << 22;

struct PixelSums {
  FixedSum xyz[replicate_count][3];  // [replicate][X, Y, Z], quanta
};
struct PixelCounts {
  uint32_t replicate[replicate_count];  // samples taken; refused ones count, as black

  uint64_t total() const { return uint64_t{replicate[0]} + replicate[1] + replicate[2] + replicate[3]; }
};
inline constexpr size_t film_bytes_per_pixel = sizeof(PixelSums) + sizeof(PixelCounts);  // 192 + 16
static_assert(film_bytes_per_pixel == 208);

// Bytes that Film(width, height, band_count) holds; the largest number where they would not fit 64 bits.
uint64_t film_bytes(uint64_t width, uint64_t height, uint32_t band_count = 0);

// What is wrong with a frame of this size, if anything: no pixels, sides above 2^20, or a film and its
// developed picture larger than the memory now available. To be asked before the first ray.
std::optional<std::string> check_frame_size(uint64_t width, uint64_t height, uint32_t band_count = 0);

// The same of a spectral picture that is read from a file, and what it is developed into.
std::optional<std::string> check_spectral_picture_size(uint64_t width, uint64_t height, uint64_t band_count);

class Film {
 public:
  Film() = default;
  // All sums and counts zero; with bands if band_count is not 0. Throws std::bad_alloc where memory is refused.
  Film(uint32_t width, uint32_t height, uint32_t band_count = 0);

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  uint32_t band_count() const { return band_count_; }  // 0: no spectral film
  size_t pixel_count() const { return size_t{width_} * height_; }

  // Row by row from the top left. Not to be read while threads flush.
  std::span<PixelSums> sums() { return {sums_.get(), pixel_count()}; }
  std::span<const PixelSums> sums() const { return {sums_.get(), pixel_count()}; }
  std::span<PixelCounts> counts() { return {counts_.get(), pixel_count()}; }
  std::span<const PixelCounts> counts() const { return {counts_.get(), pixel_count()}; }
  // All bands of a pixel, then those of the next.
  std::span<BandSum> bands() { return {bands_.get(), pixel_count() * band_count_}; }
  std::span<const BandSum> bands() const { return {bands_.get(), pixel_count() * band_count_}; }

  // Samples refused because a channel was not a number, infinite, or beyond sample_limit.
  uint64_t invalid_samples() const { return invalid_samples_; }
  void set_invalid_samples(uint64_t count) { invalid_samples_ = count; }

 private:
  friend void flush(Film& film, const class TileFilm& tile);
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  uint32_t width_ = 0;
  uint32_t height_ = 0;
  uint32_t band_count_ = 0;
  std::unique_ptr<PixelSums[], Free> sums_;
  std::unique_ptr<PixelCounts[], Free> counts_;
  std::unique_ptr<BandSum[], Free> bands_;
  std::unique_ptr<std::atomic_flag[]> locks_;  // one per row of pixels, and one for invalid_samples_
  uint64_t invalid_samples_ = 0;
};

// The part of the film one unit of work adds to: a rectangle of pixels and the samples [begin, end) of each.
// Owned by one thread, reused from unit to unit. A unit that was cancelled half-way is not flushed.
class TileFilm {
 public:
  // Pixels [x, x + width) by [y, y + height) of a film with that many bands, sums zero.
  void reset(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint32_t sample_begin, uint32_t sample_end,
             uint32_t band_count = 0);

  uint32_t x() const { return x_; }
  uint32_t y() const { return y_; }
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  const PixelCounts& counts() const { return counts_; }  // of every pixel in it
  uint64_t invalid_samples() const { return invalid_samples_; }
  std::span<const PixelSums> sums() const { return sums_; }
  uint32_t band_count() const { return band_count_; }
  std::span<const BandSum> bands() const { return bands_; }  // all of a pixel, then those of the next
  size_t bytes() const { return sums_.bytes() + bands_.bytes(); }

 private:
  friend void add_samples(TileFilm& tile, std::span<const uint32_t> pixel, std::span<const uint32_t> sample,
                          const float* X, const float* Y, const float* Z, std::span<const uint8_t> live);
  friend void add_band_samples(TileFilm& tile, std::span<const uint32_t> pixel, const struct BandSamples& samples,
                               std::span<const uint8_t> live, std::span<const uint8_t> recorded);

  uint32_t x_ = 0, y_ = 0, width_ = 0, height_ = 0, band_count_ = 0;
  Column<PixelSums> sums_;
  Column<BandSum> bands_;
  PixelCounts counts_ = {};
  uint64_t invalid_samples_ = 0;
};

// Adds sample[i] of pixel[i] (row by row within the tile) for each i, at most once per pixel and sample.
// `sample` holds sample indices or replicates: only the value mod 4 matters. X, Y, Z hold as many values.
// Where `live` is not empty, rows with live[i] == 0 are skipped. A sample with a channel that is not
// recordable is counted and adds nothing. A pixel outside the tile or a replicate that the tile's range does
// not reach stops the program.
void add_samples(TileFilm& tile, std::span<const uint32_t> pixel, std::span<const uint32_t> sample, const float* X,
                 const float* Y, const float* Z, std::span<const uint8_t> live = {});

// What the wavelengths of samples add to the bands; columns as long as that of the pixels.
struct BandSamples {
  std::array<const float*, 4> lambda_nm, inv_pdf_nm, radiance;  // nm, nm (at most 2^14), W m^-2 sr^-1 nm^-1
  float scale = 1;                                              // on the radiance
  const float* row_scale = nullptr;                             // the same of each row; null: 1
  bool adds_weights = true;  // false: the weights of these samples have been added with another part of their light
};

// Adds w = inv_pdf_nm of each wavelength to the weights of its band, and L w to its radiances. Wavelengths outside the
// bands add nothing. Rows with live[i] == 0 are skipped, of those with recorded[i] == 0 only the weights are added: the
// sample counts as black. L w beyond band_sample_limit is left out and counted among the invalid samples. Stops the
// program for a pixel outside the tile.
void add_band_samples(TileFilm& tile, std::span<const uint32_t> pixel, const BandSamples& samples,
                      std::span<const uint8_t> live, std::span<const uint8_t> recorded);

// Adds the tile's sums and sample counts to the film, once per unit of work. Any threads may flush any tiles
// at one time, overlapping ones too. Stops the program where the tile lies outside the film or a pixel would
// exceed max_samples_per_pixel.
void flush(Film& film, const TileFilm& tile);

// Adds the samples of `from`. An error, and `into` unchanged, where the sizes differ or a pixel would exceed
// max_samples_per_pixel. That the two hold different samples of one frame is for the caller to know.
std::optional<std::string> merge(Film& into, const Film& from);

// Equal to the last bit: size, sums, counts and refused samples.
bool operator==(const Film& a, const Film& b);

// Mean over a pixel's samples, cd/m^2; 0 where there is none. Sums are exact, so the error is that of two
// roundings, relative 2^-52.
std::array<double, 3> mean_xyz(const Film& film, size_t pixel);

// The means of all pixels as columns, rounded to float.
void mean_xyz(const Film& film, Column<float>& X, Column<float>& Y, Column<float>& Z);

// Unbiased estimate of the variance of mean_xyz, (cd/m^2)^2, from R replicates with n_r samples and means m_r:
// sum_r n_r (m_r - m)^2 / (N (R - 1)), the weighted one-way form in which var(m_r) = sigma^2 / n_r; with equal
// n_r it is the textbook variance of a mean of R. Infinite where fewer than two replicates have samples.
std::array<double, 3> variance_of_mean_xyz(const Film& film, size_t pixel);

// Samples over all pixels, and the smallest and largest number in one pixel.
struct SampleTotals {
  uint64_t total = 0;
  uint64_t fewest = 0;
  uint64_t most = 0;
};
SampleTotals sample_totals(const Film& film);

}  // namespace metamer
