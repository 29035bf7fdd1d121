#include "tests/systems/support/bsdf_kernels.h"

#include <cmath>
#include <cstring>

#include "tests/systems/support/coat_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/systems/support/bsdf_kernels.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
#include "systems/bsdf/coated-inl.h"
#include "systems/bsdf/dielectric-inl.h"
#include "systems/bsdf/diffuse-inl.h"
#include "systems/bsdf/diffuse_transmission-inl.h"
#include "systems/bsdf/ggx-inl.h"
#include "systems/bsdf/phase-inl.h"
#include "systems/bsdf/rough-inl.h"
#include "systems/bsdf/rough_dielectric-inl.h"
#include "systems/bsdf/thin-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {
using testing::BsdfCase;
using testing::BsdfResult;
using testing::Coat;

struct Arguments {
  Vec3 wo, wi;
  VF u, v, alpha_x, alpha_y;
  VF albedo[4], eta[4], kappa[4];
  MF schlick, dispersive, opaque;
  RoughOptics rough;
  VF choice;
};
struct Results {
  Vec3 wi;
  VF value[4], pdf, pdfs[4], delta, transmitted, terminate_secondary;
};
Results nothing() {
  const VF zero = splat(0);
  return {{zero, zero, zero}, {zero, zero, zero, zero}, zero, {zero, zero, zero, zero}, zero, zero, zero};
}

template <class Kernel>
std::vector<BsdfResult> run(const std::vector<BsdfCase>& cases, Kernel kernel) {
  const size_t count = cases.size();
  std::vector<BsdfResult> results(count);
  constexpr size_t fields = sizeof(BsdfCase) / sizeof(float), outputs = sizeof(BsdfResult) / sizeof(float);
  const FloatTag d;
  const size_t lanes = hn::Lanes(d);
  alignas(64) float in[fields][16], out[outputs][16];
  for (size_t first = 0; first < count; first += lanes) {
    for (size_t lane = 0; lane < lanes; ++lane) {
      float row[fields];
      if (first + lane < count) std::memcpy(row, &cases[first + lane], sizeof(row));
      for (size_t f = 0; f < fields; ++f) in[f][lane] = first + lane < count ? row[f] : std::nanf("");
    }
    size_t f = 0;
    const auto next = [&] { return hn::Load(d, in[f++]); };
    Arguments a;
    a.wo.x = next(), a.wo.y = next(), a.wo.z = next();
    a.wi.x = next(), a.wi.y = next(), a.wi.z = next();
    a.u = next(), a.v = next(), a.alpha_x = next(), a.alpha_y = next();
    for (VF& x : a.albedo) x = next();
    for (VF& x : a.eta) x = next();
    for (VF& x : a.kappa) x = next();
    a.schlick = hn::Eq(next(), splat(1.0f));
    a.dispersive = hn::Eq(next(), splat(1.0f));
    a.opaque = hn::Eq(next(), splat(1.0f));
    for (int j = 0; j < 4; ++j) a.rough.kd[j] = a.albedo[j];
    for (VF& x : a.rough.ks) x = next();
    a.rough.shininess = next();
    a.rough.normalized = hn::Eq(next(), splat(1.0f));
    a.choice = next();
    const Results r = kernel(a);
    size_t o = 0;
    for (const VF& x : {r.wi.x, r.wi.y, r.wi.z, r.value[0], r.value[1], r.value[2], r.value[3], r.pdf, r.pdfs[0],
                        r.pdfs[1], r.pdfs[2], r.pdfs[3], r.delta, r.transmitted, r.terminate_secondary}) {
      hn::Store(x, d, out[o++]);
    }
    for (size_t lane = 0; lane < lanes && first + lane < count; ++lane) {
      float row[outputs];
      for (size_t k = 0; k < outputs; ++k) row[k] = out[k][lane];
      std::memcpy(&results[first + lane], row, sizeof(row));
    }
  }
  return results;
}

VF flag(MF mask) { return hn::IfThenElseZero(mask, splat(1.0f)); }
Results of_sample(const BsdfSample& sample) {
  Results r = nothing();
  r.wi = sample.wi;
  for (int j = 0; j < 4; ++j) r.value[j] = sample.weight[j];
  r.pdf = sample.pdf;
  return r;
}
ConductorOptics metal(const Arguments& a) {
  ConductorOptics optics;
  for (int j = 0; j < 4; ++j) optics.n[j] = a.eta[j], optics.kappa[j] = a.kappa[j];
  optics.schlick = a.schlick;
  return optics;
}

