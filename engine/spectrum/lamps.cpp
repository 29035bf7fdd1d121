#include "engine/spectrum/lamps.h"

namespace metamer {
namespace {

struct LampMatrices {
  Matrix3 forward, backward;
};

LampMatrices make_matrices(Observer observer) {
  if (observer == Observer::stiles_burch1955) {
    const Matrix3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return {identity, identity};
  }
  Matrix3 columns;
  for (size_t lamp = 0; lamp < 3; ++lamp) {
    const Color3 value = observer_value(observer, lamp_nm[lamp]);
    for (size_t row = 0; row < 3; ++row) columns[row][lamp] = value[row];
  }
  return {columns, inverse(columns)};
}

const LampMatrices& matrices(Observer observer) {
  static const std::array<LampMatrices, observer_count> all = {
      make_matrices(Observer::cie1931), make_matrices(Observer::cie1964), make_matrices(Observer::cie2015_2),
      make_matrices(Observer::cie2015_10), make_matrices(Observer::stiles_burch1955)};
  return all[static_cast<size_t>(observer)];
}

}  // namespace

const Matrix3& lamps_to_tristimulus(Observer observer) { return matrices(observer).forward; }

Color3 lamp_amounts(const Color3& tristimulus, Observer observer) {
  return multiply(matrices(observer).backward, tristimulus);
}

Color3 lamp_amounts(const Samples& light, Observer observer) {
  return lamp_amounts(integrate_xyz(light, observer), observer);
}

Color3 lamp_amounts_of_line(double lambda_nm, Observer observer) {
  return lamp_amounts(Color3(observer_value(observer, lambda_nm)), observer);
}

Color3 xyz_of_lamps(const Color3& amounts) { return multiply(lamps_to_tristimulus(Observer::cie1931), amounts); }

}  // namespace metamer
