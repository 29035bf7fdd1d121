// SIMD twins of window_distribution.h: coordinates agree to 2e-6 absolute and pdfs to 1e-5 relative, where windows are
// at least a hundredth wide, asserted on every instruction set by tests/engine/sampling/window_distribution_test.cpp.
#if defined(METAMER_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_INL_H_
#undef METAMER_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_INL_H_
#else
#define METAMER_ENGINE_SAMPLING_WINDOW_DISTRIBUTION_INL_H_
#endif

#include "engine/sampling/window_distribution.h"
#include "engine/simd/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::HWY_NAMESPACE {

struct WindowV {
  VF x0, y0, x1, y1;
};
struct WindowSampleV {
  VF x, y;
  VF pdf;  // per unit square's area; 0: the window is empty
};

namespace window_detail {

struct Cells {
  VI first, last;
  VF start, end;
  VF first_part, last_part;
};
HWY_INLINE VI next(VI cell) { return hn::Add(cell, hn::Set(IntTag(), 1)); }
HWY_INLINE VF real(VI cell) { return hn::ConvertTo(FloatTag(), cell); }

HWY_INLINE Cells cells_of(VF from, VF to, uint32_t count) {
  const VF n = splat(static_cast<float>(count)), zero = hn::Zero(FloatTag()), one = splat(1.0f);
  const VI last = hn::Set(IntTag(), static_cast<int32_t>(count) - 1);
  Cells cells;
  cells.start = hn::Mul(hn::Max(zero, hn::Min(from, one)), n);
  cells.end = hn::Mul(hn::Max(zero, hn::Min(to, one)), n);
  cells.first = hn::Min(hn::ConvertTo(IntTag(), cells.start), last);
  cells.last = hn::Min(hn::ConvertTo(IntTag(), cells.end), last);
  const MF same = hn::RebindMask(FloatTag(), hn::Eq(cells.first, cells.last));
  cells.first_part = hn::Sub(hn::IfThenElse(same, cells.end, real(next(cells.first))), cells.start);
  cells.last_part = hn::IfThenZeroElse(same, hn::Sub(cells.end, real(cells.last)));
  return cells;
}

struct Sums {
  const int32_t* data;
  VI stride;
  HWY_INLINE explicit Sums(const WindowDistribution& d)
      : data(d.sums.data()), stride(hn::Set(IntTag(), static_cast<int32_t>(d.width) + 1)) {}
  HWY_INLINE VF rectangle(VI x0, VI x1, VI y0, VI y1) const {
    const IntTag di;
    const VI upper = hn::Mul(y0, stride), lower = hn::Mul(y1, stride);
    const VI below =
        hn::Sub(hn::GatherIndex(di, data, hn::Add(lower, x1)), hn::GatherIndex(di, data, hn::Add(lower, x0)));
    const VI above =
        hn::Sub(hn::GatherIndex(di, data, hn::Add(upper, x1)), hn::GatherIndex(di, data, hn::Add(upper, x0)));
    return real(hn::Sub(below, above));
  }
  HWY_INLINE VF strip(VI x0, VI x1, const Cells& rows) const {
    const VF inner = rectangle(x0, x1, hn::Min(next(rows.first), rows.last), rows.last);
    const VF upper = hn::MulAdd(rows.first_part, rectangle(x0, x1, rows.first, next(rows.first)), inner);
    return hn::MulAdd(rows.last_part, rectangle(x0, x1, rows.last, next(rows.last)), upper);
  }
  HWY_INLINE VF before(VI x, const Cells& columns, const Cells& rows) const {
    const VI inner = next(columns.first);
    const VF mass =
        hn::MulAdd(columns.first_part, strip(columns.first, inner, rows), strip(inner, hn::Max(inner, x), rows));
    return hn::IfThenElseZero(hn::RebindMask(FloatTag(), hn::Lt(columns.first, x)), mass);
  }
  HWY_INLINE VF window(const Cells& columns, const Cells& rows) const {
    const MF one = hn::RebindMask(FloatTag(), hn::Eq(columns.first, columns.last));
    return hn::MulAdd(hn::IfThenElse(one, columns.first_part, columns.last_part),
                      strip(columns.last, next(columns.last), rows), before(columns.last, columns, rows));
  }
  HWY_INLINE VF above(VI y, VI x, const Cells& rows) const {
    const VI inner = next(rows.first);
    const VF mass = hn::MulAdd(rows.first_part, rectangle(x, next(x), rows.first, inner),
                               rectangle(x, next(x), inner, hn::Max(inner, y)));
    return hn::IfThenElseZero(hn::RebindMask(FloatTag(), hn::Lt(rows.first, y)), mass);
  }
};

// Lanes that are done wait for the others without changing.
template <class Before>
HWY_INLINE VI find_cell(const Cells& cells, VF target, const Before& before) {
  const IntTag di;
  VI low = cells.first, high = hn::Max(cells.first, cells.last);
  while (!hn::AllTrue(di, hn::Eq(low, high))) {
    const VI middle = hn::ShiftRight<1>(next(hn::Add(low, high)));
    const auto up = hn::RebindMask(di, hn::Le(before(middle), target));
    high = hn::IfThenElse(up, high, hn::Max(low, hn::Sub(middle, hn::Set(di, 1))));
    low = hn::IfThenElse(up, middle, low);
  }
  return low;
}

HWY_INLINE VF place_in_cell(const Cells& cells, VI cell, VF rest, VF density) {
  const VF start = hn::Max(cells.start, real(cell)), end = hn::Min(cells.end, real(next(cell)));
  return hn::Min(hn::Add(start, hn::Div(rest, density)), end);
}

HWY_INLINE MF is_filled(const WindowV& window) {
  return hn::And(hn::Gt(window.x1, window.x0), hn::Gt(window.y1, window.y0));
}

// An empty window becomes a whole one, for lanes that are masked in the end.
HWY_INLINE WindowV whole_unless(MF filled, const WindowV& window) {
  const VF zero = hn::Zero(FloatTag()), one = splat(1.0f);
  return {hn::IfThenElse(filled, window.x0, zero), hn::IfThenElse(filled, window.y0, zero),
          hn::IfThenElse(filled, window.x1, one), hn::IfThenElse(filled, window.y1, one)};
}

HWY_INLINE VF cell_pdf(const WindowDistribution& distribution, VF cell, VF total) {
  const float cells = static_cast<float>(distribution.width) * static_cast<float>(distribution.height);
  return hn::Div(hn::Mul(cell, splat(cells)), total);
}

}  // namespace window_detail

