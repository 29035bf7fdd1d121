#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/bump.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "systems/texture-inl.h"
#include "systems/texture_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

HWY_INLINE void scatter(const Vec3& v, const Columns<float, 3>& c, VI lane) {
  hn::ScatterIndex(v.x, FloatTag(), c[0], lane);
  hn::ScatterIndex(v.y, FloatTag(), c[1], lane);
  hn::ScatterIndex(v.z, FloatTag(), c[2], lane);
}

// The bent normal, on the side of the surface's own, and the direction of growing u; lanes without a length keep
// theirs.
HWY_INLINE void store_frame(const World& world, const Vec3& bent, const Vec3& along_u, VI lane, ShadeStream& shade) {
  const VF length2 = dot(bent, bent);
  const MF known = hn::Gt(length2, splat(1e-30f));
  const Vec3 unit = bent * hn::Div(splat(1.0f), hn::Sqrt(hn::Max(length2, splat(1e-30f))));
  const VF side = hn::CopySign(splat(1.0f), dot(unit, gather(shade.normal, lane)));
  scatter(if_then_else(known, unit * side, gather(shade.shading_normal, lane)), shade.shading_normal, lane);
  if (world.needs_tangents) scatter(if_then_else(known, along_u, gather(shade.tangent, lane)), shade.tangent, lane);
}

// The surface p + d n has the tangents dp/du + dd/du n + d dn/du, and likewise in v (Blinn, "Simulation of Wrinkled
// Surfaces", SIGGRAPH 1978, with the last term that he drops for small d).
void displaced_lanes(const World& world, uint32_t program, const uint32_t* lanes, uint32_t count, ShadeStream& shade) {
  for_each_vector(lanes, count, [&](VI lane) {
    TexturePoint points[3] = {point_of(world, shade, lane)};
    move_points(gather(shade.dp_du, lane), gather(shade.dp_dv, lane), points);
    VF d[3];
    run_program<TextureResult::slopes>(world, world.textures.programs[program], points, d);
    const Vec3 n = gather(shade.shading_normal, lane);
    const Vec3 along_u = mul_add(n, d[1], mul_add(gather(shade.dn_du, lane), d[0], gather(shade.dp_du, lane)));
    const Vec3 along_v = mul_add(n, d[2], mul_add(gather(shade.dn_dv, lane), d[0], gather(shade.dp_dv, lane)));
    store_frame(world, cross(along_u, along_v), along_u, lane, shade);
  });
}

// A normal (2 r - 1, 2 g - 1, 2 b - 1) in the frame of dp/du, n x dp/du and n.
void mapped_lanes(const World& world, uint32_t map, const uint32_t* lanes, uint32_t count, ShadeStream& shade) {
  const TextureImage& image = world.textures.normal_maps[map];
  const TextureSet& set = world.textures;
  const float* numbers = set.numbers.data() + image.first_texel;
  const ImageLevel level = level_of({0, image.width, image.height}, set.normal_map_files, map);
  for_each_vector(lanes, count, [&](VI lane) {
    const TexturePoint point = point_of(world, shade, lane);
    const TexelSquare square = texel_square(level, {point.u, point.v, point.u}, TextureWrap::repeat);
    VF rgb[4][3], local[3];
    for (int k = 0; k < 4; ++k) {
      const VI nth = texel_of(level, square.texel[k]), at = hn::Add(hn::ShiftLeft<1>(nth), nth);
      if (level.is_in_file)
        fetch<3>(set, level, square.texel[k], rgb[k]);
      else
        for (int c = 0; c < 3; ++c) rgb[k][c] = gather(numbers + c, at);
    }
    for (int c = 0; c < 3; ++c) {
      const VF texel[4] = {rgb[0][c], rgb[1][c], rgb[2][c], rgb[3][c]};
      const VF upper = between(texel[0], texel[1], square.right), lower = between(texel[2], texel[3], square.right);
      local[c] = hn::MulSub(splat(2.0f), between(upper, lower, square.lower), splat(1.0f));
    }
    const Vec3 n = gather(shade.shading_normal, lane), dp_du = gather(shade.dp_du, lane);
    const Vec3 s = normalize(dp_du);
    const Vec3 bent = mul_add(s, local[0], mul_add(cross(n, s), local[1], n * local[2]));
    store_frame(world, bent, dp_du, lane, shade);
  });
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer {

HWY_EXPORT(displaced_lanes);
HWY_EXPORT(mapped_lanes);

void bump(const World& world, ShadeStream& shade) {
  if (!world.has_bumps) return;
  const auto programs = static_cast<uint32_t>(world.textures.programs.size());
  TexturedLanes lanes;
  for (size_t kind = 0; kind < shade_kind_count; ++kind)
    collect_lanes(shade.groups[kind], shade, world.bumps[kind], lanes);
  sort_by_key(programs + world.textures.normal_maps.size(), lanes);
  for_each_key(lanes, [&](uint32_t key, const uint32_t* first, uint32_t count) {
    if (key < programs)
      HWY_DYNAMIC_DISPATCH(displaced_lanes)(world, key, first, count, shade);
    else
      HWY_DYNAMIC_DISPATCH(mapped_lanes)(world, key - programs, first, count, shade);
  });
}

}  // namespace metamer
#endif
