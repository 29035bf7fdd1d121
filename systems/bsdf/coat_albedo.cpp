#include "systems/bsdf/coat_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/bsdf/coat_layer.h"
#include "systems/bsdf/facet_quadrature.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

constexpr double eta_step = 0.02;
constexpr uint32_t most_rows = 64;

// Light with its transmitted cosine; see fresnel_dielectric in fresnel-inl.h.
double exact_reflectance(double eta, double c, double g) {
  const double sum = c + g, s2 = 1 - c * c;
  if (sum == 0) return 0;  // grazing on a surface that is not there
  const double r = (eta - 1) * (eta + 1) / (sum * sum * (c * g + s2));
  return std::min(1.0, r * r * (c * c * g * g + s2 * s2));
}

// In the place of the average; see coat_layer.h.
double layered_average(const CoatSurface& surface, double alpha, double eta) {
  return 1 - eta * eta * (1 - layer_return(alpha, eta, surface.thickness));
}

void add_rough_row(const CoatSurface& surface, double eta, Column<float>& table) {
  const double alpha = std::max(surface.alpha, double{least_alpha});
  std::array<float, coat_nodes> albedo;
  double average = 0;
  for (uint32_t k = 0; k < coat_nodes; ++k) {
    const double t = static_cast<double>(k) / (coat_nodes - 1);
    const double cos_theta = t * t * t * t;
    albedo[k] = static_cast<float>(surface.layered ? 1 - rough_layer_entry(alpha, eta, surface.thickness, cos_theta)
                                                   : rough_coat_albedo(alpha, eta, surface.schlick, cos_theta));
    if (k == 0) continue;
    // 2 cos_theta d cos_theta = 8 t^7 dt, against an E that is linear in t.
    const double h = 1.0 / (coat_nodes - 1), t0 = t - h;
    const auto power8 = [](double x) { return x * x * x * x * x * x * x * x; };
    const double zeroth = power8(t) - power8(t0), first = 8.0 / 9 * (power8(t) * t - power8(t0) * t0);
    const double slope = (double{albedo[k]} - double{albedo[k - 1]}) / h;
    average += double{albedo[k - 1]} * zeroth + slope * (first - t0 * zeroth);
  }
  table.push_back(static_cast<float>(surface.layered ? layered_average(surface, alpha, eta) : average));
  for (const float e : albedo) table.push_back(e);
}

}  // namespace

double coat_fresnel(double eta, double cos_theta, bool schlick) {
  const double g2 = cos_theta * cos_theta + (eta - 1) * (eta + 1);
  if (g2 < 0) return 1;
  const double g = std::sqrt(g2);
  if (!schlick) return exact_reflectance(eta, cos_theta, g);
  const double r = (eta - 1) / (eta + 1), x = 1 - std::min(1.0, eta < 1 ? g / eta : cos_theta);
  return r * r + (1 - r * r) * (x * x * x * x * x);
}

double smooth_coat_average(double eta, bool schlick) {
  // All is reflected beyond the critical angle, near which F has an infinite slope; s^4 spreads it.
  const double critical2 = std::max(0.0, (1 - eta) * (1 + eta)), critical = std::sqrt(critical2);
  constexpr int cells = 2048;
  double sum = 0;
  for (int k = 0; k < cells; ++k) {
    const double s = (k + 0.5) / cells, s3 = s * s * s;
    const double cos_theta = critical + (1 - critical) * s3 * s;
    sum += 2 * cos_theta * coat_fresnel(eta, cos_theta, schlick) * 4 * s3 * (1 - critical);
  }
  return critical2 + sum / cells;
}

double rough_coat_albedo(double alpha, double eta, bool schlick, double cos_theta) {
  // Below 1 facets beyond the critical angle reflect all, an edge in the integrand.
  static const FacetQuadrature coarse = make_facet_quadrature(16, 8), fine = make_facet_quadrature(64, 48);
  const FacetView view(alpha, cos_theta);
  return integrate_facets(eta < 1 ? fine : coarse, view, true, [&](const FacetView::Facet& facet) {
    const FacetView::Light i = view.reflected(facet);
    return i.z > 0 ? coat_fresnel(eta, std::max(0.0, facet.cos_d), schlick) * view.shadowing(i) : 0;
  });
}

double coat_table_alpha(double alpha_x, double alpha_y) {
  if (alpha_x == alpha_y) return std::max(alpha_x, double{smooth_alpha});
  return std::max(std::sqrt((alpha_x * alpha_x + alpha_y * alpha_y) / 2), double{smooth_alpha});
}

CoatRows add_coat_rows(const CoatSurface& surface, double eta_least, double eta_most, Column<float>& table) {
  const bool smooth = surface.alpha < double{smooth_alpha};
  const double range = eta_most - eta_least;
  const auto pairs = static_cast<uint32_t>(std::ceil(std::min(range / eta_step, most_rows - 1.0)));
  CoatRows rows;
  rows.first = static_cast<uint32_t>(table.size());
  rows.eta_least = static_cast<float>(eta_least);
  if (pairs > 0) {
    rows.stride = smooth ? 1 : 1 + coat_nodes;
    rows.last_pair = pairs - 1;
    rows.rows_per_eta = static_cast<float>(pairs / range);
  }
  for (uint32_t row = 0; row <= pairs; ++row) {
    const double eta = pairs == 0 ? eta_least : eta_least + range * row / pairs;
    if (!smooth)
      add_rough_row(surface, eta, table);
    else
      table.push_back(static_cast<float>(surface.layered ? layered_average(surface, 0, eta)
                                                         : smooth_coat_average(eta, surface.schlick)));
  }
  return rows;
}

}  // namespace metamer
