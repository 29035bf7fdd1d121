#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/textures.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/texture-inl.h"
#include "systems/texture_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// The spectrum of lanes that share a program, 0 to 1.
void spectrum_lanes(const World& world, uint32_t depth, uint32_t program, const uint32_t* lanes, uint32_t count,
                    ShadeStream& shade, const Columns<float, 4>& out) {
  for_each_vector(lanes, count, [&](VI lane) {
    TexturePoint point = point_of(world, shade, lane);
    for (size_t j = 0; j < 4; ++j) point.lambda_nm[j] = gather(shade.lambda_nm[j], lane);
    point.key = {gather(shade.pixel_seed, lane), gather(shade.index, lane)};
    point.depth = depth;
    VF value[4];
    run_program<TextureResult::spectrum>(world, world.textures.programs[program], &point, value);
    for (size_t j = 0; j < 4; ++j) {
      const VF bounded = hn::Min(hn::Max(value[j], hn::Zero(FloatTag())), splat(1.0f));
      hn::ScatterIndex(bounded, FloatTag(), out[j], lane);
    }
  });
}

void number_lanes(const World& world, uint32_t program, const uint32_t* lanes, uint32_t count, ShadeStream& shade,
                  float* out) {
  for_each_vector(lanes, count, [&](VI lane) {
    const TexturePoint point = point_of(world, shade, lane);
    VF value[1];
    run_program<TextureResult::number>(world, world.textures.programs[program], &point, value);
    hn::ScatterIndex(value[0], FloatTag(), out, lane);
  });
}

float number_at(const World& world, uint32_t program, const SurfacePoint& at) {
  TexturePoint point;
  point.u = splat(at.uv[0]);
  point.v = splat(at.uv[1]);
  point.position = splat_vec3(at.position);
  point.normal = splat_vec3(at.normal);
  for (int k = 0; k < 4; ++k) point.footprint[k] = splat(at.footprint[k]);
  VF value[1];
  run_program<TextureResult::number>(world, world.textures.programs[program], &point, value);
  return hn::GetLane(value[0]);
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {
namespace {

void collect(const ShadeStream& shade, ShadeKind kind, const Column<uint32_t>& programs, TexturedLanes& lanes) {
  collect_lanes(shade.groups[static_cast<size_t>(kind)], shade, programs, lanes);
}

}  // namespace

HWY_EXPORT(spectrum_lanes);
HWY_EXPORT(number_lanes);
HWY_EXPORT(number_at);

void textures(const World& world, uint32_t depth, ShadeStream& shade) {
  if (!world.has_textures()) return;
  const size_t programs = world.textures.programs.size();
  TexturedLanes lanes;
  const auto spectra = [&](const Columns<float, 4>& out) {
    sort_by_key(programs, lanes);
    for_each_key(lanes, [&](uint32_t program, const uint32_t* first, uint32_t count) {
      HWY_DYNAMIC_DISPATCH(spectrum_lanes)(world, depth, program, first, count, shade, out);
    });
    lanes.count = 0;
  };
  collect(shade, ShadeKind::diffuse, world.diffuse.texture, lanes);
  collect(shade, ShadeKind::diffuse_transmission, world.diffuse_transmission.reflectance_texture, lanes);
  collect(shade, ShadeKind::smooth_coated, world.smooth_coated.texture, lanes);
  collect(shade, ShadeKind::rough_coated, world.rough_coated.texture, lanes);
  collect(shade, ShadeKind::layered, world.layered.texture, lanes);
  collect(shade, ShadeKind::hair, world.hair.texture, lanes);
  collect(shade, ShadeKind::rough_conductor, world.conductor.texture, lanes);
  collect(shade, ShadeKind::smooth_conductor, world.conductor.texture, lanes);
  spectra(shade.reflectance);
  collect(shade, ShadeKind::diffuse_transmission, world.diffuse_transmission.transmittance_texture, lanes);
  collect(shade, ShadeKind::layered, world.layered.albedo_texture, lanes);
  spectra(shade.transmittance);
  const auto numbers = [&](float* out) {
    sort_by_key(programs, lanes);
    for_each_key(lanes, [&](uint32_t program, const uint32_t* first, uint32_t count) {
      HWY_DYNAMIC_DISPATCH(number_lanes)(world, program, first, count, shade, out);
    });
    lanes.count = 0;
  };
  for (size_t axis = 0; axis < 2 && world.has_textured_alpha; ++axis) {
    collect(shade, ShadeKind::rough_conductor, world.conductor.alpha_texture[axis], lanes);
    collect(shade, ShadeKind::rough_dielectric, world.dielectric.alpha_texture[axis], lanes);
    collect(shade, ShadeKind::layered, world.layered.alpha_texture[axis], lanes);
    numbers(shade.alpha[axis]);
  }
  if (!world.has_textured_layers) return;
  for (size_t axis = 0; axis < 2; ++axis) {
    collect(shade, ShadeKind::layered, world.layered.base_alpha_texture[axis], lanes);
    numbers(shade.base_alpha[axis]);
  }
  collect(shade, ShadeKind::layered, world.layered.thickness_texture, lanes);
  numbers(shade.thickness);
  collect(shade, ShadeKind::layered, world.layered.asymmetry_texture, lanes);
  numbers(shade.asymmetry);
}

float number_at_hit(const World& world, uint32_t program, const RayHit& hit) {
  return HWY_DYNAMIC_DISPATCH(number_at)(world, program, surface_point(world, hit));
}

}  // namespace metamer
#endif
