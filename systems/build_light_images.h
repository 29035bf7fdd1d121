// Images of lights as columns of spectra, or of the mode's coefficients.
#pragma once
#include <optional>

#include "engine/ecs/world.h"

namespace metamer {

inline constexpr const char* too_many_light_texels = "the images of all lights have more than 2^29 pixels";

// The row of World::light_images for a light that has an image; nothing where a kernel could not reach its texels any
// more. Lights with the same image share its texels.
std::optional<uint32_t> add_light_image(const Scene& scene, const Light& light, World& world);

// A light's portal and, of what is seen through it, the density of directions: of the environment, whose image
// (null: none) and mapping are known already.
void build_portal(const Light& light, const Image* image, Environment& environment);

}  // namespace metamer
