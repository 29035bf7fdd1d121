#include "tests/systems/support/noise_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/support/noise_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "systems/noise-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

Vec3 everywhere(const glm::dvec3& p) {
  return {splat(static_cast<float>(p.x)), splat(static_cast<float>(p.y)), splat(static_cast<float>(p.z))};
}
double noise_at(const glm::dvec3& p) { return hn::GetLane(noise(everywhere(p))); }
double fbm_at(const glm::dvec3& p, float roughness, uint32_t octaves) {
  return hn::GetLane(fbm(everywhere(p), roughness, octaves));
}
double turbulence_at(const glm::dvec3& p, float roughness, uint32_t octaves) {
  return hn::GetLane(turbulence(everywhere(p), roughness, octaves));
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(noise_at);
HWY_EXPORT(fbm_at);
HWY_EXPORT(turbulence_at);

double kernel_noise(const glm::dvec3& p) { return HWY_DYNAMIC_DISPATCH(noise_at)(p); }
double kernel_fbm(const glm::dvec3& p, float roughness, uint32_t octaves) {
  return HWY_DYNAMIC_DISPATCH(fbm_at)(p, roughness, octaves);
}
double kernel_turbulence(const glm::dvec3& p, float roughness, uint32_t octaves) {
  return HWY_DYNAMIC_DISPATCH(turbulence_at)(p, roughness, octaves);
}

}  // namespace metamer
#endif
