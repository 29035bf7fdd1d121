// Transforms of the native format.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// Local to parent: one operation or a list of them, the first applied to the object first. The identity where it is
// wrong, which is reported with the line of the operation: singular ones, axes without a direction, numbers beyond
// single precision.
Transform read_transform(const SceneContext& context, const Json::Value* value);

// [first, second] in seconds, the second after the first; [0, 1] after reporting what is wrong.
glm::dvec2 read_times(const JsonReader& reader, const Json::Value& value, std::string_view what);

// A "motion" object: where the entity is at the end of it, and when.
Motion read_motion(const SceneContext& context, const Json::Value& value);

// z negated, after which `then` is applied.
Transform mirrored_z(const Transform& then);
// `first`, after which z is negated.
Transform then_mirrored_z(const Transform& first);

}  // namespace metamer
