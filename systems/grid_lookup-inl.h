// Values of frozen grids (engine/ecs/volume_grids.h) between their voxels. All lanes ask one grid.
#if defined(METAMER_SYSTEMS_GRID_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SYSTEMS_GRID_LOOKUP_INL_H_
#undef METAMER_SYSTEMS_GRID_LOOKUP_INL_H_
#else
#define METAMER_SYSTEMS_GRID_LOOKUP_INL_H_
#endif

#include "engine/ecs/volume_grids.h"
#include "engine/sampling/hash-inl.h"
#include "systems/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

// Row-major 3x4 times (p, 1) and (v, 0).
HWY_INLINE VF affine_row(const float* row, const Vec3& p, VF last) {
  return hn::MulAdd(splat(row[0]), p.x, hn::MulAdd(splat(row[1]), p.y, hn::MulAdd(splat(row[2]), p.z, last)));
}
HWY_INLINE Vec3 affine_point(const float* m, const Vec3& p) {
  return {affine_row(m, p, splat(m[3])), affine_row(m + 4, p, splat(m[7])), affine_row(m + 8, p, splat(m[11]))};
}
HWY_INLINE Vec3 affine_vector(const float* m, const Vec3& v) {
  const VF zero = hn::Zero(FloatTag());
  return {affine_row(m, v, zero), affine_row(m + 4, v, zero), affine_row(m + 8, v, zero)};
}

// Where the values of a voxel lie, and of the seven above it. Lanes beyond the table have is_inside false.
struct VoxelPlace {
  VI index;
  MF is_inside;
};
// `voxel` holds whole numbers from the table's lower end.
HWY_INLINE VoxelPlace voxel_place(const GridColumns& grids, const GridRow& row, const Vec3& voxel) {
  const VF zero = hn::Zero(FloatTag());
  const auto within = [&](VF x, int32_t nodes) {
    return hn::And(hn::Ge(x, zero), hn::Lt(x, splat(static_cast<float>(nodes * node_voxels))));
  };
  VoxelPlace place;
  place.is_inside =
      hn::And(within(voxel.x, row.nodes[0]), hn::And(within(voxel.y, row.nodes[1]), within(voxel.z, row.nodes[2])));
  const auto whole = [&](VF x) { return hn::ConvertTo(IntTag(), hn::IfThenElseZero(place.is_inside, x)); };
  const VI x = whole(voxel.x), y = whole(voxel.y), z = whole(voxel.z);
  const auto splat_i = [](int32_t i) { return hn::Set(IntTag(), i); };
  const VI node_x = hn::ShiftRight<7>(x), node_y = hn::ShiftRight<7>(y), node_z = hn::ShiftRight<7>(z);
  VI node = hn::Add(node_x, splat_i(static_cast<int32_t>(row.first_node)));
  if (row.nodes[1] > 1 || row.nodes[2] > 1) {
    const VI slice = hn::Add(node_y, hn::Mul(node_z, splat_i(row.nodes[1])));
    node = hn::Add(node, hn::Mul(slice, splat_i(row.nodes[0])));
  }
  const VI low = splat_i(node_side - 1), in_brick = splat_i(7);
  const auto brick_of = [&](VI i) { return hn::And(hn::ShiftRight<3>(i), low); };
  VI brick = as_index(gather(grids.nodes.data(), node));
  brick = hn::Add(brick, hn::Add(brick_of(x), hn::Add(hn::ShiftLeft<4>(brick_of(y)), hn::ShiftLeft<8>(brick_of(z)))));
  const VI first = as_index(gather(grids.bricks.data(), brick));
  const VI vx = hn::And(x, in_brick), vy = hn::And(y, in_brick), vz = hn::And(z, in_brick);
  // x + 9 y + 81 z
  const VI slice = hn::Add(vy, hn::Add(vz, hn::ShiftLeft<3>(vz)));
  VI voxel_index = hn::Add(vx, hn::Add(slice, hn::ShiftLeft<3>(slice)));
  if (row.channels == 3) voxel_index = hn::Add(voxel_index, hn::Add(voxel_index, voxel_index));
  place.index = hn::Add(first, voxel_index);
  return place;
}

// Relative to the lower end of the table; what no float can hold exactly is far outside.
HWY_INLINE Vec3 from_lower(const GridRow& row, const Vec3& p) {
  const auto one = [](VF x, int32_t lower) {
    const VF bounded = clamp(x, static_cast<float>(-4 * farthest_voxel), static_cast<float>(4 * farthest_voxel));
    return hn::Sub(bounded, splat(static_cast<float>(lower)));
  };
  return {one(p.x, row.lower[0]), one(p.y, row.lower[1]), one(p.z, row.lower[2])};
}

// Linear between the centres of the eight voxels around p, in index space; background outside. `channels` is the
// grid's. Twin: reference::grid_value(). Absolute error below 2e-6 of the greatest of the eight magnitudes, plus what
// single precision leaves uncertain about p, as seen from the lowest voxel.
template <int channels>
HWY_INLINE void grid_trilinear(const GridColumns& grids, const GridRow& row, const Vec3& p, VF out[channels]) {
  const Vec3 from = from_lower(row, p);
  const Vec3 voxel = {hn::Floor(from.x), hn::Floor(from.y), hn::Floor(from.z)};
  const VF fx = hn::Sub(from.x, voxel.x), fy = hn::Sub(from.y, voxel.y), fz = hn::Sub(from.z, voxel.z);
  const VoxelPlace place = voxel_place(grids, row, voxel);
  const auto between = [](VF a, VF b, VF f) { return hn::MulAdd(f, hn::Sub(b, a), a); };
  for (int c = 0; c < channels; ++c) {
    const float* values = grids.values.data() + c;
    const auto along_x = [&](int y, int z) {
      const float* first = values + channels * stored_side * (y + stored_side * z);
      return between(gather(first, place.index), gather(first + channels, place.index), fx);
    };
    const VF low = between(along_x(0, 0), along_x(1, 0), fy), high = between(along_x(0, 1), along_x(1, 1), fy);
    out[c] = hn::IfThenElse(place.is_inside, between(low, high, fz), splat(row.background[c]));
  }
}

// One of the eight voxels, each with its trilinear weight for a probability; u, v, w in [0, 1): the mean is what
// grid_trilinear gives.
template <int channels>
HWY_INLINE void grid_stochastic(const GridColumns& grids, const GridRow& row, const Vec3& p, const Vec3& u,
                                VF out[channels]) {
  const Vec3 from = from_lower(row, p) + u;
  const VoxelPlace place = voxel_place(grids, row, {hn::Floor(from.x), hn::Floor(from.y), hn::Floor(from.z)});
  for (int c = 0; c < channels; ++c)
    out[c] = hn::IfThenElse(place.is_inside, gather(grids.values.data() + c, place.index), splat(row.background[c]));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
