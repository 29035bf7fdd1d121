#include "systems/bsdf/coat_layer.h"

#include <algorithm>
#include <cmath>

#include "engine/simd/portable_math.h"
#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/facet_quadrature.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

// Of light from the base at cos_theta to the normal: the share that the surface above sends back through the layer.
double returned(const FacetQuadrature& quadrature, double alpha, double eta_outwards, double thickness,
                double cos_theta) {
  if (alpha < double{smooth_alpha})
    return coat_fresnel(eta_outwards, cos_theta, false) * layer_transmittance(thickness, cos_theta);
  const FacetView view(alpha, cos_theta);
  return integrate_facets(quadrature, view, true, [&](const FacetView::Facet& facet) {
    const FacetView::Light i = view.reflected(facet);
    if (!(i.z > 0)) return 0.0;
    return coat_fresnel(eta_outwards, std::max(0.0, facet.cos_d), false) * view.shadowing(i) *
           layer_transmittance(thickness, i.z);
  });
}

}  // namespace

double layer_transmittance(double thickness, double cos_inside) {
  return thickness == 0 ? 1 : portable::exp(-thickness / std::max(cos_inside, 1e-300));
}

double rough_layer_entry(double alpha, double eta, double thickness, double cos_theta) {
  static const FacetQuadrature coarse = make_facet_quadrature(16, 12), fine = make_facet_quadrature(48, 32);
  const FacetView view(alpha, cos_theta);
  return integrate_facets(eta < 1 ? fine : coarse, view, false, [&](const FacetView::Facet& facet) {
    const FacetView::Light i = view.refracted(facet, eta);
    if (!(i.z < 0)) return 0.0;
    return (1 - coat_fresnel(eta, std::max(0.0, facet.cos_d), false)) * view.shadowing(i) *
           layer_transmittance(thickness, -i.z);
  });
}

// The integral of 2 c T(c) R(c) dc. R has an infinite slope at the critical angle and T at 0: nodes gather there.
double layer_return(double alpha, double eta, double thickness) {
  static const FacetQuadrature quadrature = make_facet_quadrature(32, 24);
  static const std::vector<QuadratureNode> nodes = gauss_legendre(32);
  const double critical = eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0;
  const auto integrand = [&](double c) {
    return 2 * c * layer_transmittance(thickness, c) * returned(quadrature, alpha, 1 / eta, thickness, c);
  };
  double sum = 0;
  for (const QuadratureNode& node : nodes) {
    const double x = node.x, x2 = x * x, below = x2 * (3 - 2 * x);
    sum += node.weight * critical * 6 * x * (1 - x) * integrand(critical * below);
    sum += node.weight * (1 - critical) * 4 * x2 * x * integrand(critical + (1 - critical) * x2 * x2);
  }
  return sum;
}

}  // namespace metamer
