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

// Its functions are called once per vector and not made part of the loop: they are long.
struct LayeredLobe {
  LayeredOptics optics;
  LayeredView view;
  VU seeds[2];  // of walks to the light, and of walks that choose the next direction
  HWY_NOINLINE void eval(const Vec3& wi, VF f_cos[4], VF& pdf) const {
    eval_layered(view, optics, wi, seeds[0], f_cos, pdf);
  }
  HWY_NOINLINE BsdfSample sample(const Draw& draw) const {
    return sample_layered(view, optics, draw.choice, draw.u, draw.v, seeds[1]);
  }
};

void shade_layered_kernel(const World& world, const ShadeWork& work, ShadeStream& shade, ShadowStream& shadow) {
  shade_spreading(world, ShadeKind::layered, work, shade, shadow, [&](size_t i, const Vec3& wo) HWY_ATTR {
    LayeredLobe lobe;
    lobe.optics = layered_optics(world, shade, i);
    lobe.view = make_layered_view(wo, lobe.optics, work.draw_mirror);
    for (uint32_t purpose = 0; purpose < 2; ++purpose) lobe.seeds[purpose] = walk_seed(shade, i, work.depth, purpose);
    return lobe;
  });
}

void shade_layered_mirror_kernel(const World& world, ShadeStream& shade) {
  shade_mirror(ShadeKind::layered, shade, [&](size_t i, VF cos_theta, VF weight[4]) HWY_ATTR {
    layered_mirror(layered_optics(world, shade, i), cos_theta, weight);
  });
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
