#include "scenes/program/look_report.h"

#include <fmt/format.h>

#include "systems/display_colour.h"

namespace metamer {

std::string tone_map_text(const Look& look) {
  if (look.view) return fmt::format("{}, {}", look.view->display, look.view->view);
  if (look.aces) return "aces";
  const std::string name(tone_curve_name(look.curve));
  return look.curve == ToneCurve::reinhard_extended ? fmt::format("{} {}", name, look.reinhard_white) : name;
}

void tell_negative_amounts(const Developed& developed) {
  if (developed.tone.display != ColorSpace::lamps) return;
  const NegativeAmounts negative = negative_amounts(developed.picture);
  const size_t pixels = developed.picture.pixel_count();
  if (negative.pixels == 0) {
    fmt::print(stderr, "metamer: no pixel needs a negative amount of a lamp\n");
    return;
  }
  fmt::print(stderr,
             "metamer: {} of {} pixels ({:.1f} %) need a negative amount of a lamp: red down to {:.4g}, green {:.4g}, "
             "blue {:.4g} (1/683 W m^-2 sr^-1)\n",
             negative.pixels, pixels, 100.0 * static_cast<double>(negative.pixels) / static_cast<double>(pixels),
             negative.least[0], negative.least[1], negative.least[2]);
}

}  // namespace metamer
