// What can only be done when the whole file is known: instances of objects, and shapes of interface material that
// separate nothing.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/pbrt/matrix.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

void place(Reader& reader, const Instance& instance, const ShapeRecord& shape, NameId name) {
  const glm::dmat4 transform = instance.transform * shape.transform;
  const std::string_view mistake = transform_mistake(transform);
  if (!mistake.empty()) {
    return reader.messages.error(instance.source, fmt::format("the transformation of this instance is {}", mistake));
  }
  Registry& registry = reader.scene.registry;
  const Entity entity = registry.create();
  registry.set(entity, to_component(transform));
  registry.set(entity, shape.geometry);
  registry.set(entity, shape.source);
  registry.set(entity, Name{name});
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
                                                         did_you_mean(instance.object, known)));
      continue;
    }
    const NameId name = reader.scene.names.add(instance.object);
    for (const ShapeRecord& shape : object->second) place(reader, instance, shape, name);
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
