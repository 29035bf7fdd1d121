#include "scenes/native/varying.h"

#include "scenes/images/texture_memory.h"
#include "scenes/native/components.h"

namespace metamer {
namespace {

TextureId add_texture(SceneContext& context, const Texture& texture) {
  context.scene.textures.push_back(texture);
  return static_cast<TextureId>(context.scene.textures.size() - 1);
}

TextureId add_number(SceneContext& context, float value) {
  Texture constant;
  constant.is_number = 1;
  constant.value = value;
  return add_texture(context, constant);
}

TextureId in_metres(SceneContext& context, std::optional<TextureId> length) {
  if (!length || context.metres_per_unit == 1) return length.value_or(no_index);
  Texture product;
  product.kind = TextureKind::scale;
  product.is_number = 1;
  product.a = *length;
  product.b = add_number(context, context.metres(1));
  return add_texture(context, product);
}

}  // namespace

NumberOrTexture read_number_or_texture(SceneContext& context, const Json::Value& value, std::string_view what,
                                       const Range& range) {
  if (is_texture(value)) return {0, read_texture_reference(context, value, true).value_or(no_index)};
  return {static_cast<float>(context.reader.number(value, what, range, 0)), no_index};
}

std::optional<ImageId> read_shared_image(SceneContext& context, const Json::Value& file, std::string_view key,
                                         double gamma, std::optional<ColorSpace> space) {
  const std::string name = context.reader.text(file, key);
  if (name.empty()) return std::nullopt;
  const std::string path = resolve_path(name, context.reader.document().path());
  const auto [known, is_new] = context.images.try_emplace({path, gamma, space}, std::nullopt);
  if (!is_new) return known->second;
  Image image;
  ImageEncoding encoding = texture_encoding(path);
  encoding.gamma = gamma;
  if (!read_image(path, context.reader.document().at(file), image, context.reader.diagnostics(), encoding,
                  pixels_of_textures(context.scene)))
    return std::nullopt;
  image.color_space = space.value_or(image.color_space);
  context.scene.images.push_back(std::move(image));
  return known->second = static_cast<ImageId>(context.scene.images.size() - 1);
}

void read_bump(SceneContext& context, const JsonObject& object, Material& material) {
  if (!object.knows("displacement")) return;  // a mix is bumpy where its parts are
  const Json::Value* displacement = object.find("displacement");
  const Json::Value* map = object.find("normal_map");
  if (displacement != nullptr && map != nullptr)
    context.reader.error(*map, "'displacement' and 'normal_map' exclude each other");
  if (displacement != nullptr && !is_texture(*displacement))
    context.reader.expected(*displacement, "displacement", "a texture of numbers: {\"texture\": NAME}");
  else if (displacement != nullptr)
    material.displacement = in_metres(context, read_texture_reference(context, *displacement, true));
  if (map != nullptr)
    material.normal_map = read_shared_image(context, *map, "normal_map", 1, ColorSpace::srgb).value_or(no_index);
}

TextureId read_alpha(SceneContext& context, const JsonObject& object) {
  if (!object.has("alpha")) return no_index;
  const NumberOrTexture alpha = read_number_or_texture(context, *object.find("alpha"), "alpha", unit_interval);
  if (alpha.texture != no_index || alpha.number >= 1) return alpha.texture;
  return add_number(context, alpha.number);
}

}  // namespace metamer
