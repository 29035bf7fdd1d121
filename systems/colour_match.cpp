#include "systems/colour_match.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/colour_match.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// The vocabulary follows foreach_target, which includes this file once per instruction set.
#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

void multiply_matrix(const ColourMatrix& m, size_t count, const float* HWY_RESTRICT X, const float* HWY_RESTRICT Y,
                     const float* HWY_RESTRICT Z, float* HWY_RESTRICT r, float* HWY_RESTRICT g, float* HWY_RESTRICT b) {
  const FloatTag tag;
  const auto row = [&m](size_t i, VF x, VF y, VF z) {
    // No fused step, which SSE4 has not: memory is the limit here, and the bits agree everywhere.
    return hn::Add(hn::Add(hn::Mul(splat(m[i][0]), x), hn::Mul(splat(m[i][1]), y)), hn::Mul(splat(m[i][2]), z));
  };
  for (size_t i = 0; i < count; i += hn::Lanes(tag)) {
    const VF x = hn::Load(tag, X + i), y = hn::Load(tag, Y + i), z = hn::Load(tag, Z + i);
    hn::Store(row(0, x, y, z), tag, r + i);
    hn::Store(row(1, x, y, z), tag, g + i);
    hn::Store(row(2, x, y, z), tag, b + i);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(multiply_matrix);

ColourMatrix rounded(const Matrix3& matrix) {
  ColourMatrix result;
  for (size_t row = 0; row < 3; ++row)
    for (size_t column = 0; column < 3; ++column) result[row][column] = static_cast<float>(matrix[row][column]);
  return result;
}

void colour_match(const ColourMatrix& xyz_to_rgb, const Column<float>& X, const Column<float>& Y,
                  const Column<float>& Z, Column<float>& r, Column<float>& g, Column<float>& b) {
  for (Column<float>* column : {&r, &g, &b}) column->resize(X.size());
  HWY_DYNAMIC_DISPATCH(multiply_matrix)
  (xyz_to_rgb, X.size(), X.data(), Y.data(), Z.data(), r.data(), g.data(), b.data());
}

}  // namespace metamer
#endif
