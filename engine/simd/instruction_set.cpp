#include "engine/simd/instruction_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/diagnostics.h"
#include "hwy/highway.h"
#if HWY_ARCH_X86
#include <immintrin.h>
#endif

namespace metamer {
namespace {

struct Isa {
  int64_t target;
  std::string_view name;
  std::string_view embree_name;
};

Isa isa_of(int64_t target) {
#if HWY_ARCH_X86
  if (target == HWY_SSE4) return {target, "sse4", "sse4.2"};
  if (target == HWY_AVX2) return {target, "avx2", "avx2"};
  if (target == HWY_AVX3) return {target, "avx512", "avx512"};
#endif
  return {target, hwy::TargetName(target), ""};
}

// Slowest first: Highway gives better targets lower bits.
std::vector<Isa> isas_of(int64_t targets) {
  std::vector<Isa> isas;
  for (; targets != 0; targets &= targets - 1) isas.push_back(isa_of(targets & -targets));
  std::reverse(isas.begin(), isas.end());
  return isas;
}

int64_t chosen_target() {
  const int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return targets & -targets;
}

std::vector<std::string_view> names_of(const std::vector<Isa>& isas) {
  std::vector<std::string_view> names;
  for (const Isa& isa : isas) names.push_back(isa.name);
  return names;
}

// Dispatch follows what is left; whatever was disabled before is enabled again.
void disable_targets(int64_t targets) {
  hwy::DisableTargets(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

std::vector<Isa> available_isas() {
  const int64_t chosen = chosen_target();
  disable_targets(0);
  const std::vector<Isa> isas = isas_of(hwy::SupportedTargets() & HWY_TARGETS);
  disable_targets(~chosen);
  return isas;
}

}  // namespace

std::vector<std::string_view> compiled_isa_names() { return names_of(isas_of(HWY_TARGETS)); }

std::vector<std::string_view> available_isa_names() { return names_of(available_isas()); }

std::string_view chosen_isa_name() { return isa_of(chosen_target()).name; }

std::string_view embree_isa_name() { return isa_of(chosen_target()).embree_name; }

std::string apply_isa(std::string_view name) {
  const std::vector<Isa> available = available_isas();
  if (name == "native") {
    disable_targets(~available.back().target);
    return "";
  }
  for (const Isa& isa : available) {
    if (isa.name != name) continue;
    disable_targets(~isa.target);
    return "";
  }
  std::vector<std::string_view> words = names_of(available);
  words.push_back("native");
  for (const std::string_view compiled : compiled_isa_names()) {
    if (compiled != name) continue;
    return fmt::format("this machine cannot run instruction set '{}'; expected {}", name, fmt::join(words, ", "));
  }
  return fmt::format("unknown instruction set '{}'{}; expected {}", name, did_you_mean(name, words),
                     fmt::join(words, ", "));
}

std::string apply_isa_environment() {
  const char* word = std::getenv("METAMER_ISA");
  const std::string error = apply_isa(word == nullptr || *word == '\0' ? "native" : word);
  return error.empty() ? "" : "METAMER_ISA: " + error;
}

#if HWY_ARCH_X86
namespace {
constexpr unsigned flush_to_zero_and_denormals_are_zero = 0x8040;
}
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(static_cast<unsigned>(saved_) | flush_to_zero_and_denormals_are_zero);
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(static_cast<unsigned>(saved_)); }
#elif HWY_ARCH_ARM_A64
FlushDenormals::FlushDenormals() {
  asm volatile("mrs %0, fpcr" : "=r"(saved_));
  asm volatile("msr fpcr, %0" ::"r"(saved_ | (uint64_t{1} << 24)));
}
FlushDenormals::~FlushDenormals() { asm volatile("msr fpcr, %0" ::"r"(saved_)); }
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() {}
#endif

}  // namespace metamer
