#include "scenes/native/spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"

namespace metamer {
namespace {

constexpr std::string_view forms[] = {"constant", "table", "named",   "blackbody",
                                      "daylight", "rgb",   "samples", "sigmoid"};

const Range& range_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::reflectance: return unit_interval;
    case Quantity::eta: return positive;
    case Quantity::brdf:
    case Quantity::kappa:
    case Quantity::coefficient:
    case Quantity::light: return not_negative;
    case Quantity::any: break;
  }
  return any_number;
}

RgbKind rgb_kind(Quantity quantity) {
  if (quantity == Quantity::reflectance) return RgbKind::albedo;
  return quantity == Quantity::light ? RgbKind::illuminant : RgbKind::unbounded;
}

class SpectrumReader {
 public:
  // `is_definition`: an entry of "spectra". It may name built-in spectra only, and whether its values suit a quantity
  // is judged where it is used.
  SpectrumReader(SceneContext& context, std::string_view what, Quantity quantity, bool is_definition)
      : context_(context),
        reader_(context.reader),
        set_(context.scene.spectra),
        what_(what),
        quantity_(quantity),
        is_definition_(is_definition) {}

  SpectrumId read(const Json::Value& value) {
    const size_t errors_before = reader_.diagnostics().error_count();
    const SpectrumId id = value.isString()    ? named(value)
                          : value.isNumeric() ? constant(value, what_)
                                              : read_object(value);
    if (reader_.diagnostics().error_count() != errors_before) return zero_spectrum;
    check_range(value, id);
    return id;
  }

 private:
  SpectrumId read_object(const Json::Value& value) {
    if (!value.isObject()) {
      reader_.expected(value, what_, "a spectrum: a number, a name, or an object such as {\"rgb\": [1, 0.5, 0]}");
      return zero_spectrum;
    }
    const JsonObject object(reader_, value, *find_object_spec("spectrum"), "a spectrum");
    const std::string_view form = object.one_of(forms);
    scale_ = object.number("scale", not_negative, 1);
    if (object.has("space") && form != "rgb" && !form.empty())
      reader_.error(*object.find("space"), "'space' belongs to 'rgb' only");
    if (object.has("times") && form != "sigmoid" && !form.empty())
      reader_.error(*object.find("times"), "'times' belongs to 'sigmoid' only");
    const SpectrumId id = form.empty() ? zero_spectrum : read_form(object, form);
    return scale_ == 1 ? id : checked(value, set_.scaled(id, scale_));
  }

  // What the finished spectrum is worth must suit the quantity.
  void check_range(const Json::Value& at, SpectrumId id) const {
    if (is_definition_ || quantity_ == Quantity::any) return;
    const double low = set_.min_value(id), high = set_.max_value(id);
    // Single precision may round a table's 1 up.
    const bool too_high = quantity_ == Quantity::reflectance && high > 1 + 1e-6;
    if (!too_high && range_of(quantity_).contains(low)) return;
    reader_.error(at, fmt::format("'{}' reaches {:.6g}; expected {} at every wavelength", what_, too_high ? high : low,
                                  describe_range(range_of(quantity_), "values")));
  }

  SpectrumId checked(const Json::Value& at, const SpectrumResult& result) const {
    if (!result.ok()) reader_.error(at, fmt::format("'{}': {}", what_, result.error));
    return result.id;
  }

  // The numbers of a spectrum that is scaled afterwards are judged by `check_range` alone.
  const Range& entry_range() const { return is_definition_ || scale_ != 1 ? any_number : range_of(quantity_); }

  SpectrumId constant(const Json::Value& value, std::string_view key) {
    return checked(value, set_.add_constant(reader_.number(value, key, entry_range(), 0)));
  }

