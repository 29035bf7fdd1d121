// The parts of build_materials: what is wrong with a material of a kind, and its row in the table of that kind.
#pragma once
#include "systems/freeze.h"

namespace metamer {

// The material is coated or layered. Errors: roughness below 0 or, coated, not the same in both directions, eta not
// above 0, reflectance not in 0..1.
bool check_coated(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics);
// The material has passed its check.
MaterialRow add_coated(const Material& material, World& world);

// Layers of pbrt's coat. Errors: optical thickness below 0, albedo not in 0..1, asymmetry not between -1 and 1, a
// base's index not above 0 or its roughness or kappa below 0. Warning: where its light has to be followed at random,
// and so its index to be one, it is not constant.
bool check_layered(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics);
// The material has passed its checks. In closed form where there is one.
MaterialRow add_layered(const Material& material, World& world);

// Errors: an index below 1, negative absorption, betas not in 0..1, a tilt beyond 20 degrees.
bool check_hair(const Scene& scene, Entity entity, const Material& material, Diagnostics& diagnostics);
MaterialRow add_hair(const Material& material, World& world);

// Rows of materials that are mixed of two others, into `rows` by entity index, where those of all others are. Errors:
// amounts that are not numbers, materials mixed of themselves or of nothing.
void add_mixes(const Scene& scene, std::vector<MaterialRow>& rows, World& world, Diagnostics& diagnostics);

}  // namespace metamer
