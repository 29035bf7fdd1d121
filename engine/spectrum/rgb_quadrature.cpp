#include "engine/spectrum/rgb_quadrature.h"

#include <algorithm>
#include <vector>

#include "engine/spectrum/rgb_fit.h"

namespace metamer {
namespace {

using Nodes = std::vector<QuadratureNode>;

double t_of(double lambda_nm) { return (lambda_nm - sigmoid_center_nm) / sigmoid_half_range_nm; }

Nodes make_full(ColorSpace space) {
  const Samples& white = white_illuminant(space);
  const auto& matching = observer_table(Observer::cie1931).matching;
  const double y = integrate(white, matching[1]);
  Nodes nodes(lambda_count);
  for (size_t i = 0; i < lambda_count; ++i) {
    const double w = white[i] / y;
    const Color3 xyz = {w * matching[0][i], w * matching[1][i], w * matching[2][i]};
    nodes[i] = {t_of(lambda_min_nm + static_cast<double>(i)), multiply(xyz_to_rgb(space), xyz)};
  }
  return nodes;
}

// Spreads the weight of each 1 nm node over four of the coarse nodes by Lagrange's basis polynomials.
Nodes make_reduced(ColorSpace space) {
  constexpr size_t step = 5;
  static_assert((lambda_count - 1) % step == 0);
  Nodes nodes((lambda_count - 1) / step + 1);
  for (size_t k = 0; k < nodes.size(); ++k) nodes[k] = {t_of(lambda_min_nm + static_cast<double>(k * step)), {}};
  const std::span<const QuadratureNode> full = full_quadrature(space);
  for (size_t i = 0; i < lambda_count; ++i) {
    const size_t cell = i / step;
    const size_t first = std::min(cell == 0 ? 0 : cell - 1, nodes.size() - 4);
    const double at = static_cast<double>(i) / step - static_cast<double>(first);
    for (size_t j = 0; j < 4; ++j) {
      double basis = 1.0;
      for (size_t other = 0; other < 4; ++other) {
        if (other != j)
          basis *= (at - static_cast<double>(other)) / (static_cast<double>(j) - static_cast<double>(other));
      }
      for (size_t c = 0; c < 3; ++c) nodes[first + j].weight[c] += basis * full[i].weight[c];
    }
  }
  return nodes;
}

template <class Make>
std::array<Nodes, color_space_count> for_all_spaces(Make make) {
  return {make(ColorSpace::srgb), make(ColorSpace::dci_p3), make(ColorSpace::rec2020), make(ColorSpace::aces2065_1)};
}

}  // namespace

std::span<const QuadratureNode> full_quadrature(ColorSpace space) {
  static const std::array<Nodes, color_space_count> all = for_all_spaces(make_full);
  return all[static_cast<size_t>(space)];
}

std::span<const QuadratureNode> reduced_quadrature(ColorSpace space) {
  static const std::array<Nodes, color_space_count> all = for_all_spaces(make_reduced);
  return all[static_cast<size_t>(space)];
}

}  // namespace metamer
