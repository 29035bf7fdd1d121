// The directives and the graphics state they change.
#include "scenes/pbrt/directives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace metamer::pbrt {
namespace {

constexpr size_t most_mistakes = 1000;  // reading stops here: the file is probably not a pbrt file

constexpr size_t most_attributes = 256;  // blocks copy them

// Where a directive may stand.
enum class Where : uint8_t { anywhere, before_world, in_world };

struct Directive {
  std::string_view name;
  Where where;
  void (*read)(Reader&, Tokenizer&, std::string_view, Source);
};

// A directive of the form: Name "kind" parameters. Calls read(kind, parameters).
template <class F>
void read_with_parameters(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source,
                          const ParameterPointers& defaults, F&& read) {
  const auto kind = read_string(reader, tokens, directive, source);
  if (!kind) return;
  const ParameterList list = parse_parameters(tokens, source.file, reader.state.color_space);
  Parameters parameters(fmt::format("{} \"{}\"", directive, *kind), source, list, defaults, reader.messages);
  read(*kind, parameters);
  parameters.report_unused();
}

template <void (*read)(Reader&, std::string_view, Parameters&)>
void plain(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  read_with_parameters(reader, tokens, directive, source, {},
                       [&](const std::string& kind, Parameters& parameters) { read(reader, kind, parameters); });
}

template <void (*read)(Reader&, std::string_view, Parameters&), AttributeTarget target>
void with_attributes(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  read_with_parameters(reader, tokens, directive, source, reader.attributes(target),
                       [&](const std::string& kind, Parameters& parameters) { read(reader, kind, parameters); });
}

void area_light_source(Reader& reader, std::string_view kind, Parameters& parameters) {
  reader.state.area_light = read_area_light(reader, kind, parameters);
}

void material(Reader& reader, std::string_view kind, Parameters& parameters) {
  reader.state.material = read_material(reader, kind, parameters, reader.scene.registry.create());
}

void make_named_material(Reader& reader, std::string_view name, Parameters& parameters) {
  NamedMaterial& entry = named_material(reader, std::string(name), parameters.source());
  if (entry.defined) reader.messages.error(parameters.source(), fmt::format("material '{}' is made twice", name));
  entry.defined = true;
  if (!parameters.has("type")) parameters.error("type", "'string type' is missing");
  const std::string kind = parameters.string("type", "diffuse");
  read_material(reader, kind, parameters, entry.entity);
}

void use_named_material(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (name) reader.state.material = named_material(reader, *name, source).entity;
}

void medium_interface(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto inside = read_string(reader, tokens, directive, source);
  if (!inside) return;
  const bool has_outside = tokens.peek().kind == TokenKind::string;
  const auto outside = has_outside ? read_string(reader, tokens, directive, source) : inside;
  if (outside) use_media(reader, *inside, *outside, source);
}

// Texture "name" "spectrum" "kind" parameters.
void texture(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  const auto type = read_string(reader, tokens, directive, source);
  if (!type) return;
  if (*type != "spectrum" && *type != "float") {
    reader.messages.error(source, fmt::format("a texture is \"spectrum\" or \"float\", not \"{}\"", *type));
    return tokens.skip_to_directive();
  }
  const bool is_number = *type == "float";
  auto& textures = is_number ? reader.float_textures : reader.spectrum_textures;
  std::optional<TextureId> made;
  read_with_parameters(reader, tokens, directive, source, reader.attributes(AttributeTarget::texture),
                       [&](const std::string& kind, Parameters& parameters) {
                         made = read_texture(reader, kind, parameters, is_number);
                       });
  if (!textures.try_emplace(*name, made).second)
    reader.messages.error(source, fmt::format("texture '{}' is defined twice", *name));
}

void attribute(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  ParameterList list = parse_parameters(tokens, source.file, reader.state.color_space);
  const auto found = std::find(std::begin(attribute_targets), std::end(attribute_targets), *name);
  if (found == std::end(attribute_targets)) {
    return reader.messages.error(
        source, fmt::format("Attribute expects shape, light, material, medium or texture, not \"{}\"{}", *name,
                            did_you_mean(*name, attribute_targets)));
  }
  ParameterPointers& all = reader.state.attributes[found - std::begin(attribute_targets)];
  for (Parameter& parameter : list) {
    // The latest word on a parameter counts.
    std::erase_if(all, [&](const Parameter* old) { return old->name == parameter.name; });
    all.push_back(&reader.attribute_values.emplace_back(std::move(parameter)));
  }
  if (all.size() <= most_attributes) return;
  reader.messages.error(source, fmt::format("more than {} attributes are set", most_attributes));
  all.resize(most_attributes);
}

void color_space(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  if (const auto space = find_color_space(*name)) {
    reader.state.color_space = *space;
  } else {
    reader.messages.error(
        source, fmt::format("there is no colour space '{}'{}", *name, did_you_mean(*name, color_space_names())));
  }
}

void accelerator(Reader& reader, std::string_view, Parameters& parameters) {
  parameters.ignore_the_rest();
  reader.messages.note_once("accelerator", parameters.source(), parameters.what() + ": Embree's is always used",
                            Strict::allows);
}

constexpr auto directives = std::to_array<Directive>({
    {"Accelerator", Where::before_world, plain<accelerator>},
    {"AreaLightSource", Where::in_world, with_attributes<area_light_source, AttributeTarget::light>},
    {"Attribute", Where::anywhere, attribute},
    {"AttributeBegin", Where::in_world, attribute_begin},
    {"AttributeEnd", Where::in_world, attribute_end},
    {"Camera", Where::before_world, plain<read_camera>},
    {"ColorSpace", Where::anywhere, color_space},
    {"Film", Where::before_world, plain<read_film>},
    {"Import", Where::in_world, import},
    {"Include", Where::anywhere, include},
    {"Integrator", Where::before_world, plain<read_integrator>},
    {"LightSource", Where::in_world, with_attributes<read_light, AttributeTarget::light>},
    {"MakeNamedMaterial", Where::in_world, with_attributes<make_named_material, AttributeTarget::material>},
    {"MakeNamedMedium", Where::anywhere, with_attributes<make_named_medium, AttributeTarget::medium>},
    {"Material", Where::in_world, with_attributes<material, AttributeTarget::material>},
    {"MediumInterface", Where::anywhere, medium_interface},
    {"NamedMaterial", Where::in_world, use_named_material},
    {"ObjectBegin", Where::in_world, object_begin},
    {"ObjectEnd", Where::in_world, object_end},
    {"ObjectInstance", Where::in_world, object_instance},
    {"Option", Where::before_world, read_option},
    {"PixelFilter", Where::before_world, plain<read_filter>},
    {"ReverseOrientation", Where::in_world, reverse_orientation},
    {"Sampler", Where::before_world, plain<read_sampler>},
    {"Shape", Where::in_world, with_attributes<read_shape, AttributeTarget::shape>},
    {"Texture", Where::in_world, texture},
    {"TransformBegin", Where::in_world, transform_begin},
    {"TransformEnd", Where::in_world, transform_end},
    {"WorldBegin", Where::before_world, world_begin},
    {"WorldEnd", Where::in_world, world_end},
});
constexpr std::string_view transform_directives[] = {
    "ActiveTransform", "ConcatTransform", "CoordSysTransform", "CoordinateSystem", "Identity", "LookAt",
    "Rotate",          "Scale",           "Transform",         "TransformTimes",   "Translate"};

void unknown_directive(Reader& reader, Tokenizer& tokens, const Token& token, Source source) {
  std::vector<std::string_view> known(std::begin(transform_directives), std::end(transform_directives));
  for (const Directive& directive : directives) known.push_back(directive.name);
  reader.messages.error(source,
                        fmt::format("expected a directive, not {}{}", show(token), did_you_mean(token.text, known)));
  tokens.skip_to_directive();
}

void read_directive(Reader& reader, Tokenizer& tokens) {
  const Token token = tokens.next();
  const Source source{reader.file, token.line};
  const bool is_word = token.kind == TokenKind::word;
  if (is_word && read_transform_directive(reader, tokens, token.text, source)) return;
  const auto found =
      std::find_if(directives.begin(), directives.end(), [&](const Directive& d) { return d.name == token.text; });
  if (!is_word || found == directives.end()) return unknown_directive(reader, tokens, token, source);
  if (found->where != Where::anywhere && (found->where == Where::in_world) != reader.in_world) {
    reader.messages.error(source,
                          fmt::format("{} must stand {} WorldBegin", token.text, reader.in_world ? "before" : "after"));
  }
  found->read(reader, tokens, token.text, source);
}

}  // namespace

void read_directives(Reader& reader, Tokenizer& tokens) {
  while (tokens.peek().kind != TokenKind::end) {
    if (reader.gave_up) return;
    read_directive(reader, tokens);
    if (reader.messages.diagnostics.error_count() < most_mistakes || reader.gave_up) continue;
    reader.gave_up = true;
    reader.messages.error({reader.file, tokens.peek().line}, "too many mistakes; the rest is not read");
  }
}

}  // namespace metamer::pbrt
