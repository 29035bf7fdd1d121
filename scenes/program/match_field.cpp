#include "scenes/program/match_field.h"

#include <algorithm>
#include <cmath>

#include "engine/spectrum/lamps.h"

namespace metamer {
namespace {

constexpr int width = 480, height = 400;                            // pixels
constexpr int disc_x = 240, disc_y = 150, disc_radius = 130;        // pixels; the field of 2 degrees
constexpr int bars_bottom = 390, tallest_bar = 90, bar_width = 36;  // pixels

void set(Picture& picture, int x, int y, const Color3& rgb) {
  const size_t pixel = static_cast<size_t>(y) * width + static_cast<size_t>(x);
  picture.r[pixel] = static_cast<float>(rgb[0]);
  picture.g[pixel] = static_cast<float>(rgb[1]);
  picture.b[pixel] = static_cast<float>(rgb[2]);
}

// What sRGB can show of amounts of the lamps, as bright as it can.
Color3 shown(const Color3& amounts) {
  Color3 rgb = multiply(xyz_to_rgb(ColorSpace::srgb), xyz_of_lamps(amounts));
  const double largest = std::max({rgb[0], rgb[1], rgb[2]});
  for (double& v : rgb) v = std::max(v, 0.0) / largest;
  return rgb;
}

void draw_disc(Picture& picture, const Color3& rgb) {
  for (int y = disc_y - disc_radius; y <= disc_y + disc_radius; ++y)
    for (int x = disc_x - disc_radius; x <= disc_x + disc_radius; ++x) {
      const int dx = x - disc_x, dy = y - disc_y;
      if (dx * dx + dy * dy > disc_radius * disc_radius || dx == 0) continue;  // a thin line between the halves
      set(picture, x, y, rgb);
    }
}

// `part` of the tallest bar.
void draw_bar(Picture& picture, int centre_x, double part, const Color3& rgb) {
  const int top = bars_bottom - static_cast<int>(std::lround(part * tallest_bar));
  for (int y = top; y < bars_bottom; ++y)
    for (int x = centre_x - bar_width / 2; x < centre_x + bar_width / 2; ++x) set(picture, x, y, rgb);
}

}  // namespace

Picture match_field(const Color3& amounts) {
  Picture picture{width, height, Column<float>(size_t{width} * height), Column<float>(size_t{width} * height),
                  Column<float>(size_t{width} * height)};
  // Light and added lamps on the left look like the other lamps on the right: that is what a match means.
  Color3 mixture{};
  for (size_t lamp = 0; lamp < 3; ++lamp) mixture[lamp] = std::max(0.0, amounts[lamp]);
  draw_disc(picture, shown(mixture));

  const double largest = std::max({std::fabs(amounts[0]), std::fabs(amounts[1]), std::fabs(amounts[2])});
  draw_bar(picture, 40, 1, shown(amounts));
  for (size_t lamp = 0; lamp < 3; ++lamp) {
    Color3 alone{};
    alone[lamp] = 1;
    const int side = amounts[lamp] < 0 ? 100 : disc_x + 40;
    draw_bar(picture, side + 50 * static_cast<int>(lamp), std::fabs(amounts[lamp]) / largest, shown(alone));
  }
  return picture;
}

}  // namespace metamer
