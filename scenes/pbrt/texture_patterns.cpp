// Where textures lie, and those that are computed rather than looked up.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/pbrt/texture_nodes.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view mapping_kinds[] = {"uv", "spherical", "cylindrical", "planar"};

void copy_to(const glm::dvec3& from, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

// The matrix of the moment takes texture space to the world.
void set_space(const Reader& reader, TextureMapping& mapping) {
  const glm::dmat4 to_texture = glm::inverse(reader.state.transform);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      mapping.to_texture[4 * row + column] = static_cast<float>(to_texture[column][row]);
}

Texture pattern(Reader& reader, Parameters& parameters, TextureKind kind) {
  Texture texture;
  texture.kind = kind;
  texture.is_number = kind != TextureKind::marble;
  texture.mapping.kind = TextureMapping::Kind::point;
  set_space(reader, texture.mapping);
  if (kind != TextureKind::windy) {
    const int octaves = parameters.integer("octaves", 8, 0);
    if (octaves > most_octaves)
      parameters.error("octaves", fmt::format("expected at most {} octaves, not {}", most_octaves, octaves));
    texture.octaves = static_cast<uint32_t>(std::min(octaves, most_octaves));
    texture.roughness = static_cast<float>(parameters.number("roughness", 0.5));
  }
  if (kind == TextureKind::marble) {
    texture.scale = static_cast<float>(parameters.number("scale", 1));
    texture.variation = static_cast<float>(parameters.number("variation", 0.2));
  }
  return texture;
}

TextureId add_mix(Reader& reader, TextureId a, TextureId b, TextureId amount, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::mix;
  texture.is_number = is_number;
  texture.a = a;
  texture.b = b;
  texture.amount = amount;
  return add_texture(reader, texture);
}

// Between four corners: rows mixed along t, then along s.
TextureId bilerp(Reader& reader, Parameters& parameters, bool is_number) {
  Texture coordinate;
  coordinate.kind = TextureKind::coordinate;
  coordinate.is_number = 1;
  coordinate.mapping = read_mapping(reader, parameters);
  const TextureId s = add_texture(reader, coordinate);
  coordinate.axis = 1;
  const TextureId t = add_texture(reader, coordinate);
  const auto corner = [&](std::string_view name, double fallback) {
    return texture_operand(reader, parameters, name, is_number, fallback);
  };
  const TextureId v00 = corner("v00", 0), v01 = corner("v01", 1), v10 = corner("v10", 0), v11 = corner("v11", 1);
  return add_mix(reader, add_mix(reader, v00, v01, t, is_number), add_mix(reader, v10, v11, t, is_number), s,
                 is_number);
}

TextureId dots(Reader& reader, Parameters& parameters, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::dots;
  texture.is_number = 1;
  texture.mapping = read_mapping(reader, parameters);
  const TextureId where = add_texture(reader, texture);
  const TextureId inside = texture_operand(reader, parameters, "inside", is_number, 1);
  const TextureId outside = texture_operand(reader, parameters, "outside", is_number, 0);
  return add_mix(reader, outside, inside, where, is_number);
}

// The first texture where the surface faces `dir`, the second where it stands along it.
TextureId direction_mix(Reader& reader, Parameters& parameters, bool is_number) {
  Texture facing;
  facing.kind = TextureKind::facing;
  facing.is_number = 1;
  const glm::dvec3 direction = glm::dmat3(reader.state.transform) * parameters.vector3("dir", {0, 1, 0});
  if (glm::length(direction) > 0)
    copy_to(glm::normalize(direction), facing.axis_direction);
  else
    parameters.error("dir", "a direction of length 0");
  const TextureId amount = add_texture(reader, facing);
  const TextureId a = texture_operand(reader, parameters, "tex1", is_number, 0);
  const TextureId b = texture_operand(reader, parameters, "tex2", is_number, 1);
  return add_mix(reader, b, a, amount, is_number);
}

}  // namespace

TextureMapping read_mapping(Reader& reader, Parameters& parameters) {
  using Kind = TextureMapping::Kind;
  const std::string word = texture_choice(parameters, "mapping", "uv", mapping_kinds);
  TextureMapping mapping;
  mapping.kind = word == "spherical"     ? Kind::spherical
                 : word == "cylindrical" ? Kind::cylindrical
                 : word == "planar"      ? Kind::planar
                                         : Kind::uv;
  if (mapping.kind != Kind::uv) set_space(reader, mapping);
  if (mapping.kind == Kind::uv) {
    mapping.u_scale = static_cast<float>(parameters.number("uscale", 1));
    mapping.v_scale = static_cast<float>(parameters.number("vscale", 1));
  }
  if (mapping.kind == Kind::uv || mapping.kind == Kind::planar) {
    mapping.u_offset = static_cast<float>(parameters.number("udelta", 0));
    mapping.v_offset = static_cast<float>(parameters.number("vdelta", 0));
  }
  if (mapping.kind == Kind::planar) {
    copy_to(parameters.vector3("v1", {1, 0, 0}), mapping.u_axis);
    copy_to(parameters.vector3("v2", {0, 1, 0}), mapping.v_axis);
  }
  return mapping;
}

TextureMapping point_mapping(const Reader& reader) {
  TextureMapping mapping;
  mapping.kind = TextureMapping::Kind::point;
  set_space(reader, mapping);
  return mapping;
}

std::optional<TextureId> read_pattern(Reader& reader, std::string_view kind, Parameters& parameters, bool is_number) {
  if (kind == "bilerp") return bilerp(reader, parameters, is_number);
  if (kind == "dots") return dots(reader, parameters, is_number);
  if (kind == "directionmix") return direction_mix(reader, parameters, is_number);
  struct Noise {
    std::string_view name;
    TextureKind kind;
    bool is_number;
  };
  constexpr Noise noises[] = {{"fbm", TextureKind::fbm, true},
                              {"wrinkled", TextureKind::wrinkled, true},
                              {"windy", TextureKind::windy, true},
                              {"marble", TextureKind::marble, false}};
  for (const Noise& noise : noises) {
    if (kind != noise.name) continue;
    const Texture texture = pattern(reader, parameters, noise.kind);
    if (is_number == noise.is_number) return add_texture(reader, texture);
    reader.messages.error(parameters.source(), fmt::format("texture \"{}\" makes values of type \"{}\"", kind,
                                                           noise.is_number ? "float" : "spectrum"));
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace metamer::pbrt
