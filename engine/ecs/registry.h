// Entities and their components. Data only: behaviour lives in the systems.
#pragma once
#include <array>
#include <cassert>

#include "engine/ecs/table.h"

namespace metamer {

template <class... Components>
class BasicRegistry {
 public:
  Entity create() {
    if (!free_.empty()) {
      const uint32_t index = free_.back();
      free_.pop_back();
      alive_[index] = true;
      return {index, generations_[index]};
    }
    generations_.push_back(0);
    alive_.push_back(true);
    return {static_cast<uint32_t>(generations_.size() - 1), 0};
  }

  // Handles to a destroyed entity become dead: its slot is reused under the next generation.
  void destroy(Entity entity) {
    if (!is_alive(entity)) return;
    ++tick_;
    (mutable_table<Components>().erase(entity, tick_), ...);
    ++generations_[entity.index];
    alive_[entity.index] = false;
    free_.push_back(entity.index);
  }

  bool is_alive(Entity entity) const {
    return entity.index < generations_.size() && alive_[entity.index] &&
           generations_[entity.index] == entity.generation;
  }
  size_t entity_count() const { return generations_.size() - free_.size(); }

  template <class C>
  void set(Entity entity, const C& component) {
    assert(is_alive(entity));
    mutable_table<C>().set(entity, component, ++tick_);
  }
  template <class C>
  void remove(Entity entity) {
    mutable_table<C>().erase(entity, ++tick_);
  }
  template <class C>
  bool has(Entity entity) const {
    return table<C>().row_of(entity) != no_index;
  }
  // The component, or its default where the entity has none.
  template <class C>
  C get(Entity entity) const {
    const uint32_t row = table<C>().row_of(entity);
    return row == no_index ? C{} : table<C>().get(row);
  }
  template <class C>
  const Table<C>& table() const {
    return std::get<Table<C>>(tables_);
  }

  // The tick of the last change; pass it to changed_since() later.
  Tick tick() const { return tick_; }

  // Calls f(entity, row of First, rows of Rest...) for every entity that has all of the components, in the
  // row order of the first.
  template <class First, class... Rest, class F>
  void each(F&& f) const {
    const Table<First>& first = table<First>();
    for (uint32_t row = 0; row < first.size(); ++row) {
      const Entity entity = first.owner(row);
      const std::array<uint32_t, sizeof...(Rest)> rest{table<Rest>().row_of(entity)...};
      bool has_all = true;
      for (const uint32_t r : rest) has_all = has_all && r != no_index;
      if (has_all) std::apply([&](auto... rows) { f(entity, row, rows...); }, rest);
    }
  }

  size_t bytes() const {
    return generations_.size() * (sizeof(uint32_t) + 1) + (size_t{0} + ... + table<Components>().bytes());
  }

 private:
  template <class C>
  Table<C>& mutable_table() {
    return std::get<Table<C>>(tables_);
  }

  std::vector<uint32_t> generations_;
  std::vector<bool> alive_;
  std::vector<uint32_t> free_;
  std::tuple<Table<Components>...> tables_;
  Tick tick_ = 0;
};

}  // namespace metamer
