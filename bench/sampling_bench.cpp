// Points, warps, distributions and elementary functions: items (lanes) per second on each instruction set.
//   build/metamer_bench --benchmark_filter=Sampling
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/sampling_bench.cpp"
#include <benchmark/benchmark.h>
#include <hwy/foreach_target.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/sampling/distribution-inl.h"
#include "engine/sampling/filters-inl.h"
#include "engine/sampling/points-inl.h"
#include "engine/sampling/warps-inl.h"
#include "engine/simd/column.h"
#include "engine/simd/instruction_set.h"
#include "engine/simd/math-inl.h"

#ifndef METAMER_BENCH_SAMPLING_BENCH_ONCE
#define METAMER_BENCH_SAMPLING_BENCH_ONCE
namespace metamer {
enum class SamplingKernel {
  point_key,
  sample_1d,
  sample_2d,
  cosine_hemisphere,
  filter,
  discrete,
  square,
  exp,
  exp2,
  log,
  pow,
  sincos,
  sincos_2pi,
  atan2,
  acos
};
// A batch of the size the pipeline uses; everything in L1 or L2.
struct SamplingBatch {
  Column<uint32_t> counter{2048};
  Column<float> u{2048}, v{2048}, out{2048};
  Distribution1D lights;
  Distribution2D environment;
  PixelFilter gaussian;
};
}  // namespace metamer
#endif

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE VF first_of(const SinCos& s) { return hn::Add(s.sin, s.cos); }

template <SamplingKernel kernel>
HWY_INLINE VF evaluate(const SamplingBatch& batch, VU counter, VF u, VF v) {
  const FloatTag d;
  const PointKey key{counter, hn::Xor(counter, splat_u(77))};
  VF a, b;
  switch (kernel) {
    case SamplingKernel::point_key: {
      const PointKey made = make_point_key(counter, hn::ShiftRight<3>(counter), counter, 1);
      return hn::BitCast(d, hn::Xor(made.pixel_seed, made.index_reversed));
    }
    case SamplingKernel::sample_1d: return sample_1d(key, counter);
    case SamplingKernel::sample_2d: sample_2d(key, counter, &a, &b); return hn::Add(a, b);
    case SamplingKernel::cosine_hemisphere: {
      const Vec3 w = sample_cosine_hemisphere(u, v);
      return hn::Add(w.x, hn::Add(w.y, w.z));
    }
    case SamplingKernel::filter: {
      const Point2V p = sample_filter(batch.gaussian, u, v);
      return hn::Add(p.x, p.y);
    }
    case SamplingKernel::discrete: {
      const DiscreteSampleV s = sample_discrete(batch.lights, u);
      return hn::Add(s.remapped, s.probability);
    }
    case SamplingKernel::square: {
      const SquareSampleV s = sample_square(batch.environment, u, v);
      return hn::Add(hn::Add(s.x, s.y), s.pdf);
    }
    case SamplingKernel::exp: return exp(u);
    case SamplingKernel::exp2: return exp2(u);
    case SamplingKernel::log: return log(u);
    case SamplingKernel::pow: return pow(u, v);
    case SamplingKernel::sincos: return first_of(sincos(u));
    case SamplingKernel::sincos_2pi: return first_of(sincos_2pi(u));
    case SamplingKernel::atan2: return atan2(u, v);
    case SamplingKernel::acos: return acos(u);
  }
  return u;
}

template <SamplingKernel kernel>
void run(SamplingBatch* batch) {
  const FloatTag d;
  for (size_t i = 0; i < batch->u.size(); i += hn::Lanes(d)) {
    const VU counter = hn::Load(UintTag(), batch->counter.data() + i);
    const VF u = hn::Load(d, batch->u.data() + i), v = hn::Load(d, batch->v.data() + i);
    hn::Store(evaluate<kernel>(*batch, counter, u, v), d, batch->out.data() + i);
  }
}