std::vector<BsdfResult> EvalDiffuse(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    eval_diffuse(a.wo, a.albedo, a.wi, r.value, r.pdf);
    return r;
  });
}
std::vector<BsdfResult> SampleDiffuse(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) { return of_sample(sample_diffuse(a.wo, a.albedo, a.u, a.v)); });
}
SheetOptics sheet(const Arguments& a) {
  SheetOptics optics;
  for (int j = 0; j < 4; ++j) optics.reflectance[j] = a.albedo[j], optics.transmittance[j] = a.rough.ks[j];
  optics.reflected_share = sheet_share(optics);
  return optics;
}
std::vector<BsdfResult> EvalSheet(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    eval_sheet(a.wo, sheet(a), a.wi, r.value, r.pdf);
    return r;
  });
}
std::vector<BsdfResult> SampleSheet(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) { return of_sample(sample_sheet(a.wo, sheet(a), a.choice, a.u, a.v)); });
}
std::vector<BsdfResult> EvalRough(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    eval_rough(make_rough_lobe(a.wo, a.rough), a.rough, a.wi, r.value, r.pdf);
    return r;
  });
}
std::vector<BsdfResult> SampleRough(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    return of_sample(sample_rough(make_rough_lobe(a.wo, a.rough), a.rough, a.choice, a.u, a.v));
  });
}
std::vector<BsdfResult> EvalConductor(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    eval_conductor(make_ggx_lobe(a.wo, a.alpha_x, a.alpha_y), metal(a), a.wi, r.value, r.pdf);
    return r;
  });
}
std::vector<BsdfResult> SampleConductor(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    const GgxLobe lobe = make_ggx_lobe(a.wo, a.alpha_x, a.alpha_y);
    Results r = of_sample(sample_conductor(lobe, metal(a), a.u, a.v));
    r.delta = flag(lobe.smooth);
    return r;
  });
}
DielectricOptics glass(const Arguments& a) {
  DielectricOptics optics;
  optics.schlick = a.schlick;
  optics.dispersive = a.dispersive;
  optics.some_opaque = !hn::AllFalse(FloatTag(), a.opaque);
  for (int j = 0; j < 4; ++j) {
    optics.eta[j] = a.eta[j];
    optics.kappa[j] = a.kappa[j];
    optics.opaque[j] = hn::And(a.opaque, hn::Ge(a.kappa[j], splat(refracting_kappa)));
  }
  return optics;
}
std::vector<BsdfResult> EvalRoughDielectric(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    eval_rough_dielectric(make_ggx_lobe(a.wo, a.alpha_x, a.alpha_y), glass(a), a.wi, r.value, r.pdfs);
    return r;
  });
}
std::vector<BsdfResult> SampleRoughDielectric(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    const RoughDielectricSample sample =
        sample_rough_dielectric(make_ggx_lobe(a.wo, a.alpha_x, a.alpha_y), glass(a), a.choice, a.u, a.v);
    Results r = nothing();
    r.wi = sample.wi;
    for (int j = 0; j < 4; ++j) r.value[j] = sample.weight[j];
    r.pdf = sample.pdf;
    r.transmitted = flag(sample.transmitted);
    r.terminate_secondary = flag(sample.terminate_secondary);
    return r;
  });
}
std::vector<BsdfResult> SampleThin(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    ThinOptics optics;
    for (int j = 0; j < 4; ++j) {
      optics.eta[j] = a.eta[j];
      optics.kappa[j] = optics.optical_depth[j] = a.kappa[j];
      optics.opaque[j] = a.opaque;
    }
    optics.schlick = a.schlick;
    optics.companions = a.dispersive;
    const ThinSample sample = sample_thin(hn::Abs(a.wo.z), optics, a.u);
    Results r = nothing();
    for (int j = 0; j < 4; ++j) r.value[j] = sample.weight[j];
    r.pdf = sample.probability;
    r.transmitted = flag(sample.transmitted);
    return r;
  });
}
std::vector<BsdfResult> SampleDielectric(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    const DielectricSample sample = sample_dielectric(a.wo, glass(a), a.u);
    Results r = nothing();
    r.wi = sample.wi;
    for (int j = 0; j < 4; ++j) r.value[j] = sample.weight[j];
    r.pdf = sample.probability;
    r.delta = splat(1.0f);
    r.transmitted = flag(sample.transmitted);
    r.terminate_secondary = flag(sample.terminate_secondary);
    return r;
  });
}

CoatOptics optics_of(const Coat& coat, const Arguments& a) {
  CoatOptics optics;
  for (int j = 0; j < 4; ++j) optics.albedo[j] = a.albedo[j], optics.eta[j] = a.eta[j];
  optics.schlick = hn::Eq(splat(coat.schlick ? 1.0f : 0.0f), splat(1.0f));
  optics.thickness = splat(static_cast<float>(coat.thickness));
  optics.hits = splat(static_cast<float>(coat.hits));
  optics.table = coat.table.data();
  const auto set = [](uint32_t x) { return hn::Set(IntTag(), static_cast<int>(x)); };
  optics.rows = {set(coat.rows.first), set(coat.rows.stride), set(coat.rows.last_pair), splat(coat.rows.eta_least),
                 splat(coat.rows.rows_per_eta)};
  return optics;
}

