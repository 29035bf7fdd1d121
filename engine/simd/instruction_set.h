// Which instruction set the kernels run on, and the floating-point mode they assume.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace metamer {

// "sse4", "avx2", "avx512" on x86; elsewhere Highway's names. Slowest first.
std::vector<std::string_view> compiled_isa_names();
// Those of them that this machine can run, whatever was chosen.
std::vector<std::string_view> available_isa_names();
// The one that HWY_DYNAMIC_DISPATCH goes to.
std::string_view chosen_isa_name();

// Chooses the instruction set for all further dispatches: one of the available names, or "native" for the best.
// Returns the text of the error, empty if there is none; on error nothing changes. Not while kernels run.
std::string apply_isa(std::string_view name);

// The same for METAMER_ISA; unset or empty means "native". To be called before the first kernel.
std::string apply_isa_environment();

// The value for `isa=` in Embree's device configuration that matches the chosen set; "" where Embree has none.
std::string_view embree_isa_name();

// For its lifetime, subnormal results and operands of this thread count as zero. Every thread that computes
// pixels holds one: kernels would otherwise differ between threads, and crawl.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  uint64_t saved_;
};

}  // namespace metamer
