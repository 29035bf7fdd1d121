#include "systems/freeze.h"

namespace metamer {

void build_mask(TextureId texture, World& world) {
  if (texture == no_index) return;
  const TextureProgram program = world.textures.programs[texture];
  const TextureOp& first = world.textures.ops[program.begin];
  if (program.end - program.begin == 1 && first.kind == TextureKind::constant) {
    if (first.value <= 0) world.objects.visibility.back() = 0;
    if (first.value <= 0 || first.value >= 1) return;
  }
  world.objects.alpha.back() = texture;
  world.has_masks = true;
}

void build_light_finding(World& world) {
  ObjectColumns& objects = world.objects;
  const bool is_seen = (objects.visibility.back() & visible_to_bounces) != 0;
  const LightFinding finding = objects.alpha.back() != no_index ? LightFinding::rays
                               : is_seen                        ? LightFinding::both
                                                                : LightFinding::samples;
  while (world.light_finding.size() < world.lights.size())
    world.light_finding.push_back(static_cast<uint32_t>(finding));
}

}  // namespace metamer
