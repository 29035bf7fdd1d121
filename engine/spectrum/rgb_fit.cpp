#include "engine/spectrum/rgb_fit.h"

#include <algorithm>
#include <cmath>

namespace metamer {
namespace {

// Relative to min(largest channel, 1 - smallest channel).
constexpr double tolerance = 1e-8;

struct Evaluation {
  Color3 rgb{};
  Matrix3 jacobian{};  // d rgb[k] / d c[j]
};

Evaluation evaluate(std::span<const QuadratureNode> nodes, const SigmoidCoefficients& c) {
  Evaluation e;
  for (const auto& [t, weight] : nodes) {
    const double x = (c[0] * t + c[1]) * t + c[2];
    const double inverse_root = 1.0 / std::sqrt(1.0 + x * x);
    const double s = 0.5 + 0.5 * x * inverse_root;
    const double ds = 0.5 * inverse_root * inverse_root * inverse_root;
    for (size_t k = 0; k < 3; ++k) {
      const double w = weight[k];
      e.rgb[k] += w * s;
      e.jacobian[k][2] += w * ds;
      e.jacobian[k][1] += w * ds * t;
      e.jacobian[k][0] += w * ds * t * t;
    }
  }
  return e;
}

double largest_difference(const Color3& a, const Color3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

double squared_distance(const Color3& a, const Color3& b) {
  const Color3 d = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

// The Gauss-Newton step of (J^T J + damping diag(J^T J)) d = J^T r.
Color3 damped_step(const Matrix3& jacobian, const Color3& residual, double damping) {
  Matrix3 normal{};
  Color3 right{};
  for (size_t a = 0; a < 3; ++a) {
    for (size_t k = 0; k < 3; ++k) {
      right[a] += jacobian[k][a] * residual[k];
      for (size_t b = 0; b < 3; ++b) normal[a][b] += jacobian[k][a] * jacobian[k][b];
    }
  }
  for (size_t a = 0; a < 3; ++a) normal[a][a] *= 1.0 + damping;
  return multiply(inverse(normal), right);
}

double residual_scale(const Color3& rgb) {
  const auto [low, high] = std::minmax({rgb[0], rgb[1], rgb[2]});
  return std::min(high, 1.0 - low);
}

// Goes from the grey of the same luminance towards the colour in steps as long as each can be solved from the last;
// then as near to the colour as possible from there.
SigmoidCoefficients solve_from_grey(ColorSpace space, const Color3& rgb) {
  const std::span<const QuadratureNode> nodes = full_quadrature(space);
  const Color3& y = rgb_to_xyz(space)[1];
  const double luminance = y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2];
  const double grey = std::clamp(luminance, 1e-8, 1.0 - 1e-8);
  SigmoidCoefficients reached = grey_sigmoid(grey);
  double position = 0.0;
  double step = 1.0;
  while (position < 1.0 && step > 1e-3) {
    const double next = std::min(1.0, position + step);
    Color3 target;
    for (size_t k = 0; k < 3; ++k) target[k] = grey + next * (rgb[k] - grey);
    SigmoidCoefficients c = reached;
    if (refine_sigmoid(nodes, target, c)) {
      reached = c;
      position = next;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  if (position < 1.0) refine_sigmoid(nodes, rgb, reached);
  return reached;
}

}  // namespace

double sigmoid(double x) { return 0.5 + 0.5 * x / std::sqrt(1.0 + x * x); }

double sigmoid_polynomial(const SigmoidCoefficients& c, double lambda_nm) {
  const double t = (lambda_nm - sigmoid_center_nm) / sigmoid_half_range_nm;
  return sigmoid((c[0] * t + c[1]) * t + c[2]);
}

SigmoidCoefficients grey_sigmoid(double grey) {
  if (grey <= 0.0) return {0.0, 0.0, -sigmoid_saturated};
  if (grey >= 1.0) return {0.0, 0.0, sigmoid_saturated};
  return {0.0, 0.0, (grey - 0.5) / std::sqrt(grey * (1.0 - grey))};
}

SigmoidFit fit_sigmoid(ColorSpace space, const Color3& rgb) {
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return {grey_sigmoid(rgb[0]), 0.0};
  const SigmoidCoefficients c = solve_from_grey(space, rgb);
  return {c, largest_difference(sigmoid_rgb(space, c), rgb)};
}

Color3 sigmoid_rgb(ColorSpace space, const SigmoidCoefficients& c) { return evaluate(full_quadrature(space), c).rgb; }

bool refine_sigmoid(std::span<const QuadratureNode> nodes, const Color3& rgb, SigmoidCoefficients& c) {
  const double accepted = tolerance * residual_scale(rgb);
  Evaluation now = evaluate(nodes, c);
  double distance = squared_distance(now.rgb, rgb);
  double damping = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    if (largest_difference(now.rgb, rgb) <= accepted) return true;
    const Color3 residual = {rgb[0] - now.rgb[0], rgb[1] - now.rgb[1], rgb[2] - now.rgb[2]};
    // An undamped step through the 3x3 system itself is better conditioned than the normal equations.
    const Color3 step =
        damping == 0.0 ? multiply(inverse(now.jacobian), residual) : damped_step(now.jacobian, residual, damping);
    const SigmoidCoefficients trial = {c[0] + step[0], c[1] + step[1], c[2] + step[2]};
    const double size = std::max({std::abs(trial[0]), std::abs(trial[1]), std::abs(trial[2])});
    if (size <= largest_sigmoid_coefficient) {  // false for NaN too
      const Evaluation next = evaluate(nodes, trial);
      const double next_distance = squared_distance(next.rgb, rgb);
      if (next_distance < distance) {
        c = trial;
        now = next;
        distance = next_distance;
        damping = damping < 1e-6 ? 0.0 : damping * 0.1;
        continue;
      }
    }
    damping = damping == 0.0 ? 1e-5 : damping * 10.0;
    if (damping > 1e4) return false;
  }
  return largest_difference(now.rgb, rgb) <= accepted;
}

}  // namespace metamer
