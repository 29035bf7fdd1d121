// The BSDF kernels over columns of path vertices: the scalar double twin and every instruction set of this machine.
// An item is one vertex; BSDFs treat four wavelengths of it, the Fresnel functions one.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "engine/simd/column.h"
#include "engine/simd/instruction_set.h"
#include "systems/bsdf/reference.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/bsdf_bench.cpp"
#include "hwy/foreach_target.h"
//
#include "hwy/highway.h"
#include "systems/bsdf/dielectric-inl.h"
#include "systems/bsdf/diffuse-inl.h"
#include "systems/bsdf/ggx-inl.h"
#include "systems/bsdf/rough-inl.h"

#ifndef METAMER_BENCH_BSDF_ONCE
#define METAMER_BENCH_BSDF_ONCE
namespace metamer::bench {
inline constexpr size_t vertices = 1024;
// The columns of a batch: everything a vertex may need, and where results go.
struct Batch {
  std::array<Column<float>, 3> wo, wi, out_wi;
  Column<float> u, v, alpha_x, alpha_y, out_pdf;
  std::array<Column<float>, 4> n, kappa, eta, out_value;
};
enum class Work {
  fresnel_dielectric,
  schlick_dielectric,
  fresnel_conductor,
  schlick_conductor,
  eval_diffuse,
  sample_diffuse,
  eval_rough,
  sample_rough,
  eval_conductor,
  sample_conductor,
  vertex_conductor,
  sample_dielectric,
  sample_dispersive
};
}  // namespace metamer::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {
using bench::Batch;
using bench::Work;

MF no_lane() { return hn::Lt(hn::Zero(FloatTag()), hn::Zero(FloatTag())); }

Vec3 load(const std::array<Column<float>, 3>& columns, size_t row) {
  const FloatTag d;
  return {hn::Load(d, columns[0].data() + row), hn::Load(d, columns[1].data() + row),
          hn::Load(d, columns[2].data() + row)};
}
void load(const std::array<Column<float>, 4>& columns, size_t row, VF values[4]) {
  for (size_t j = 0; j < 4; ++j) values[j] = hn::Load(FloatTag(), columns[j].data() + row);
}
void store(VF value, Column<float>& column, size_t row) { hn::Store(value, FloatTag(), column.data() + row); }
void store(const Vec3& wi, const VF values[4], VF pdf, Batch& batch, size_t row) {
  store(wi.x, batch.out_wi[0], row), store(wi.y, batch.out_wi[1], row), store(wi.z, batch.out_wi[2], row);
  for (size_t j = 0; j < 4; ++j) store(values[j], batch.out_value[j], row);
  store(pdf, batch.out_pdf, row);
}
ConductorOptics load_metal(const Batch& batch, size_t row) {
  ConductorOptics optics;
  load(batch.n, row, optics.n);
  load(batch.kappa, row, optics.kappa);
  optics.schlick = no_lane();
  return optics;
}
GgxLobe load_lobe(const Batch& batch, size_t row) {
  const FloatTag d;
  return make_ggx_lobe(load(batch.wo, row), hn::Load(d, batch.alpha_x.data() + row),
                       hn::Load(d, batch.alpha_y.data() + row));
}

