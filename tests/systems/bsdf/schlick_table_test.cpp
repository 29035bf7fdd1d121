// Keeps the table of docs/fresnel.md true: Schlick's approximation against the exact form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "engine/spectrum/sources.h"
#include "systems/bsdf/reference.h"

namespace metamer {
namespace {

// Over the angle of incidence from 0 to 90 degrees in steps of 0.01.
struct Deviation {
  double largest = 0, at_degrees = 0, mean = 0;
};
template <class Exact, class Approximate>
Deviation compare(Exact exact, Approximate approximate) {
  Deviation deviation;
  constexpr int steps = 9000;
  for (int i = 0; i <= steps; ++i) {
    const double degrees = 90.0 * i / steps;
    const double cos_theta = i == steps ? 0 : std::cos(degrees * std::numbers::pi / 180);
    const double difference = approximate(cos_theta) - exact(cos_theta);
    deviation.mean += std::abs(difference) / (steps + 1);
    if (std::abs(difference) > std::abs(deviation.largest)) {
      deviation.largest = difference;
      deviation.at_degrees = degrees;
    }
  }
  return deviation;
}
std::string row(const std::string& medium, int lambda_nm, const char* seen_from, double n, double kappa,
                const Deviation& d) {
  char text[200];
  std::snprintf(text, sizeof(text), "| %s | %d | %s | %.4f | %.4f | %+.4f | %.1f | %.4f |", medium.c_str(), lambda_nm,
                seen_from, n, kappa, d.largest, d.at_degrees, d.mean);
  return text;
}

void add_dielectric(std::vector<std::string>& rows, const std::string& medium, int lambda_nm, double n) {
  for (const bool inside : {false, true}) {
    const double eta = inside ? 1 / n : n;
    const Deviation d = compare([&](double c) { return reference::fresnel_dielectric(eta, c); },
                                [&](double c) { return reference::schlick_dielectric(eta, c); });
    rows.push_back(row(medium, lambda_nm, inside ? "inside" : "air", n, 0, d));
  }
}

std::vector<std::string> computed_table() {
  std::vector<std::string> rows;
  const int rgb_nm[] = {611, 549, 464};  // where RGB mode takes its indices
  for (const int lambda_nm : rgb_nm) add_dielectric(rows, "glass", lambda_nm, 1.5);
  for (const char* medium : {"water", "diamond"}) {
    const Samples n = *dispersion_index(medium);
    for (const int lambda_nm : rgb_nm) add_dielectric(rows, medium, lambda_nm, interpolate(n, lambda_nm));
  }
  for (const char* metal : {"Ag", "Al", "Au", "Cr", "Cu", "Fe", "Ni", "Pt", "Ti", "W"}) {
    const ComplexIndex index = *metal_index(metal);
    for (const int lambda_nm : rgb_nm) {
      const double n = interpolate(index.eta, lambda_nm), kappa = interpolate(index.kappa, lambda_nm);
      const Deviation d = compare([&](double c) { return reference::fresnel_conductor(n, kappa, c); },
                                  [&](double c) { return reference::schlick_conductor(n, kappa, c); });
      rows.push_back(row(metal, lambda_nm, "air", n, kappa, d));
    }
  }
  return rows;
}

TEST(SchlickTable, InTheDocumentationIsWhatTheCodeDoes) {
  std::ifstream file(METAMER_SOURCE_DIR "/docs/fresnel.md");
  ASSERT_TRUE(file) << "docs/fresnel.md is missing";
  std::vector<std::string> documented;
  for (std::string line; std::getline(file, line);) {
    const bool a_row = line.find("| air |") != std::string::npos || line.find("| inside |") != std::string::npos;
    if (a_row) documented.push_back(line);
  }
  const std::vector<std::string> computed = computed_table();
  std::ostringstream whole;
  for (const std::string& line : computed) whole << line << "\n";
  EXPECT_EQ(documented, computed) << "the table should read\n" << whole.str();
}

}  // namespace
}  // namespace metamer
