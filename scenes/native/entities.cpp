#include "scenes/native/entities.h"

#include <fmt/format.h>

#include <set>

#include "scenes/native/components.h"
#include "scenes/native/transforms.h"

namespace metamer {
namespace {

void name_entity(SceneContext& context, Entity entity, const std::string& name, const Json::Value& at,
                 bool has_material) {
  Registry& registry = context.scene.registry;
  const SourceLocation location = context.reader.document().at_key(at);
  registry.set(entity, Name{context.scene.names.add(name)});
  const auto [first, is_new] = context.entities.try_emplace(name, NamedEntity{entity, location, has_material});
  if (!is_new) {
    context.reader.diagnostics().error(
        location, fmt::format("the name '{}' is taken by line {}; entities and materials need names of their own",
                              printable_text(name), first->second.at.line));
  }
}

// One element of "entities" on its way into the registry.
struct PendingEntity {
  Entity entity;
  JsonObject object;
};

class EntityReader {
 public:
  explicit EntityReader(SceneContext& context)
      : context_(context), reader_(context.reader), registry_(context.scene.registry) {}

  void read(const Json::Value& entities) {
    if (!reader_.array(entities, "entities", "entities")) return;
    for (const Json::Value& value : entities) create(value);
    for (const PendingEntity& pending : pending_) set_components(pending);
    check_cycles();
    for (const PendingEntity& pending : pending_) unmirror_child_of_camera(pending.entity);
  }

 private:
  void create(const Json::Value& value) {
    const JsonObject object(reader_, value, *find_object_spec("entity"), "an entity");
    if (!object.is_valid()) return;
    const Entity entity = registry_.create();
    registry_.set(entity, context_.source_of(value));
    if (const Json::Value* name = object.find("name")) {
      const std::string text = reader_.text(*name, "name");
      if (!text.empty()) name_entity(context_, entity, text, *name, has_own_material(object));
    }
    pending_.push_back({entity, object});
  }

  void set_components(const PendingEntity& pending) {
    const auto& [entity, object] = pending;
    if (const Json::Value* parent = object.find("parent")) set_parent(entity, *parent);
    if (const Json::Value* material = object.find("material")) set_material(entity, *material);
    if (const Json::Value* value = object.find("geometry"))
      if (const auto geometry = read_geometry(context_, *value)) registry_.set(entity, *geometry);
    if (const Json::Value* value = object.find("light")) set_light(entity, object, *value);
    if (const Json::Value* value = object.find("visibility")) registry_.set(entity, read_visibility(context_, *value));
    if (const Json::Value* value = object.find("media")) set_media(entity, object, *value);
    if (const Json::Value* value = object.find("motion")) registry_.set(entity, read_motion(context_, *value));
    const Transform transform = read_transform(context_, object.find("transform"));
    if (object.has("camera")) {
      set_camera(entity, object, transform);
    } else if (object.has("transform")) {
      registry_.set(entity, transform);
    }
  }

  static bool has_own_material(const JsonObject& object) {
    const Json::Value* material = object.find("material");
    return material != nullptr && !material->isString();
  }

  void set_parent(Entity entity, const Json::Value& value) {
    const std::string name = reader_.text(value, "parent");
    if (name.empty()) return;
    const auto found = context_.entities.find(name);
    if (found == context_.entities.end()) {
      reader_.error(
          value, fmt::format("unknown entity '{}'{}", printable_text(name), did_you_mean_key(name, context_.entities)));
      return;
    }
    registry_.set(entity, Parent{found->second.entity});
  }

  // A name refers to an entry of "materials", or to an entity that has a material of its own.
  void set_material(Entity entity, const Json::Value& value) {
    if (!value.isString()) {
      context_.reader.set_subject(context_.scene.describe(entity));
      if (const auto material = read_material(context_, value)) registry_.set(entity, *material);
      context_.reader.set_subject({});
      return;
    }
    const std::string name = value.asString();
    const auto found = context_.entities.find(name);
    if (found == context_.entities.end()) {
      reader_.error(value, fmt::format("unknown material '{}'{}", printable_text(name),
                                       did_you_mean_key(name, context_.entities)));
    } else if (!found->second.has_material) {
      reader_.error(
          value, fmt::format("'{}' (line {}) has no material of its own", printable_text(name), found->second.at.line));
    } else {
      registry_.set(entity, MaterialSlot{found->second.entity});
    }
  }

