#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/nodes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// Highway's headers come after foreach_target.
#include "engine/sampling/hash-inl.h"
#include "systems/shade-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {
namespace {

// Four columns, turned so that the leading wavelength comes first: it is the hero that decides at what follows.
HWY_INLINE void append_rotated(MF mask, const VF v[4], size_t lead, const Columns<float, 4>& column, size_t at) {
  for (size_t j = 0; j < 4; ++j) append(mask, v[(lead + j) % 4], column[j], at);
}

void push_lanes(const ShadeStream& shade, const Slots& slots, Branch branch, size_t i, NodeStack& nodes) {
  VF throughput[4], lambda_nm[4], inv_pdf_nm[4];
  next_throughput(shade, i, throughput);
  const VU slot = load(shade.slot, i);
  const MF live = is_live(slot);
  const VI row = as_index(hn::IfThenElseZero(uint_mask(live), slot));
  const VU pixel = gather(slots.pixel, row);
  const VF importance = hn::Mul(max_of(throughput), next_eta_scale(shade, i));
  const Vec3 direction = load(shade.next_direction, i), origin = ray_origin(shade, i, direction);
  // Lanes beside the picture end here; camera rays only kept their packets company.
  const MF seen = hn::And(live, float_mask(hn::Ne(pixel, splat_u(dead_lane))));
  const MF carries = hn::And(hn::Gt(importance, splat(least_node_importance)), is_traceable(origin, direction));
  const MF kept = hn::And(seen, carries);
  if (hn::AllFalse(FloatTag(), kept)) return;

  const size_t lead = leading_wavelength(branch), at = nodes.rays.size;
  const VU seed = hash_combine(load(shade.pixel_seed, i), splat_u(static_cast<uint32_t>(branch)));
  for (size_t j = 0; j < 4; ++j) inv_pdf_nm[j] = gather(slots.inv_pdf_nm[j], row);
  append_ray(kept, shade, i, {origin, direction}, throughput, nodes.rays);
  load(shade.lambda_nm, i, lambda_nm);
  append_rotated(kept, lambda_nm, lead, nodes.rays.lambda_nm, at);
  append_rotated(kept, throughput, lead, nodes.rays.throughput, at);
  append_rotated(kept, inv_pdf_nm, lead, nodes.inv_pdf_nm, at);
  append(kept, seed, nodes.rays.pixel_seed, at);
  append(kept, pixel, nodes.pixel, at);
  append(kept, gather(slots.sample, row), nodes.sample, at);
  append(kept, gather(slots.weight, row), nodes.weight, at);
}

void push_nodes_kernel(const ShadeStream& shade, const Slots& slots, ShadeKind kind, Branch branch, NodeStack& nodes) {
  const Group& group = group_of(shade, kind);
  for (size_t i = group.begin; i < group.padded_end(); i += lane_count()) push_lanes(shade, slots, branch, i, nodes);
}

}  // namespace
}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fmt/format.h>

namespace metamer {

HWY_EXPORT(push_nodes_kernel);

void push_nodes(const ShadeStream& shade, const Slots& slots, uint32_t depth, ShadeKind kind, Branch branch,
                NodeStack& nodes) {
  const uint32_t size = nodes.rays.size;
  nodes.reserve(size + slots.size);
  HWY_DYNAMIC_DISPATCH(push_nodes_kernel)(shade, slots, kind, branch, nodes);
  if (nodes.rays.size == size) return;
  if (nodes.levels.empty() || nodes.levels.back().depth < depth) nodes.levels.push_back({depth, size});
  const uint64_t bound = uint64_t{depth} * batch_capacity;
  if (nodes.rays.size <= bound) return;
  fmt::print(stderr, "metamer: broken invariant in recursive: {} nodes wait at depth {}, at most {} may\n",
             nodes.rays.size, depth, bound);
  std::abort();
}

bool pop_nodes(uint32_t most, NodeStack& nodes, uint32_t* depth, PathStream& paths, Slots& slots) {
  if (nodes.levels.empty()) return false;
  const NodeStack::Level level = nodes.levels.back();
  const uint32_t count = std::min(most, nodes.rays.size - level.begin), first = nodes.rays.size - count;
  const auto copy = [&](auto& to, const auto& from) { std::copy(from + first, from + first + count, to); };
  const auto copy_all = [&](auto& to, const auto& from) {
    for (size_t j = 0; j < from.size(); ++j) copy(to[j], from[j]);
  };
  copy_columns(nodes.rays, first, count, paths);
  copy_all(slots.lambda_nm, nodes.rays.lambda_nm);
  copy_all(slots.inv_pdf_nm, nodes.inv_pdf_nm);
  copy(slots.pixel, nodes.pixel);
  copy(slots.sample, nodes.sample);
  copy(slots.weight, nodes.weight);
  for (float* column : slots.radiance) std::fill(column, column + count, 0.0f);
  for (uint32_t i = 0; i < count; ++i) paths.slot[i] = i;
  paths.size = slots.size = count;
  slots.are_roots = false;
  nodes.rays.size = first;
  if (first == level.begin) nodes.levels.pop_back();
  *depth = level.depth;
  return true;
}

}  // namespace metamer
#endif
