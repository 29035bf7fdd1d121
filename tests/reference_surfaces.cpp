#include "tests/reference_surfaces.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/reference_lights.h"
#include "tests/systems/support/layered_walk.h"

namespace metamer {

using reference::Direction;
using reference::Spectrum4;

namespace {

// pbrt's coat by scalar walks, one for each wavelength. Directions are drawn by their cosine alone, or for a smooth
// surface as often the mirror image.
struct ReferenceLayers {
  std::array<testing::LayeredWalk, 4> walks;
  double side;
  Direction wo;

  Direction up(const Direction& w) const { return {w.x, w.y, w.z * side}; }
  double surface_f(const testing::LayeredWalk& walk, const Direction& wi) const {
    if (reference::is_smooth(walk.surface)) return 0;
    const Direction h = reference::normalize({wo.x + wi.x, wo.y + wi.y, wo.z + wi.z});
    const double g = 1 / (1 + reference::ggx_lambda(walk.surface, wo) + reference::ggx_lambda(walk.surface, wi));
    return reference::ggx_d(walk.surface, h) * g * reference::fresnel_dielectric(walk.eta, reference::dot(wo, h)) /
           (4 * wo.z * wi.z);
  }
  reference::BsdfValue eval(const Direction& direction) {
    reference::BsdfValue value;
    const Direction wi = up(direction);
    if (!(wi.z > 0)) return value;
    value.pdf = wi.z / std::numbers::pi;
    for (size_t j = 0; j < 4; ++j) value.f_cos[j] = (walks[j].inner_f(wo, wi) + surface_f(walks[j], wi)) * wi.z;
    return value;
  }
  double mirror(const testing::LayeredWalk& walk) const {
    const double f = reference::fresnel_dielectric(walk.eta, wo.z);
    if (!walk.conductor || !reference::is_smooth(walk.base)) return f;
    const double c = reference::cos_transmitted(walk.eta, wo.z);
    const double r = reference::fresnel_conductor(walk.n, walk.kappa, c) * std::exp(-2 * walk.thickness / c);
    double sum = f, term = (1 - f) * (1 - f) * r;
    for (int k = 0; k < walk.max_depth / 2; ++k, term *= f * r) sum += term;
    return sum;
  }
  reference::BsdfSample sample(double choice, double u, double v) {
    reference::BsdfSample result;
    const bool smooth = reference::is_smooth(walks[0].surface);
    const double share = smooth ? 0.5 : 0;
    if (choice < share) {
      result.wi = {-wo.x, -wo.y, wo.z * side};
      result.delta = true;
      result.pdf = share;
      for (size_t j = 0; j < 4; ++j) result.weight[j] = mirror(walks[j]) / share;
      return result;
    }
    const reference::BsdfSample even = reference::sample_diffuse({0, 0, side}, {1, 1, 1, 1}, u, v);
    const reference::BsdfValue value = eval(even.wi);
    result.wi = even.wi;
    result.pdf = even.pdf * (1 - share);
    if (result.pdf > 0)
      for (size_t j = 0; j < 4; ++j) result.weight[j] = value.f_cos[j] / result.pdf;
    return result;
  }
};

ReferenceSurface layered_surface(const World& world, uint32_t row, const Direction& wo, const Spectrum4& lambda_nm) {
  const LayeredColumns& table = world.layered;
  const auto layers = std::make_shared<ReferenceLayers>();
  layers->side = wo.z < 0 ? -1 : 1;
  layers->wo = {wo.x, wo.y, std::abs(wo.z)};
  const auto spectrum = [&](const Column<uint32_t>& ids) { return reference_spectrum(world, ids[row], lambda_nm); };
  const Spectrum4 reflectance = spectrum(table.reflectance), albedo = spectrum(table.albedo);
  const Spectrum4 n = spectrum(table.base_eta), kappa = spectrum(table.base_kappa);
  for (size_t j = 0; j < 4; ++j) {
    testing::LayeredWalk& walk = layers->walks[j];
    walk.eta = double{table.eta[row]};
    walk.surface = {double{table.alpha_x[row]}, double{table.alpha_y[row]}};
    walk.conductor = table.conductor[row] != 0;
    walk.reflectance = reflectance[j];
    walk.n = n[j] / walk.eta;
    walk.kappa = kappa[j] / walk.eta;
    walk.base = {double{table.base_alpha_x[row]}, double{table.base_alpha_y[row]}};
    walk.thickness = double{table.thickness[row]};
    walk.albedo = albedo[j];
    walk.asymmetry = double{table.asymmetry[row]};
    walk.max_depth = static_cast<int>(table.max_depth[row]);
    // Any number that differs from vertex to vertex.
    walk.random.seed(static_cast<uint64_t>(1e9 * (wo.x + 2)) * 31 + static_cast<uint64_t>(1e9 * (wo.y + 2)) * 7 + j);
  }
  return {[=](const Direction& wi) { return layers->eval(wi); },
          [=](double choice, double u, double v) { return layers->sample(choice, u, v); }};
}

}  // namespace

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
  if (kind == ShadeKind::layered) return layered_surface(world, row, wo, lambda_nm);
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
