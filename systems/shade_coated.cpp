#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/shade_coated.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/bsdf/coated-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE CoatOptics coat_optics(const World& world, const CoatedColumns& table, const ShadeStream& shade, size_t i,
                                  VI row) {
  const SpectrumView spectra = world.spectra.view();
  VF lambda_nm[4];
  load(shade.lambda_nm, i, lambda_nm);
  CoatOptics optics;
  lane_reflectance(world, table.reflectance, table.texture, row, shade, i, optics.albedo);
  eval_spectrum4(spectra, gather(table.eta.data(), row), lambda_nm, optics.eta);
  optics.schlick = float_mask(hn::Ne(gather(table.schlick.data(), row), splat_u(0)));
  optics.thickness = gather(table.thickness.data(), row);
  optics.hits = gather(table.hits.data(), row);
  optics.table = table.albedos.data();
  optics.rows = {as_index(gather(table.first_row.data(), row)), as_index(gather(table.row_stride.data(), row)),
                 as_index(gather(table.last_pair.data(), row)), gather(table.eta_least.data(), row),
                 gather(table.rows_per_eta.data(), row)};
  return optics;
}

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

void shade_smooth_coated_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const VF zero = hn::Zero(FloatTag());
  const Group& group = group_of(shade, ShadeKind::smooth_coated);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const CoatOptics optics = coat_optics(world, world.smooth_coated, shade, i, material_row(shade, i));
    const Frame frame = shading_frame(world, shade, i);
    const Vec3 wo = to_local(frame, load(shade.wo, i));
    CoatView view = make_smooth_coat_view(wo, optics);
    if (!work.draw_mirror) view.surface_share = zero;
    VF f_cos[4], pdf;
    if (work.weigh_light) {
      eval_smooth_coat(wo, view, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const Draw draw = draw_of(work.depth, shade, i);
    const CoatSample next = sample_smooth_coat(wo, view, optics, draw.choice, draw.u, draw.v);
    // Lights that the mirror shows cannot be sampled.
    const VF next_pdf = hn::IfThenZeroElse(next.mirrored, next.draw.pdf);
    store_next(frame, next.draw.wi, next.draw.weight, next_pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

void shade_coat_mirror_kernel(const World& world, ShadeStream& shade) {
  const Group& group = group_of(shade, ShadeKind::smooth_coated);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const CoatOptics optics = coat_optics(world, world.smooth_coated, shade, i, material_row(shade, i));
    const Vec3 wo = load(shade.wo, i), normal = load(shade.shading_normal, i);
    VF weight[4];
    coat_reflectance(optics, hn::Abs(dot(wo, normal)), weight);
    store(reflect(-wo, normal), shade.next_direction, i);
    store(weight, shade.next_weight, i);
    store(hn::Zero(FloatTag()), shade.next_pdf, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

void shade_rough_coated_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  const Group& group = group_of(shade, ShadeKind::rough_coated);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) {
    const VI row = material_row(shade, i);
    const CoatOptics optics = coat_optics(world, world.rough_coated, shade, i, row);
    const VF alpha_x = gather(world.rough_coated.alpha_x.data(), row);
    const VF alpha_y = gather(world.rough_coated.alpha_y.data(), row);
    const Frame frame = shading_frame(world, shade, i);
    const GgxLobe lobe = make_ggx_lobe(to_local(frame, load(shade.wo, i)), alpha_x, alpha_y);
    const CoatView view = make_rough_coat_view(lobe, optics);
    VF f_cos[4], pdf;
    if (work.weigh_light) {
      eval_rough_coat(lobe, view, optics, to_local(frame, load(shade.light_direction, i)), f_cos, pdf);
      append_shadow_rays(shade, i, f_cos, pdf, shadow);
    }
    if (!work.draw_next) continue;
    const Draw draw = draw_of(work.depth, shade, i);
    const BsdfSample next = sample_rough_coat(lobe, view, optics, draw.choice, draw.u, draw.v);
    store_next(frame, next.wi, next.weight, next.pdf, shade, i);
    store(splat(1.0f), shade.next_eta_scale, i);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(shade_smooth_coated_kernel);
HWY_EXPORT(shade_coat_mirror_kernel);
HWY_EXPORT(shade_rough_coated_kernel);

void shade_smooth_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_smooth_coated_kernel)(world, work, shade, shadow);
}

void shade_coat_mirror(const World& world, ShadeStream& shade) {
  HWY_DYNAMIC_DISPATCH(shade_coat_mirror_kernel)(world, shade);
}

void shade_rough_coated(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  HWY_DYNAMIC_DISPATCH(shade_rough_coated_kernel)(world, work, shade, shadow);
}

}  // namespace metamer
#endif
