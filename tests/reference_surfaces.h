// The rough surfaces of the scalar oracle that need nothing but their own row: which twin they are evaluated by.
#pragma once
#include <functional>
#include <optional>

#include "systems/bsdf/reference.h"
#include "tests/reference_scene.h"

namespace metamer {

struct ReferenceSurface {
  std::function<reference::BsdfValue(const reference::Direction& wi)> eval;
  std::function<reference::BsdfSample(double choice, double u, double v)> sample;
};

// Seen from wo; nothing for kinds that depend on what is around, or have delta lobes.
std::optional<ReferenceSurface> reference_surface(const World& world, ShadeKind kind, uint32_t row,
                                                  const reference::Direction& wo,
                                                  const reference::Spectrum4& lambda_nm);

// The kind and row of what is met at an object; `random` draws numbers in [0, 1) for mixed materials.
struct ReferenceMaterial {
  ShadeKind kind;
  uint32_t row;
};
ReferenceMaterial reference_material(const World& world, uint32_t object, const std::function<double()>& random);

}  // namespace metamer
