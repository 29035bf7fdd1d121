#include "tests/reference_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "engine/spectrum/observers.h"
#include "systems/bsdf/limits.h"
#include "systems/bsdf/reference.h"
#include "tests/reference_camera.h"
#include "tests/reference_grids.h"
#include "tests/reference_lights.h"
#include "tests/reference_media.h"
#include "tests/reference_optics.h"
#include "tests/reference_surfaces.h"

namespace metamer {
namespace {

using reference::BsdfSample;
using reference::Direction;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Tracer {
  const World& world;
  ReferenceScene scene;
  ReferenceRandom random;

  bool is_path;
  std::vector<uint32_t> summed, chosen;  // lights that are no environments: all of these, and one of those

  Tracer(const World& frozen, uint32_t seed)
      : world(frozen), scene(frozen), random(seed), is_path(frozen.settings.integrator == Integrator::path) {
    for (uint32_t row = 0; row < world.lights.size(); ++row) {
      const auto shape = static_cast<LightShape>(world.lights[row].shape);
      if (shape != LightShape::environment) (!is_path && is_abstract(shape) ? summed : chosen).push_back(row);
    }
  }

  // Radiance that arrives at `origin` against `direction` after at most `events` scatterings. `sees_lights`: area
  // lights count where they are hit, not having been sampled before; `sees_sky`: so does the environment. `together`:
  // four wavelengths on one way.
  Spectrum4 radiance(const Vector& origin, const Vector& direction, ReferenceMedia media, const Spectrum4& lambda_nm,
                     bool together, uint32_t events, bool sees_lights, bool sees_sky, uint32_t mask) {
    const ReferenceHit hit = scene.intersect(origin, direction, mask);
    if (media.volume != 0)
      return through_volume(hit, origin, direction, media, lambda_nm, together, events, sees_lights, sees_sky, mask);
    return arriving(hit, origin, direction, media, lambda_nm, together, events, sees_lights, sees_sky, mask);
  }

  // A volume before what the ray meets. Where it scatters each wavelength goes its own way from here on, by its own
  // free path; its glow is gathered where rays are scattered or absorbed.
  Spectrum4 through_volume(const ReferenceHit& hit, const Vector& origin, const Vector& direction,
                           const ReferenceMedia& media, const Spectrum4& lambda_nm, bool together, uint32_t events,
                           bool sees_lights, bool sees_sky, uint32_t mask) {
    const double distance = hit.object == no_index ? infinity : hit.t;
    Spectrum4 result{};
    if (!is_path || world.volumes.scatters[media.volume] == 0) {
      result = arriving(hit, origin, direction, media, lambda_nm, together, events, sees_lights, sees_sky, mask);
      attenuate_and_glow(world, media.volume, origin, direction, lambda_nm, distance, random, result);
      return result;
    }
    for (size_t j = 0; j < 4; ++j) {
      if (j > 0 && !together) {
        result[j] = result[0];
        continue;
      }
      Spectrum4 alone;
      alone.fill(lambda_nm[j]);
      ReferenceVolume volume = volume_at(world, media.volume, origin, lambda_nm[j]);
      double t = infinity;
      if (world.volumes.grid[media.volume] != no_index) {
        t = reference_free_path(world, media.volume, origin, direction, distance, lambda_nm[j], random);
        if (t < distance) volume = volume_at(world, media.volume, origin + t * direction, lambda_nm[j]);
      } else if (volume.extinction() > 0) {
        t = -std::log(1 - random()) / volume.extinction();
      }
      if (!(t < distance)) {
        result[j] = arriving(hit, origin, direction, media, alone, false, events, sees_lights, sees_sky, mask)[0];
        continue;
      }
      result[j] = volume.absorption / volume.extinction() * volume.glow;
      if (events == 0) continue;
      result[j] += volume.scattering / volume.extinction() *
                   scattered_in(origin + t * direction, direction, media, alone, events)[0];
    }
    return result;
  }

  Spectrum4 scattered_in(const Vector& position, const Vector& direction, const ReferenceMedia& media,
                         const Spectrum4& lambda_nm, uint32_t events) {
    const VolumeColumns& table = world.volumes;
    const reference::PhaseLobes g = {table.g[media.volume], table.g2[media.volume], table.g2_share[media.volume]};
    const ReferenceHit place = place_in_volume(position, direction);
    const ReferenceFrame frame = reference_frame(place, direction);
    const Spectrum4 lit = direct(place, frame, media, lambda_nm, [&](const Direction& wi) {
      const double p = reference::eval_phase(wi.z, g);
      return Spectrum4{p, p, p, p};
    });
    BsdfSample next;
    const double u = random(), v = random();
    next.wi = reference::sample_phase(g, random(), u, v);
    next.weight = {1, 1, 1, 1};
    next.pdf = reference::eval_phase(next.wi.z, g);
    return plus(lit, go_on(place, frame, media, next, lambda_nm, false, events));
  }

  // What comes from what the ray meets.
  Spectrum4 arriving(const ReferenceHit& hit, const Vector& origin, const Vector& direction, ReferenceMedia media,
                     const Spectrum4& lambda_nm, bool together, uint32_t events, bool sees_lights, bool sees_sky,
                     uint32_t mask) {
    if (hit.object == no_index) {
      Spectrum4 sky = sees_sky ? reference_environment(world, origin, direction, lambda_nm) : Spectrum4{};
      if (sees_lights) sky = plus(sky, reference_disks(world, direction, lambda_nm));
      attenuate(world, media, lambda_nm, infinity, sky);
      return sky;
    }
    // It comes out of what it never went into: it has been inside all the time.
    const uint32_t left = glm::dot(direction, hit.outside) > 0 ? medium_of(world, hit.object) : 0;
    if (left != 0 && std::find(media.begin(), media.end(), left) == media.end()) media.insert(media.begin(), left);
    Spectrum4 sum{};
    if (sees_lights && hit.light != no_index) {
      const LightRow& row = world.lights[hit.light];
      if (row.two_sided != 0 || glm::dot(direction, hit.outside) < 0)
        sum = reference_emission(world, row, glm::dot(direction, hit.outside), lambda_nm);
    }
    if (static_cast<ShadeKind>(world.objects.shade_kind[hit.object]) == ShadeKind::interface) {
      media.volume = volume_towards(world, media, hit, direction);
      sum =
          plus(sum, radiance(hit.position, direction, media, lambda_nm, together, events, sees_lights, sees_sky, mask));
    } else if (events > 0)
      sum = plus(sum, scatter(hit, direction, media, lambda_nm, together, events));
    attenuate(world, media, lambda_nm, hit.t, sum);
    return sum;
  }

  Spectrum4 scatter(const ReferenceHit& hit, const Vector& direction, const ReferenceMedia& media,
                    const Spectrum4& lambda_nm, bool together, uint32_t events) {
    const auto [kind, row] = reference_material(world, hit.object, [&] { return random(); });
    const ReferenceFrame frame = reference_frame(hit, direction);
    const Direction wo = frame.in(-direction);
    if (kind == ShadeKind::absorber) return {};
    if (kind == ShadeKind::dielectric || kind == ShadeKind::rough_dielectric)
      return enter({kind, row}, hit, direction, media, lambda_nm, together, events);
    if (kind == ShadeKind::thin_dielectric) {
      const reference::ThinOptics optics = reference_thin(world, row, fills(world, media), lambda_nm);
      return branch(
          hit, frame, media, [&](double u) { return reference::sample_thin(wo, optics, u); }, lambda_nm, together,
          events);
    }
    if (const auto surface = reference_surface(world, kind, row, wo, lambda_nm)) {
      const Spectrum4 lit =
          direct(hit, frame, media, lambda_nm, [&](const Direction& wi) { return surface->eval(wi).f_cos; });
      const double choice = random(), u = random(), v = random();
      return plus(lit, go_on(hit, frame, media, surface->sample(choice, u, v), lambda_nm, together, events));
    }
    if (kind == ShadeKind::smooth_coated || kind == ShadeKind::rough_coated)
      return coated(hit, frame, media, wo, reference_coat(world, kind, row, lambda_nm), lambda_nm, together, events);
    const reference::Roughness roughness =
        kind == ShadeKind::smooth_conductor
            ? reference::Roughness{}
            : reference::Roughness{world.conductor.alpha_x[row], world.conductor.alpha_y[row]};
    const uint32_t around = fills(world, media);
    const reference::ConductorOptics optics{reference_relative(world, world.conductor.eta[row], around, lambda_nm),
                                            reference_relative(world, world.conductor.kappa[row], around, lambda_nm),
                                            world.conductor.schlick[row] != 0};
    Spectrum4 lit{};
    if (kind == ShadeKind::rough_conductor)
      lit = direct(hit, frame, media, lambda_nm,
                   [&](const Direction& wi) { return reference::eval_conductor(wo, roughness, optics, wi).f_cos; });
    const double u = random(), v = random();
    return plus(lit, go_on(hit, frame, media, reference::sample_conductor(wo, roughness, optics, u, v), lambda_nm,
                           together, events));
  }

  // A boundary that light crosses, smooth or rough.
  Spectrum4 enter(const ReferenceMaterial& material, const ReferenceHit& hit, const Vector& direction,
                  const ReferenceMedia& media, const Spectrum4& lambda_nm, bool together, uint32_t events) {
    const DielectricColumns& table = world.dielectric;
    const uint32_t row = material.row, medium = table.medium[row];
    const ReferenceMedia behind = crossed(world, media, hit, direction);
    const uint32_t before = fills(world, media), after = fills(world, behind);
    if (medium != 0 && before == after)  // it fills the space on neither side: nothing happens
      return radiance(hit.position, direction, behind, lambda_nm, together, events - 1, true, true, visible_to_bounces);
    const uint32_t around = medium == 0 ? 0 : after == medium ? before : after;
    const bool parts = table.dispersive[row] != 0 || world.media.dispersive[around] != 0;
    if (together && parts) return disperse(hit, direction, media, lambda_nm, events);
    reference::DielectricOptics optics;
    optics.eta = reference_relative(world, table.eta[row], around, lambda_nm);
    optics.kappa = reference_relative(world, table.kappa[row], around, lambda_nm);
    optics.schlick = table.schlick[row] != 0;
    for (size_t j = 0; j < 4; ++j)
      optics.opaque[j] = world.spectra.value(table.kappa[row], lambda_nm[j]) >= double{refracting_kappa};
    const ReferenceFrame frame = reference_frame(hit, direction);
    const Direction wo = frame.in(-direction);
    if (material.kind == ShadeKind::dielectric)
      return branch(
          hit, frame, media, [&](double u) { return reference::sample_dielectric(wo, optics, u); }, lambda_nm, together,
          events);
    const reference::Roughness roughness{table.alpha_x[row], table.alpha_y[row]};
    const Spectrum4 lit = direct(hit, frame, media, lambda_nm, [&](const Direction& wi) {
      return reference::eval_rough_dielectric(wo, roughness, optics, wi).f_cos;
    });
    const double choice = random(), u = random(), v = random();
    return plus(lit, go_on(hit, frame, media, reference::sample_rough_dielectric(wo, roughness, optics, choice, u, v),
                           lambda_nm, together, events));
  }

  // Without chance both: the mirror image, and the body by its own direction.
  Spectrum4 coated(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                   const Direction& wo, const reference::CoatOptics& optics, const Spectrum4& lambda_nm, bool together,
                   uint32_t events) {
    const auto evaluate = [&](const Direction& wi) { return reference::eval_coated(wo, optics, wi).f_cos; };
    const Spectrum4 lit = direct(hit, frame, media, lambda_nm, evaluate);
    const double choice = random(), u = random(), v = random();
    if (is_path || optics.alpha > 0)
      return plus(lit, go_on(hit, frame, media, reference::sample_coated(wo, optics, choice, u, v), lambda_nm, together,
                             events));
    BsdfSample body = reference::sample_diffuse(wo, {1, 1, 1, 1}, u, v), mirror;
    body.weight = evaluate(body.wi);
    for (double& weight : body.weight) weight /= body.pdf;
    mirror.wi = {-wo.x, -wo.y, wo.z};
    mirror.pdf = 1;
    mirror.delta = true;
    for (size_t j = 0; j < 4; ++j)
      mirror.weight[j] = reference::coat_surface_albedo(optics, optics.eta[j], std::abs(wo.z));
    return plus(lit, plus(go_on(hit, frame, media, body, lambda_nm, together, events),
                          go_on(hit, frame, media, mirror, lambda_nm, together, events)));
  }

  // Each wavelength goes its own way from here on.
  Spectrum4 disperse(const ReferenceHit& hit, const Vector& direction, const ReferenceMedia& media,
                     const Spectrum4& lambda_nm, uint32_t events) {
    Spectrum4 result;
    for (size_t j = 0; j < 4; ++j) {
      Spectrum4 alone;
      alone.fill(lambda_nm[j]);
      result[j] = scatter(hit, direction, media, alone, false, events)[0];
    }
    return result;
  }

  template <class Evaluate>
  Spectrum4 direct(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                   const Spectrum4& lambda_nm, const Evaluate& evaluate) {
    Spectrum4 sum{};
    for (const uint32_t light : summed) sum = plus(sum, light_from(hit, frame, media, lambda_nm, evaluate, light, 1));
    if (!chosen.empty()) {
      const size_t place = std::min(static_cast<size_t>(random() * double(chosen.size())), chosen.size() - 1);
      sum = plus(sum, light_from(hit, frame, media, lambda_nm, evaluate, chosen[place], double(chosen.size())));
    }
    if (!world.settings.shadows) sum = plus(sum, sky_through_everything(hit, frame, media, lambda_nm, evaluate));
    return sum;
  }

  template <class Evaluate>
  Spectrum4 light_from(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                       const Spectrum4& lambda_nm, const Evaluate& evaluate, uint32_t light, double count) {
    const ReferenceLightPoint sample = reference_light_point(world.lights[light], hit.position, random);
    if (!(sample.factor > 0)) return {};
    const Spectrum4 f_cos = evaluate(frame.in(sample.direction));
    const double far = std::isinf(sample.distance) ? infinity : sample.distance * (1 - 1e-6);
    if (world.settings.shadows &&
        scene.intersect(hit.position, sample.direction, visible_to_shadows, far).object != no_index)
      return {};
    Spectrum4 result = reference_radiance(world, world.lights[light], lambda_nm);
    const Spectrum4 image = reference_light_image(world, light, -sample.direction, lambda_nm);
    for (size_t j = 0; j < 4; ++j) result[j] *= f_cos[j] * image[j] * sample.factor * count;
    through_media(next_media(media, hit, frame.came, sample.direction), hit.position, sample.direction, sample.distance,
                  lambda_nm, result);
    return result;
  }

  template <class Evaluate>
  Spectrum4 sky_through_everything(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                                   const Spectrum4& lambda_nm, const Evaluate& evaluate) {
    const Vector direction = reference_direction(random);
    Spectrum4 result = reference_environment(world, hit.position, direction, lambda_nm);
    const Spectrum4 f_cos = evaluate(frame.in(direction));
    for (size_t j = 0; j < 4; ++j) result[j] *= f_cos[j] * 4 * std::numbers::pi;
    through_media(next_media(media, hit, frame.came, direction), hit.position, direction, infinity, lambda_nm, result);
    return result;
  }

  void through_media(const ReferenceMedia& media, const Vector& from, const Vector& direction, double distance,
                     const Spectrum4& lambda_nm, Spectrum4& light) {
    attenuate(world, media, lambda_nm, distance, light);
    const Spectrum4 passes = volume_transmittance(scene, media.volume, from, direction, distance, lambda_nm, random);
    for (size_t j = 0; j < 4; ++j) light[j] *= passes[j];
  }

  // A smooth boundary: one of its two lobes by chance, or without chance each that there is. `sample` reflects for
  // small random numbers.
  template <class Sample>
  Spectrum4 branch(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                   const Sample& sample, const Spectrum4& lambda_nm, bool together, uint32_t events) {
    if (is_path) return go_on(hit, frame, media, sample(random()), lambda_nm, together, events);
    Spectrum4 sum{};
    BsdfSample lobes[2] = {sample(0), sample(1 - 1e-15)};
    const size_t count = lobes[0].transmitted == lobes[1].transmitted ? 1 : 2;
    for (size_t lobe = 0; lobe < count; ++lobe) {
      for (double& weight : lobes[lobe].weight) weight *= lobes[lobe].pdf;
      sum = plus(sum, go_on(hit, frame, media, lobes[lobe], lambda_nm, together, events));
    }
    return sum;
  }

  // Of a ray that leaves the surface along `direction`.
  ReferenceMedia next_media(const ReferenceMedia& media, const ReferenceHit& hit, const Vector& came,
                            const Vector& direction) const {
    const bool crosses = glm::dot(came, hit.outside) * glm::dot(direction, hit.outside) > 0;
    if (hit.object != no_index && crosses) return crossed(world, media, hit, direction);
    ReferenceMedia next = media;
    next.volume = volume_towards(world, media, hit, direction);
    return next;
  }

  Spectrum4 go_on(const ReferenceHit& hit, const ReferenceFrame& frame, const ReferenceMedia& media,
                  const BsdfSample& sample, const Spectrum4& lambda_nm, bool together, uint32_t events) {
    if (!(sample.pdf > 0)) return {};
    if (sample.delta && world.settings.integrator == Integrator::local) return {};
    // Where only the light sources light rough surfaces, the sky is the only one not sampled.
    const uint32_t left = is_path || sample.delta ? events - 1 : 0;
    const Vector next = frame.out(sample.wi);
    Spectrum4 result = radiance(hit.position, next, next_media(media, hit, frame.came, next), lambda_nm, together, left,
                                sample.delta, sample.delta || world.settings.shadows, visible_to_bounces);
    for (size_t j = 0; j < 4; ++j) result[j] *= sample.weight[j];
    return result;
  }

  static Spectrum4 plus(const Spectrum4& a, const Spectrum4& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
  }

  Spectrum4 camera_radiance(uint32_t x, uint32_t y, const Spectrum4& lambda_nm) {
    const ReferenceRay ray = reference_camera_ray(world, x, y, random);
    return radiance(ray.origin, ray.direction, camera_media(world), lambda_nm, true, world.settings.max_depth, true,
                    true, visible_to_camera);
  }

  std::array<double, 3> sample_xyz(uint32_t x, uint32_t y) {
    constexpr double range = lambda_max_nm - lambda_min_nm;
    const double start = random();
    Spectrum4 lambda_nm;
    for (size_t j = 0; j < 4; ++j) lambda_nm[j] = lambda_min_nm + range * (double(j) + start) / 4;
    const Spectrum4 radiance = camera_radiance(x, y, lambda_nm);
    std::array<double, 3> xyz{};
    for (size_t j = 0; j < 4; ++j) {
      const auto matching = observer_value(Observer::cie1931, lambda_nm[j]);
      for (size_t c = 0; c < 3; ++c)
        xyz[c] += luminous_efficacy * radiance[j] * matching[c] * range / 4 * world.settings.sensor_scale;
    }
    return xyz;
  }
};

}  // namespace

std::array<double, 4> reference_pixel_radiance(const World& world, uint32_t x, uint32_t y,
                                               const std::array<double, 4>& lambda_nm, uint32_t seed) {
  return Tracer(world, seed).camera_radiance(x, y, lambda_nm);
}

std::vector<ReferencePixel> reference_path(const World& world, uint32_t samples_per_pixel, uint32_t seed) {
  Tracer tracer(world, seed);
  const uint32_t width = world.settings.width, height = world.settings.height;
  std::vector<ReferencePixel> pixels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      std::array<double, 3> sum{}, squares{};
      for (uint32_t k = 0; k < samples_per_pixel; ++k) {
        const std::array<double, 3> xyz = tracer.sample_xyz(x, y);
        for (size_t c = 0; c < 3; ++c) sum[c] += xyz[c], squares[c] += xyz[c] * xyz[c];
      }
      ReferencePixel pixel;
      const double n = samples_per_pixel;
      for (size_t c = 0; c < 3; ++c) {
        pixel.mean_xyz[c] = sum[c] / n;
        pixel.variance_of_mean[c] = (squares[c] / n - pixel.mean_xyz[c] * pixel.mean_xyz[c]) / (n - 1);
      }
      pixels.push_back(pixel);
    }
  return pixels;
}

}  // namespace metamer
