#include "systems/compare_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/schedule/workers.h"
#include "engine/simd/portable_math.h"
#include "engine/spectrum/color_difference.h"
#include "engine/spectrum/lab.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr size_t pixels_per_unit = 1 << 12;

// The columns are the primaries' XYZ, scaled so that they sum to white of Y = 1.
Matrix3 matrix_of(const Chromaticities& c) {
  const auto xyz = [](const std::array<float, 2>& xy) { return xyz_of_chromaticity(double{xy[0]}, double{xy[1]}); };
  const Color3 columns[3] = {xyz(c.red), xyz(c.green), xyz(c.blue)};
  Matrix3 matrix;
  for (size_t row = 0; row < 3; ++row)
    for (size_t column = 0; column < 3; ++column) matrix[row][column] = columns[column][row];
  const Color3 scale = multiply(inverse(matrix), xyz(c.white));
  for (auto& row : matrix)
    for (size_t column = 0; column < 3; ++column) row[column] *= scale[column];
  return matrix;
}

void set_size(XyzPicture& picture, uint32_t width, uint32_t height) {
  picture.width = width;
  picture.height = height;
  for (Column<float>* column : {&picture.X, &picture.Y, &picture.Z}) column->resize(size_t{width} * height);
}

struct Comparison {
  const XyzPicture &a, &b;
  double exposure;
  PictureDifference& difference;
};

Color3 seen_lab(const XyzPicture& picture, size_t pixel, double exposure) {
  Color3 xyz = {picture.X[pixel] * exposure, picture.Y[pixel] * exposure, picture.Z[pixel] * exposure};
  const double over_white = std::max(xyz[1], 1.0);
  for (double& component : xyz) component /= over_white;
  return lab_of_xyz(xyz, white_xyz(ColorSpace::srgb));
}

void compare_unit(void* context, uint32_t, size_t unit) {
  const Comparison& job = *static_cast<Comparison*>(context);
  Column<float>& delta_e = job.difference.delta_e;
  const size_t begin = unit * pixels_per_unit, end = std::min(begin + pixels_per_unit, delta_e.size());
  for (size_t pixel = begin; pixel < end; ++pixel) {
    const double value = delta_e_2000(seen_lab(job.a, pixel, job.exposure), seen_lab(job.b, pixel, job.exposure));
    delta_e[pixel] = std::isfinite(value) ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }
}

void summarise(PictureDifference& difference) {
  std::vector<float> finite;
  finite.reserve(difference.delta_e.size());
  double sum = 0;
  for (size_t pixel = 0; pixel < difference.delta_e.size(); ++pixel) {
    const float value = difference.delta_e[pixel];
    if (std::isnan(value)) continue;
    if (finite.empty() || double{value} > difference.largest) {
      difference.largest = double{value};
      difference.largest_pixel = pixel;
    }
    finite.push_back(value);
    sum += double{value};
  }
  difference.not_finite = difference.delta_e.size() - finite.size();
  if (finite.empty()) return;
  const auto quantile = [&](double share) {
    const auto at = finite.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(finite.size() - 1) + 0.5);
    std::nth_element(finite.begin(), at, finite.end());
    return double{*at};
  };
  difference.mean = sum / static_cast<double>(finite.size());
  difference.median = quantile(0.5);
  difference.percentile_95 = quantile(0.95);
}

// The scale of difference_map at 0 to 1. Lightness is the value; hue goes from 300 to 100 degrees upwards through 0;
// chroma stays inside sRGB.
Color3 scale_color(double value) {
  const double hue = (300 + 160 * value) * (pi / 180), chroma = 200 * value * (1 - value);
  const Color3 lab = {100 * value, chroma * portable::cos(hue), chroma * portable::sin(hue)};
  Color3 rgb = multiply(xyz_to_rgb(ColorSpace::srgb), xyz_of_lab(lab, white_xyz(ColorSpace::srgb)));
  for (double& channel : rgb) channel = std::clamp(channel, 0.0, 1.0);
  return rgb;
}

}  // namespace

XyzPicture xyz_of(const Picture& picture, const Chromaticities& chromaticities) {
  const Matrix3 matrix = matrix_of(chromaticities);
  XyzPicture result;
  set_size(result, picture.width, picture.height);
  for (size_t pixel = 0; pixel < picture.pixel_count(); ++pixel) {
    const Color3 xyz =
        multiply(matrix, Color3{double{picture.r[pixel]}, double{picture.g[pixel]}, double{picture.b[pixel]}});
    result.X[pixel] = static_cast<float>(xyz[0]);
    result.Y[pixel] = static_cast<float>(xyz[1]);
    result.Z[pixel] = static_cast<float>(xyz[2]);
  }
  return result;
}

XyzPicture xyz_of(const Film& film, std::optional<int> half) {
  XyzPicture result;
  set_size(result, film.width(), film.height());
  const uint32_t first = half ? 2 * static_cast<uint32_t>(*half) : 0, end = half ? first + 2 : replicate_count;
  for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    FixedSum sum[3] = {};
    uint64_t samples = 0;
    for (uint32_t r = first; r < end; ++r) {
      for (int c = 0; c < 3; ++c) sum[c] += film.sums()[pixel].xyz[r][c];
      samples += film.counts()[pixel].replicate[r];
    }
    const auto mean = [&](int c) {
      return samples == 0 ? 0.0f : static_cast<float>(to_double(sum[c]) / static_cast<double>(samples));
    };
    result.X[pixel] = mean(0);
    result.Y[pixel] = mean(1);
    result.Z[pixel] = mean(2);
  }
  return result;
}

PictureDifference compare_pictures(const XyzPicture& a, const XyzPicture& b, const CompareSettings& settings) {
  PictureDifference difference;
  difference.delta_e.resize(a.X.size());
  Comparison job{a, b, portable::pow(2.0, settings.exposure_stops), difference};
  const uint32_t threads = settings.threads == 0 ? available_threads() : settings.threads;
  run_units(threads, (a.X.size() + pixels_per_unit - 1) / pixels_per_unit, Cancellation(), compare_unit, &job);
  summarise(difference);
  return difference;
}

Picture difference_map(const PictureDifference& difference, uint32_t width, uint32_t height, double scale) {
  Picture map{width, height, {}, {}, {}};
  for (Column<float>* column : {&map.r, &map.g, &map.b}) column->resize(map.pixel_count());
  for (size_t pixel = 0; pixel < map.pixel_count(); ++pixel) {
    const float value = difference.delta_e[pixel];
    const Color3 rgb =
        std::isnan(value) ? Color3{0, 1, 0} : scale_color(std::min(static_cast<double>(value) / scale, 1.0));
    map.r[pixel] = static_cast<float>(rgb[0]);
    map.g[pixel] = static_cast<float>(rgb[1]);
    map.b[pixel] = static_cast<float>(rgb[2]);
  }
  return map;
}

}  // namespace metamer
