// Spectrum parameters: rgb, blackbody, tables, names and .spd files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/spectrum/named_spectra.h"
#include "scenes/file_bytes.h"
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view name_prefixes[] = {"metal-", "glass-", "stdillum-", "illum-"};

bool has_spectrum_prefix(std::string_view name) {
  return std::any_of(std::begin(name_prefixes), std::end(name_prefixes),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

// pbrt calls SF5, SF10 and SF11 glass-F5, -F10 and -F11.
std::string_view canonical_name(std::string_view name) {
  if (name == "glass-F5") return "glass-SF5";
  if (name == "glass-F10") return "glass-SF10";
  if (name == "glass-F11") return "glass-SF11";
  return name;
}

struct SpectrumReader {
  Reader& reader;
  Parameters& parameters;
  const Parameter& parameter;
  RgbKind kind;

  std::optional<SpectrumValue> fail(std::string message) {
    reader.messages.error(parameter.source, fmt::format("{}: '{}': {}", parameters.what(), parameter.name, message));
    return std::nullopt;
  }

  std::optional<SpectrumValue> result(const SpectrumResult& made, std::optional<ColorSpace> rgb = std::nullopt) {
    if (!made.ok()) return fail(made.error);
    return SpectrumValue{made.id, rgb};
  }

  void warn_above_one() {
    reader.messages.warning(parameter.source,
                            fmt::format("{}: '{}' exceeds 1, which no passive surface does; it is clamped to 1",
                                        parameters.what(), parameter.name));
  }

  // What a physical quantity of this kind may be.
  std::optional<SpectrumValue> checked(const std::optional<SpectrumValue>& value) {
    if (!value) return value;
    SpectrumSet& set = reader.scene.spectra;
    if (set.has_negative(value->id)) return fail("negative values are not possible");
    if (kind != RgbKind::albedo || set.max_value(value->id) <= 1) return value;
    warn_above_one();
    Samples samples = set.samples(value->id);
    for (double& sample : samples) sample = std::min(sample, 1.0);
    return result(set.add_samples(samples));
  }

  std::optional<SpectrumValue> rgb() {
    if (parameter.numbers.size() != 3)
      return fail(fmt::format("an rgb value has three numbers, not {}", parameter.numbers.size()));
    Color3 color{parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]};
    if (*std::min_element(color.begin(), color.end()) < 0) return fail("negative values are not possible");
    if (kind == RgbKind::albedo && *std::max_element(color.begin(), color.end()) > 1) {
      warn_above_one();
      for (double& channel : color) channel = std::min(channel, 1.0);
    }
    return result(reader.scene.spectra.add_rgb(color, kind, parameter.color_space), parameter.color_space);
  }

  std::optional<SpectrumValue> blackbody() {
    if (parameter.numbers.size() != 1 || !(parameter.numbers[0] > 0))
      return fail("a blackbody has one temperature in kelvin above 0");
    return result(reader.scene.spectra.add_blackbody_normalized(parameter.numbers[0]));
  }

  // Pairs of wavelength and value. Outside of a table a reflectance or a lamp is zero, as in pbrt; an index keeps its
  // last value there (pbrt's zero would be no index at all).
  std::optional<SpectrumValue> table(std::span<const double> numbers) {
    if (numbers.size() % 2 != 0)
      return fail(fmt::format("{} numbers are not pairs of wavelength and value", numbers.size()));
    std::vector<double> lambda_nm, values;
    for (size_t i = 0; i < numbers.size(); i += 2) {
      lambda_nm.push_back(numbers[i]);
      values.push_back(numbers[i + 1]);
    }
    const Extend extend = kind == RgbKind::unbounded ? Extend::constant : Extend::zero;
    return checked(result(reader.scene.spectra.add_table(lambda_nm, values, extend)));
  }

  std::optional<SpectrumValue> file(const std::string& name) {
    const std::string path = reader.resolve(name);
    FileBytes bytes;
    if (!read_file(path, reader.messages.at(parameter.source), bytes, reader.messages.diagnostics)) return std::nullopt;
    std::vector<double> numbers;
    Diagnostics mistakes;  // a file of numbers has no strings that could be wrong
    Tokenizer tokens(bytes.text(), path, mistakes);
    for (Token token = tokens.next(); token.kind != TokenKind::end; token = tokens.next()) {
      const auto number = token.kind == TokenKind::word ? parse_number(token.text) : std::nullopt;
      if (!number) {
        reader.messages.diagnostics.error({path, token.line},
                                          fmt::format("expected wavelength and value, not {}", show(token)));
        return std::nullopt;
      }
      numbers.push_back(*number);
    }
    return table(numbers);
  }

  std::optional<SpectrumValue> named() {
    if (parameter.strings.size() != 1) return fail(fmt::format("expects one name, not {}", parameter.strings.size()));
    const std::string& name = parameter.strings[0];
    if (!has_spectrum_prefix(name)) return file(name);
    if (const auto id = reader.scene.spectra.add_named(canonical_name(name))) return checked(SpectrumValue{*id, {}});
    std::vector<std::string_view> known;
    for (const std::string_view candidate : spectrum_names()) {
      if (has_spectrum_prefix(candidate)) known.push_back(candidate);
    }
    return fail(fmt::format("the spectrum '{}' is unknown or not supported yet{}", name, did_you_mean(name, known)));
  }

  std::optional<SpectrumValue> read() {
    switch (parameter.type) {
      case ParameterType::rgb: return rgb();
      case ParameterType::blackbody: return checked(blackbody());
      case ParameterType::real: {
        if (parameter.numbers.size() != 1) return fail("expects one number");
        return checked(result(reader.scene.spectra.add_constant(parameter.numbers[0])));
      }
      default: return parameter.strings.empty() ? table(parameter.numbers) : named();
    }
  }
};

// The texture that is named, if it is the same everywhere: then its value does.
const Texture* constant_texture(const Reader& reader, const Parameter& parameter,
                                const std::map<std::string, std::optional<TextureId>>& textures) {
  const auto known = parameter.strings.size() == 1 ? textures.find(parameter.strings[0]) : textures.end();
  if (known == textures.end() || !known->second) return nullptr;
  const Texture& texture = reader.scene.textures[*known->second];
  return texture.kind == TextureKind::constant ? &texture : nullptr;
}

void report_texture(Reader& reader, Parameters& parameters, const Parameter& parameter,
                    const std::map<std::string, std::optional<TextureId>>& textures) {
  const std::string name = parameter.strings.size() == 1 ? parameter.strings[0] : "";
  if (!textures.contains(name)) {
    std::vector<std::string_view> known;
    for (const auto& [texture, id] : textures) known.push_back(texture);
    reader.messages.error(parameter.source, fmt::format("{}: there is no texture '{}'{}", parameters.what(), name,
                                                        did_you_mean(name, known)));
    return;
  }
  reader.messages.warning_once(
      "texture for " + parameter.name, parameter.source,
      fmt::format("textures for '{}' are not supported yet; it gets its default value", parameter.name));
}

}  // namespace

