// What may vary over a surface beside its colours: numbers that may be textures, bumps and masks.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// A number in the range, or {"texture": name} of a texture of numbers.
struct NumberOrTexture {
  float number = 0;
  TextureId texture = no_index;
};
NumberOrTexture read_number_or_texture(SceneContext& context, const Json::Value& value, std::string_view what,
                                       const Range& range);

// An image file, decoded once for each encoding and colour space (the file's own if none is given); nothing where it is
// wrong, which is reported.
std::optional<ImageId> read_shared_image(SceneContext& context, const Json::Value& file, std::string_view key,
                                         double gamma, std::optional<ColorSpace> space);

// The keys `displacement` and `normal_map` of a material.
void read_bump(SceneContext& context, const JsonObject& object, Material& material);

// The key `alpha` of a geometry: no_index where the shape is there for every ray.
TextureId read_alpha(SceneContext& context, const JsonObject& object);

}  // namespace metamer
