#include "engine/spectrum/rgb_fit.h"

#include <algorithm>
#include <cmath>

namespace metamer {
namespace {

// Coefficients past this are steps narrower than the tables can tell from one another.
constexpr double largest_coefficient = 2e4;
// Relative to the largest channel of the colour or of its complement, whichever is smaller.
constexpr double tolerance = 1e-8;

// rgb_weight[k][i] integrates a reflectance to channel k; white gives 1.
struct Weights {
  std::array<double, lambda_count> t;
  std::array<std::array<double, 3>, lambda_count> rgb;
};

Weights make_weights(ColorSpace space) {
  Weights weights;
  const Samples& white = white_illuminant(space);
  const auto& matching = observer_table(Observer::cie1931).matching;
  const double y = integrate(white, matching[1]);
  for (size_t i = 0; i < lambda_count; ++i) {
    weights.t[i] = (lambda_min_nm + static_cast<double>(i) - sigmoid_center_nm) / sigmoid_half_range_nm;
    const double w = white[i] / y;
    weights.rgb[i] = multiply(xyz_to_rgb(space), Color3{w * matching[0][i], w * matching[1][i], w * matching[2][i]});
  }
  return weights;
}

const Weights& weights_of(ColorSpace space) {
  static const std::array<Weights, color_space_count> all = {
      make_weights(ColorSpace::srgb), make_weights(ColorSpace::dci_p3), make_weights(ColorSpace::rec2020),
      make_weights(ColorSpace::aces2065_1)};
  return all[static_cast<size_t>(space)];
}

struct Evaluation {
  Color3 rgb{};
  Matrix3 jacobian{};  // d rgb[k] / d c[j]
};

Evaluation evaluate(const Weights& weights, const SigmoidCoefficients& c) {
  Evaluation e;
  for (size_t i = 0; i < lambda_count; ++i) {
    const double t = weights.t[i];
    const double x = (c[0] * t + c[1]) * t + c[2];
    const double inverse_root = 1.0 / std::sqrt(1.0 + x * x);
    const double s = 0.5 + 0.5 * x * inverse_root;
    const double ds = 0.5 * inverse_root * inverse_root * inverse_root;
    for (size_t k = 0; k < 3; ++k) {
      const double w = weights.rgb[i][k];
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

// Levenberg-Marquardt from `c`; true if the colour is met to the tolerance. On failure c is left at the best found.
bool solve(const Weights& weights, const Color3& rgb, double scale, SigmoidCoefficients& c) {
  Evaluation now = evaluate(weights, c);
  double error = largest_difference(now.rgb, rgb);
  double damping = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    if (error <= tolerance * scale) return true;
    const Color3 residual = {rgb[0] - now.rgb[0], rgb[1] - now.rgb[1], rgb[2] - now.rgb[2]};
    // An undamped step through the 3x3 system itself is better conditioned than the normal equations.
    const Color3 step =
        damping == 0.0 ? multiply(inverse(now.jacobian), residual) : damped_step(now.jacobian, residual, damping);
    const SigmoidCoefficients trial = {c[0] + step[0], c[1] + step[1], c[2] + step[2]};
    const double size = std::max({std::abs(trial[0]), std::abs(trial[1]), std::abs(trial[2])});
    if (size <= largest_coefficient) {  // false for NaN too
      const Evaluation next = evaluate(weights, trial);
      const double next_error = largest_difference(next.rgb, rgb);
      if (next_error < error) {
        c = trial;
        now = next;
        error = next_error;
        damping = damping < 1e-6 ? 0.0 : damping * 0.1;
        continue;
      }
    }
    damping = damping == 0.0 ? 1e-5 : damping * 10.0;
    if (damping > 1e8) return false;
  }
  return error <= tolerance * scale;
}

double grey_coefficient(double grey) { return (grey - 0.5) / std::sqrt(grey * (1.0 - grey)); }

double residual_scale(const Color3& rgb) {
  const auto [low, high] = std::minmax({rgb[0], rgb[1], rgb[2]});
  return std::min(high, 1.0 - low);
}

// Goes from the grey of the same luminance towards the colour in steps as long as each can be solved from the last.
SigmoidFit solve_from_grey(ColorSpace space, const Weights& weights, const Color3& rgb) {
  const Color3& y = rgb_to_xyz(space)[1];
  const double grey = std::clamp(y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2], 1e-12, 1.0 - 1e-12);
  const double scale = residual_scale(rgb);
  SigmoidFit fit{{0.0, 0.0, grey_coefficient(grey)}, 0.0};
  double reached = 0.0;
  double step = 1.0;
  while (reached < 1.0 && step > 1e-5) {
    const double next = std::min(1.0, reached + step);
    Color3 target;
    for (size_t k = 0; k < 3; ++k) target[k] = grey + next * (rgb[k] - grey);
    SigmoidCoefficients c = fit.c;
    if (solve(weights, target, scale, c)) {
      fit.c = c;
      reached = next;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  fit.error = largest_difference(evaluate(weights, fit.c).rgb, rgb);
  return fit;
}

}  // namespace

double sigmoid(double x) { return 0.5 + 0.5 * x / std::sqrt(1.0 + x * x); }

double sigmoid_polynomial(const SigmoidCoefficients& c, double lambda_nm) {
  const double t = (lambda_nm - sigmoid_center_nm) / sigmoid_half_range_nm;
  return sigmoid((c[0] * t + c[1]) * t + c[2]);
}

SigmoidFit fit_sigmoid(ColorSpace space, const Color3& rgb) {
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) {
    if (rgb[0] <= 0.0) return {{0.0, 0.0, -sigmoid_saturated}, 0.0};
    if (rgb[0] >= 1.0) return {{0.0, 0.0, sigmoid_saturated}, 0.0};
    return {{0.0, 0.0, grey_coefficient(rgb[0])}, 0.0};
  }
  return solve_from_grey(space, weights_of(space), rgb);
}

SigmoidFit fit_sigmoid_from(ColorSpace space, const Color3& rgb, const SigmoidCoefficients& start) {
  const Weights& weights = weights_of(space);
  const bool is_grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
  SigmoidCoefficients c = start;
  if (is_grey || !solve(weights, rgb, residual_scale(rgb), c)) return fit_sigmoid(space, rgb);
  return {c, largest_difference(evaluate(weights, c).rgb, rgb)};
}

Color3 sigmoid_rgb(ColorSpace space, const SigmoidCoefficients& c) { return evaluate(weights_of(space), c).rgb; }

}  // namespace metamer
