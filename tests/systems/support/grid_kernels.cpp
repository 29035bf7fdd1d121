#include "tests/systems/support/grid_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/support/grid_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "systems/blackbody-inl.h"
#include "systems/equiangular-inl.h"
#include "systems/grid_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

Vec3 everywhere(const glm::vec3& p) { return {splat(p.x), splat(p.y), splat(p.z)}; }

// One lane asks, the others are elsewhere.
Vec3 alone(const glm::vec3& p) {
  const MF first = hn::FirstN(FloatTag(), 1);
  return if_then_else(first, everywhere(p), everywhere(glm::vec3(1e9f)));
}

template <class Look>
std::array<double, 3> first_lane(const GridRow& row, const Look& look) {
  VF out[3] = {splat(0.0f), splat(0.0f), splat(0.0f)};
  look(row.channels, out);
  return {double{hn::GetLane(out[0])}, double{hn::GetLane(out[1])}, double{hn::GetLane(out[2])}};
}

std::array<double, 3> trilinear(const GridColumns& grids, const GridRow& row, const glm::vec3& p) {
  return first_lane(row, [&](uint32_t channels, VF* out) {
    if (channels == 3)
      grid_trilinear<3>(grids, row, alone(p), out);
    else
      grid_trilinear<1>(grids, row, alone(p), out);
  });
}
std::array<double, 3> stochastic(const GridColumns& grids, const GridRow& row, const glm::vec3& p, const glm::vec3& u) {
  return first_lane(row, [&](uint32_t channels, VF* out) {
    if (channels == 3)
      grid_stochastic<3>(grids, row, alone(p), everywhere(u), out);
    else
      grid_stochastic<1>(grids, row, alone(p), everywhere(u), out);
  });
}
double shape(float kelvin, float lambda_nm) { return hn::GetLane(blackbody_shape(splat(kelvin), splat(lambda_nm))); }
EquiangularPoint angles(float nearest, float distance, float u) {
  const VF zero = splat(0.0f);
  const Equiangular e = equiangular({splat(nearest), splat(distance), zero}, {splat(1.0f), zero, zero});
  const VF t = sample_equiangular(e, splat(u));
  return {double{hn::GetLane(t)}, double{hn::GetLane(equiangular_pdf(e, t))}};
}
double peak(float kelvin) { return hn::GetLane(blackbody_peak(splat(kelvin))); }

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(trilinear);
HWY_EXPORT(stochastic);
HWY_EXPORT(shape);
HWY_EXPORT(peak);
HWY_EXPORT(angles);

std::array<double, 3> kernel_trilinear(const GridColumns& grids, const GridRow& row, const glm::vec3& index) {
  return HWY_DYNAMIC_DISPATCH(trilinear)(grids, row, index);
}
std::array<double, 3> kernel_stochastic(const GridColumns& grids, const GridRow& row, const glm::vec3& index,
                                        const glm::vec3& chance) {
  return HWY_DYNAMIC_DISPATCH(stochastic)(grids, row, index, chance);
}
double kernel_blackbody_shape(float kelvin, float lambda_nm) { return HWY_DYNAMIC_DISPATCH(shape)(kelvin, lambda_nm); }
double kernel_blackbody_peak(float kelvin) { return HWY_DYNAMIC_DISPATCH(peak)(kelvin); }
EquiangularPoint kernel_equiangular(float nearest, float distance, float u) {
  return HWY_DYNAMIC_DISPATCH(angles)(nearest, distance, u);
}

}  // namespace metamer
#endif
