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
  const auto is_textured = [&](const Column<uint32_t>& programs) {
    return float_mask(hn::Ne(gather(programs.data(), row), splat_u(no_index)));
  };
  const auto varying = [&](const Column<float>& column, const Column<uint32_t>& programs, const float* made) {
    const VF value = number(column);
    return world.has_textured_layers ? hn::IfThenElse(is_textured(programs), load(made, i), value) : value;
  };
  // Two widths of which a texture made one: as in build_layered.cpp.
  const auto widths = [&](VF& x, VF& y) {
    if (!world.has_textured_layers) return;
    const MF rough = hn::Ge(hn::Max(x, y), smooth);
    x = hn::IfThenElseZero(rough, hn::Max(x, splat(least_alpha)));
    y = hn::IfThenElseZero(rough, hn::Max(y, splat(least_alpha)));
  };
  LayeredOptics o;
  o.eta = number(table.eta);
  o.alpha_x = varying(table.alpha_x, table.alpha_texture[0], shade.alpha[0]);
  o.alpha_y = varying(table.alpha_y, table.alpha_texture[1], shade.alpha[1]);
  widths(o.alpha_x, o.alpha_y);
  o.smooth_surface = hn::Lt(hn::Max(o.alpha_x, o.alpha_y), smooth);
  o.thickness = hn::Max(varying(table.thickness, table.thickness_texture, shade.thickness), hn::Zero(FloatTag()));
  o.asymmetry = varying(table.asymmetry, table.asymmetry_texture, shade.asymmetry);
  if (world.has_textured_layers) o.asymmetry = clamp(o.asymmetry, -0.9999f, 0.9999f);
  o.max_depth = number(table.max_depth);
  o.walks = number(table.walks);
  o.conductor = is_set(table.conductor);
  o.scatters = is_set(table.scatters);
  eval_spectrum4(spectra, gather(table.albedo.data(), row), lambda_nm, o.albedo);
  lane_reflectance(world, table.reflectance, table.texture, row, shade, i, o.reflectance);
  eval_spectrum4(spectra, gather(table.base_eta.data(), row), lambda_nm, o.metal.n);
  eval_spectrum4(spectra, gather(table.base_kappa.data(), row), lambda_nm, o.metal.kappa);
  if (world.has_textured_layers) {
    const MF textured = is_textured(table.albedo_texture);
    for (int j = 0; j < 4; ++j)
      o.albedo[j] = hn::IfThenElse(textured, load(shade.transmittance[static_cast<size_t>(j)], i), o.albedo[j]);
    o.scatters = hn::Or(hn::AndNot(textured, o.scatters), hn::And(textured, hn::Gt(max_of(o.albedo), splat(0.0f))));
  }
  if (world.has_textures()) {
    const MF textured = hn::And(o.conductor, is_textured(table.texture));
    for (int j = 0; j < 4; ++j) {
      o.metal.n[j] = hn::IfThenElse(textured, splat(1.0f), o.metal.n[j]);
      o.metal.kappa[j] = hn::IfThenElse(textured, kappa_of_reflectance(o.reflectance[j]), o.metal.kappa[j]);
    }
  }
  const VF inv_eta = hn::Div(splat(1.0f), o.eta);
  for (int j = 0; j < 4; ++j) {
    o.metal.n[j] = hn::Mul(o.metal.n[j], inv_eta);
    o.metal.kappa[j] = hn::Mul(o.metal.kappa[j], inv_eta);
  }
  o.metal.schlick = hn::Lt(o.eta, hn::Zero(FloatTag()));
  o.base_alpha_x = varying(table.base_alpha_x, table.base_alpha_texture[0], shade.base_alpha[0]);
  o.base_alpha_y = varying(table.base_alpha_y, table.base_alpha_texture[1], shade.base_alpha[1]);
  widths(o.base_alpha_x, o.base_alpha_y);
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
