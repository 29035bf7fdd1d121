// Transforms of the native format.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// Local to parent: one operation or a list of them, the first applied to the object first. The identity where it is
// wrong, which is reported with the line of the operation: singular ones, axes without a direction, numbers beyond
// single precision.
Transform read_transform(const SceneContext& context, const Json::Value* value);

// z negated, after which `then` is applied.
Transform mirrored_z(const Transform& then);
// `first`, after which z is negated.
Transform then_mirrored_z(const Transform& first);

}  // namespace metamer
