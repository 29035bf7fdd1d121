// "settings" of the native format.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

RenderSettings read_settings(const SceneContext& context, const Json::Value& value);

}  // namespace metamer
