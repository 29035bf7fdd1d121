// The optics of the world's materials, in the form that the scalar BSDFs take.
#pragma once
#include <glm/geometric.hpp>

#include "engine/ecs/world.h"
#include "systems/bsdf/reference.h"
#include "systems/bsdf/reference_coat.h"
#include "tests/reference_scene.h"

namespace metamer {

// The shading frame at a hit, in which the scalar BSDFs work.
struct ReferenceFrame {
  Vector x, y, z;
  Vector came;  // along the ray that hit
  reference::Direction in(const Vector& v) const { return {glm::dot(x, v), glm::dot(y, v), glm::dot(z, v)}; }
  Vector out(const reference::Direction& v) const { return x * v.x + y * v.y + z * v.z; }
};
ReferenceFrame reference_frame(const ReferenceHit& hit, const Vector& came);

// An index against that of a row of World::media.
reference::Spectrum4 reference_relative(const World& world, uint32_t index, uint32_t around,
                                        const reference::Spectrum4& lambda_nm);
// A thin plate within a row of World::media.
reference::ThinOptics reference_thin(const World& world, uint32_t row, uint32_t around,
                                     const reference::Spectrum4& lambda_nm);
reference::CoatOptics reference_coat(const World& world, ShadeKind kind, uint32_t row,
                                     const reference::Spectrum4& lambda_nm);

}  // namespace metamer
