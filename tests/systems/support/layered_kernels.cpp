#include "tests/systems/support/layered_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/support/layered_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "systems/bsdf/layered-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {
using testing::BsdfResult;
using testing::LayeredWalk;

VF number(double x) { return splat(static_cast<float>(x)); }
MF mask(bool is_set) { return hn::Eq(number(is_set ? 1 : 0), splat(1.0f)); }
Vec3 vector(const reference::Direction& w) { return {number(w.x), number(w.y), number(w.z)}; }

LayeredOptics optics_of(const LayeredWalk& s) {
  LayeredOptics o;
  o.eta = number(s.eta);
  o.alpha_x = number(s.surface.alpha_x);
  o.alpha_y = number(s.surface.alpha_y);
  o.smooth_surface = mask(reference::is_smooth(s.surface));
  o.thickness = number(s.thickness);
  o.asymmetry = number(s.asymmetry);
  o.scatters = mask(s.albedo > 0);
  o.max_depth = number(s.max_depth);
  o.walks = splat(1.0f);
  o.conductor = mask(s.conductor);
  for (int j = 0; j < 4; ++j) {
    o.albedo[j] = number(s.albedo);
    o.reflectance[j] = number(s.reflectance);
    o.metal.n[j] = number(s.n);
    o.metal.kappa[j] = number(s.kappa);
  }
  o.metal.schlick = mask(false);
  o.base_alpha_x = number(s.base.alpha_x);
  o.base_alpha_y = number(s.base.alpha_y);
  o.smooth_base = mask(s.conductor && reference::is_smooth(s.base));
  return o;
}

// Calls the kernel with other seeds on every lane and collects what it makes of them.
template <class Kernel>
std::vector<BsdfResult> repeat(size_t count, const Kernel& kernel) {
  std::vector<BsdfResult> results(count);
  const size_t lanes = hn::Lanes(FloatTag());
  alignas(64) float x[16], y[16], z[16], value[16], pdf[16];
  for (size_t first = 0; first < count; first += lanes) {
    const VU number = hn::Add(hn::Iota(UintTag(), 0), splat_u(static_cast<uint32_t>(first)));
    const BsdfSample sample = kernel(hash_u32(hash_u32(number)));
    hn::Store(sample.wi.x, FloatTag(), x);
    hn::Store(sample.wi.y, FloatTag(), y);
    hn::Store(sample.wi.z, FloatTag(), z);
    hn::Store(sample.weight[0], FloatTag(), value);
    hn::Store(sample.pdf, FloatTag(), pdf);
    for (size_t lane = 0; lane < lanes && first + lane < count; ++lane) {
      BsdfResult& r = results[first + lane];
      r.wi[0] = x[lane], r.wi[1] = y[lane], r.wi[2] = z[lane];
      r.value[0] = value[lane];
      r.pdf = pdf[lane];
      r.delta = pdf[lane] == 0 && value[lane] > 0 ? 1.0f : 0.0f;
    }
  }
  return results;
}

std::vector<BsdfResult> EvalLayered(const LayeredWalk& s, const reference::Direction& wo,
                                    const reference::Direction& wi, size_t count) {
  const LayeredOptics optics = optics_of(s);
  const LayeredView view = make_layered_view(vector(wo), optics, true);
  return repeat(count, [&](VU seed) {
    BsdfSample result;
    result.wi = vector(wi);
    eval_layered(view, optics, result.wi, seed, result.weight, result.pdf);
    return result;
  });
}

std::vector<BsdfResult> SampleLayered(const LayeredWalk& s, const reference::Direction& wo, size_t count) {
  const LayeredOptics optics = optics_of(s);
  const LayeredView view = make_layered_view(vector(wo), optics, true);
  return repeat(count, [&](VU seed) {
    const VF choice = unit_float(hash_u32(hn::Xor(seed, splat_u(0x1234567u))));
    const VF u = unit_float(hash_u32(hn::Xor(seed, splat_u(0x2345678u))));
    const VF v = unit_float(hash_u32(hn::Xor(seed, splat_u(0x3456789u))));
    return sample_layered(view, optics, choice, u, v, seed);
  });
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(EvalLayered);
HWY_EXPORT(SampleLayered);

namespace testing {
std::vector<BsdfResult> run_eval_layered(const LayeredWalk& setting, const reference::Direction& wo,
                                         const reference::Direction& wi, size_t count) {
  return HWY_DYNAMIC_DISPATCH(EvalLayered)(setting, wo, wi, count);
}
std::vector<BsdfResult> run_sample_layered(const LayeredWalk& setting, const reference::Direction& wo, size_t count) {
  return HWY_DYNAMIC_DISPATCH(SampleLayered)(setting, wo, count);
}
}  // namespace testing
}  // namespace metamer
#endif
