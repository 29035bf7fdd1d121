// What the two files about textures share.
#pragma once
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

inline constexpr int most_octaves = 64;  // at 1.99^64 a cell is smaller than a float can tell

TextureId add_texture(Reader& reader, const Texture& texture);
// A parameter of a texture, itself a texture or a value.
TextureId texture_operand(Reader& reader, Parameters& parameters, std::string_view name, bool is_number,
                          double fallback);
// One of the words; an error and the first of them if it is another.
std::string texture_choice(Parameters& parameters, std::string_view name, std::string_view fallback,
                           std::span<const std::string_view> words);

// texture_patterns.cpp. `mapping` and its parameters; and the space of the moment with all three coordinates.
TextureMapping read_mapping(Reader& reader, Parameters& parameters);
TextureMapping point_mapping(const Reader& reader);
// bilerp, dots, directionmix, fbm, wrinkled, windy and marble; nothing where it is none of them, or wrong.
std::optional<TextureId> read_pattern(Reader& reader, std::string_view kind, Parameters& parameters, bool is_number);

}  // namespace metamer::pbrt