HWY_INLINE WindowSampleV sample_window(const WindowDistribution& distribution, const WindowV& wanted, VF u, VF v) {
  using namespace window_detail;
  MF filled = is_filled(wanted);
  const WindowV window = whole_unless(filled, wanted);
  const Sums sums(distribution);
  const Cells columns = cells_of(window.x0, window.x1, distribution.width);
  const Cells rows = cells_of(window.y0, window.y1, distribution.height);
  const VF total = sums.window(columns, rows), target = hn::Mul(u, total);
  filled = hn::And(filled, hn::Gt(total, hn::Zero(FloatTag())));
  const VI x = find_cell(columns, target, [&](VI column) HWY_ATTR { return sums.before(column, columns, rows); });
  const VF column = sums.strip(x, next(x), rows);
  const VF place_x = place_in_cell(columns, x, hn::Sub(target, sums.before(x, columns, rows)), column);
  const VF target_y = hn::Mul(v, column);
  const VI y = find_cell(rows, target_y, [&](VI row) HWY_ATTR { return sums.above(row, x, rows); });
  const VF cell = sums.rectangle(x, next(x), y, next(y));
  const VF place_y = place_in_cell(rows, y, hn::Sub(target_y, sums.above(y, x, rows)), cell);
  return {hn::Div(place_x, splat(static_cast<float>(distribution.width))),
          hn::Div(place_y, splat(static_cast<float>(distribution.height))),
          hn::IfThenElseZero(filled, cell_pdf(distribution, cell, total))};
}

HWY_INLINE VF window_pdf(const WindowDistribution& distribution, const WindowV& wanted, VF x, VF y) {
  using namespace window_detail;
  const MF filled = is_filled(wanted);
  const WindowV window = whole_unless(filled, wanted);
  const Sums sums(distribution);
  const Cells columns = cells_of(window.x0, window.x1, distribution.width);
  const Cells rows = cells_of(window.y0, window.y1, distribution.height);
  const VI at_x = cells_of(x, x, distribution.width).first, at_y = cells_of(y, y, distribution.height).first;
  const VF total = sums.window(columns, rows);
  const VF cell = sums.rectangle(at_x, next(at_x), at_y, next(at_y));
  const MF inside =
      hn::And(hn::And(hn::Ge(x, window.x0), hn::Le(x, window.x1)), hn::And(hn::Ge(y, window.y0), hn::Le(y, window.y1)));
  const MF counts = hn::And(hn::And(filled, inside), hn::Gt(total, hn::Zero(FloatTag())));
  return hn::IfThenElseZero(counts, cell_pdf(distribution, cell, total));
}

}  // namespace metamer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