  SpectrumId read_form(const JsonObject& object, std::string_view form) {
    const Json::Value& value = *object.find(form);
    if (form == "constant") return constant(value, form);
    if (form == "table") return table(value);
    if (form == "named") return named(value);
    if (form == "rgb") return rgb(object, value);
    if (form == "samples") return samples(value);
    if (form == "sigmoid") return sigmoid(object, value);
    constexpr Range kelvin{0, 1e9, true};
    constexpr Range daylight_kelvin{4000, 25000};
    if (form == "blackbody") {
      const double temperature = reader_.number(value, form, kelvin, 6500);
      return checked(value, set_.add_blackbody(temperature));
    }
    return checked(value, set_.add_daylight(reader_.number(value, form, daylight_kelvin, 6500)));
  }

  SpectrumId table(const Json::Value& value) {
    if (!reader_.array(value, "table", "[nm, value] pairs")) return zero_spectrum;
    const size_t errors_before = reader_.diagnostics().error_count();
    std::vector<double> lambda_nm, values;
    for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
      const Json::Value& row = value[i];
      if (!row.isArray() || row.size() != 2) {
        reader_.expected(row, fmt::format("table[{}]", i), "a pair [nm, value]");
        continue;
      }
      lambda_nm.push_back(reader_.number(row[0], fmt::format("table[{}][0]", i), positive, 1));
      values.push_back(reader_.number(row[1], fmt::format("table[{}][1]", i), entry_range(), 1));
      const size_t n = lambda_nm.size();
      if (n > 1 && !(lambda_nm[n - 1] > lambda_nm[n - 2])) {
        reader_.error(
            row, fmt::format("wavelengths must ascend, but {} nm follows {} nm", lambda_nm[n - 1], lambda_nm[n - 2]));
      }
    }
    if (reader_.diagnostics().error_count() != errors_before) return zero_spectrum;
    return checked(value,
                   set_.add_table(lambda_nm, values, quantity_ == Quantity::light ? Extend::zero : Extend::constant));
  }

  SpectrumId samples(const Json::Value& value) {
    if (!value.isArray() || value.size() != lambda_count) {
      reader_.expected(value, "samples",
                       fmt::format("an array of {} numbers, for {}, {}, ... {} nm", lambda_count, lambda_min_nm,
                                   lambda_min_nm + 1, lambda_max_nm));
      return zero_spectrum;
    }
    Samples read{};
    for (Json::ArrayIndex i = 0; i < value.size(); ++i)
      read[i] = reader_.number(value[i], fmt::format("samples[{}]", i), any_number, 0);
    return checked(value, set_.add_samples(read));
  }

  SpectrumId sigmoid(const JsonObject& object, const Json::Value& value) {
    Color3 coefficients{};
    if (!reader_.numbers(value, "sigmoid", any_number, coefficients)) return zero_spectrum;
    const Json::Value* times = object.find("times");
    if (times == nullptr) return checked(value, set_.add_sigmoid(coefficients, unit_spectrum));
    const size_t errors_before = reader_.diagnostics().error_count();
    const SpectrumId factor = SpectrumReader(context_, "times", Quantity::any, is_definition_).read(*times);
    if (reader_.diagnostics().error_count() != errors_before) return zero_spectrum;
    return checked(*times, set_.add_sigmoid(coefficients, factor));
  }

  SpectrumId rgb(const JsonObject& object, const Json::Value& value) {
    const auto space = static_cast<ColorSpace>(object.choice("space", color_space_names(), 0));
    Color3 color{};
    const Range& range = quantity_ == Quantity::reflectance ? unit_interval : not_negative;
    if (!reader_.numbers(value, "rgb", range, color)) return zero_spectrum;
    const SpectrumId id = checked(value, set_.add_rgb(color, rgb_kind(quantity_), space));
    if (quantity_ != Quantity::light) return id;
    // Radiance that the display shows as this colour: its white has a luminance of 1 cd/m^2.
    return checked(value, set_.scaled(id, 1 / set_.luminance(set_.add_white(space))));
  }

  SpectrumId named(const Json::Value& value) {
    const std::string name = reader_.text(value, what_);
    if (name.empty()) return zero_spectrum;
    const auto own = context_.spectra.find(name);
    const bool is_own = own != context_.spectra.end();
    if (is_own && !is_definition_) return own_spectrum(own->second);
    if (const auto id = set_.add_named(name)) return *id;
    std::vector<std::string_view> known(spectrum_names().begin(), spectrum_names().end());
    if (!is_definition_)
      for (const auto& entry : context_.spectra) known.push_back(entry.first);
    reader_.error(value, fmt::format("unknown spectrum '{}'{}", printable_text(name),
                                     is_own ? "; entries of 'spectra' may name built-in spectra only"
                                            : did_you_mean(name, known)));
    return zero_spectrum;
  }

  // Mistakes in the definition are reported once, however often it is used.
  SpectrumId own_spectrum(NamedSpectrum& own) {
    const auto known = own.ids.find(quantity_);
    if (own.is_wrong || known != own.ids.end()) return own.is_wrong ? fallback() : known->second;
    const size_t errors_before = reader_.diagnostics().error_count();
    const SpectrumId id = SpectrumReader(context_, what_, quantity_, true).read(*own.value);
    own.is_wrong = reader_.diagnostics().error_count() != errors_before;
    own.ids[quantity_] = id;
    return own.is_wrong ? fallback() : id;
  }

  // Stands for a spectrum whose mistakes have been reported: suits every quantity.
  static SpectrumId fallback() { return unit_spectrum; }

  SceneContext& context_;
  const JsonReader& reader_;
  SpectrumSet& set_;
  std::string_view what_;
  Quantity quantity_;
  bool is_definition_;
  double scale_ = 1;
};

