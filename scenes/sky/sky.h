// Sun and sky on a clear day: Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999.
//
// Directions are those of the sky's own space: x east, y north, z up. Angles in degrees; azimuth from north over east.
#pragma once
#include <glm/vec3.hpp>

#include "engine/ecs/scene.h"

namespace metamer {

// What the model was fitted to: clear air (2) to thick haze (10), sun above the horizon.
inline constexpr double turbidity_min = 2, turbidity_max = 10;

inline constexpr uint32_t resolution_min = 8, resolution_max = 8192;  // rows

// Seen from the ground: 2 x 1.39 / 300 rad, the disc that the paper's table of the sun's radiance belongs to.
inline constexpr double sun_diameter_deg = 0.531;

// pi sin^2 of half the diameter: irradiance over radiance on a plane facing the sun, sr.
double sun_projected_solid_angle();

struct SkySettings {
  double turbidity = 3;  // turbidity_min to turbidity_max
  double sun_elevation_deg = 45, sun_azimuth_deg = 180;
  bool has_sun = true;         // as far as the ground is lit by it
  double ground_albedo = 0.2;  // of the diffuse plane below the horizon, 0 to 1
  uint32_t resolution = 256;   // rows of the image, an even number
};

// Towards the middle of the sun, unit.
glm::dvec3 sun_direction(const SkySettings& settings);

// The sun's radiance on the ground, W m^-2 sr^-1 nm^-1: above the atmosphere, less what air, aerosols, ozone, mixed
// gases and water vapour take on the way (0.35 cm of ozone, 2 cm of water, Angstrom's exponent 1.3, as in the paper).
// The paper's table ends at 380 and 750 nm and keeps its end values beyond.
Samples sun_radiance(double turbidity, double sun_elevation_deg);

// Luminance in cd/m^2 and chromaticity by direction.
class SkyModel {
 public:
  SkyModel(double turbidity, double sun_elevation_deg);
  Color3 zenith() const { return zenith_; }  // Y, x, y
  // Y, x, y at a height above the horizon, cos_theta > 0 the cosine to the zenith, gamma the angle to the sun, radians.
  Color3 at(double cos_theta, double gamma) const;

 private:
  double coefficient_[3][5];  // of Perez' distribution, for Y, x and y
  Color3 zenith_;
  Color3 per_distribution_;  // zenith_ over the distribution's value there
};

// Latitude and longitude, linear Rec. 2020 in cd/m^2: the sky without the sun's disc, and below the horizon diffuse
// ground lit by both. What ground and sky send, `illuminance` (lx, XYZ on the horizontal), counts the sky and, where
// there is one, the sun.
struct SkyImage {
  Image image;
  Color3 sky_illuminance{}, sun_illuminance{};
};
SkyImage make_sky(const SkySettings& settings);

}  // namespace metamer
