#include "tests/systems/support/layered_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace metamer::testing {
namespace {
using reference::Direction;
constexpr double pi = std::numbers::pi;

Direction opposite(const Direction& w) { return {-w.x, -w.y, -w.z}; }
Direction upper(const Direction& w) { return w.z < 0 ? opposite(w) : w; }
Direction plus(const Direction& a, const Direction& b, double s) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
double g1(const reference::Roughness& r, const Direction& w) { return 1 / (1 + reference::ggx_lambda(r, w)); }
double g2(const reference::Roughness& r, const Direction& a, const Direction& b) {
  return 1 / (1 + reference::ggx_lambda(r, a) + reference::ggx_lambda(r, b));
}
// The distribution of normals visible from w, per solid angle of the normal.
double visible_pdf(const reference::Roughness& r, const Direction& w, const Direction& m) {
  return reference::ggx_d(r, m) * g1(r, w) * std::max(0.0, reference::dot(upper(w), m)) / std::abs(w.z);
}
// The share of the weaker strategy falls with its square.
double power(double a, double b) { return a == 0 ? 0 : a * a / (a * a + b * b); }
}  // namespace

// By slopes (Heitz & d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals",
// EGSR 2014) in the later form of Heitz, JCGT 7(4), 2018: points of a disk, pulled towards the viewer.
Direction LayeredWalk::visible_normal(const reference::Roughness& r, const Direction& w) {
  const Direction up = upper(w);
  const Direction v = reference::normalize({r.alpha_x * up.x, r.alpha_y * up.y, up.z});
  const double across = std::hypot(v.x, v.y);
  const Direction t1 = across > 1e-12 ? Direction{-v.y / across, v.x / across, 0} : Direction{1, 0, 0};
  const Direction t2 = {v.y * t1.z - v.z * t1.y, v.z * t1.x - v.x * t1.z, v.x * t1.y - v.y * t1.x};
  const double radius = std::sqrt(uniform()), phi = 2 * pi * uniform();
  const double a = radius * std::cos(phi), s = 0.5 * (1 + v.z);
  const double b = (1 - s) * std::sqrt(std::max(0.0, 1 - a * a)) + s * radius * std::sin(phi);
  const double c = std::sqrt(std::max(0.0, 1 - a * a - b * b));
  const Direction h = plus(plus({a * t1.x, a * t1.y, a * t1.z}, t2, b), v, c);
  return reference::normalize({r.alpha_x * h.x, r.alpha_y * h.y, std::max(1e-12, h.z)});
}

LayeredWalk::Step LayeredWalk::transmit(const Direction& w) {
  const double relative = w.z > 0 ? eta : 1 / eta;
  const Direction up = upper(w);
  const Direction m = is_smooth_surface() ? Direction{0, 0, 1} : visible_normal(surface, up);
  const double c = reference::dot(up, m);
  Direction t;
  if (c <= 0 || !reference::refract(opposite(up), m, relative, t) || t.z >= 0) return {};
  Step step;
  step.w = w.z > 0 ? t : opposite(t);
  step.weight = 1 - reference::fresnel_dielectric(relative, c);
  if (is_smooth_surface()) return step;
  step.weight *= g2(surface, up, t) / g1(surface, up);
  transmission_f(w, step.w, &step.pdf);
  return step;
}

LayeredWalk::Step LayeredWalk::reflect_inside(const Direction& w) {
  const Direction up = opposite(w);
  const Direction m = is_smooth_surface() ? Direction{0, 0, 1} : visible_normal(surface, up);
  const double c = reference::dot(up, m);
  const Direction r = reference::reflect(opposite(up), m);
  if (c <= 0 || r.z <= 0) return {};
  Step step;
  step.w = opposite(r);
  step.weight = reference::fresnel_dielectric(1 / eta, c);
  if (is_smooth_surface()) return step;
  step.weight *= g2(surface, up, r) / g1(surface, up);
  step.pdf = visible_pdf(surface, up, m) / (4 * c);
  return step;
}