std::optional<SpectrumValue> read_spectrum(Reader& reader, Parameters& parameters, std::string_view name, RgbKind kind,
                                           SpectrumAlso also) {
  constexpr ParameterType types[] = {ParameterType::rgb, ParameterType::spectrum, ParameterType::blackbody,
                                     ParameterType::texture, ParameterType::real};
  const size_t count = also == SpectrumAlso::nothing ? 3 : also == SpectrumAlso::texture ? 4 : 5;
  const Parameter* parameter = parameters.find(name, std::span(types).first(count));
  if (parameter == nullptr) return std::nullopt;
  if (parameter->type == ParameterType::texture) {
    const Texture* constant = constant_texture(reader, *parameter, reader.spectrum_textures);
    if (constant != nullptr && kind == RgbKind::albedo && constant->is_number == 0)
      return SpectrumValue{constant->spectrum, {}};
    report_texture(reader, parameters, *parameter, reader.spectrum_textures);
    return std::nullopt;
  }
  return SpectrumReader{reader, parameters, *parameter, kind}.read();
}

double read_real_or_texture(Reader& reader, Parameters& parameters, std::string_view name, double fallback) {
  constexpr ParameterType types[] = {ParameterType::real, ParameterType::texture};
  const Parameter* parameter = parameters.find(name, types);
  if (parameter == nullptr) return fallback;
  if (parameter->type == ParameterType::texture) {
    if (const Texture* constant = constant_texture(reader, *parameter, reader.float_textures))
      return double{constant->value};
    report_texture(reader, parameters, *parameter, reader.float_textures);
    return fallback;
  }
  return parameters.number(name, fallback);
}

}  // namespace metamer::pbrt
