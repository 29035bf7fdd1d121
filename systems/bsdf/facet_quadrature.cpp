#include "systems/bsdf/facet_quadrature.h"

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {
constexpr double pi = 3.14159265358979323846;
}

// Roots of the Legendre polynomial by Newton's method.
std::vector<QuadratureNode> gauss_legendre(int count) {
  std::vector<QuadratureNode> nodes;
  for (int i = 0; i < count; ++i) {
    double x = portable::cos(pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double p = x, before = 1;
      for (int n = 2; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    nodes.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

// Integrands bend at phi = pi and at the horizon: nodes gather there.
FacetQuadrature make_facet_quadrature(int around, int outwards) {
  FacetQuadrature quadrature;
  for (const QuadratureNode& node : gauss_legendre(around)) {
    const double rest = 1 - node.x, phi = pi * (1 - rest * rest * rest);
    quadrature.azimuths.push_back({portable::cos(phi), portable::sin(phi), node.weight * 3 * rest * rest});
  }
  for (const QuadratureNode& node : gauss_legendre(outwards))
    quadrature.rings.push_back({node.x * (2 - node.x), node.weight * 2 * (1 - node.x)});
  return quadrature;
}

}  // namespace metamer
