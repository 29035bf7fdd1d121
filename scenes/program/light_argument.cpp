#include "scenes/program/light_argument.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/diagnostics.h"
#include "engine/spectrum/named_spectra.h"
#include "engine/spectrum/sources.h"
#include "scenes/program/failure.h"
#include "scenes/program/spectrum_file.h"

namespace metamer {
namespace {

// Lights and reflectances, not refractive indices.
std::vector<std::string_view> light_names() {
  std::vector<std::string_view> names;
  for (const std::string_view name : spectrum_names())
    if (name.starts_with("colorchecker.") || name.starts_with("stdillum-") || name.starts_with("illum-") ||
        cie_illuminant(name))
      names.push_back(name);
  return names;
}

bool looks_like_a_file(const std::string& text) {
  std::error_code failed;
  return !text.starts_with("colorchecker.") &&
         (text.find_first_of("/.") != std::string::npos || std::filesystem::exists(text, failed));
}

}  // namespace

Samples read_light(const std::string& text) {
  const std::vector<std::string_view> names = light_names();
  if (std::find(names.begin(), names.end(), text) != names.end()) return *named_spectrum(text);
  if (named_spectrum(text))
    throw Failure(exit_wrong_input, fmt::format("{}: is a refractive index, neither a light nor a reflectance", text));
  if (!looks_like_a_file(text))
    throw Failure(exit_wrong_input,
                  fmt::format("unknown spectrum '{}'{}; expected a file of lines 'nm value', or one of {}", text,
                              did_you_mean(text, names), fmt::join(names, ", ")));
  Diagnostics diagnostics;
  const Samples samples = read_spectrum_file(text, diagnostics);
  if (diagnostics.has_errors()) {
    std::fputs(format_diagnostics(diagnostics).c_str(), stderr);
    throw Failure(exit_wrong_input, "");
  }
  return samples;
}

std::optional<double> number_argument(std::string_view text) {
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || failed != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace metamer
