// The spectral film's numbers: for each pixel and band the sums of L w and of w over the wavelengths that fell into the
// band, w = 1/p(lambda). Their ratio is the band's mean radiance whatever the density p does inside the band, and does
// not depend on how many wavelengths fell there: a spectrum that is constant over a band gives that constant.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/film/fixed_point.h"
#include "engine/simd/column.h"

namespace metamer {

class Film;

// N bands of equal width over this range. Wavelengths outside belong to none.
inline constexpr float band_min_nm = 380.0f, band_max_nm = 740.0f;
inline constexpr uint32_t default_band_count = 36, max_band_count = 360;

// A contribution L w, W m^-2 sr^-1, is summed in units of 2^-40, up to a magnitude of 2^30. At the limits of 2^22
// samples a pixel with four wavelengths each a sum stays below 2^94 units. Weights, at most 2^14 nm, are summed in
// units of 2^-20 nm, in which every w above 8 nm is exact; they stay below 2^58.
inline constexpr int band_unit_log2 = -40;
inline constexpr float band_sample_limit = 0x1p30f;

// 20 bytes: 96 bits of two's complement and 64 bits, the least significant limb first.
struct BandSum {
  std::array<uint32_t, 3> radiance;  // sum of L w, units of 2^-40 W m^-2 sr^-1
  std::array<uint32_t, 2> weight;    // sum of w, units of 2^-20 nm

  FixedSum radiance_units() const {
    const uint64_t low = radiance[0] | uint64_t{radiance[1]} << 32;
    return static_cast<FixedSum>(static_cast<int32_t>(radiance[2])) * (FixedSum{1} << 64) + static_cast<FixedSum>(low);
  }
  uint64_t weight_units() const { return weight[0] | uint64_t{weight[1]} << 32; }
  void add_radiance(FixedSum units) {
    const auto sum = static_cast<unsigned __int128>(radiance_units() + units);
    for (int limb = 0; limb < 3; ++limb)
      radiance[static_cast<size_t>(limb)] = static_cast<uint32_t>(sum >> (32 * limb));
  }
  void add_weight(uint64_t units) {
    const uint64_t sum = weight_units() + units;
    weight = {static_cast<uint32_t>(sum), static_cast<uint32_t>(sum >> 32)};
  }
  void add(const BandSum& more) {
    add_radiance(more.radiance_units());
    add_weight(more.weight_units());
  }
};
static_assert(sizeof(BandSum) == 20);

// The N + 1 edges of N bands, ascending.
std::vector<double> band_edges_nm(uint32_t band_count);

// Mean radiance per nm over the band, W m^-2 sr^-1 nm^-1; 0 where no wavelength fell into it.
double band_mean(const BandSum& sum);

// Means of the bands of pixels [first, first + count): columns[b][i] is band b of pixel first + i. A band without
// wavelengths takes the value on the line between the nearest bands that have some, beyond the last of them the nearest
// one's value, and 0 where the pixel has none at all: what a curve through the measured bands would show.
void band_means(const Film& film, size_t first, size_t count, std::span<float* const> columns);

}  // namespace metamer
