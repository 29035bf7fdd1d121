#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_layered.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/layered-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE LayeredOptics layered_optics(const World& world, const ShadeStream& shade, size_t i) {
  const LayeredColumns& table = world.layered;
  const SpectrumView spectra = world.spectra.view();
  const VI row = material_row(shade, i);
  const VF smooth = splat(smooth_alpha);
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  const auto number = [&](const Column<float>& column) { return gather(column.data(), row); };
  const auto is_set = [&](const Column<uint32_t>& column) {
    return float_mask(hn::Ne(gather(column.data(), row), splat_u(0)));
  };
  LayeredOptics o;
  o.eta = number(table.eta);
  o.alpha_x = number(table.alpha_x);
  o.alpha_y = number(table.alpha_y);
  o.smooth_surface = hn::Lt(hn::Max(o.alpha_x, o.alpha_y), smooth);
  o.thickness = number(table.thickness);
  o.asymmetry = number(table.asymmetry);
  o.max_depth = number(table.max_depth);
  o.walks = number(table.walks);
  o.conductor = is_set(table.conductor);
  o.scatters = is_set(table.scatters);
  eval_spectrum4(spectra, gather(table.albedo.data(), row), lambda_nm, o.albedo);
  lane_reflectance(world, table.reflectance, table.texture, row, shade, i, o.reflectance);
  eval_spectrum4(spectra, gather(table.base_eta.data(), row), lambda_nm, o.metal.n);
  eval_spectrum4(spectra, gather(table.base_kappa.data(), row), lambda_nm, o.metal.kappa);
  const VF inv_eta = hn::Div(splat(1.0f), o.eta);
  for (int j = 0; j < 4; ++j) {
    o.metal.n[j] = hn::Mul(o.metal.n[j], inv_eta);
    o.metal.kappa[j] = hn::Mul(o.metal.kappa[j], inv_eta);
  }
  o.metal.schlick = hn::Lt(o.eta, hn::Zero(FloatTag()));
  o.base_alpha_x = number(table.base_alpha_x);
  o.base_alpha_y = number(table.base_alpha_y);
  o.smooth_base = hn::And(o.conductor, hn::Lt(hn::Max(o.base_alpha_x, o.base_alpha_y), smooth));
  return o;
}

// Of the vertex, and of what the number is for.
HWY_INLINE VU walk_seed(const ShadeStream& shade, size_t i, uint32_t depth, uint32_t purpose) {
  const VU path = hash_combine(load(shade.pixel_seed, i), load(shade.index, i));
  return hash_combine(path, splat_u(2 * bounce_dimension(depth, lobe_dimension) + purpose));
}

// The functions are called once per vector and not made part of the loop: they are long.
HWY_NOINLINE void weigh_light(const LayeredView& view, const LayeredOptics& optics, const Frame& frame, uint32_t depth,
                              const ShadeStream& shade, size_t i, ShadowStream& shadow) {
  VF f_cos[4], pdf;
  eval_layered(view, optics, to_local(frame, load(shade.light_direction, i)), walk_seed(shade, i, depth, 0), f_cos,
               pdf);
  append_shadow_rays(shade, i, f_cos, pdf, shadow);
}
HWY_NOINLINE void draw_next(const LayeredView& view, const LayeredOptics& optics, const Frame& frame, uint32_t depth,
                            ShadeStream& shade, size_t i) {
  const PointKey key = point_key(shade, i);
  const VF choice = sample_1d(key, splat_u(bounce_dimension(depth, lobe_dimension)));
  VF u, v;
  sample_2d(key, splat_u(bounce_dimension(depth, direction_dimension)), &u, &v);
  const BsdfSample next = sample_layered(view, optics, choice, u, v, walk_seed(shade, i, depth, 1));
  store_next(frame, next.wi, next.weight, next.pdf, shade, i);
  store(splat(1.0f), shade.next_eta_scale, i);
}

void shade_layered_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::layered);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const LayeredOptics optics = layered_optics(world, shade, i);
    const Frame frame = shading_frame(world, shade, i);
    const LayeredView view = make_layered_view(to_local(frame, load(shade.wo, i)), optics, work.draw_mirror);
    if (work.weigh_light) weigh_light(view, optics, frame, work.depth, shade, i, shadow);
    if (work.draw_next) draw_next(view, optics, frame, work.depth, shade, i);
  }
}

void shade_layered_mirror_kernel(const World& world, ShadeStream& shade) {
  const Group& group = group_of(shade, ShadeKind::layered);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const LayeredOptics optics = layered_optics(world, shade, i);
    const Vec3 wo = load(shade.wo, i), normal = load(shade.shading_normal, i);
    VF weight[4];
    layered_mirror(optics, hn::Abs(dot(wo, normal)), weight);
    store(reflect(-wo, normal), shade.next_direction, i);
    store(weight, shade.next_weight, i);
    store(hn::Zero(FloatTag()), shade.next_pdf, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_layered_kernel);
HWY_EXPORT(shade_layered_mirror_kernel);

void shade_layered(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_layered_kernel)(world, work, shade, shadow);
}

void shade_layered_mirror(const World& world, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_layered_mirror_kernel)(world, shade);
}

}  // namespace metamer
#endif
