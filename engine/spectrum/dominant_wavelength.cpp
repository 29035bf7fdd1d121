#include "engine/spectrum/dominant_wavelength.h"

#include <cmath>
#include <optional>

namespace metamer {
namespace {

using Point = std::array<double, 2>;

// Beyond 699 nm the locus stands still: all longer wavelengths look alike.
constexpr int locus_begin_nm = 360, locus_end_nm = 699;

Point locus(int lambda_nm) {
  const Color3 xyz = observer_value(Observer::cie1931, lambda_nm);
  return {xyz[0] / (xyz[0] + xyz[1] + xyz[2]), xyz[1] / (xyz[0] + xyz[1] + xyz[2])};
}

struct Crossing {
  double along;     // on the half-line, in units of its direction
  double fraction;  // on the segment, 0 to 1
};

// Where from + along direction, along > 0, meets the segment from a to b.
std::optional<Crossing> crossing(const Point& from, const Point& direction, const Point& a, const Point& b) {
  const Point edge = {b[0] - a[0], b[1] - a[1]}, to_a = {a[0] - from[0], a[1] - from[1]};
  const double determinant = direction[0] * edge[1] - direction[1] * edge[0];
  if (determinant == 0) return std::nullopt;
  const double along = (to_a[0] * edge[1] - to_a[1] * edge[0]) / determinant;
  const double fraction = (to_a[0] * direction[1] - to_a[1] * direction[0]) / determinant;
  if (!(along > 0) || !(fraction >= 0 && fraction <= 1)) return std::nullopt;
  return Crossing{along, fraction};
}

struct OnLocus {
  double lambda_nm, along;
};

std::optional<OnLocus> leaves_through_spectrum(const Point& from, const Point& direction) {
  Point previous = locus(locus_begin_nm);
  for (int lambda = locus_begin_nm + 1; lambda <= locus_end_nm; ++lambda) {
    const Point next = locus(lambda);
    if (const auto found = crossing(from, direction, previous, next))
      return OnLocus{lambda - 1 + found->fraction, found->along};
    previous = next;
  }
  return std::nullopt;
}

}  // namespace

DominantWavelength dominant_wavelength(const Point& xy, const Point& white) {
  const Point direction = {xy[0] - white[0], xy[1] - white[1]};
  if (std::fabs(direction[0]) < 1e-9 && std::fabs(direction[1]) < 1e-9) return {};
  if (const auto found = leaves_through_spectrum(white, direction)) return {found->lambda_nm, false, 1 / found->along};
  const auto purple = crossing(white, direction, locus(locus_begin_nm), locus(locus_end_nm));
  const auto opposite = leaves_through_spectrum(white, {-direction[0], -direction[1]});
  if (!purple || !opposite) return {};  // the white was outside
  // The tables' last digits may place the longest wavelengths past the end of the spectrum.
  if (purple->fraction > 1 - 1e-5) return {locus_end_nm, false, 1 / purple->along};
  return {opposite->lambda_nm, true, 1 / purple->along};
}

}  // namespace metamer
