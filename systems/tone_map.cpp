#include "systems/tone_map.h"

#include <algorithm>
#include <cmath>

#include "engine/schedule/blocks.h"
#include "systems/display_colour.h"
#include "systems/tone_job.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/tone_map.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// The vocabulary follows foreach_target, which includes this file once per instruction set.
#include "systems/tone_curve-inl.h"
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

// `encoded` from 0 to 1.
HWY_INLINE VU quantise(VF encoded, VF threshold) {
  const VF code = hn::Add(hn::Mul(encoded, splat(255.0f)), threshold);
  const VI whole = hn::ConvertTo(IntTag(), code);  // towards zero
  return hn::BitCast(UintTag(), hn::Min(whole, hn::Set(IntTag(), 255)));
}

void encode_column(size_t count, const float* HWY_RESTRICT linear, float* HWY_RESTRICT encoded) {
  const FloatTag tag;
  for (size_t i = 0; i < count; i += hn::Lanes(tag))
    hn::Store(srgb_encode(hn::Load(tag, linear + i)), tag, encoded + i);
}

HWY_INLINE Vec3 exposed(const Picture& picture, size_t i, const ToneJob& job) {
  const FloatTag tag;
  return {tamed(hn::Mul(hn::Load(tag, picture.r.data() + i), splat(job.scale[0]))),
          tamed(hn::Mul(hn::Load(tag, picture.g.data() + i), splat(job.scale[1]))),
          tamed(hn::Mul(hn::Load(tag, picture.b.data() + i), splat(job.scale[2])))};
}

// A component of linear light, or of codes, to [0, 1].
HWY_INLINE VF encode(VF component, bool is_encoded) {
  if (!is_encoded) return srgb_encode(component);
  return hn::Min(positive(component), splat(1.0f));
}

template <ToneCurve curve>
void encode_with(const Picture& picture, const ToneJob& job, size_t begin, size_t end, uint32_t* HWY_RESTRICT codes) {
  const VU width = splat_u(picture.width), step = splat_u(static_cast<uint32_t>(hn::Lanes(FloatTag())));
  const uint32_t x = static_cast<uint32_t>(begin % picture.width), y = static_cast<uint32_t>(begin / picture.width);
  Position at = wrapped({hn::Iota(UintTag(), x), splat_u(y)}, width);
  for (size_t i = begin; i < end; i += hn::Lanes(FloatTag())) {
    const VF threshold = job.dither ? dither_threshold(at) : splat(0.5f);
    const Vec3 light = exposed(picture, i, job);
    const Vec3 rgb = tone_curve<curve>(job.desaturate ? desaturated(light, job.constants) : light, job.constants);
    const VU r = quantise(encode(rgb.x, job.encoded), threshold), g = quantise(encode(rgb.y, job.encoded), threshold),
             b = quantise(encode(rgb.z, job.encoded), threshold);
    hn::Store(hn::Or(r, hn::Or(hn::ShiftLeft<8>(g), hn::ShiftLeft<16>(b))), UintTag(), codes + i);
    at = wrapped({hn::Add(at.x, step), at.y}, width);
  }
}

template <ToneCurve curve>
void expose_with(Picture& picture, const ToneJob& job, size_t begin, size_t end) {
  const FloatTag tag;
  for (size_t i = begin; i < end; i += hn::Lanes(tag)) {
    const Vec3 rgb = tone_curve<curve>(exposed(picture, i, job), job.constants);
    hn::Store(hn::Mul(rgb.x, splat(job.unit[0])), tag, picture.r.data() + i);
    hn::Store(hn::Mul(rgb.y, splat(job.unit[1])), tag, picture.g.data() + i);
    hn::Store(hn::Mul(rgb.z, splat(job.unit[2])), tag, picture.b.data() + i);
  }
}

// Calls F<curve> of the run-time curve.
#define METAMER_WITH_CURVE(F, ...)                                                          \
  switch (job.curve) {                                                                      \
    case ToneCurve::linear: return F<ToneCurve::linear>(__VA_ARGS__);                       \
    case ToneCurve::reinhard: return F<ToneCurve::reinhard>(__VA_ARGS__);                   \
    case ToneCurve::reinhard_extended: return F<ToneCurve::reinhard_extended>(__VA_ARGS__); \
    case ToneCurve::hable: return F<ToneCurve::hable>(__VA_ARGS__);                         \
    case ToneCurve::filmic: return F<ToneCurve::filmic>(__VA_ARGS__);                       \
    case ToneCurve::agx: return F<ToneCurve::agx>(__VA_ARGS__);                             \
  }

void encode_pixels(const Picture& picture, const ToneJob& job, size_t begin, size_t end, uint32_t* codes) {
  METAMER_WITH_CURVE(encode_with, picture, job, begin, end, codes)
}
void expose_pixels(Picture& picture, const ToneJob& job, size_t begin, size_t end) {
  METAMER_WITH_CURVE(expose_with, picture, job, begin, end)
}
#undef METAMER_WITH_CURVE

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(encode_column);
HWY_EXPORT(encode_pixels);
HWY_EXPORT(expose_pixels);

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

ToneJob tone_job(const ToneSettings& settings) {
  const float stops = std::isnan(settings.exposure_stops) ? 0 : std::clamp(settings.exposure_stops, -100.0f, 100.0f);
  const double scale = power_of_two(stops);
  const Color3 white = white_amounts(settings.display);
  ToneJob job;
  for (size_t i = 0; i < 3; ++i) {
    job.scale[i] = static_cast<float>(scale / white[i]);
    job.unit[i] = static_cast<float>(white[i]);
  }
  job.dither = settings.dither;
  job.encoded = settings.encoded;
  job.desaturate = settings.display == ColorSpace::lamps && !settings.encoded;
  job.curve = settings.curve;
  job.constants = tone_constants(settings.display, settings.reinhard_white);
  return job;
}

constexpr size_t pixels_per_block = size_t{1} << 16;

}  // namespace

CodedPicture tone_map(const Picture& picture, const ToneSettings& settings) {
  CodedPicture coded{picture.width, picture.height, Column<uint32_t>(picture.pixel_count())};
  const ToneJob job = tone_job(settings);
  for_blocks(picture.pixel_count(), settings.threads, pixels_per_block, [&](size_t begin, size_t end) {
    HWY_DYNAMIC_DISPATCH(encode_pixels)(picture, job, begin, end, coded.codes.data());
  });
  return coded;
}

void expose(Picture& picture, const ToneSettings& settings) {
  if (settings.exposure_stops == 0 && settings.curve == ToneCurve::linear) return;
  const ToneJob job = tone_job(settings);
  for_blocks(picture.pixel_count(), settings.threads, pixels_per_block, [&](size_t begin, size_t end) {
    HWY_DYNAMIC_DISPATCH(expose_pixels)(picture, job, begin, end);
  });
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
