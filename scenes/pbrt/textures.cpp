// Textures, and the parameters that may be one.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/images/read_image.h"
#include "scenes/pbrt/texture_nodes.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view texture_kinds[] = {"bilerp", "checkerboard", "constant", "directionmix", "dots",
                                              "fbm",    "imagemap",     "marble",   "mix",          "ptex",
                                              "scale",  "windy",        "wrinkled"};
constexpr std::string_view pattern_kinds[] = {"bilerp", "dots", "directionmix", "fbm", "wrinkled", "windy", "marble"};
constexpr std::string_view wrap_kinds[] = {"repeat", "black", "clamp", "octahedralsphere"};
constexpr std::string_view filter_kinds[] = {"point", "bilinear", "trilinear", "EWA", "ewa"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

TextureId add_number(Reader& reader, double value) {
  Texture texture;
  texture.is_number = 1;
  texture.value = static_cast<float>(value);
  return add_texture(reader, texture);
}

TextureId add_spectrum(Reader& reader, SpectrumId spectrum) {
  Texture texture;
  texture.spectrum = spectrum;
  return add_texture(reader, texture);
}

ImageEncoding read_encoding(Parameters& parameters) {
  const std::string word = parameters.string("encoding", "sRGB");
  ImageEncoding encoding;
  if (word == "linear") encoding.gamma = 1;
  if (word.starts_with("gamma ")) {
    const auto number = parse_number(std::string_view(word).substr(6));
    if (number && *number > 0) {
      encoding.gamma = *number;
      return encoding;
    }
  }
  if (word != "sRGB" && word != "linear")
    parameters.error("encoding",
                     fmt::format("expected \"sRGB\", \"linear\" or \"gamma\" and a number, not \"{}\"", word));
  return encoding;
}

bool has_extension(const std::string& name, std::string_view extension) {
  return name.size() > extension.size() &&
         std::equal(extension.rbegin(), extension.rend(), name.rbegin(),
                    [](char wanted, char c) { return wanted == (c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c); });
}
// pbrt takes the alpha of these files only, and decodes that of PNG like their colours.
bool is_png(const std::string& name) { return has_extension(name, ".png"); }
bool may_have_alpha(const std::string& name) { return is_png(name) || has_extension(name, ".exr"); }

// Images are shared by name and encoding. The new one is empty until read_pending.
std::optional<ImageId> read_shared_image(Reader& reader, Parameters& parameters, std::string_view parameter,
                                         ImageEncoding encoding) {
  const std::string name = parameters.string(parameter, "");
  if (name.empty()) {
    parameters.error(parameter, fmt::format("'string {}' is missing", parameter));
    return std::nullopt;
  }
  encoding.decodes_alpha = is_png(name);
  encoding.allows_negative = true;
  const std::string path = reader.resolve(name);
  const auto [known, fresh] = reader.images.try_emplace({path, encoding.gamma}, std::nullopt);
  if (!fresh) return known->second;
  known->second = static_cast<ImageId>(reader.scene.images.size());
  reader.scene.images.emplace_back();
  reader.pending_files.push_back({.path = path,
                                  .named_at = reader.messages.at(parameters.source()),
                                  .image = *known->second,
                                  .encoding = encoding});
  return known->second;
}

void read_filter(const Reader& reader, Parameters& parameters, Texture& texture) {
  const std::string filter = texture_choice(parameters, "filter", "bilinear", filter_kinds);
  texture.filter = filter == "point"       ? TextureFilter::nearest
                   : filter == "bilinear"  ? TextureFilter::linear
                   : filter == "trilinear" ? TextureFilter::trilinear
                                           : TextureFilter::anisotropic;
  if (reader.disables_texture_levels && uses_levels(texture.filter)) texture.filter = TextureFilter::linear;
  const double most = parameters.number("maxanisotropy", 8);
  if (most < 1) parameters.error("maxanisotropy", "'maxanisotropy' must be at least 1");
  texture.most_anisotropy = static_cast<float>(std::max(most, 1.0));
}

std::optional<TextureId> imagemap(Reader& reader, Parameters& parameters, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::image;
  texture.is_number = is_number;
  texture.mapping = read_mapping(reader, parameters);
  texture.scale = static_cast<float>(parameters.number("scale", 1));
  texture.invert = parameters.boolean("invert", false);
  read_filter(reader, parameters, texture);
  const std::string wrap = texture_choice(parameters, "wrap", "repeat", wrap_kinds);
  texture.wrap = wrap == "clamp"              ? TextureWrap::clamp
                 : wrap == "black"            ? TextureWrap::black
                 : wrap == "octahedralsphere" ? TextureWrap::octahedral
                                              : TextureWrap::repeat;
  const auto image = read_shared_image(reader, parameters, "filename", read_encoding(parameters));
  if (!image) return std::nullopt;
  texture.image = *image;
  const TextureId id = add_texture(reader, texture);
  if (is_number && may_have_alpha(parameters.string("filename", ""))) reader.may_take_alpha.push_back(id);
  return id;
}

TextureId checkerboard(Reader& reader, Parameters& parameters, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::checkerboard;
  texture.is_number = is_number;
  const auto dimension = parameters.integer("dimension", 2, 2);
  if (dimension > 3) parameters.error("dimension", fmt::format("expected 2 or 3, not {}", dimension));
  texture.mapping = dimension == 2 ? read_mapping(reader, parameters) : point_mapping(reader);
  texture.a = texture_operand(reader, parameters, "tex1", is_number, 1);
  texture.b = texture_operand(reader, parameters, "tex2", is_number, 0);
  return add_texture(reader, texture);
}

TextureId scale(Reader& reader, Parameters& parameters, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::scale;
  texture.is_number = is_number;
  texture.a = texture_operand(reader, parameters, "tex", is_number, 1);
  texture.b = texture_operand(reader, parameters, "scale", true, 1);
  return add_texture(reader, texture);
}

TextureId mix(Reader& reader, Parameters& parameters, bool is_number) {
  Texture texture;
  texture.kind = TextureKind::mix;
  texture.is_number = is_number;
  texture.a = texture_operand(reader, parameters, "tex1", is_number, 0);
  texture.b = texture_operand(reader, parameters, "tex2", is_number, 1);
  texture.amount = texture_operand(reader, parameters, "amount", true, 0.5);
  return add_texture(reader, texture);
}

std::optional<TextureId> unsupported(Reader& reader, std::string_view kind, Parameters& parameters) {
  parameters.ignore_the_rest();
  if (kind != "ptex") {
    reader.messages.error(parameters.source(),
                          fmt::format("there is no texture \"{}\"{}", kind, did_you_mean(kind, texture_kinds)));
    return std::nullopt;
  }
  reader.messages.warning_once(
      fmt::format("texture {}", kind), parameters.source(),
      fmt::format("texture \"{}\" is not supported; what it would colour gets its default value", kind));
  return std::nullopt;
}

}  // namespace

