// What the BSDF kernels of all kinds do around their BSDF: the shading frame, the light sample's way into the shadow
// stream, the next direction's way into the shading stream.
#if defined(METAMER_SYSTEMS_SHADE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_SHADE_INL_H_
#undef METAMER_SYSTEMS_SHADE_INL_H_
#else
#define METAMER_SYSTEMS_SHADE_INL_H_
#endif

#include "engine/sampling/points-inl.h"
#include "engine/spectrum/spectrum-inl.h"
#include "systems/bsdf/fresnel-inl.h"
#include "systems/bsdf/limits.h"
#include "systems/bsdf/local-inl.h"
#include "systems/dimensions.h"
#include "systems/lanes-inl.h"
#include "systems/lights-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Any frame around the shading normal will do for isotropic materials; anisotropic ones measure along the tangent.
HWY_INLINE Frame shading_frame(const World& world, const ShadeStream& shade, size_t i) {
  const Vec3 n = load(shade.shading_normal, i);
  const Frame any = make_frame(n);
  if (!world.needs_tangents) return any;
  const Vec3 tangent = load(shade.tangent, i);
  const Vec3 across = tangent - n * dot(n, tangent);
  const VF length2 = dot(across, across);
  const MF known = hn::Gt(length2, splat(1e-30f));
  const Vec3 s = across * hn::Div(splat(1.0f), hn::Sqrt(hn::Max(length2, splat(1e-30f))));
  return {if_then_else(known, s, any.s), if_then_else(known, cross(n, s), any.t), n};
}

// Where a ray in `direction` starts: off the surface, on the direction's side of it.
HWY_INLINE Vec3 ray_origin(const ShadeStream& shade, size_t i, const Vec3& direction) {
  const Vec3 normal = load(shade.normal, i);
  const VF offset = hn::CopySign(load(shade.offset, i), dot(normal, direction));
  return mul_add(normal, offset, load(shade.position, i));
}

// What a ray in `direction` is in: the volume of that side of the surface.
HWY_INLINE VU volume_towards(const ShadeStream& shade, size_t i, const Vec3& direction) {
  const MF outwards = hn::Gt(dot(direction, load(shade.normal, i)), hn::Zero(FloatTag()));
  return hn::IfThenElse(uint_mask(outwards), load(shade.volumes[1], i), load(shade.volumes[0], i));
}

// The light sample's share against the BSDF's chance to have found the light (power heuristic; lights of pdf 0 it
// cannot find).
HWY_INLINE VF light_sample_weight(const ShadeStream& shade, size_t i, VF pdf_bsdf) {
  const VF light_pdf = load(shade.light_pdf, i);
  const MF can_be_found = hn::Gt(light_pdf, hn::Zero(FloatTag()));
  return hn::IfThenElse(can_be_found, power_heuristic(light_pdf, pdf_bsdf), splat(1.0f));
}

