// Images as factors on lights' spectra, each lane with an image of its own.
#if defined(METAMER_SYSTEMS_LIGHT_IMAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_LIGHT_IMAGE_INL_H_
#undef METAMER_SYSTEMS_LIGHT_IMAGE_INL_H_
#else
#define METAMER_SYSTEMS_LIGHT_IMAGE_INL_H_
#endif

#include "engine/spectrum/spectrum-inl.h"
#include "systems/lanes-inl.h"
#include "systems/systems.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

namespace light_image_detail {

struct Fields {
  VI first_texel, width, height;
  VU lookup;
  HWY_INLINE Fields(const LightImages& images, VI image) {
    const VI row = hn::ShiftLeft<3>(image);
    const auto* base = reinterpret_cast<const uint32_t*>(images.rows.data());
    const auto field = [&](size_t offset) { return gather(base + offset / sizeof(uint32_t), row); };
    first_texel = as_index(field(offsetof(LightImage, first_texel)));
    width = as_index(field(offsetof(LightImage, width)));
    height = as_index(field(offsetof(LightImage, height)));
    lookup = field(offsetof(LightImage, lookup));
  }
};

// factor += weight times the spectrum of a texel.
HWY_INLINE void add_texel(const LightImages& images, const Fields& image, VI column, VI row, VF weight,
                          const VF lambda_nm[4], VF factor[4]) {
  const VI texel = hn::Add(image.first_texel, hn::Add(hn::Mul(row, image.width), column));
  const VI at = hn::ShiftLeft<2>(texel);
  const float* texels = images.texels.data();
  if (images.has_coefficients) {
    for (int j = 0; j < 4; ++j)
      factor[j] = hn::MulAdd(weight, gather(texels, hn::Add(at, channel_of(lambda_nm[j]))), factor[j]);
    return;
  }
  const VF c0 = gather(texels, at), c1 = gather(texels + 1, at), c2 = gather(texels + 2, at);
  const VF scale = hn::Mul(weight, gather(texels + 3, at));
  for (int j = 0; j < 4; ++j) factor[j] = hn::MulAdd(scale, sigmoid_polynomial(c0, c1, c2, lambda_nm[j]), factor[j]);
}

}  // namespace light_image_detail

// The image in row `image` of each lane at (u, v) of its unit square, v down; see ImageLookup. The density of
// directions stays constant on a texel: where a dark texel next to a bright one is never chosen, rays of the BSDF find
// its light with full weight.
HWY_INLINE void light_image(const LightImages& images, VI image, VF u, VF v, const VF lambda_nm[4], VF factor[4]) {
  using namespace light_image_detail;
  const IntTag di;
  const FloatTag d;
  const Fields fields(images, image);
  const VI one = hn::Set(di, 1), zero = hn::Zero(di);
  const VI last_column = hn::Sub(fields.width, one), last_row = hn::Sub(fields.height, one);
  const VF x = hn::Mul(u, hn::ConvertTo(d, fields.width)), y = hn::Mul(v, hn::ConvertTo(d, fields.height));
  for (int j = 0; j < 4; ++j) factor[j] = hn::Zero(d);
  const auto within = [&](VI at, VI last) { return hn::Max(hn::Min(at, last), zero); };
  const VI nearest_column = within(hn::ConvertTo(di, x), last_column),
           nearest_row = within(hn::ConvertTo(di, y), last_row);
  const MF nearest = float_mask(hn::Eq(fields.lookup, splat_u(static_cast<uint32_t>(ImageLookup::nearest))));
  const VF all = splat(1.0f), half = splat(0.5f);
  if (hn::AllTrue(d, nearest)) {
    add_texel(images, fields, nearest_column, nearest_row, all, lambda_nm, factor);
    return;
  }
  // Lanes that take the nearest texel give it all the weight.
  const auto around =
      hn::RebindMask(di, hn::Eq(fields.lookup, splat_u(static_cast<uint32_t>(ImageLookup::linear_around))));
  const VF x_floor = hn::Floor(hn::Sub(x, half)), y_floor = hn::Floor(hn::Sub(y, half));
  const VF right = hn::IfThenZeroElse(nearest, hn::Sub(hn::Sub(x, half), x_floor));
  const VF lower = hn::IfThenZeroElse(nearest, hn::Sub(hn::Sub(y, half), y_floor));
  const VI left = hn::ConvertTo(di, x_floor), top = hn::ConvertTo(di, y_floor);
  const auto exact = hn::RebindMask(di, nearest);
  const VI past_left = hn::IfThenElse(around, last_column, zero),
           past_right = hn::IfThenElse(around, zero, last_column);
  VI column0 = hn::IfThenElse(hn::Lt(left, zero), past_left, hn::Min(left, last_column));
  const VI column1 = hn::IfThenElse(hn::Lt(left, last_column), hn::Add(left, one), past_right);
  column0 = hn::IfThenElse(exact, nearest_column, column0);
  const VI row0 = hn::IfThenElse(exact, nearest_row, within(top, last_row)), row1 = within(hn::Add(top, one), last_row);
  const VF left_share = hn::Sub(all, right), upper_share = hn::Sub(all, lower);
  const VI safe_column1 = within(column1, last_column);
  add_texel(images, fields, column0, row0, hn::Mul(left_share, upper_share), lambda_nm, factor);
  add_texel(images, fields, safe_column1, row0, hn::Mul(right, upper_share), lambda_nm, factor);
  add_texel(images, fields, column0, row1, hn::Mul(left_share, lower), lambda_nm, factor);
  add_texel(images, fields, safe_column1, row1, hn::Mul(right, lower), lambda_nm, factor);
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
