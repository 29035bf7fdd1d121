// The oracle's camera rays.
#pragma once
#include "tests/reference_lights.h"

namespace metamer {

struct ReferenceRay {
  Vector origin, direction;
};
// Through a pixel, at random by its filter and the lens.
ReferenceRay reference_camera_ray(const World& world, uint32_t x, uint32_t y, ReferenceRandom& random);

}  // namespace metamer