template <Work work>
void vertex(Batch& batch, size_t row) {
  const FloatTag d;
  const VF u = hn::Load(d, batch.u.data() + row), v = hn::Load(d, batch.v.data() + row);
  const Vec3 wo = load(batch.wo, row), wi = load(batch.wi, row);
  VF values[4], pdf;
  if constexpr (work == Work::fresnel_dielectric || work == Work::schlick_dielectric) {
    const VF eta = hn::Load(d, batch.eta[0].data() + row), inv_eta = hn::Div(splat(1.0f), eta);
    const VF c = hn::Abs(wo.z);
    const DielectricBoundary b =
        work == Work::fresnel_dielectric ? fresnel_dielectric(eta, inv_eta, c) : schlick_dielectric(eta, inv_eta, c);
    store(b.reflectance, batch.out_pdf, row);
  } else if constexpr (work == Work::fresnel_conductor || work == Work::schlick_conductor) {
    const VF n = hn::Load(d, batch.n[0].data() + row), kappa = hn::Load(d, batch.kappa[0].data() + row);
    const VF c = hn::Abs(wo.z);
    store(work == Work::fresnel_conductor ? fresnel_conductor(n, kappa, c) : schlick_conductor(n, kappa, c),
          batch.out_pdf, row);
  } else if constexpr (work == Work::eval_diffuse) {
    VF albedo[4];
    load(batch.n, row, albedo);
    eval_diffuse(wo, albedo, wi, values, pdf);
    store(wi, values, pdf, batch, row);
  } else if constexpr (work == Work::sample_diffuse) {
    VF albedo[4];
    load(batch.n, row, albedo);
    const BsdfSample sample = sample_diffuse(wo, albedo, u, v);
    store(sample.wi, sample.weight, sample.pdf, batch, row);
  } else if constexpr (work == Work::eval_rough || work == Work::sample_rough) {
    RoughOptics optics;
    load(batch.n, row, optics.kd);
    load(batch.kappa, row, optics.ks);
    optics.shininess = hn::Mul(hn::Load(d, batch.alpha_x.data() + row), splat(100.0f));
    optics.normalized = no_lane();
    const RoughLobe lobe = make_rough_lobe(wo, optics);
    if constexpr (work == Work::eval_rough) {
      eval_rough(lobe, optics, wi, values, pdf);
      store(wi, values, pdf, batch, row);
    } else {
      const BsdfSample sample = sample_rough(lobe, optics, hn::Load(d, batch.alpha_y.data() + row), u, v);
      store(sample.wi, sample.weight, sample.pdf, batch, row);
    }
  } else if constexpr (work == Work::eval_conductor) {
    eval_conductor(load_lobe(batch, row), load_metal(batch, row), wi, values, pdf);
    store(wi, values, pdf, batch, row);
  } else if constexpr (work == Work::sample_conductor) {
    const BsdfSample sample = sample_conductor(load_lobe(batch, row), load_metal(batch, row), u, v);
    store(sample.wi, sample.weight, sample.pdf, batch, row);
  } else if constexpr (work == Work::vertex_conductor) {
    // What shading does: one lobe, one light direction, one continuation.
    const GgxLobe lobe = load_lobe(batch, row);
    const ConductorOptics optics = load_metal(batch, row);
    eval_conductor(lobe, optics, wi, values, pdf);
    store(wi, values, pdf, batch, row);
    const BsdfSample sample = sample_conductor(lobe, optics, u, v);
    store(sample.wi, sample.weight, sample.pdf, batch, row);
  } else {
    DielectricOptics optics;
    load(batch.eta, row, optics.eta);
    optics.schlick = no_lane();
    optics.dispersive = work == Work::sample_dispersive ? hn::Not(no_lane()) : no_lane();
    const DielectricSample sample = sample_dielectric(wo, optics, u);
    store(sample.wi, sample.weight, sample.probability, batch, row);
  }
}
template <Work work>
void all_vertices(Batch& batch) {
  for (size_t row = 0; row < bench::vertices; row += hn::Lanes(FloatTag())) vertex<work>(batch, row);
}