  void set_media(Entity entity, const JsonObject& object, const Json::Value& value) {
    if (!object.has("geometry") && !object.has("camera"))
      reader_.error(value, "'media' needs a 'geometry' or a 'camera' on the same entity");
    registry_.set(entity, read_medium_slot(context_, value));
  }

  void set_light(Entity entity, const JsonObject& object, const Json::Value& value) {
    read_light(context_, entity, value);
    if (!registry_.has<Light>(entity)) return;
    if (registry_.get<Light>(entity).kind == LightKind::area && !object.has("geometry"))
      reader_.error(value, "an area light needs a 'geometry' on the same entity");
  }

  // In the file cameras look along -z in a right-handed space, as in the component along +z in a left-handed one. The
  // mirror goes into the entity's transform; its children are mirrored back by unmirror_child_of_camera.
  void set_camera(Entity entity, const JsonObject& object, const Transform& transform) {
    if (const auto camera = read_camera(context_, *object.find("camera"))) registry_.set(entity, *camera);
    registry_.set(entity, mirrored_z(transform));
    mirror_motion(entity, mirrored_z);
    for (const std::string_view key : {"geometry", "light"})
      if (object.has(key))
        reader_.error(*object.find(key), fmt::format("an entity with a camera cannot have '{}'; make it a child", key));
  }

  void unmirror_child_of_camera(Entity entity) {
    const Entity parent = registry_.get<Parent>(entity).entity;
    if (parent.is_null() || !registry_.has<Camera>(parent)) return;
    registry_.set(entity, then_mirrored_z(registry_.get<Transform>(entity)));
    mirror_motion(entity, then_mirrored_z);
  }

  void mirror_motion(Entity entity, Transform (*mirror)(const Transform&)) {
    if (!registry_.has<Motion>(entity)) return;
    Motion motion = registry_.get<Motion>(entity);
    const Transform end = mirror({motion.row0, motion.row1, motion.row2});
    motion.row0 = end.row0;
    motion.row1 = end.row1;
    motion.row2 = end.row2;
    registry_.set(entity, motion);
  }

  // Walks up from every entity; what was walked before need not be walked again.
  void check_cycles() {
    std::vector<uint32_t> walk_of(registry_.entity_count(), 0);
    uint32_t walk = 0;
    for (const PendingEntity& pending : pending_) {
      ++walk;
      Entity entity = pending.entity;
      while (!entity.is_null() && walk_of[entity.index] == 0) {
        walk_of[entity.index] = walk;
        entity = registry_.get<Parent>(entity).entity;
      }
      if (!entity.is_null() && walk_of[entity.index] == walk) report_cycle(entity);
    }
  }

  void report_cycle(Entity first) {
    constexpr int most_shown = 8;
    std::string chain = context_.scene.describe(first);
    Entity entity = first;
    for (int shown = 0; shown < most_shown; ++shown) {
      entity = registry_.get<Parent>(entity).entity;
      chain += " in " + context_.scene.describe(entity);
      if (entity == first) break;
    }
    reader_.diagnostics().error(context_.scene.location(first),
                                fmt::format("parents run in a circle: {}{}", chain, entity == first ? "" : " in ..."));
  }

  SceneContext& context_;
  const JsonReader& reader_;
  Registry& registry_;
  std::vector<PendingEntity> pending_;
};

}  // namespace

void read_materials(SceneContext& context, const Json::Value& materials) {
  if (!materials.isObject()) {
    context.reader.expected(materials, "materials", "an object of named materials");
    return;
  }
  // Names first, so that materials may be mixed of any others.
  const auto members = members_in_order(materials);
  std::vector<Entity> entities;
  for (const auto& [name, value] : members) {
    const Entity entity = context.scene.registry.create();
    entities.push_back(entity);
    context.scene.registry.set(entity, Source{context.file, context.reader.document().at_key(*value).line});
    name_entity(context, entity, name, *value, true);
  }
  for (size_t i = 0; i < members.size(); ++i) {
    const auto& [name, value] = members[i];
    context.reader.set_subject(fmt::format("material '{}'", printable_text(name)));
    if (const auto material = read_material(context, *value)) context.scene.registry.set(entities[i], *material);
    context.reader.set_subject({});
  }
}

void read_entities(SceneContext& context, const Json::Value& entities) { EntityReader(context).read(entities); }

}  // namespace metamer
