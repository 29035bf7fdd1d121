// Uses metamer as a library: through find_package and the installed headers alone.
#include <cstdio>

#include "engine/diagnostics.h"
#include "engine/simd/column.h"

int main() {
  metamer::Column<float> wavelengths_nm;
  for (float lambda_nm = 360; lambda_nm <= 830; lambda_nm += 5) wavelengths_nm.push_back(lambda_nm);

  metamer::Diagnostics diagnostics;
  if (wavelengths_nm.size() != 95) diagnostics.error({"example.cpp", 10}, "95 wavelengths were expected");
  std::fputs(metamer::format_diagnostics(diagnostics).c_str(), stderr);
  std::printf("%zu wavelengths\n", wavelengths_nm.size());
  return diagnostics.has_errors() ? 1 : 0;
}