TextureId add_texture(Reader& reader, const Texture& texture) {
  reader.scene.textures.push_back(texture);
  return static_cast<TextureId>(reader.scene.textures.size() - 1);
}

TextureId texture_operand(Reader& reader, Parameters& parameters, std::string_view name, bool is_number,
                          double fallback) {
  if (parameters.is_texture(name)) {
    if (const auto id = read_texture_parameter(reader, parameters, name, is_number)) return *id;
    return add_number(reader, fallback);  // reported
  }
  if (is_number) return add_number(reader, parameters.number(name, fallback));
  const auto value = read_spectrum(reader, parameters, name, RgbKind::albedo, SpectrumAlso::nothing);
  return add_spectrum(reader, value ? value->id : reader.scene.spectra.add_constant(fallback).id);
}

std::string texture_choice(Parameters& parameters, std::string_view name, std::string_view fallback,
                           std::span<const std::string_view> words) {
  const std::string word = parameters.string(name, fallback);
  if (is_one_of(word, words)) return word;
  parameters.error(name, fmt::format("there is no {} \"{}\"{}", name, word, did_you_mean(word, words)));
  return std::string(words.front());
}

std::optional<TextureId> read_texture(Reader& reader, std::string_view kind, Parameters& parameters, bool is_number) {
  if (kind == "constant") return texture_operand(reader, parameters, "value", is_number, 1);
  if (kind == "imagemap") return imagemap(reader, parameters, is_number);
  if (kind == "checkerboard") return checkerboard(reader, parameters, is_number);
  if (kind == "scale") return scale(reader, parameters, is_number);
  if (kind == "mix") return mix(reader, parameters, is_number);
  if (is_one_of(kind, pattern_kinds)) return read_pattern(reader, kind, parameters, is_number);
  return unsupported(reader, kind, parameters);
}

std::optional<TextureId> read_texture_parameter(Reader& reader, Parameters& parameters, std::string_view name,
                                                bool is_number) {
  if (!parameters.is_texture(name)) return std::nullopt;
  const Parameter* parameter = parameters.find(name, ParameterType::texture);
  const auto& textures = is_number ? reader.float_textures : reader.spectrum_textures;
  if (parameter == nullptr) return std::nullopt;
  const std::string wanted = parameter->strings.size() == 1 ? parameter->strings[0] : "";
  const auto found = textures.find(wanted);
  if (found != textures.end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [texture, id] : textures) known.push_back(texture);
  reader.messages.error(parameter->source, fmt::format("{}: there is no texture '{}'{}", parameters.what(), wanted,
                                                       did_you_mean(wanted, known)));
  return std::nullopt;
}

NumberOrTexture read_number_or_texture(Reader& reader, Parameters& parameters, std::string_view name, double fallback) {
  if (!parameters.is_texture(name)) return {parameters.number(name, fallback), no_index};
  return {fallback, read_texture_parameter(reader, parameters, name, true).value_or(no_index)};
}

TextureId read_alpha(Reader& reader, Parameters& parameters) {
  const NumberOrTexture alpha = read_number_or_texture(reader, parameters, "alpha", 1);
  return alpha.texture == no_index && alpha.number < 1 ? add_number(reader, alpha.number) : alpha.texture;
}

TextureId square_root_of(Reader& reader, TextureId texture) {
  Texture root;
  root.kind = TextureKind::square_root;
  root.is_number = 1;
  root.a = texture;
  return add_texture(reader, root);
}

void read_bump(Reader& reader, Parameters& parameters, Material& material) {
  if (parameters.has("displacement")) {
    parameters.find("displacement", ParameterType::texture);
    material.displacement = read_texture_parameter(reader, parameters, "displacement", true).value_or(no_index);
  }
  if (!parameters.has("normalmap")) return;
  ImageEncoding linear;
  linear.gamma = 1;
  material.normal_map = read_shared_image(reader, parameters, "normalmap", linear).value_or(no_index);
}

}  // namespace metamer::pbrt
