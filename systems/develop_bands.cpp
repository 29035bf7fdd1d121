#include "systems/develop_bands.h"

#include "engine/schedule/blocks.h"
#include "engine/spectrum/sources.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/develop_bands.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// The vocabulary follows foreach_target, which includes this file once per instruction set.
#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Pixels whose sums stay in a core's first cache while band after band is added.
constexpr size_t pixels_at_once = 1024;

// Adds weight times values[begin, end) to out; the first band finds nothing there. No fused step, which SSE4 has not.
void add_band(float weight, const float* HWY_RESTRICT values, size_t begin, size_t end, bool is_first,
              float* HWY_RESTRICT out) {
  const FloatTag tag;
  for (size_t i = begin; i < end; i += hn::Lanes(tag)) {
    const VF term = hn::Mul(splat(weight), hn::Load(tag, values + i));
    hn::Store(is_first ? term : hn::Add(hn::Load(tag, out + i), term), tag, out + i);
  }
}

}  // namespace

void sum_bands(const BandMatrix& matrix, std::span<const float* const> bands, size_t begin, size_t end,
               const std::array<float*, 3>& xyz) {
  for (; begin < end; begin += pixels_at_once) {
    const size_t stop = std::min(end, begin + pixels_at_once);
    for (size_t b = 0; b < bands.size(); ++b)
      for (size_t c = 0; c < 3; ++c) add_band(matrix[c][b], bands[b], begin, stop, b == 0, xyz[c]);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(sum_bands);

namespace {

constexpr size_t pixels_per_block = size_t{1} << 14;

XyzPicture empty_picture(uint32_t width, uint32_t height) {
  const size_t pixels = size_t{width} * height;
  return {width, height, Column<float>(pixels), Column<float>(pixels), Column<float>(pixels)};
}

}  // namespace

BandMatrix band_matrix(std::span<const double> edges_nm, Observer observer) {
  const std::array<std::vector<double>, 3> weights = band_weights(edges_nm, observer);
  const Matrix3 to_xyz = observer_to_xyz(observer, *cie_illuminant("D65"));
  BandMatrix matrix;
  for (size_t r = 0; r < 3; ++r)
    for (size_t b = 0; b + 1 < edges_nm.size(); ++b)
      matrix[r].push_back(static_cast<float>(multiply(to_xyz, Color3{weights[0][b], weights[1][b], weights[2][b]})[r]));
  return matrix;
}

XyzPicture integrate_bands(const SpectralPicture& picture, const BandMatrix& matrix, uint32_t threads) {
  XyzPicture xyz = empty_picture(picture.width, picture.height);
  std::vector<const float*> bands;
  for (const Column<float>& band : picture.bands) bands.push_back(band.data());
  for_blocks(xyz.X.size(), threads, pixels_per_block, [&](size_t begin, size_t end) {
    HWY_DYNAMIC_DISPATCH(sum_bands)(matrix, bands, begin, end, {xyz.X.data(), xyz.Y.data(), xyz.Z.data()});
  });
  return xyz;
}

XyzPicture integrate_bands(const Film& film, const BandMatrix& matrix, uint32_t threads) {
  XyzPicture xyz = empty_picture(film.width(), film.height());
  constexpr size_t block = 1024;  // its bands' means stay in a core's second cache
  for_blocks(xyz.X.size(), threads, block, [&](size_t begin, size_t end) {
    std::vector<Column<float>> means(film.band_count());
    std::vector<float*> columns;
    for (Column<float>& column : means) {
      column.resize(block);
      columns.push_back(column.data());
    }
    band_means(film, begin, end - begin, columns);
    const std::vector<const float*> bands(columns.begin(), columns.end());
    HWY_DYNAMIC_DISPATCH(sum_bands)
    (matrix, bands, 0, end - begin, {xyz.X.data() + begin, xyz.Y.data() + begin, xyz.Z.data() + begin});
  });
  return xyz;
}

}  // namespace metamer
#endif
