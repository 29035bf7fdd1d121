#include "engine/spectrum/rgb_start_table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>

#include "engine/spectrum/rgb_fit.h"

namespace metamer {
namespace {

double coefficient_scale(const Color3& rgb) {
  const auto [low, high] = std::minmax({rgb[0], rgb[1], rgb[2]});
  return std::sqrt(high * (1.0 - low));
}

// Solves for `rgb` from the coefficients of the neighbour `from`, by way of the colours between where needed.
bool step_to(std::span<const QuadratureNode> nodes, const Color3& from, const Color3& rgb, SigmoidCoefficients& c) {
  constexpr int parts = 4;
  SigmoidCoefficients trial = c;
  if (!refine_sigmoid(nodes, rgb, trial)) {
    trial = c;
    for (int part = 1; part <= parts; ++part) {
      Color3 between;
      for (size_t k = 0; k < 3; ++k) between[k] = from[k] + (rgb[k] - from[k]) * part / parts;
      if (!refine_sigmoid(nodes, between, trial)) return false;
    }
  }
  c = trial;
  return true;
}

// All saturations of one hue and lightness, from grey outwards. Past the last colour that exists the coefficients of
// that one stay.
void fill_ray(std::span<const QuadratureNode> nodes, size_t hue, size_t lightness, RgbStartTable& table) {
  // At black and white themselves the scaled coefficients have a limit that is taken nearby.
  const double l = std::clamp(static_cast<double>(lightness) / (start_lightnesses - 1), 1e-5, 1.0 - 1e-5);
  const double h = static_cast<double>(hue) * 6.0 / start_hues;
  Color3 previous = {l, l, l};
  SigmoidCoefficients c = grey_sigmoid(l);
  Color3 scaled = {0.0, 0.0, c[2] * coefficient_scale(previous)};
  bool exists = true;
  for (size_t saturation = 0; saturation < start_saturations; ++saturation) {
    if (saturation > 0 && exists) {
      const Color3 rgb = rgb_of_hsl(h, static_cast<double>(saturation) / (start_saturations - 1), l);
      exists = step_to(nodes, previous, rgb, c);
      if (exists) {
        for (size_t k = 0; k < 3; ++k) scaled[k] = c[k] * coefficient_scale(rgb);
        previous = rgb;
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      table.scaled_c[3 * start_entry(hue, saturation, lightness) + k] = static_cast<float>(scaled[k]);
    }
  }
}

RgbStartTable make_table(ColorSpace space) {
  RgbStartTable table;
  const std::span<const QuadratureNode> nodes = reduced_quadrature(space);
  table.scaled_c.resize(3 * start_hues * start_saturations * start_lightnesses);
  for (size_t hue = 0; hue < start_hues; ++hue) {
    for (size_t lightness = 0; lightness < start_lightnesses; ++lightness) fill_ray(nodes, hue, lightness, table);
  }
  for (const auto& [t, weight] : nodes) {
    for (const double value : {t, weight[0], weight[1], weight[2]}) table.nodes.push_back(static_cast<float>(value));
  }
  return table;
}

}  // namespace

Color3 rgb_of_hsl(double hue, double saturation, double lightness) {
  const double chroma = saturation * (1.0 - std::abs(2.0 * lightness - 1.0));
  const double high = lightness + 0.5 * chroma;
  const double low = lightness - 0.5 * chroma;
  const int sector = std::min(static_cast<int>(hue), 5);
  const double rising = low + chroma * (hue - sector);
  const double falling = high - chroma * (hue - sector);
  switch (sector) {
    case 0: return {high, rising, low};
    case 1: return {falling, high, low};
    case 2: return {low, high, rising};
    case 3: return {low, falling, high};
    case 4: return {rising, low, high};
    default: return {high, low, falling};
  }
}

const RgbStartTable& rgb_start_table(ColorSpace space) {
  static std::array<std::once_flag, color_space_count> made;
  static std::array<RgbStartTable, color_space_count> tables;
  const auto index = static_cast<size_t>(space);
  std::call_once(made[index], [&] { tables[index] = make_table(space); });
  return tables[index];
}

}  // namespace metamer