std::vector<std::string_view> metal_names() {
  std::vector<std::string_view> names;
  for (const std::string_view name : spectrum_names())
    if (name.ends_with(".n")) names.push_back(name.substr(0, name.size() - 2));
  return names;
}

// Everything that is neither part of a metal or a colour chart nor a light.
std::vector<std::string_view> glass_names() {
  std::vector<std::string_view> names;
  for (const std::string_view name : spectrum_names()) {
    const bool is_other = name.find('.') != std::string_view::npos || name.starts_with("metal-") ||
                          name.starts_with("stdillum-") || name.starts_with("illum-") || cie_illuminant(name);
    if (!is_other) names.push_back(name);
  }
  return names;
}

// The name if it is one of those, else empty after a report.
std::string known_name(const SceneContext& context, const Json::Value& value, std::string_view what,
                       std::span<const std::string_view> names) {
  const std::string name = context.reader.text(value, what);
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return name;
  const std::string hint = did_you_mean(name, names);
  std::string list;
  for (const std::string_view known : names) list += fmt::format("{}{}", list.empty() ? "; known are " : ", ", known);
  context.reader.error(value, fmt::format("unknown {} '{}'{}", what, printable_text(name), hint.empty() ? list : hint));
  return {};
}

}  // namespace

void declare_spectra(SceneContext& context, const Json::Value& spectra) {
  if (!spectra.isObject()) {
    context.reader.expected(spectra, "spectra", "an object of named spectra");
    return;
  }
  for (auto it = spectra.begin(); it != spectra.end(); ++it)
    if (!is_repeated_key(it.name())) context.spectra[it.name()].value = &*it;
}

void check_unused_spectra(SceneContext& context) {
  for (const auto& [name, spectrum] : context.spectra)
    if (spectrum.ids.empty()) SpectrumReader(context, name, Quantity::any, true).read(*spectrum.value);
}

SpectrumId read_spectrum(SceneContext& context, const Json::Value& value, std::string_view what, Quantity quantity) {
  return SpectrumReader(context, what, quantity, false).read(value);
}

MetalSpectra read_metal(SceneContext& context, const Json::Value& value) {
  const std::string name = known_name(context, value, "metal", metal_names());
  if (name.empty()) return {};
  SpectrumSet& set = context.scene.spectra;
  return {set.add_named(name + ".n").value_or(zero_spectrum), set.add_named(name + ".k").value_or(zero_spectrum)};
}

SpectrumId read_glass(SceneContext& context, const Json::Value& value) {
  const std::string name = known_name(context, value, "glass", glass_names());
  return name.empty() ? zero_spectrum : context.scene.spectra.add_named(name).value_or(zero_spectrum);
}

}  // namespace metamer
