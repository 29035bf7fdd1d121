// Entities of the native format: their names, components and parents.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// "materials": an entity with a Material and a Name for each.
void read_materials(SceneContext& context, const Json::Value& materials);

// "entities", after the materials and the meshes: names first, so that parents and materials may be named in any order.
void read_entities(SceneContext& context, const Json::Value& entities);

}  // namespace metamer
