#include "systems/tone_map.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/tone_map.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// The vocabulary follows foreach_target, which includes this file once per instruction set.
#include "systems/tone_map-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Pixel positions of consecutive lanes in a picture of some width.
struct Position {
  VU x, y;
};
HWY_INLINE Position wrapped(Position p, VU width) {
  for (auto inside = hn::Lt(p.x, width); !hn::AllTrue(UintTag(), inside); inside = hn::Lt(p.x, width)) {
    p.x = hn::Sub(p.x, hn::IfThenZeroElse(inside, width));
    p.y = hn::Add(p.y, hn::IfThenZeroElse(inside, splat_u(1)));
  }
  return p;
}

// Thresholds in [0, 1), evenly spread over any neighbourhood: the two-dimensional golden-ratio sequence of
// M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences" (2018), frac(x / g + y / g^2) with
// g = 1.3247..., in units of 2^-32.
HWY_INLINE VF dither_threshold(const Position& p) {
  const VU phase = hn::Add(hn::Mul(p.x, splat_u(3242174889u)), hn::Mul(p.y, splat_u(2447445414u)));
  return hn::Mul(hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), hn::ShiftRight<8>(phase))), splat(0x1p-24f));
}

HWY_INLINE VU quantise(VF linear, VF scale, VF threshold) {
  const VF code = hn::Add(hn::Mul(srgb_encode(hn::Mul(linear, scale)), splat(255.0f)), threshold);
  const VI whole = hn::ConvertTo(IntTag(), code);  // towards zero
  return hn::BitCast(UintTag(), hn::Min(whole, hn::Set(IntTag(), 255)));
}

void encode_column(size_t count, const float* HWY_RESTRICT linear, float* HWY_RESTRICT encoded) {
  const FloatTag tag;
  for (size_t i = 0; i < count; i += hn::Lanes(tag))
    hn::Store(srgb_encode(hn::Load(tag, linear + i)), tag, encoded + i);
}

void encode_picture(const Picture& picture, float scale, bool dither, uint32_t* HWY_RESTRICT codes) {
  const FloatTag tag;
  const VU width = splat_u(picture.width), step = splat_u(static_cast<uint32_t>(hn::Lanes(tag)));
  Position at = wrapped({hn::Iota(UintTag(), 0), hn::Zero(UintTag())}, width);
  for (size_t i = 0; i < picture.pixel_count(); i += hn::Lanes(tag)) {
    const VF threshold = dither ? dither_threshold(at) : splat(0.5f);
    const VU r = quantise(hn::Load(tag, picture.r.data() + i), splat(scale), threshold);
    const VU g = quantise(hn::Load(tag, picture.g.data() + i), splat(scale), threshold);
    const VU b = quantise(hn::Load(tag, picture.b.data() + i), splat(scale), threshold);
    hn::Store(hn::Or(r, hn::Or(hn::ShiftLeft<8>(g), hn::ShiftLeft<16>(b))), UintTag(), codes + i);
    at = wrapped({hn::Add(at.x, step), at.y}, width);
  }
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(encode_column);
HWY_EXPORT(encode_picture);

namespace {

// 2^stops: the fraction's binary digits choose among repeated square roots of 2, so whole stops are exact and
// the rest is within 52 roundings of it, the same on every machine.
double power_of_two(double stops) {
  const double whole = std::floor(stops);
  double factor = 1, root = 2, rest = stops - whole;
  while (rest > 0) {
    root = std::sqrt(root);
    rest *= 2;
    if (rest < 1) continue;
    factor *= root;
    rest -= 1;
  }
  return std::ldexp(factor, static_cast<int>(whole));
}

}  // namespace

CodedPicture tone_map(const Picture& picture, const ToneSettings& settings) {
  CodedPicture coded{picture.width, picture.height, Column<uint32_t>(picture.pixel_count())};
  const float stops = std::isnan(settings.exposure_stops) ? 0 : std::clamp(settings.exposure_stops, -100.0f, 100.0f);
  const float scale = static_cast<float>(power_of_two(stops));
  HWY_DYNAMIC_DISPATCH(encode_picture)(picture, scale, settings.dither, coded.codes.data());
  return coded;
}

void srgb_encode(size_t count, const float* linear, float* encoded) {
  HWY_DYNAMIC_DISPATCH(encode_column)(count, linear, encoded);
}

double srgb_encode_scalar(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace metamer
#endif
