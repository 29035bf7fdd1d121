#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "scenes/native/transforms.h"
#include "scenes/native/write_parts.h"

namespace metamer {
namespace {

bool same_bits(const glm::vec4& a, const glm::vec4& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }
bool same_bits(const Transform& a, const Transform& b) {
  return same_bits(a.row0, b.row0) && same_bits(a.row1, b.row1) && same_bits(a.row2, b.row2);
}

JsonText numbers(const glm::vec4& row) { return JsonText::numbers(std::array{row.x, row.y, row.z, row.w}); }

JsonText write_geometry(WriteContext& context, const Geometry& geometry) {
  JsonText object = JsonText::object();
  const auto type = [&](std::string_view name) { object.add("type", JsonText::string(name)); };
  const auto length = [&](std::string_view key, float value) { object.add(key, JsonText::number(value)); };
  const auto turn = [&] {
    if (geometry.phi_max_deg != 360) length("phi_max", geometry.phi_max_deg);
  };
  switch (geometry.kind) {
    case ShapeKind::mesh:
      type("mesh");
      object.add("mesh", JsonText::string(context.mesh_name(geometry.mesh)));
      break;
    case ShapeKind::sphere:
      type("sphere");
      length("radius", geometry.radius);
      if (std::isfinite(geometry.z_min)) length("z_min", geometry.z_min);
      if (std::isfinite(geometry.z_max)) length("z_max", geometry.z_max);
      turn();
      break;
    case ShapeKind::cylinder:
      type("cylinder");
      length("radius", geometry.radius);
      length("z_min", geometry.z_min);
      length("z_max", geometry.z_max);
      turn();
      break;
    case ShapeKind::disk:
      type("disk");
      length("radius", geometry.radius);
      if (geometry.inner_radius != 0) length("inner_radius", geometry.inner_radius);
      if (geometry.height != 0) length("height", geometry.height);
      turn();
      break;
    case ShapeKind::rectangle:
      type("rectangle");
      length("width", geometry.width);
      length("depth", geometry.depth);
      break;
    case ShapeKind::flat_curves:
    case ShapeKind::ribbons:
    case ShapeKind::round_curves:
      type("curves");
      object.add("curves", JsonText::string(context.curves_name(geometry.curves)));
      object.add("kind", JsonText::string(geometry.kind == ShapeKind::flat_curves ? "flat"
                                          : geometry.kind == ShapeKind::ribbons   ? "ribbons"
                                                                                  : "round"));
      break;
  }
  if (geometry.flip_normal != 0) object.add("flip_normal", JsonText::boolean(true));
  if (geometry.alpha_texture != no_index) object.add("alpha", context.texture(geometry.alpha_texture));
  return object;
}

JsonText write_camera(const Camera& camera) {
  JsonText object = JsonText::object();
  switch (camera.kind) {
    case CameraKind::perspective:
      object.add("type", JsonText::string("perspective"));
      object.add("fov", JsonText::number(camera.fov_deg));
      break;
    case CameraKind::orthographic:
      object.add("type", JsonText::string("orthographic"));
      object.add("screen_height", JsonText::number(camera.screen_height));
      break;
    case CameraKind::spherical:
      object.add("type", JsonText::string("spherical"));
      return object.add("mapping", JsonText::string(mapping_name(camera.mapping)));
  }
  if (camera.lens_radius != 0) object.add("lens_radius", JsonText::number(camera.lens_radius));
  if (camera.focal_distance != 1) object.add("focal_distance", JsonText::number(camera.focal_distance));
  if (camera.screen_window != glm::vec4(0)) object.add("screen_window", numbers(camera.screen_window));
  return object;
}

JsonText write_visibility(const Visibility& visibility) {
  JsonText object = JsonText::object();
  const auto flag = [&](std::string_view key, uint32_t bit) {
    if ((visibility.mask & bit) == 0) object.add(key, JsonText::boolean(false));
  };
  flag("camera", visible_to_camera);
  flag("bounces", visible_to_bounces);
  flag("shadows", visible_to_shadows);
  return object;
}

class EntityWriter {
 public:
  explicit EntityWriter(WriteContext& context) : context_(context), registry_(context.scene.registry) {}

  JsonText write() {
    find_parents();
    const std::vector<Entity> order = entities_in_order();
    for (const Entity entity : order) name(entity);
    JsonText entities = JsonText::array().break_lines();
    for (const Entity entity : order) entities.add(write(entity));
    return entities;
  }

 private:
  void find_parents() {
    const Table<Parent>& table = registry_.table<Parent>();
    for (uint32_t row = 0; row < table.size(); ++row) mark(is_parent_, table.get(row).entity);
  }

