#include "tests/reference_surfaces.h"

#include "tests/reference_lights.h"

namespace metamer {

using reference::Direction;
using reference::Spectrum4;

std::optional<ReferenceSurface> reference_surface(const World& world, ShadeKind kind, uint32_t row, const Direction& wo,
                                                  const Spectrum4& lambda_nm) {
  if (kind == ShadeKind::diffuse) {
    const Spectrum4 albedo = reference_spectrum(world, world.diffuse.reflectance[row], lambda_nm);
    return ReferenceSurface{[=](const Direction& wi) { return reference::eval_diffuse(wo, albedo, wi); },
                            [=](double, double u, double v) { return reference::sample_diffuse(wo, albedo, u, v); }};
  }
  if (kind == ShadeKind::diffuse_transmission) {
    const DiffuseTransmissionColumns& table = world.diffuse_transmission;
    const reference::SheetOptics optics{reference_spectrum(world, table.reflectance[row], lambda_nm),
                                        reference_spectrum(world, table.transmittance[row], lambda_nm)};
    return ReferenceSurface{
        [=](const Direction& wi) { return reference::eval_sheet(wo, optics, wi); },
        [=](double choice, double u, double v) { return reference::sample_sheet(wo, optics, choice, u, v); }};
  }
  if (kind == ShadeKind::rough) {
    const reference::RoughOptics optics{reference_spectrum(world, world.rough.kd[row], lambda_nm),
                                        reference_spectrum(world, world.rough.ks[row], lambda_nm),
                                        world.rough.shininess[row], world.rough.normalized[row] != 0};
    return ReferenceSurface{
        [=](const Direction& wi) { return reference::eval_rough(wo, optics, wi); },
        [=](double choice, double u, double v) { return reference::sample_rough(wo, optics, choice, u, v); }};
  }
  return std::nullopt;
}

ReferenceMaterial reference_material(const World& world, uint32_t object, const std::function<double()>& random) {
  uint32_t kind = world.objects.shade_kind[object], row = world.objects.material[object];
  while (kind == mixed_kind) {
    const MixRow& mix = world.mixes[row];
    const size_t which = random() < double{mix.amount} ? 1 : 0;
    kind = mix.kind[which];
    row = mix.row[which];
  }
  return {static_cast<ShadeKind>(kind), row};
}

}  // namespace metamer