// Walter et al. 2007, equation 21, as a share of power; `pdf` that of transmit(from) for `to`.
double LayeredWalk::transmission_f(const Direction& from, const Direction& to, double* pdf) const {
  *pdf = 0;
  if (is_smooth_surface() || from.z * to.z >= 0) return 0;
  const double relative = from.z > 0 ? eta : 1 / eta;
  Direction m = reference::normalize(plus(from, to, relative));
  m = upper(m);
  const Direction up = upper(from), down = from.z > 0 ? to : opposite(to);
  const double c = reference::dot(up, m), t = reference::dot(down, m);
  if (c <= 0 || t >= 0) return 0;
  const double jacobian = -t / std::pow(t + c / relative, 2);
  *pdf = visible_pdf(surface, up, m) * jacobian;
  const double passes = 1 - reference::fresnel_dielectric(relative, c);
  return reference::ggx_d(surface, m) * g2(surface, up, down) * passes * c * jacobian / (up.z * -down.z);
}

double LayeredWalk::base_f(const Direction& w, const Direction& to, double* pdf) const {
  *pdf = 0;
  if (w.z <= 0 || to.z <= 0) return 0;
  if (!conductor) {
    *pdf = to.z / pi;
    return reflectance / pi;
  }
  const reference::BsdfValue value =
      reference::eval_conductor(w, base, {{n, n, n, n}, {kappa, kappa, kappa, kappa}, false}, to);
  *pdf = value.pdf;
  return value.f_cos[0] / to.z;
}

LayeredWalk::Step LayeredWalk::scatter_at_base(const Direction& w) {
  Step step;
  if (!conductor) {
    const double r = std::sqrt(uniform()), phi = 2 * pi * uniform();
    step.w = {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1 - r * r))};
    step.weight = reflectance;
    step.pdf = step.w.z / pi;
    return step;
  }
  const bool smooth = reference::is_smooth(base);
  const Direction m = smooth ? Direction{0, 0, 1} : visible_normal(base, w);
  const double c = reference::dot(w, m);
  step.w = reference::reflect(opposite(w), m);
  if (c <= 0 || step.w.z <= 0) return {};
  step.weight = reference::fresnel_conductor(n, kappa, c);
  if (smooth) return step;
  step.weight *= g2(base, w, step.w) / g1(base, w);
  step.pdf = visible_pdf(base, w, m) / (4 * c);
  return step;
}

// Henyey & Greenstein; cos_theta between the way in and the way out.
double LayeredWalk::phase(double cos_theta) const {
  const double g = asymmetry;
  return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cos_theta, 1.5));
}
Direction LayeredWalk::sample_phase(const Direction& w) {
  const double g = asymmetry, u = uniform(), phi = 2 * pi * uniform();
  const double s = (1 - g * g) / (1 - g + 2 * g * u);
  const double c = std::abs(g) < 1e-3 ? 1 - 2 * u : (1 + g * g - s * s) / (2 * g),
               r = std::sqrt(std::max(0.0, 1 - c * c));
  const Direction x = std::abs(w.x) > 0.5 ? Direction{0, 1, 0} : Direction{1, 0, 0};
  const Direction a = reference::normalize(plus(x, w, -reference::dot(x, w)));
  const Direction b = {w.y * a.z - w.z * a.y, w.z * a.x - w.x * a.z, w.x * a.y - w.y * a.x};
  return plus(plus({c * w.x, c * w.y, c * w.z}, a, r * std::cos(phi)), b, r * std::sin(phi));
}

double LayeredWalk::transmittance(double distance, const Direction& w) const {
  return std::exp(-std::abs(distance / w.z));
}