// Appends the light sample of lanes that let some of it go to the viewer; `weight` is the sample's share.
HWY_INLINE void append_weighted_shadow_rays(const ShadeStream& shade, size_t i, const VF f_cos[4], const VF weight[4],
                                            ShadowStream& shadow) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  VF contribution[4];
  for (size_t j = 0; j < 4; ++j)
    contribution[j] =
        hn::Mul(hn::Mul(load(shade.throughput[j], i), load(shade.light_radiance[j], i)), hn::Mul(f_cos[j], weight[j]));
  Vec3 direction = load(shade.light_direction, i);
  const Vec3 origin = ray_origin(shade, i, direction);
  // Aimed anew from where the ray starts: on a wide plane that is far enough off to matter to a lamp close by.
  VF distance = load(shade.light_distance, i);
  const Vec3 to_light = load(shade.position, i) - origin + direction * distance;
  const VF length = hn::Sqrt(dot(to_light, to_light));
  const MF near = hn::Lt(distance, hn::Inf(FloatTag()));
  direction = if_then_else(near, to_light * hn::Div(one, length), direction);
  distance = hn::IfThenElse(near, length, distance);
  const VF t_far = hn::Mul(distance, splat(shadow_ray_share));
  // Throughput is 0 in dead lanes.
  const MF lit = hn::And(is_live(load(shade.slot, i)), hn::Gt(max_of(contribution), zero));
  const MF counts = hn::And(lit, hn::And(is_traceable(origin, direction), hn::Gt(t_far, zero)));
  append(counts, origin, shadow.origin, shadow.size);
  append(counts, direction, shadow.direction, shadow.size);
  append(counts, t_far, shadow.t_far, shadow.size);
  append(counts, contribution, shadow.contribution, shadow.size);
  append(counts, load(shade.slot, i), shadow.slot, shadow.size);
  if (shade.carries_volumes) {
    VF lambda_nm[4];
    load(shade.lambda_nm, i, lambda_nm);
    append(counts, lambda_nm, shadow.lambda_nm, shadow.size);
    append(counts, volume_towards(shade, i, direction), shadow.volume, shadow.size);
  }
  if (shade.carries_keys) {
    append(counts, load(shade.pixel_seed, i), shadow.pixel_seed, shadow.size);
    append(counts, load(shade.index, i), shadow.index, shadow.size);
  }
  if (shade.carries_time) append(counts, load(shade.time, i), shadow.time, shadow.size);
  shadow.size += static_cast<uint32_t>(hn::CountTrue(FloatTag(), counts));
}
HWY_INLINE void append_shadow_rays(const ShadeStream& shade, size_t i, const VF f_cos[4], VF pdf_bsdf,
                                   ShadowStream& shadow) {
  const VF one = light_sample_weight(shade, i, pdf_bsdf);
  const VF weight[4] = {one, one, one, one};
  append_weighted_shadow_rays(shade, i, f_cos, weight, shadow);
}
// Where each wavelength has its own chance.
HWY_INLINE void append_shadow_rays(const ShadeStream& shade, size_t i, const VF f_cos[4], const VF pdf_bsdf[4],
                                   ShadowStream& shadow) {
  VF weight[4];
  for (int j = 0; j < 4; ++j) weight[j] = light_sample_weight(shade, i, pdf_bsdf[j]);
  append_weighted_shadow_rays(shade, i, f_cos, weight, shadow);
}

// The next direction, in world space; `pdf` 0 for a delta lobe.
HWY_INLINE void store_next(const Frame& frame, const Vec3& wi, const VF weight[4], VF pdf, ShadeStream& shade,
                           size_t i) {
  store(to_world(frame, wi), shade.next_direction, i);
  store(weight, shade.next_weight, i);
  store(pdf, shade.next_pdf, i);
}

// The next direction of a smooth surface, a delta lobe, in world space.
HWY_INLINE void store_delta(const Vec3& direction, const VF weight[4], ShadeStream& shade, size_t i) {
  store(direction, shade.next_direction, i);
  store(weight, shade.next_weight, i);
  store(hn::Zero(FloatTag()), shade.next_pdf, i);
  store(splat(1.0f), shade.next_eta_scale, i);
}

