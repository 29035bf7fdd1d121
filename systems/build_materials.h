// The parts of build_materials: what is wrong with a material of a kind, and its row in the table of that kind.
#pragma once
#include "systems/freeze.h"

namespace metamer {

// Errors: roughness below 0 or not the same in both directions, eta not above 0, reflectance not in 0..1.
bool check_coated(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics);
// The material has passed its check.
MaterialRow add_coated(const Material& material, World& world);

}  // namespace metamer