LayeredWalk::Sample LayeredWalk::sample(const Direction& wo) {
  Sample result;
  // What the surface does first, by chance.
  const Direction m = is_smooth_surface() ? Direction{0, 0, 1} : visible_normal(surface, wo);
  const double c = reference::dot(wo, m);
  const double f = reference::fresnel_dielectric(eta, c);
  Direction w;
  if (uniform() < f) {
    w = reference::reflect(opposite(wo), m);
    if (w.z <= 0) return result;
    result.wi = w;
    result.weight = is_smooth_surface() ? 1 : g2(surface, wo, w) / g1(surface, wo);
    result.mirrored = true;
    return result;
  }
  if (!reference::refract(opposite(wo), m, eta, w) || w.z >= 0) return result;
  double weight = is_smooth_surface() ? 1 : g2(surface, wo, w) / g1(surface, wo);
  double z = thickness;
  for (int depth = 0; depth < max_depth; ++depth) {
    if (albedo > 0) {
      const double next = z - std::log(1 - uniform()) * w.z;
      if (next > 0 && next < thickness) {
        weight *= albedo;
        w = sample_phase(w);
        z = next;
        continue;
      }
    } else {
      weight *= transmittance(thickness, w);
    }
    z = w.z > 0 ? thickness : 0;
    if (z == 0) {
      const Step step = scatter_at_base(opposite(w));
      weight *= step.weight;
      w = step.w;
    } else {
      // Either direction at the facet.
      const Direction up = w;
      const Direction facet = is_smooth_surface() ? Direction{0, 0, 1} : visible_normal(surface, up);
      const double cosine = reference::dot(up, facet);
      const bool passes = uniform() >= reference::fresnel_dielectric(1 / eta, cosine);
      Direction next = reference::reflect(opposite(up), facet);
      if (passes && !reference::refract(opposite(up), facet, 1 / eta, next)) return {};
      if (passes ? next.z >= 0 : next.z <= 0) return {};
      if (!is_smooth_surface()) weight *= g2(surface, up, next) / g1(surface, up);
      w = opposite(next);
      if (passes) {
        result.wi = w;
        result.weight = weight;
        return result;
      }
    }
    if (weight == 0) return {};
  }
  return {};
}

// As pbrt, but for the weights of the two ways to find the direction towards wi, which sum to 1 here.
double LayeredWalk::inner_f(const Direction& wo, const Direction& wi) {
  const Step in = transmit(wo), out = transmit(wi);
  if (in.weight == 0 || out.weight == 0) return 0;
  const bool smooth = is_smooth_surface();
  const bool specular_base = conductor && reference::is_smooth(base);
  // The radiance outside is less by eta^2; of the way out, f over pdf.
  double weight = in.weight / (eta * eta), f = 0, z = thickness;
  const double out_f = out.weight / std::abs(out.w.z);
  Direction w = in.w;
  for (int depth = 0; depth < max_depth; ++depth) {
    if (albedo == 0) {
      z = z == thickness ? 0 : thickness;
      weight *= transmittance(thickness, w);
    } else {
      const double next = z - std::log(1 - uniform()) * w.z;
      if (next > 0 && next < thickness) {
        const double p = phase(-reference::dot(w, out.w));
        const double share = smooth ? 1 : power(out.pdf, p);
        f += weight * albedo * p * share * transmittance(thickness - next, out.w) * out_f;
        const Direction to = sample_phase(w);
        const double sampled = phase(reference::dot(w, to));
        weight *= albedo;
        w = to;
        z = next;
        if (w.z > 0 && !smooth) {
          double pdf;
          const double exit = transmission_f(wi, opposite(w), &pdf);
          f += weight * transmittance(thickness - z, w) * exit * power(sampled, pdf);
        }
        continue;
      }
      z = w.z > 0 ? thickness : 0;
    }
    if (z > 0) {
      const Step step = reflect_inside(opposite(w));
      // The twin of `sample`'s choice, taken always.
      if (step.weight == 0) break;
      weight *= step.weight;
      w = step.w;
      continue;
    }
    const Direction from = opposite(w), towards = opposite(out.w);
    if (!specular_base) {
      double pdf;
      const double at_base = base_f(from, towards, &pdf);
      const double share = smooth ? 1 : power(out.pdf, pdf);
      f += weight * at_base * towards.z * share * transmittance(thickness, out.w) * out_f;
    }
    const Step step = scatter_at_base(from);
    if (step.weight == 0) break;
    weight *= step.weight;
    w = step.w;
    if (smooth) continue;
    double pdf;
    const double exit = transmission_f(wi, opposite(w), &pdf);
    f += weight * transmittance(thickness, w) * exit * (specular_base ? 1 : power(step.pdf, pdf));
  }
  return f;
}

}  // namespace metamer::testing
