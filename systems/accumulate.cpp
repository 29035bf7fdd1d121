#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/accumulate.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/spectrum/spectrum-inl.h"
#include "engine/spectrum/wavelengths.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// X = 683 integral of L xbar d(lambda), estimated by the mean over a path's wavelengths of L xbar / p. X, Y and Z
// overwrite the first three columns of the radiances, which end here.
void accumulate_kernel(const World& world, Slots& slots) {
  const float* observer = observer_table(Observer::cie1931).columns.data();
  const VF scale = splat(static_cast<float>(luminous_efficacy / wavelengths_per_path) * world.settings.sensor_scale);
  for (size_t i = 0; i < slots.size; i += lane_count()) {
    VF sum[3] = {hn::Zero(FloatTag()), hn::Zero(FloatTag()), hn::Zero(FloatTag())};
    for (size_t j = 0; j < 4; ++j) {
      VF matching[3];
      observer_xyz(observer, load(slots.lambda_nm[j], i), matching);
      const VF weight = hn::Mul(load(slots.radiance[j], i), load(slots.inv_pdf_nm[j], i));
      for (size_t c = 0; c < 3; ++c) sum[c] = hn::MulAdd(weight, matching[c], sum[c]);
    }
    for (size_t c = 0; c < 3; ++c) store(hn::Mul(sum[c], scale), slots.radiance[c], i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(accumulate_kernel);

void accumulate(const World& world, Slots& slots, TileFilm& film) {
  HWY_DYNAMIC_DISPATCH(accumulate_kernel)(world, slots);
  uint8_t live[batch_capacity];
  for (uint32_t i = 0; i < slots.size; ++i) live[i] = slots.pixel[i] != dead_lane;
  add_samples(film, {slots.pixel, slots.size}, {slots.sample, slots.size}, slots.radiance[0], slots.radiance[1],
              slots.radiance[2], {live, slots.size});
}

}  // namespace metamer
#endif
