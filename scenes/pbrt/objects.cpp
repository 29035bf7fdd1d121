// What can only be done when the whole file is known: instances of objects, and shapes of interface material that
// separate nothing.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

// Shapes that move, or are in an object that does, are children of an entity of its own for the instance.
struct Placed {
  const Instance& instance;
  NameId name;
  Entity node = {};
};

void place(Reader& reader, Placed& placed, const ShapeRecord& shape) {
  const TransformPair &outer = placed.instance.transforms, &inner = shape.transforms;
  const TransformPair both{outer.start * inner.start, outer.end * inner.end};
  for (const glm::dmat4& transform : {both.start, both.end}) {
    const std::string_view mistake = transform_mistake(transform);
    if (mistake.empty()) continue;
    return reader.messages.error(placed.instance.source,
                                 fmt::format("the transformation of this instance is {}", mistake));
  }
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  if (!outer.moves() && !inner.moves()) {
    set_place(reader, entity, both);
  } else {
    if (placed.node.is_null()) {
      placed.node = registry.create();
      set_place(reader, placed.node, outer);
      registry.set(placed.node, placed.instance.source);
    }
    set_place(reader, entity, inner);
    registry.set(entity, Parent{placed.node});
  }
  registry.set(entity, shape.geometry);
  registry.set(entity, shape.source);
  registry.set(entity, Name{placed.name});
  if (!shape.material.is_null()) registry.set(entity, MaterialSlot{shape.material});
  if (separates(shape.media)) registry.set(entity, shape.media);
}

}  // namespace

void place_instances(Reader& reader) {
  std::vector<std::string_view> known;
  for (const auto& [name, shapes] : reader.objects) known.push_back(name);
  for (const Instance& instance : reader.instances) {
    const auto object = reader.objects.find(instance.object);
    if (object == reader.objects.end()) {
      reader.messages.error(instance.source, fmt::format("there is no object '{}'{}", instance.object,
                                                         guess(reader, instance.object, known)));
      continue;
    }
    Placed placed{instance, reader.scene.names.add(instance.object)};
    for (const ShapeRecord& shape : object->second) place(reader, placed, shape);
  }
}

void drop_interfaces(Reader& reader) {
  if (reader.interface_materials.empty()) return;
  std::sort(reader.interface_materials.begin(), reader.interface_materials.end());
  Registry& registry = reader.scene.registry;
  std::vector<Entity> shapes;
  registry.each<MaterialSlot>([&](Entity entity, uint32_t) {
    const bool is_seen = registry.has<MediumSlot>(entity) || registry.has<Light>(entity);
    if (!is_seen && std::binary_search(reader.interface_materials.begin(), reader.interface_materials.end(),
                                       registry.get<MaterialSlot>(entity).material)) {
      shapes.push_back(entity);
    }
  });
  for (const Entity shape : shapes) registry.destroy(shape);
}

}  // namespace metamer::pbrt