std::vector<BsdfResult> EvalCoated(const Coat& coat, const std::vector<BsdfCase>& cases) {
  const VF alpha_x = splat(static_cast<float>(coat.alpha)), alpha_y = splat(static_cast<float>(coat.alpha_y));
  return run(cases, [&](const Arguments& a) {
    const CoatOptics optics = optics_of(coat, a);
    Results r = nothing();
    if (coat.alpha == 0) {
      eval_smooth_coat(a.wo, make_smooth_coat_view(a.wo, optics), optics, a.wi, r.value, r.pdf);
    } else {
      const GgxLobe lobe = make_ggx_lobe(a.wo, alpha_x, alpha_y);
      eval_rough_coat(lobe, make_rough_coat_view(lobe, optics), optics, a.wi, r.value, r.pdf);
    }
    return r;
  });
}
std::vector<BsdfResult> SampleCoated(const Coat& coat, const std::vector<BsdfCase>& cases) {
  const VF alpha_x = splat(static_cast<float>(coat.alpha)), alpha_y = splat(static_cast<float>(coat.alpha_y));
  return run(cases, [&](const Arguments& a) {
    const CoatOptics optics = optics_of(coat, a);
    if (coat.alpha == 0) {
      const CoatView view = make_smooth_coat_view(a.wo, optics);
      const CoatSample sample = sample_smooth_coat(a.wo, view, optics, a.choice, a.u, a.v);
      Results r = of_sample(sample.draw);
      r.delta = flag(sample.mirrored);
      return r;
    }
    const GgxLobe lobe = make_ggx_lobe(a.wo, alpha_x, alpha_y);
    return of_sample(sample_rough_coat(lobe, make_rough_coat_view(lobe, optics), optics, a.choice, a.u, a.v));
  });
}

std::vector<BsdfResult> EvalPhase(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    r.pdf = eval_phase(a.wi.z, PhaseLobes{a.alpha_x, a.alpha_y, a.rough.shininess});
    return r;
  });
}
std::vector<BsdfResult> SamplePhase(const std::vector<BsdfCase>& cases) {
  return run(cases, [](const Arguments& a) {
    Results r = nothing();
    const PhaseLobes lobes = {a.alpha_x, a.alpha_y, a.rough.shininess};
    r.wi = sample_phase(lobes, a.choice, a.u, a.v);
    r.pdf = eval_phase(r.wi.z, lobes);
    return r;
  });
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(EvalDiffuse);
HWY_EXPORT(SampleDiffuse);
HWY_EXPORT(EvalSheet);
HWY_EXPORT(SampleSheet);
HWY_EXPORT(EvalRough);
HWY_EXPORT(SampleRough);
HWY_EXPORT(EvalConductor);
HWY_EXPORT(SampleConductor);
HWY_EXPORT(SampleDielectric);
HWY_EXPORT(EvalCoated);
HWY_EXPORT(SampleCoated);
HWY_EXPORT(EvalRoughDielectric);
HWY_EXPORT(SampleRoughDielectric);
HWY_EXPORT(SampleThin);
HWY_EXPORT(EvalPhase);
HWY_EXPORT(SamplePhase);

namespace testing {
std::vector<BsdfResult> run_eval_diffuse(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalDiffuse)(cases);
}
std::vector<BsdfResult> run_sample_diffuse(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleDiffuse)(cases);
}
std::vector<BsdfResult> run_eval_sheet(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalSheet)(cases);
}
std::vector<BsdfResult> run_sample_sheet(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleSheet)(cases);
}
std::vector<BsdfResult> run_eval_rough(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalRough)(cases);
}
std::vector<BsdfResult> run_sample_rough(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleRough)(cases);
}
std::vector<BsdfResult> run_eval_conductor(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalConductor)(cases);
}
std::vector<BsdfResult> run_sample_conductor(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleConductor)(cases);
}
std::vector<BsdfResult> run_sample_dielectric(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleDielectric)(cases);
}
std::vector<BsdfResult> run_eval_coated(const Coat& coat, const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalCoated)(coat, cases);
}
std::vector<BsdfResult> run_sample_coated(const Coat& coat, const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleCoated)(coat, cases);
}
std::vector<BsdfResult> run_eval_rough_dielectric(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalRoughDielectric)(cases);
}
std::vector<BsdfResult> run_sample_rough_dielectric(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleRoughDielectric)(cases);
}
std::vector<BsdfResult> run_sample_thin(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SampleThin)(cases);
}
std::vector<BsdfResult> run_eval_phase(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(EvalPhase)(cases);
}
std::vector<BsdfResult> run_sample_phase(const std::vector<BsdfCase>& cases) {
  return HWY_DYNAMIC_DISPATCH(SamplePhase)(cases);
}
}  // namespace testing
}  // namespace metamer
#endif
