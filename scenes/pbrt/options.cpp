// Option "name" value.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenes/pbrt/directives.h"

namespace metamer::pbrt {
namespace {

enum class OptionType : uint8_t { boolean, integer, real, string };

// How an option that is not followed is remarked on: as one that only concerns how pbrt works, or as a difference.
struct KnownOption {
  std::string_view name;
  OptionType type;
  Strict strict;
  std::string_view instead;  // empty: supported
};
constexpr KnownOption known_options[] = {
    {"disablepixeljitter", OptionType::boolean, Strict::refuses, ""},
    {"disabletexturefiltering", OptionType::boolean, Strict::refuses, ""},
    {"disablewavelengthjitter", OptionType::boolean, Strict::refuses, "wavelengths are sampled"},
    {"displacementedgescale", OptionType::real, Strict::refuses, "displacement is not tessellated by it"},
    {"forcediffuse", OptionType::boolean, Strict::refuses, "materials stay what they are"},
    {"msereferenceimage", OptionType::string, Strict::allows, "errors are measured with 'metamer compare'"},
    {"msereferenceout", OptionType::string, Strict::allows, "errors are measured with 'metamer compare'"},
    {"pixelstats", OptionType::boolean, Strict::allows, "costs are measured with --stats"},
    {"rendercoordsys", OptionType::string, Strict::allows, "the coordinates of calculation are always the world's"},
    {"seed", OptionType::integer, Strict::refuses, ""},
    {"wavefront", OptionType::boolean, Strict::allows, "there is one renderer"},
};

// As pbrt: in any case, with or without - and _.
std::string normalized(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c != '-' && c != '_') text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

std::string_view value_mistake(OptionType type, const Token& value) {
  const auto number = value.kind == TokenKind::word ? parse_number(value.text) : std::nullopt;
  const bool is_boolean = value.kind == TokenKind::word && (value.text == "true" || value.text == "false");
  switch (type) {
    case OptionType::boolean: return is_boolean ? "" : "true or false";
    case OptionType::integer: {
      const bool fits = number && *number >= 0 && *number <= std::numeric_limits<int32_t>::max() &&
                        *number == static_cast<double>(static_cast<int32_t>(*number));
      return fits ? "" : "a non-negative integer";
    }
    case OptionType::real: return number ? "" : "a number";
    case OptionType::string: break;
  }
  return value.kind == TokenKind::string ? "" : "a quoted string";
}

void apply(Reader& reader, const KnownOption& option, const Token& value) {
  if (option.name == "seed") {
    reader.scene.settings.seed = static_cast<uint32_t>(*parse_number(value.text));
  } else if (option.name == "disabletexturefiltering") {
    reader.disables_texture_levels = value.text == "true";
  } else {
    reader.scene.settings.pixel_jitter = value.text == "false";
  }
}

}  // namespace

void read_option(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  if (tokens.peek().kind == TokenKind::end || looks_like_directive(tokens.peek())) {
    return reader.messages.error(source, fmt::format("Option \"{}\" has no value", *name));
  }
  const Token value = tokens.next();
  const std::string wanted = normalized(*name);
  const auto* option = std::find_if(std::begin(known_options), std::end(known_options),
                                    [&](const KnownOption& known) { return known.name == wanted; });
  if (option == std::end(known_options)) {
    std::vector<std::string_view> names;
    for (const KnownOption& known : known_options) names.push_back(known.name);
    return reader.messages.error(source,
                                 fmt::format("there is no Option \"{}\"{}", *name, did_you_mean(wanted, names)));
  }
  if (const std::string_view expected = value_mistake(option->type, value); !expected.empty()) {
    return reader.messages.error(source, fmt::format("Option \"{}\" expects {}, not {}", *name, expected, show(value)));
  }
  if (option->instead.empty()) return apply(reader, *option, value);
  if (option->type == OptionType::boolean && value.text == "false") return;  // as it is here
  reader.messages.note_once("option " + wanted, source,
                            fmt::format("Option \"{}\" is not supported; {}", *name, option->instead), option->strict);
}

}  // namespace metamer::pbrt
