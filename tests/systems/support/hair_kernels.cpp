#include "tests/systems/support/hair_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/support/hair_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "systems/bsdf/hair-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {
using testing::BsdfResult;
using testing::HairCase;

// One value of each of the next cases; the last case's behind them.
template <class Value>
VF column(const std::vector<HairCase>& cases, size_t first, const Value& value) {
  alignas(64) float lanes[16];
  for (size_t lane = 0; lane < hn::Lanes(FloatTag()); ++lane)
    lanes[lane] = static_cast<float>(value(cases[std::min(first + lane, cases.size() - 1)]));
  return hn::Load(FloatTag(), lanes);
}

template <class Kernel>
std::vector<BsdfResult> run(const reference::HairOptics& hair, const std::vector<HairCase>& cases,
                            const Kernel& kernel) {
  std::vector<BsdfResult> results(cases.size());
  const size_t lanes = hn::Lanes(FloatTag());
  for (size_t first = 0; first < cases.size(); first += lanes) {
    const auto of = [&](const auto& value) { return column(cases, first, value); };
    HairOptics o;
    o.h = of([](const HairCase& c) { return c.h; });
    o.eta = splat(static_cast<float>(hair.eta));
    for (int j = 0; j < 4; ++j) o.sigma_a[j] = of([j](const HairCase& c) { return c.c.kappa[j]; });
    o.variance = splat(static_cast<float>(hair.shape.variance));
    o.width = splat(static_cast<float>(hair.shape.width));
    for (int k = 0; k < 3; ++k) {
      o.sin_tilt[k] = splat(static_cast<float>(hair.shape.sin_tilt[k]));
      o.cos_tilt[k] = splat(static_cast<float>(hair.shape.cos_tilt[k]));
    }
    const auto vector = [&](const auto& w) {
      return Vec3{of([&](const HairCase& c) { return w(c)[0]; }), of([&](const HairCase& c) { return w(c)[1]; }),
                  of([&](const HairCase& c) { return w(c)[2]; })};
    };
    const HairView view = make_hair_view(vector([](const HairCase& c) { return c.c.wo; }), o);
    BsdfSample sample;
    sample.wi = vector([](const HairCase& c) { return c.c.wi; });
    kernel(view, o, of, sample);
    alignas(64) float out[8][16];
    const VF values[] = {sample.wi.x,      sample.wi.y,      sample.wi.z,      sample.weight[0],
                         sample.weight[1], sample.weight[2], sample.weight[3], sample.pdf};
    for (int k = 0; k < 8; ++k) hn::Store(values[k], FloatTag(), out[k]);
    for (size_t lane = 0; lane < lanes && first + lane < cases.size(); ++lane) {
      BsdfResult& r = results[first + lane];
      for (int k = 0; k < 3; ++k) r.wi[k] = out[k][lane];
      for (int k = 0; k < 4; ++k) r.value[k] = out[3 + k][lane];
      r.pdf = out[7][lane];
    }
  }
  return results;
}

std::vector<BsdfResult> EvalHair(const reference::HairOptics& hair, const std::vector<HairCase>& cases) {
  return run(hair, cases, [](const HairView& view, const HairOptics& o, const auto&, BsdfSample& sample) {
    eval_hair(view, o, sample.wi, sample.weight, sample.pdf);
  });
}
std::vector<BsdfResult> SampleHair(const reference::HairOptics& hair, const std::vector<HairCase>& cases) {
  return run(hair, cases, [](const HairView& view, const HairOptics& o, const auto& of, BsdfSample& sample) {
    sample = sample_hair(view, o, of([](const HairCase& c) { return c.c.choice; }),
                         of([](const HairCase& c) { return c.c.u; }), of([](const HairCase& c) { return c.c.v; }));
  });
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(EvalHair);
HWY_EXPORT(SampleHair);

namespace testing {
std::vector<BsdfResult> run_eval_hair(const reference::HairOptics& hair, const std::vector<HairCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalHair)(hair, cases);
}
std::vector<BsdfResult> run_sample_hair(const reference::HairOptics& hair, const std::vector<HairCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleHair)(hair, cases);
}
}  // namespace testing
}  // namespace metamer
#endif