void RunBsdfBatch(Work work, Batch& batch) {
  switch (work) {
    case Work::fresnel_dielectric: return all_vertices<Work::fresnel_dielectric>(batch);
    case Work::schlick_dielectric: return all_vertices<Work::schlick_dielectric>(batch);
    case Work::fresnel_conductor: return all_vertices<Work::fresnel_conductor>(batch);
    case Work::schlick_conductor: return all_vertices<Work::schlick_conductor>(batch);
    case Work::eval_diffuse: return all_vertices<Work::eval_diffuse>(batch);
    case Work::sample_diffuse: return all_vertices<Work::sample_diffuse>(batch);
    case Work::eval_rough: return all_vertices<Work::eval_rough>(batch);
    case Work::sample_rough: return all_vertices<Work::sample_rough>(batch);
    case Work::eval_conductor: return all_vertices<Work::eval_conductor>(batch);
    case Work::sample_conductor: return all_vertices<Work::sample_conductor>(batch);
    case Work::vertex_conductor: return all_vertices<Work::vertex_conductor>(batch);
    case Work::sample_dielectric: return all_vertices<Work::sample_dielectric>(batch);
    case Work::sample_dispersive: return all_vertices<Work::sample_dispersive>(batch);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(RunBsdfBatch);

namespace bench {
namespace {

Batch random_batch() {
  std::mt19937 engine(3);
  const auto uniform = [&] { return static_cast<float>(engine() >> 8) * 0x1p-24f; };
  Batch batch;
  const auto fill = [&](Column<float>& column, float low, float high) {
    column.resize(vertices);
    for (size_t row = 0; row < vertices; ++row) column[row] = low + (high - low) * uniform();
  };
  fill(batch.u, 0, 1), fill(batch.v, 0, 1), fill(batch.alpha_x, 0.05f, 1), fill(batch.alpha_y, 0.05f, 1);
  batch.out_pdf.resize(vertices);
  for (size_t j = 0; j < 4; ++j) {
    fill(batch.n[j], 0.1f, 0.9f), fill(batch.kappa[j], 1, 5), fill(batch.eta[j], 1.3f, 1.8f);
    batch.out_value[j].resize(vertices);
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    fill(batch.wo[axis], -1, 1), fill(batch.wi[axis], -1, 1);
    batch.out_wi[axis].resize(vertices);
  }
  for (auto* w : {&batch.wo, &batch.wi}) {
    for (size_t row = 0; row < vertices; ++row) {
      const reference::Direction unit = reference::normalize({(*w)[0][row], (*w)[1][row], std::abs((*w)[2][row])});
      (*w)[0][row] = float(unit.x), (*w)[1][row] = float(unit.y), (*w)[2][row] = float(unit.z);
    }
  }
  return batch;
}

reference::Direction row_of(const std::array<Column<float>, 3>& columns, size_t row) {
  return {columns[0][row], columns[1][row], columns[2][row]};
}
reference::Spectrum4 row_of(const std::array<Column<float>, 4>& columns, size_t row) {
  return {columns[0][row], columns[1][row], columns[2][row], columns[3][row]};
}

double scalar_vertex(Work work, const Batch& batch, size_t row) {
  namespace r = reference;
  const r::Direction wo = row_of(batch.wo, row), wi = row_of(batch.wi, row);
  const r::Spectrum4 n = row_of(batch.n, row), eta = row_of(batch.eta, row);
  const r::ConductorOptics metal = {n, row_of(batch.kappa, row), false};
  const r::RoughOptics rough = {n, row_of(batch.kappa, row), 100.0 * batch.alpha_x[row], false};
  const r::Roughness alpha = {batch.alpha_x[row], batch.alpha_y[row]};
  const double u = batch.u[row], v = batch.v[row];
  switch (work) {
    case Work::fresnel_dielectric: return r::fresnel_dielectric(eta[0], wo.z);
    case Work::schlick_dielectric: return r::schlick_dielectric(eta[0], wo.z);
    case Work::fresnel_conductor: return r::fresnel_conductor(n[0], metal.kappa[0], wo.z);
    case Work::schlick_conductor: return r::schlick_conductor(n[0], metal.kappa[0], wo.z);
    case Work::eval_diffuse: return r::eval_diffuse(wo, n, wi).f_cos[0];
    case Work::sample_diffuse: return r::sample_diffuse(wo, n, u, v).wi.x;
    case Work::eval_rough: return r::eval_rough(wo, rough, wi).f_cos[0];
    case Work::sample_rough: return r::sample_rough(wo, rough, batch.alpha_y[row], u, v).weight[0];
    case Work::eval_conductor: return r::eval_conductor(wo, alpha, metal, wi).f_cos[0];
    case Work::sample_conductor: return r::sample_conductor(wo, alpha, metal, u, v).weight[0];
    case Work::vertex_conductor:
      return r::eval_conductor(wo, alpha, metal, wi).f_cos[0] + r::sample_conductor(wo, alpha, metal, u, v).weight[0];
    case Work::sample_dielectric: return r::sample_dielectric(wo, {eta, false, false}, u).weight[0];
    case Work::sample_dispersive: return r::sample_dielectric(wo, {eta, false, true}, u).weight[0];
  }
  return 0;
}

void count_items(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(vertices));
}
void run_scalar(benchmark::State& state, Work work) {
  const Batch batch = random_batch();
  for (auto _ : state) {
    for (size_t row = 0; row < vertices; ++row) benchmark::DoNotOptimize(scalar_vertex(work, batch, row));
  }
  count_items(state);
}
void run_simd(benchmark::State& state, Work work, std::string_view isa) {
  apply_isa(isa);
  Batch batch = random_batch();
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(RunBsdfBatch)(work, batch);
    benchmark::ClobberMemory();
  }
  count_items(state);
  apply_isa("native");
}

const bool registered = [] {
  const std::pair<const char*, Work> works[] = {{"fresnel_dielectric", Work::fresnel_dielectric},
                                                {"schlick_dielectric", Work::schlick_dielectric},
                                                {"fresnel_conductor", Work::fresnel_conductor},
                                                {"schlick_conductor", Work::schlick_conductor},
                                                {"eval_diffuse", Work::eval_diffuse},
                                                {"sample_diffuse", Work::sample_diffuse},
                                                {"eval_rough", Work::eval_rough},
                                                {"sample_rough", Work::sample_rough},
                                                {"eval_conductor", Work::eval_conductor},
                                                {"sample_conductor", Work::sample_conductor},
                                                {"vertex_conductor", Work::vertex_conductor},
                                                {"sample_dielectric", Work::sample_dielectric},
                                                {"sample_dispersive", Work::sample_dispersive}};
  for (const auto& [name, work] : works) {
    const std::string stem = std::string("bsdf/") + name + "/";
    benchmark::RegisterBenchmark((stem + "scalar").c_str(), run_scalar, work);
    for (const std::string_view isa : available_isa_names()) {
      benchmark::RegisterBenchmark((stem + std::string(isa)).c_str(), run_simd, work, isa);
    }
  }
  return true;
}();

}  // namespace
}  // namespace bench
}  // namespace metamer
#endif