void run_sampling_kernel(SamplingKernel kernel, SamplingBatch* batch) {
  switch (kernel) {
    case SamplingKernel::point_key: return run<SamplingKernel::point_key>(batch);
    case SamplingKernel::sample_1d: return run<SamplingKernel::sample_1d>(batch);
    case SamplingKernel::sample_2d: return run<SamplingKernel::sample_2d>(batch);
    case SamplingKernel::cosine_hemisphere: return run<SamplingKernel::cosine_hemisphere>(batch);
    case SamplingKernel::filter: return run<SamplingKernel::filter>(batch);
    case SamplingKernel::discrete: return run<SamplingKernel::discrete>(batch);
    case SamplingKernel::square: return run<SamplingKernel::square>(batch);
    case SamplingKernel::exp: return run<SamplingKernel::exp>(batch);
    case SamplingKernel::exp2: return run<SamplingKernel::exp2>(batch);
    case SamplingKernel::log: return run<SamplingKernel::log>(batch);
    case SamplingKernel::pow: return run<SamplingKernel::pow>(batch);
    case SamplingKernel::sincos: return run<SamplingKernel::sincos>(batch);
    case SamplingKernel::sincos_2pi: return run<SamplingKernel::sincos_2pi>(batch);
    case SamplingKernel::atan2: return run<SamplingKernel::atan2>(batch);
    case SamplingKernel::acos: return run<SamplingKernel::acos>(batch);
  }
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
HWY_EXPORT(run_sampling_kernel);
namespace {

SamplingBatch make_batch() {
  SamplingBatch batch;
  for (uint32_t i = 0; i < batch.u.size(); ++i) {
    batch.counter[i] = hash_u32(i);
    batch.u[i] = unit_float(hash_u32(i + 10000)) + 0x1p-25f;
    batch.v[i] = unit_float(hash_u32(i + 20000));
  }
  std::vector<double> weights(1024 * 512);
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = 1 + static_cast<double>(i % 977);
  batch.environment = make_distribution_2d(weights, 1024, 512);
  weights.resize(1000);
  batch.lights = make_distribution_1d(weights);
  batch.gaussian = make_pixel_filter(FilterKind::gaussian, 1.5, 1.5);
  return batch;
}

void sampling_kernel(benchmark::State& state, SamplingKernel kernel, const std::string& isa) {
  SamplingBatch batch = make_batch();
  apply_isa(isa);
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(run_sampling_kernel)(kernel, &batch);
    benchmark::ClobberMemory();
  }
  apply_isa("native");
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * batch.u.size()));
}

// One lane at a time, the same integers.
void scalar_sample_2d(benchmark::State& state) {
  SamplingBatch batch = make_batch();
  for (auto _ : state) {
    for (size_t i = 0; i < batch.u.size(); ++i) {
      const Point2 p = sample_2d(PointKeyScalar{batch.counter[i], batch.counter[i] ^ 77}, batch.counter[i]);
      batch.out[i] = p.u + p.v;
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * batch.u.size()));
}
BENCHMARK(scalar_sample_2d)->Name("Sampling/sample_2d/scalar");

const bool registered = [] {
  constexpr const char* names[] = {"point_key",
                                   "sample_1d",
                                   "sample_2d",
                                   "cosine_hemisphere",
                                   "filter_gaussian",
                                   "discrete_of_1000",
                                   "square_1024x512",
                                   "exp",
                                   "exp2",
                                   "log",
                                   "pow",
                                   "sincos",
                                   "sincos_2pi",
                                   "atan2",
                                   "acos"};
  for (size_t kernel = 0; kernel < std::size(names); ++kernel) {
    for (const std::string_view isa : available_isa_names()) {
      const std::string name = std::string("Sampling/") + names[kernel] + "/" + std::string(isa);
      benchmark::RegisterBenchmark(name.c_str(), sampling_kernel, static_cast<SamplingKernel>(kernel),
                                   std::string(isa));
    }
  }
  return true;
}();

}  // namespace
}  // namespace metamer
#endif
