// Samples of lights, and those of lights that are a point: there is one direction to them, and nothing runs into them.
#if defined(METAMER_SYSTEMS_POSITIONAL_LIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_POSITIONAL_LIGHTS_INL_H_
#undef METAMER_SYSTEMS_POSITIONAL_LIGHTS_INL_H_
#else
#define METAMER_SYSTEMS_POSITIONAL_LIGHTS_INL_H_
#endif

#include "systems/lights-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// A direction towards a light. pdf is per solid angle without the choice of the light; for point, spot and directional
// lights it is 0 and `weight` the irradiance per radiance unit they stand for (1 / d^2, 1).
struct LightSample {
  Vec3 direction;
  VF distance, pdf, weight;
  VF image_u, image_v;  // only of lights with an image
};

HWY_INLINE void sample_point_light(const LightFields& light, const Vec3& from, LightSample& sample) {
  const Vec3 to_light = light.vector(offsetof(LightRow, p)) - from;
  const VF distance2 = hn::Max(dot(to_light, to_light), splat(1e-30f));
  sample.distance = hn::Sqrt(distance2);
  sample.direction = to_light * hn::Div(splat(1.0f), sample.distance);
  sample.pdf = hn::Zero(FloatTag());
  sample.weight = hn::Div(splat(1.0f), distance2);
}

HWY_INLINE void sample_spot(const LightFields& light, const Vec3& from, LightSample& sample) {
  sample_point_light(light, from, sample);
  sample.weight = hn::Mul(sample.weight, spot_falloff(light, -sample.direction));
}

HWY_INLINE void sample_image_light(const LightFields& light, VU shape, const Vec3& from, LightSample& sample) {
  sample_point_light(light, from, sample);
  const LightImagePoint sphere = goniometric_point(light, -sample.direction);
  const LightImagePoint window = projection_point(light, -sample.direction);
  const MF throws = is_shape(shape, LightShape::projection);
  sample.image_u = hn::IfThenElse(throws, window.u, sphere.u);
  sample.image_v = hn::IfThenElse(throws, window.v, sphere.v);
  sample.weight = hn::IfThenZeroElse(hn::AndNot(window.inside, throws), sample.weight);
}

// The same of whichever kind they are.
HWY_INLINE LightSample sample_positional(const LightFields& light, const Vec3& from) {
  const FloatTag d;
  const VF zero = hn::Zero(d);
  LightSample sample{{zero, zero, zero}, zero, zero, zero, zero, zero};
  sample_image_light(light, light.word(offsetof(LightRow, shape)), from, sample);
  const VU shape = light.word(offsetof(LightRow, shape));
  const MF image = hn::Or(is_shape(shape, LightShape::goniometric), is_shape(shape, LightShape::projection));
  const MF spot = is_shape(shape, LightShape::spot);
  const VF plain = hn::Div(splat(1.0f), hn::Mul(sample.distance, sample.distance));
  const VF cone = hn::IfThenElse(spot, spot_falloff(light, -sample.direction), splat(1.0f));
  sample.weight = hn::IfThenElse(image, sample.weight, hn::Mul(plain, cone));
  return sample;
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
