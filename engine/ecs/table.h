// All rows of one component, a column per field. A component type C is a plain struct that lists its fields:
//   static constexpr auto fields = std::make_tuple(&C::radius, &C::kind);
// Rows are dense and unordered: erasing moves the last row into the gap.
#pragma once
#include <tuple>
#include <utility>
#include <vector>

#include "engine/ecs/entity.h"
#include "engine/simd/column.h"

namespace metamer {

using Tick = uint64_t;

template <class C>
class Table {
  template <class M>
  struct MemberType;
  template <class T>
  struct MemberType<T C::*> {
    using type = T;
  };
  template <class... M>
  static auto columns_of(std::tuple<M...>) -> std::tuple<Column<typename MemberType<M>::type>...>;
  using Columns = decltype(columns_of(C::fields));
  static constexpr size_t field_count = std::tuple_size_v<Columns>;

 public:
  size_t size() const { return owners_.size(); }

  // The row of an entity, or no_index.
  uint32_t row_of(Entity entity) const {
    if (entity.index >= rows_.size()) return no_index;
    const uint32_t row = rows_[entity.index];
    return row != no_index && owners_[row] == entity ? row : no_index;
  }
  Entity owner(uint32_t row) const { return owners_[row]; }
  const Column<Entity>& owners() const { return owners_; }

  // The column of one field, for instance table.column<&Geometry::radius>(). Writing goes through set().
  template <auto Member>
  const auto& column() const {
    return std::get<field_index<Member>()>(columns_);
  }

  C get(uint32_t row) const {
    C value;
    each_field([&](auto member, const auto& column) { value.*member = column[row]; });
    return value;
  }

  // Adds or replaces the component of an entity.
  void set(Entity entity, const C& value, Tick now) {
    uint32_t row = row_of(entity);
    if (row == no_index) {
      row = static_cast<uint32_t>(owners_.size());
      if (entity.index >= rows_.size()) rows_.resize(entity.index + 1, no_index);
      rows_[entity.index] = row;
      owners_.push_back(entity);
      changed_.push_back(now);
      each_column([](auto, auto& column) { column.resize(column.size() + 1); });
      structure_changed_ = now;
    }
    each_column([&](auto member, auto& column) { column[row] = value.*member; });
    changed_[row] = now;
  }

  void erase(Entity entity, Tick now) {
    const uint32_t row = row_of(entity);
    if (row == no_index) return;
    const uint32_t last = static_cast<uint32_t>(owners_.size()) - 1;
    if (row != last) {
      owners_[row] = owners_[last];
      changed_[row] = changed_[last];
      rows_[owners_[row].index] = row;
      each_column([&](auto, auto& column) { column[row] = column[last]; });
    }
    rows_[entity.index] = no_index;
    owners_.resize(last);
    changed_.resize(last);
    each_column([&](auto, auto& column) { column.resize(last); });
    structure_changed_ = now;
  }

  // The tick at which a row was last written.
  Tick changed(uint32_t row) const { return changed_[row]; }
  // The tick of the last row added or erased.
  Tick structure_changed() const { return structure_changed_; }
  // Rows written after `tick`, ascending.
  std::vector<uint32_t> changed_since(Tick tick) const {
    std::vector<uint32_t> rows;
    for (uint32_t row = 0; row < changed_.size(); ++row)
      if (changed_[row] > tick) rows.push_back(row);
    return rows;
  }

  size_t bytes() const {
    size_t total = rows_.size() * sizeof(uint32_t) + owners_.bytes() + changed_.bytes();
    each_field([&](auto, const auto& column) { total += column.bytes(); });
    return total;
  }

 private:
  template <auto Member, size_t I = 0>
  static constexpr size_t field_index() {
    static_assert(I < field_count, "the component does not list this field");
    if constexpr (std::is_same_v<decltype(std::get<I>(C::fields)), decltype(Member)> ||
                  std::is_same_v<std::remove_cvref_t<decltype(std::get<I>(C::fields))>, decltype(Member)>) {
      if constexpr (std::get<I>(C::fields) == Member)
        return I;
      else
        return field_index<Member, I + 1>();
    } else {
      return field_index<Member, I + 1>();
    }
  }
  template <class F>
  void each_column(F&& f) {
    [&]<size_t... I>(std::index_sequence<I...>) { (f(std::get<I>(C::fields), std::get<I>(columns_)), ...); }
    (std::make_index_sequence<field_count>());
  }
  template <class F>
  void each_field(F&& f) const {
    [&]<size_t... I>(std::index_sequence<I...>) { (f(std::get<I>(C::fields), std::get<I>(columns_)), ...); }
    (std::make_index_sequence<field_count>());
  }

  std::vector<uint32_t> rows_;  // by entity index
  Column<Entity> owners_;
  Column<Tick> changed_;
  Columns columns_;
  Tick structure_changed_ = 0;
};

}  // namespace metamer
