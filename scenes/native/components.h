// The components of an entity, one reader each. All report what is wrong and set what is right.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// The file's "meshes". Every one is read and checked, used or not.
void read_meshes(SceneContext& context, const Json::Value& meshes);

// The same of "curves".
void read_curves(SceneContext& context, const Json::Value& curves);
// The file's "textures", in the order of the text: they may refer to earlier ones.
void read_textures(SceneContext& context, const Json::Value& textures);
// Whether the value is {"texture": name}, which stands for a spectrum or a number.
bool is_texture(const Json::Value& value);
std::optional<TextureId> read_texture_reference(SceneContext& context, const Json::Value& value, bool is_number);

std::optional<Geometry> read_geometry(SceneContext& context, const Json::Value& value);
// The keys of a geometry of type "curves"; false if there are none.
bool read_curves_geometry(SceneContext& context, const JsonObject& object, Geometry& geometry);
std::optional<Material> read_material(SceneContext& context, const Json::Value& value);
// Sets the light of the entity; a sky becomes two children of it.
void read_light(SceneContext& context, Entity entity, const Json::Value& value);
void read_sky(SceneContext& context, Entity entity, const JsonObject& object);
std::optional<Camera> read_camera(const SceneContext& context, const Json::Value& value);
// The file's "media", each an entity; and by their names those on both sides of a surface.
void read_media(SceneContext& context, const Json::Value& media);
MediumSlot read_medium_slot(const SceneContext& context, const Json::Value& value);
Visibility read_visibility(const SceneContext& context, const Json::Value& value);

}  // namespace metamer