HWY_INLINE const Group& group_of(const ShadeStream& shade, ShadeKind kind) {
  return shade.groups[static_cast<size_t>(kind)];
}
HWY_INLINE PointKey point_key(const ShadeStream& shade, size_t i) {
  return {load(shade.pixel_seed, i), load(shade.index, i)};
}
// What the path carries behind this vertex.
HWY_INLINE void next_throughput(const ShadeStream& shade, size_t i, VF out[4]) {
  for (size_t j = 0; j < 4; ++j) out[j] = hn::Mul(load(shade.throughput[j], i), load(shade.next_weight[j], i));
}
HWY_INLINE VF next_eta_scale(const ShadeStream& shade, size_t i) {
  return hn::Mul(load(shade.eta_scale, i), load(shade.next_eta_scale, i));
}
// Appends the rays of `mask` to a stream with all that goes along with the path.
struct NextRay {
  Vec3 origin, direction;
};
HWY_INLINE void append_ray(MF mask, const ShadeStream& shade, size_t i, const NextRay& ray, const VF throughput[4],
                           PathStream& next) {
  if (hn::AllFalse(FloatTag(), mask)) return;
  const size_t at = next.size;
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  append(mask, ray.origin, next.origin, at);
  append(mask, ray.direction, next.direction, at);
  append(mask, lambda_nm, next.lambda_nm, at);
  append(mask, throughput, next.throughput, at);
  append(mask, load(shade.next_pdf, i), next.pdf_direction, at);
  append(mask, next_eta_scale(shade, i), next.eta_scale, at);
  append(mask, load(shade.pixel_seed, i), next.pixel_seed, at);
  append(mask, load(shade.index, i), next.index, at);
  append(mask, load(shade.slot, i), next.slot, at);
  if (shade.carries_time) append(mask, load(shade.time, i), next.time, at);
  if (shade.carries_media)
    for (size_t k = 0; k < 2; ++k) append(mask, load(shade.next_media[k], i), next.media[k], at);
  if (shade.carries_volumes) append(mask, volume_towards(shade, i, ray.direction), next.volume, at);
  if (shade.carries_shares)
    for (size_t j = 0; j < 4; ++j) append(mask, load(shade.share[j], i), next.share[j], at);
  next.size += static_cast<uint32_t>(hn::CountTrue(FloatTag(), mask));
}

// The wavelength that decides where the others of `branch` go.
HWY_INLINE size_t leading_wavelength(Branch branch) {
  return branch < Branch::refracted_0 ? 0 : static_cast<size_t>(branch) - static_cast<size_t>(Branch::refracted_0);
}
// What a smooth kind draws its lobe with, reflection below the probability of reflection: by chance, or so that it is
// the lobe wanted if there is one.
HWY_INLINE VF branch_number(const ShadeStream& shade, size_t i, uint32_t depth, Branch branch) {
  if (branch == Branch::drawn) return sample_1d(point_key(shade, i), splat_u(bounce_dimension(depth, lobe_dimension)));
  return splat(branch == Branch::reflected ? 0.0f : 0x1.fffffep-1f);
}
// From the weights of the lobe that came of it to those of the branch: without the division by its probability, and 0
// where it is another lobe. `disperses`: the wavelengths of these lanes part in refraction.
HWY_INLINE void keep_branch(Branch branch, MF disperses, MF transmitted, VF probability, VF weight[4]) {
  if (branch == Branch::drawn) return;
  MF kept = hn::And(transmitted, disperses);
  if (branch == Branch::refracted) kept = hn::AndNot(disperses, transmitted);
  if (branch == Branch::reflected) kept = hn::Not(transmitted);
  for (size_t j = 0; j < 4; ++j) {
    const bool goes = branch <= Branch::refracted || j == leading_wavelength(branch);
    weight[j] = goes ? hn::IfThenElseZero(kept, hn::Mul(weight[j], probability)) : hn::Zero(FloatTag());
  }
}

// The material row of live lanes, 0 in dead ones.
HWY_INLINE VI material_row(const ShadeStream& shade, size_t i) {
  const auto live = hn::Ne(load(shade.slot, i), splat_u(dead_lane));
  return as_index(hn::IfThenElseZero(live, load(shade.material, i)));
}