  // Cameras, entities that only place others, lights, shapes: each kind as in its table, whose order decides what is
  // hit and sampled.
  std::vector<Entity> entities_in_order() {
    const auto append_all = [&](const Column<Entity>& owners, auto&& wanted) {
      for (const Entity entity : owners)
        if (wanted(entity) && mark(is_listed_, entity)) order_.push_back(entity);
    };
    append_all(registry_.table<Camera>().owners(), [](Entity) { return true; });
    const auto only_places = [&](Entity entity) {
      return !registry_.has<Geometry>(entity) && !registry_.has<Light>(entity) && !registry_.has<Medium>(entity) &&
             (!registry_.has<Material>(entity) || is_marked(is_parent_, entity));
    };
    std::vector<Entity> places;
    for (const Column<Entity>* owners : {&registry_.table<Transform>().owners(), &registry_.table<Motion>().owners(),
                                         &registry_.table<Name>().owners(), &registry_.table<Parent>().owners()})
      for (const Entity entity : *owners)
        if (only_places(entity)) places.push_back(entity);
    for (const Entity& entity : registry_.table<Parent>().column<&Parent::entity>())
      if (registry_.is_alive(entity) && only_places(entity)) places.push_back(entity);
    std::sort(places.begin(), places.end());
    for (const Entity entity : places)
      if (mark(is_listed_, entity)) order_.push_back(entity);
    const Column<Entity>& shapes = registry_.table<Geometry>().owners();
    uint32_t next_shape = 0;
    for (const Entity light : registry_.table<Light>().owners()) {
      // A shape that shines keeps its place among the shapes.
      if (registry_.has<Geometry>(light) && registry_.get<Light>(light).kind == LightKind::area) continue;
      while (registry_.has<Geometry>(light) && !is_marked(is_listed_, light)) {
        if (mark(is_listed_, shapes[next_shape])) order_.push_back(shapes[next_shape]);
        ++next_shape;
      }
      if (mark(is_listed_, light)) order_.push_back(light);
    }
    append_all(shapes, [](Entity) { return true; });
    return order_;
  }

  void name(Entity entity) {
    const Name component = registry_.get<Name>(entity);
    std::string wanted = component.name == no_index ? std::string() : context_.scene.names[component.name];
    if (wanted.empty() && is_marked(is_parent_, entity)) wanted = fmt::format("entity {}", names_made_ + 1);
    ++names_made_;
    if (wanted.empty()) return;
    if (entity.index >= context_.names.size()) context_.names.resize(entity.index + 1);
    context_.names[entity.index] = context_.entity_names.take(wanted);
  }

  JsonText write(Entity entity) {
    JsonText object = JsonText::object();
    const auto add_name = [&](std::string_view key, const std::vector<std::string>& names, Entity whose) {
      if (whose.index < names.size() && !names[whose.index].empty())
        object.add(key, JsonText::string(names[whose.index]));
    };
    add_name("name", context_.names, entity);
    if (registry_.has<Parent>(entity)) add_name("parent", context_.names, registry_.get<Parent>(entity).entity);
    const Transform transform = as_in_file(entity, registry_.get<Transform>(entity));
    if (!same_bits(transform, Transform{})) object.add("transform", write_transform(transform));
    if (registry_.has<Motion>(entity)) object.add("motion", write_motion(entity));
    if (registry_.has<Camera>(entity)) {
      object.add("camera", write_camera(registry_.get<Camera>(entity)));
      if (registry_.has<Geometry>(entity) || registry_.has<Light>(entity))
        context_.mistakes.push_back(
            fmt::format("that {} is a camera and a shape or light at once", context_.scene.describe(entity)));
    }
    if (registry_.has<Geometry>(entity)) {
      object.add("geometry", write_geometry(context_, registry_.get<Geometry>(entity)));
      add_name("material", context_.material_names, material_of(entity));
    }
    if (registry_.has<Light>(entity)) object.add("light", write_light(context_, registry_.get<Light>(entity)));
    const Visibility visibility = registry_.get<Visibility>(entity);
    if (visibility.mask != visible_to_all) object.add("visibility", write_visibility(visibility));
    const MediumSlot media = registry_.get<MediumSlot>(entity);
    if (!media.inside.is_null() || !media.outside.is_null()) object.add("media", write_medium_slot(context_, media));
    return object;
  }

  JsonText write_motion(Entity entity) const {
    const Motion motion = registry_.get<Motion>(entity);
    JsonText object = JsonText::object();
    object.add("end", write_transform(as_in_file(entity, {motion.row0, motion.row1, motion.row2})));
    return object.add("times", JsonText::numbers(std::array{motion.start_time, motion.end_time}));
  }

  // The mirrors of the reader (entities.cpp) undone.
  Transform as_in_file(Entity entity, const Transform& transform) const {
    const Entity parent = registry_.get<Parent>(entity).entity;
    const bool in_camera = !parent.is_null() && registry_.has<Camera>(parent);
    const Transform first = in_camera ? then_mirrored_z(transform) : transform;
    return registry_.has<Camera>(entity) ? mirrored_z(first) : first;
  }

  // As build_materials has it: the slot's, else the entity's own; a null entity for none.
  Entity material_of(Entity entity) const {
    const Entity slot = registry_.get<MaterialSlot>(entity).material;
    const Entity source = registry_.has<Material>(slot) ? slot : entity;
    return registry_.has<Material>(source) ? source : Entity{};
  }

  static bool is_marked(const std::vector<bool>& marks, Entity entity) {
    return entity.index < marks.size() && marks[entity.index];
  }
  // False if it was already.
  static bool mark(std::vector<bool>& marks, Entity entity) {
    if (entity.is_null() || is_marked(marks, entity)) return false;
    if (entity.index >= marks.size()) marks.resize(entity.index + 1);
    return marks[entity.index] = true;
  }

  WriteContext& context_;
  const Registry& registry_;
  std::vector<bool> is_parent_, is_listed_;  // by entity index
  std::vector<Entity> order_;
  size_t names_made_ = 0;
};

}  // namespace

JsonText write_transform(const Transform& t) {
  const Transform only_offset{{1, 0, 0, t.row0.w}, {0, 1, 0, t.row1.w}, {0, 0, 1, t.row2.w}};
  JsonText object = JsonText::object();
  if (same_bits(t, only_offset))
    return object.add("translate", JsonText::numbers(std::array{t.row0.w, t.row1.w, t.row2.w}));
  return object.add("matrix", JsonText::array().add(numbers(t.row0)).add(numbers(t.row1)).add(numbers(t.row2)));
}

JsonText write_entities(WriteContext& context) { return EntityWriter(context).write(); }

}  // namespace metamer
