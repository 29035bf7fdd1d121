#include "systems/bsdf/coat_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/simd/portable_math.h"
#include "systems/bsdf/limits.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double eta_step = 0.02;
constexpr uint32_t most_rows = 64;

// Light with its transmitted cosine; see fresnel_dielectric in fresnel-inl.h.
double exact_reflectance(double eta, double c, double g) {
  const double sum = c + g, s2 = 1 - c * c;
  if (sum == 0) return 0;  // grazing on a surface that is not there
  const double r = (eta - 1) * (eta + 1) / (sum * sum * (c * g + s2));
  return std::min(1.0, r * r * (c * c * g * g + s2 * s2));
}

// One viewing direction against facets whose normals are drawn as sample_conductor draws them: points of a spherical
// cap, phi around its axis, v = s^2 from its top.
struct FacetView {
  double alpha, eta;
  bool schlick;
  double x, z;         // wo; its y is 0
  double w_x, w_z;     // wo where the surface is a hemisphere
  double stretched_o;  // sqrt((alpha x)^2 + z^2)

  struct Reflection {
    double cos_d, x, y, z;  // wi, below the surface where z < 0
  };
  Reflection reflection(double cos_phi, double sin_phi, double s) const {
    const double cap_z = (1 - s * s) * (1 + w_z) - w_z, r = std::sqrt(std::max(0.0, 1 - cap_z * cap_z));
    const double m_x = alpha * (r * cos_phi + w_x), m_y = alpha * (r * sin_phi), m_z = cap_z + w_z;
    const double inverse = 1 / std::sqrt(m_x * m_x + m_y * m_y + m_z * m_z);
    const double cos_d = std::min(1.0, (x * m_x + z * m_z) * inverse), twice = 2 * cos_d * inverse;
    return {cos_d, twice * m_x - x, twice * m_y, twice * m_z - z};
  }
  // F G / G1
  double weight(const Reflection& i) const {
    if (!(i.z > 0)) return 0;
    const double stretched_i = std::sqrt(alpha * alpha * (i.x * i.x + i.y * i.y) + i.z * i.z);
    const double shadowing = i.z * (z + stretched_o) / (stretched_o * i.z + stretched_i * z);
    return coat_fresnel(eta, std::max(0.0, i.cos_d), schlick) * std::min(1.0, shadowing);
  }
  // Where on the way from the cap's top to its rim reflections sink below the surface.
  double horizon(double cos_phi, double sin_phi) const {
    double above = 0, below = 1;
    for (int k = 0; k < 14; ++k) {
      const double middle = (above + below) / 2;
      (reflection(cos_phi, sin_phi, middle).z > 0 ? above : below) = middle;
    }
    return above;
  }
};

// Gauss-Legendre nodes and weights on [0, 1]: roots of the Legendre polynomial by Newton's method.
struct Node {
  double x, weight;
};
std::vector<Node> gauss_legendre(int count) {
  std::vector<Node> nodes;
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

// The integrand bends at phi = pi and at the horizon: nodes gather there.
struct Azimuth {
  double cosine, sine, weight;
};
struct Quadrature {
  std::vector<Azimuth> azimuths;
  std::vector<Node> rings;
};
Quadrature make_quadrature(int around, int outwards) {
  Quadrature quadrature;
  for (const Node& node : gauss_legendre(around)) {
    const double rest = 1 - node.x, phi = pi * (1 - rest * rest * rest);
    quadrature.azimuths.push_back({portable::cos(phi), portable::sin(phi), node.weight * 3 * rest * rest});
  }
  for (const Node& node : gauss_legendre(outwards))
    quadrature.rings.push_back({node.x * (2 - node.x), node.weight * 2 * (1 - node.x)});
  return quadrature;
}

void add_rough_row(double alpha, double eta, bool schlick, Column<float>& table) {
  std::array<float, coat_nodes> albedo;
  double average = 0;
  for (uint32_t k = 0; k < coat_nodes; ++k) {
    const double t = static_cast<double>(k) / (coat_nodes - 1);
    albedo[k] = static_cast<float>(rough_coat_albedo(alpha, eta, schlick, t * t * t * t));
    if (k == 0) continue;
    // 2 cos_theta d cos_theta = 8 t^7 dt, against an E that is linear in t.
    const double h = 1.0 / (coat_nodes - 1), t0 = t - h;
    const auto power8 = [](double x) { return x * x * x * x * x * x * x * x; };
    const double zeroth = power8(t) - power8(t0), first = 8.0 / 9 * (power8(t) * t - power8(t0) * t0);
    const double slope = (double{albedo[k]} - double{albedo[k - 1]}) / h;
    average += double{albedo[k - 1]} * zeroth + slope * (first - t0 * zeroth);
  }
  table.push_back(static_cast<float>(average));
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
  static const Quadrature coarse = make_quadrature(16, 8), fine = make_quadrature(64, 48);
  const Quadrature& quadrature = eta < 1 ? fine : coarse;
  const double z = std::max(cos_theta, 1e-8), x = std::sqrt(std::max(0.0, 1 - z * z));
  const double stretched = std::sqrt(alpha * alpha * x * x + z * z);
  const FacetView view{alpha, eta, schlick, x, z, alpha * x / stretched, z / stretched, stretched};
  double sum = 0;
  for (const Azimuth& azimuth : quadrature.azimuths) {
    const double edge = view.horizon(azimuth.cosine, azimuth.sine);
    for (const Node& ring : quadrature.rings) {
      const double s = edge * ring.x;
      const FacetView::Reflection wi = view.reflection(azimuth.cosine, azimuth.sine, s);
      sum += azimuth.weight * ring.weight * edge * 2 * s * view.weight(wi);
    }
  }
  return sum;
}

CoatRows add_coat_rows(double alpha, bool schlick, double eta_least, double eta_most, Column<float>& table) {
  const bool smooth = alpha < double{smooth_alpha};
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
    if (smooth)
      table.push_back(static_cast<float>(smooth_coat_average(eta, schlick)));
    else
      add_rough_row(std::max(alpha, double{least_alpha}), eta, schlick, table);
  }
  return rows;
}

}  // namespace metamer
