#include "engine/streams.h"

#include <cstring>
#include <type_traits>

namespace metamer {
namespace {

template <class Visit>
void for_each_column(HitStream& s, const Visit& visit) {
  visit_columns(visit, s.object, s.primitive, s.distance, s.u, s.material, s.passed, s.reach, s.depth_left);
}

template <class Visit>
void for_each_column(ShadeStream& s, const Visit& visit) {
  visit_columns(visit, s.wo, s.position, s.normal, s.shading_normal, s.tangent, s.uv, s.dp_du, s.dp_dv, s.dn_du,
                s.dn_dv, s.distance, s.offset, s.material, s.light, s.lambda_nm, s.throughput, s.pdf_direction,
                s.eta_scale, s.pixel_seed, s.index, s.slot, s.media, s.time, s.reflectance, s.transmittance, s.alpha,
                s.volume, s.volumes, s.share, s.footprint, s.base_alpha, s.thickness, s.asymmetry);
  visit_columns(visit, s.light_direction, s.light_radiance, s.light_distance, s.light_pdf);
  visit_columns(visit, s.next_direction, s.next_weight, s.next_pdf, s.next_eta_scale, s.next_media);
}

template <class Visit>
void for_each_column(ShadowStream& s, const Visit& visit) {
  visit_columns(visit, s.origin, s.direction, s.t_far, s.contribution, s.slot, s.lambda_nm, s.volume, s.time,
                s.pixel_seed, s.index);
}

template <class Visit>
void for_each_column(Slots& s, const Visit& visit) {
  visit_columns(visit, s.lambda_nm, s.inv_pdf_nm, s.radiance, s.pixel, s.sample, s.weight);
}

template <class Visit>
void for_each_column(Batch& batch, const Visit& visit) {
  for_each_column(batch.paths, visit);
  for_each_column(batch.next, visit);
  for_each_column(batch.hits, visit);
  for_each_column(batch.shade, visit);
  for_each_column(batch.shadow, visit);
  for_each_column(batch.slots, visit);
  visit(batch.order);
}

constexpr size_t column_bytes = (sorted_capacity + column_lanes) * sizeof(float) + 2 * column_alignment;

}  // namespace

// The last vector of a stream may be read and written whole: every column has a vector of padding.
Batch::Batch() {
  size_t columns = 0;
  for_each_column(*this, [&](auto*&) { ++columns; });
  arena.reserve(columns * column_bytes);
  for_each_column(*this, [&](auto*& column) {
    column = arena.take<std::remove_reference_t<decltype(*column)>>(sorted_capacity + column_lanes);
  });
}

void copy_columns(PathStream& from, uint32_t first, uint32_t count, PathStream& to) {
  std::array<const void*, 32> columns;
  size_t c = 0;
  for_each_column(from, [&](auto*& column) { columns.at(c++) = column + first; });
  c = 0;
  for_each_column(to, [&](auto*& column) { std::memcpy(column, columns[c++], count * sizeof(*column)); });
}

void NodeStack::reserve(uint32_t rows) {
  if (rows <= capacity) return;
  capacity = std::max(rows, 2 * capacity);
  const size_t stride = padded_to_lanes(size_t{capacity} + column_lanes) * sizeof(float);
  size_t columns = 0;
  for_each_column(*this, [&](auto*&) { ++columns; });
  Column<std::byte> fresh(columns * stride);
  std::byte* next = fresh.data();
  for_each_column(*this, [&](auto*& column) {
    if (rays.size > 0) std::memcpy(next, column, rays.size * sizeof(*column));
    column = reinterpret_cast<std::remove_reference_t<decltype(column)>>(next);
    next += stride;
  });
  memory.swap(fresh);
}

}  // namespace metamer
