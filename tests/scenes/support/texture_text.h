// A texture as text that a test can compare.
#pragma once
#include <string>

#include "engine/ecs/scene.h"

namespace metamer {

// Operands in brackets; what is as usual is left out.
std::string texture_text(const Scene& scene, TextureId id);

}  // namespace metamer