// The reflectance of each lane's material: of spectrum `ids[row]`, or what `textures` made of program `programs[row]`
// and left in `made`.
HWY_INLINE void lane_reflectance(const World& world, const Column<uint32_t>& ids, const Column<uint32_t>& programs,
                                 const Columns<float, 4>& made, VI row, const ShadeStream& shade, size_t i, VF out[4]) {
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  eval_spectrum4(world.spectra.view(), gather(ids.data(), row), lambda_nm, out);
  if (!world.has_textures()) return;
  const MF textured = float_mask(hn::Ne(gather(programs.data(), row), splat_u(no_index)));
  for (size_t j = 0; j < 4; ++j) out[j] = hn::IfThenElse(textured, load(made[j], i), out[j]);
}
HWY_INLINE void lane_reflectance(const World& world, const Column<uint32_t>& ids, const Column<uint32_t>& programs,
                                 VI row, const ShadeStream& shade, size_t i, VF out[4]) {
  lane_reflectance(world, ids, programs, shade.reflectance, row, shade, i, out);
}

// Of the metal of eta 1 that reflects so much along the normal: 2 sqrt(R) / sqrt(1 - R), as in pbrt-v4.
HWY_INLINE VF kappa_of_reflectance(VF reflectance) {
  const VF r = hn::Min(hn::Max(reflectance, hn::Zero(FloatTag())), splat(0.9999f));
  return hn::Mul(splat(2.0f), hn::Sqrt(hn::Div(r, hn::Sub(splat(1.0f), r))));
}

// A GGX width of each lane's material: a number of its row, or what `textures` made of program `programs[row]`.
HWY_INLINE VF lane_alpha(const World& world, const Column<float>& alphas, const Column<uint32_t>& programs, VI row,
                         const float* textured_alpha, size_t i) {
  const VF alpha = gather(alphas.data(), row);
  if (!world.has_textured_alpha) return alpha;
  const MF textured = float_mask(hn::Ne(gather(programs.data(), row), splat_u(no_index)));
  return hn::IfThenElse(textured, hn::Max(load(textured_alpha, i), splat(least_alpha)), alpha);
}

// What a lobe is drawn with, all in [0, 1): `choice` for which of its parts, u and v for the direction.
struct Draw {
  VF choice, u, v;
};
HWY_INLINE Draw draw_of(uint32_t depth, const ShadeStream& shade, size_t i) {
  const PointKey key = point_key(shade, i);
  Draw draw;
  draw.choice = sample_1d(key, splat_u(bounce_dimension(depth, lobe_dimension)));
  sample_2d(key, splat_u(bounce_dimension(depth, direction_dimension)), &draw.u, &draw.v);
  return draw;
}

// The loop of the kinds that spread light over directions around the shading normal and let none through to where it
// is refracted. `make_lobe(i, wo)` is the BSDF of lanes i ... seen from `wo` in the shading frame. It has
//   void eval(const Vec3& wi, VF f_cos[4], VF& pdf)   its answer to light from wi, and how likely it draws wi
//   BsdfSample sample(const Draw&)                    pdf 0: a delta lobe
template <typename MakeLobe>
HWY_INLINE void shade_spreading(const World& world, ShadeKind kind, const ShadeWork& work, ShadeStream& shade,
                                ShadowStream& shadow, const MakeLobe& make_lobe) {
  const Group& group = group_of(shade, kind);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const Frame frame = shading_frame(world, shade, i);
    const auto lobe = make_lobe(i, to_local(frame, load(shade.wo, i)));
    if (work.weigh_light) {
      VF f_cos[4], pdf;
      lobe.eval(to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const BsdfSample next = lobe.sample(draw_of(work.depth, shade, i));
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

// The loop of smooth surfaces' mirror images. `reflect_at(i, cos_theta, weight)` fills what of the light is mirrored.
template <typename ReflectAt>
HWY_INLINE void shade_mirror(ShadeKind kind, ShadeStream& shade, const ReflectAt& reflect_at) {
  const Group& group = group_of(shade, kind);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const Vec3 wo = load(shade.wo, i), normal = load(shade.shading_normal, i);
    VF weight[4];
    reflect_at(i, hn::Abs(dot(wo, normal)), weight);
    store_delta(reflect(-wo, normal), weight, shade, i);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
