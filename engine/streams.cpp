#include "engine/streams.h"

#include <cstring>
#include <type_traits>

namespace metamer {
namespace {

template <size_t N>
void take_all(BatchArena& arena, size_t rows, Columns<float, N>& columns) {
  for (float*& column : columns) column = arena.take<float>(rows);
}

template <size_t N>
void take_all(BatchArena& arena, size_t rows, Columns<uint32_t, N>& columns) {
  for (uint32_t*& column : columns) column = arena.take<uint32_t>(rows);
}

void take_paths(BatchArena& arena, size_t rows, PathStream& s) {
  for_each_column(s, [&](auto*& column) { column = arena.take<std::remove_reference_t<decltype(*column)>>(rows); });
}

void take_shade(BatchArena& arena, size_t rows, ShadeStream& s) {
  for (auto* columns : {&s.wo, &s.position, &s.normal, &s.shading_normal, &s.tangent, &s.dp_du, &s.dp_dv, &s.dn_du,
                        &s.dn_dv, &s.light_direction, &s.next_direction})
    take_all(arena, rows, *columns);
  for (auto* columns :
       {&s.lambda_nm, &s.throughput, &s.reflectance, &s.transmittance, &s.light_radiance, &s.next_weight})
    take_all(arena, rows, *columns);
  take_all(arena, rows, s.uv);
  take_all(arena, rows, s.alpha);
  for (float** column : {&s.distance, &s.offset, &s.pdf_direction, &s.eta_scale, &s.light_distance, &s.light_pdf,
                         &s.next_pdf, &s.next_eta_scale, &s.time, &s.thickness, &s.asymmetry})
    *column = arena.take<float>(rows);
  for (uint32_t** column : {&s.material, &s.light, &s.pixel_seed, &s.index, &s.slot})
    *column = arena.take<uint32_t>(rows);
  take_all(arena, rows, s.media);
  take_all(arena, rows, s.next_media);
  take_all(arena, rows, s.volumes);
  take_all(arena, rows, s.share);
  take_all(arena, rows, s.footprint);
  take_all(arena, rows, s.base_alpha);
}

constexpr size_t columns_in_all =
    2 * 27 + 8 + (11 * 3 + 7 * 4 + 8 + 9 + 5 + 4 + 2 + 4) + (6 + 1 + 4 + 2 + 4 + 1) + (12 + 2) + 1;
constexpr size_t column_bytes = (sorted_capacity + column_lanes) * sizeof(float) + 2 * column_alignment;

}  // namespace

// The last vector of a stream may be read and written whole: every column has a vector of padding.
Batch::Batch() : arena(columns_in_all * column_bytes) {
  const size_t rows = sorted_capacity + column_lanes;
  take_paths(arena, rows, paths);
  take_paths(arena, rows, next);
  hits = {arena.take<uint32_t>(rows), arena.take<uint32_t>(rows), arena.take<float>(rows), arena.take<float>(rows),
          arena.take<uint32_t>(rows), arena.take<float>(rows),    arena.take<float>(rows), arena.take<float>(rows)};
  take_shade(arena, rows, shade);
  take_all(arena, rows, shadow.origin);
  take_all(arena, rows, shadow.direction);
  shadow.t_far = arena.take<float>(rows);
  take_all(arena, rows, shadow.contribution);
  shadow.slot = arena.take<uint32_t>(rows);
  take_all(arena, rows, shadow.lambda_nm);
  shadow.volume = arena.take<uint32_t>(rows);
  shadow.time = arena.take<float>(rows);
  take_all(arena, rows, slots.lambda_nm);
  take_all(arena, rows, slots.inv_pdf_nm);
  take_all(arena, rows, slots.radiance);
  slots.pixel = arena.take<uint32_t>(rows);
  slots.sample = arena.take<uint32_t>(rows);
  order = arena.take<uint32_t>(rows);
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
