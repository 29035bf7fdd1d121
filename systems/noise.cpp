#include "systems/noise.h"

#include <array>
#include <cmath>

namespace metamer {
namespace {

constexpr std::array<uint8_t, 256> permutation_once = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

constexpr std::array<uint32_t, 512> permutation_twice = [] {
  std::array<uint32_t, 512> twice{};
  for (size_t i = 0; i < twice.size(); ++i) twice[i] = permutation_once[i % permutation_once.size()];
  return twice;
}();

// The product of (x, y, z) with one of the twelve directions to the edges of a cube.
double along_gradient(uint32_t cell_x, uint32_t cell_y, uint32_t cell_z, double x, double y, double z) {
  const auto& p = permutation_twice;
  const uint32_t h = p[p[p[cell_x] + cell_y] + cell_z] & 15;
  const bool is_extra = h == 12 || h == 13;
  const double u = h < 8 || is_extra ? x : y;
  const double v = h < 4 || is_extra ? y : z;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

std::span<const uint32_t, 512> noise_permutation() { return permutation_twice; }

namespace reference {

double noise(const glm::dvec3& p) {
  const double floors[3] = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const double at[3] = {p.x - floors[0], p.y - floors[1], p.z - floors[2]};
  uint32_t cell[3];
  for (int k = 0; k < 3; ++k) cell[k] = static_cast<uint32_t>(floors[k] - 256 * std::floor(floors[k] / 256));
  double sum = 0;
  for (uint32_t corner = 0; corner < 8; ++corner) {
    const uint32_t i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight = (i != 0 ? fade(at[0]) : 1 - fade(at[0])) * (j != 0 ? fade(at[1]) : 1 - fade(at[1])) *
                          (k != 0 ? fade(at[2]) : 1 - fade(at[2]));
    sum += weight * along_gradient(cell[0] + i, cell[1] + j, cell[2] + k, at[0] - i, at[1] - j, at[2] - k);
  }
  return sum;
}

double fbm(const glm::dvec3& p, double roughness, uint32_t octaves) {
  double sum = 0, frequency = 1, weight = 1;
  for (uint32_t i = 0; i < octaves; ++i, frequency *= 1.99, weight *= roughness) sum += weight * noise(frequency * p);
  return sum;
}

double turbulence(const glm::dvec3& p, double roughness, uint32_t octaves) {
  double sum = 0, frequency = 1, weight = 1;
  for (uint32_t i = 0; i < octaves; ++i, frequency *= 1.99, weight *= roughness)
    sum += weight * std::abs(noise(frequency * p));
  return sum;
}

}  // namespace reference
}  // namespace metamer
