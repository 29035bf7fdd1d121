// Integrals over the facets of a GGX surface that a viewing direction sees, in double precision from + - * / and sqrt
// (and portable sines): the same on every machine. For the tables that are made when a world is built.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace metamer {

// One viewing direction against facets whose normals are drawn as sample_conductor draws them: points of a spherical
// cap, phi around its axis, v = s^2 from its top.
struct FacetView {
  // alpha at least least_alpha, cos_theta in [0, 1].
  FacetView(double alpha_, double cos_theta)
      : alpha(alpha_), z(std::max(cos_theta, 1e-8)), x(std::sqrt(std::max(0.0, 1 - z * z))) {
    stretched_o = std::sqrt(alpha * alpha * x * x + z * z);
    w_x = alpha * x / stretched_o;
    w_z = z / stretched_o;
  }
  double alpha;
  double z, x;         // wo; its y is 0
  double w_x, w_z;     // wo where the surface is a hemisphere
  double stretched_o;  // sqrt((alpha x)^2 + z^2)

  struct Facet {
    double x, y, z;  // its normal
    double cos_d;    // between it and wo
  };
  Facet facet(double cos_phi, double sin_phi, double s) const {
    const double cap_z = (1 - s * s) * (1 + w_z) - w_z, r = std::sqrt(std::max(0.0, 1 - cap_z * cap_z));
    const double m_x = alpha * (r * cos_phi + w_x), m_y = alpha * (r * sin_phi), m_z = cap_z + w_z;
    const double inverse = 1 / std::sqrt(m_x * m_x + m_y * m_y + m_z * m_z);
    return {m_x * inverse, m_y * inverse, m_z * inverse, std::min(1.0, (x * m_x + z * m_z) * inverse)};
  }
  struct Light {
    double x, y, z;
  };
  // Below the surface where z < 0.
  Light reflected(const Facet& m) const {
    const double twice = 2 * m.cos_d;
    return {twice * m.x - x, twice * m.y, twice * m.z - z};
  }
  // Above the surface where z > 0; eta: relative index behind the surface; z = 0 in total internal reflection.
  Light refracted(const Facet& m, double eta) const {
    const double g2 = m.cos_d * m.cos_d + (eta - 1) * (eta + 1);
    if (g2 <= 0) return {1, 0, 0};
    const double along = (m.cos_d - std::sqrt(g2)) / eta;
    return {along * m.x - x / eta, along * m.y, along * m.z - z / eta};
  }
  // G / G1 for light on either side.
  double shadowing(const Light& i) const {
    const double c = std::abs(i.z), stretched_i = std::sqrt(alpha * alpha * (i.x * i.x + i.y * i.y) + c * c);
    return std::min(1.0, c * (z + stretched_o) / (stretched_o * c + stretched_i * z));
  }
  // Where on the way from the cap's top to its rim reflections sink below the surface.
  double horizon(double cos_phi, double sin_phi) const {
    double above = 0, below = 1;
    for (int k = 0; k < 14; ++k) {
      const double middle = (above + below) / 2;
      (reflected(facet(cos_phi, sin_phi, middle)).z > 0 ? above : below) = middle;
    }
    return above;
  }
};

// Gauss-Legendre nodes and weights on [0, 1].
struct QuadratureNode {
  double x, weight;
};
std::vector<QuadratureNode> gauss_legendre(int count);

struct FacetQuadrature {
  struct Azimuth {
    double cosine, sine, weight;
  };
  std::vector<Azimuth> azimuths;
  std::vector<QuadratureNode> rings;
};
FacetQuadrature make_facet_quadrature(int around, int outwards);

// The average of value(facet) over the visible facets. `above`: it is 0 where reflections sink below the surface.
template <class Value>
double integrate_facets(const FacetQuadrature& quadrature, const FacetView& view, bool above, const Value& value) {
  double sum = 0;
  for (const FacetQuadrature::Azimuth& azimuth : quadrature.azimuths) {
    const double edge = above ? view.horizon(azimuth.cosine, azimuth.sine) : 1;
    for (const QuadratureNode& ring : quadrature.rings) {
      const double s = edge * ring.x;
      sum += azimuth.weight * ring.weight * edge * 2 * s * value(view.facet(azimuth.cosine, azimuth.sine, s));
    }
  }
  return sum;
}

}  // namespace metamer
