#include "engine/ecs/registry.h"

#include <gtest/gtest.h>

#include "engine/ecs/components.h"

namespace metamer {
namespace {

TEST(Registry, AHandleToADestroyedEntityIsDeadAfterItsSlotIsReused) {
  Registry registry;
  const Entity first = registry.create();
  registry.set(first, Geometry{.radius = 2});
  registry.destroy(first);
  const Entity second = registry.create();
  EXPECT_EQ(second.index, first.index);
  EXPECT_NE(second.generation, first.generation);
  EXPECT_FALSE(registry.is_alive(first));
  EXPECT_FALSE(registry.has<Geometry>(second));
  EXPECT_EQ(registry.get<Geometry>(first).radius, 1.0f) << "a dead handle reads the default";
}

TEST(Registry, ErasingARowMovesTheLastOneIntoTheGap) {
  Registry registry;
  Entity entities[5];
  for (int i = 0; i < 5; ++i) {
    entities[i] = registry.create();
    registry.set(entities[i], Geometry{.radius = static_cast<float>(i)});
  }
  registry.remove<Geometry>(entities[1]);
  EXPECT_EQ(registry.table<Geometry>().size(), 4u);
  for (const int i : {0, 2, 3, 4}) EXPECT_EQ(registry.get<Geometry>(entities[i]).radius, static_cast<float>(i));
  EXPECT_FALSE(registry.has<Geometry>(entities[1]));
}

TEST(Registry, ColumnsAreAlignedAndPaddedWithZeros) {
  Registry registry;
  for (int i = 0; i < 21; ++i) registry.set(registry.create(), Geometry{.radius = 7});
  const Column<float>& radius = registry.table<Geometry>().column<&Geometry::radius>();
  EXPECT_EQ(reinterpret_cast<uintptr_t>(radius.data()) % 64, 0u);
  ASSERT_EQ(radius.size(), 21u);
  for (size_t i = 0; i < 21; ++i) EXPECT_EQ(radius[i], 7.0f);
  for (size_t i = 21; i < padded_to_lanes(21); ++i) EXPECT_EQ(radius.data()[i], 0.0f);
  EXPECT_EQ(registry.table<Geometry>().column<&Geometry::height>()[3], 0.0f) << "fields of one type have own columns";
}

TEST(Registry, AQueryVisitsExactlyTheEntitiesWithAllComponents) {
  Registry registry;
  std::vector<Entity> both;
  for (int i = 0; i < 12; ++i) {
    const Entity entity = registry.create();
    if (i % 2 == 0) registry.set(entity, Geometry{});
    if (i % 3 == 0) registry.set(entity, Light{.scale = static_cast<float>(i)});
    if (i % 6 == 0) both.push_back(entity);
  }
  std::vector<Entity> seen;
  registry.each<Geometry, Light>([&](Entity entity, uint32_t geometry_row, uint32_t light_row) {
    EXPECT_EQ(registry.table<Geometry>().owner(geometry_row), entity);
    EXPECT_EQ(registry.table<Light>().owner(light_row), entity);
    seen.push_back(entity);
  });
  EXPECT_EQ(seen, both);
}

TEST(Registry, ChangeTrackingNamesTheRowsWrittenSinceATick) {
  Registry registry;
  Entity entities[4];
  for (Entity& entity : entities) {
    entity = registry.create();
    registry.set(entity, Light{});
  }
  const Tick before = registry.tick();
  EXPECT_TRUE(registry.table<Light>().changed_since(before).empty());
  registry.set(entities[2], Light{.scale = 3});
  EXPECT_EQ(registry.table<Light>().changed_since(before), std::vector<uint32_t>{2});
  EXPECT_LE(registry.table<Light>().structure_changed(), before);
  registry.destroy(entities[0]);
  EXPECT_GT(registry.table<Light>().structure_changed(), before);
}

}  // namespace
}  // namespace metamer
