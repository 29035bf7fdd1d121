#include "scenes/program/spectrum_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

namespace metamer {
namespace {

constexpr std::string_view separators = " \t,;\r";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  for (size_t begin = line.find_first_not_of(separators); begin != std::string_view::npos;) {
    const size_t end = std::min(line.find_first_of(separators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Table {
  std::vector<double> lambda_nm, values;
};

void read_row(const std::vector<std::string_view>& words, const SourceLocation& at, Table& table,
              Diagnostics& diagnostics) {
  if (words.size() != 2) {
    diagnostics.error(at, fmt::format("{} values; expected two, a wavelength in nm and the light there", words.size()));
    return;
  }
  const std::optional<double> lambda = number(words[0]), value = number(words[1]);
  if (!lambda || !(*lambda > 0))
    diagnostics.error(at, fmt::format("'{}': expected a wavelength in nm, above 0", words[0]));
  if (!value || *value < 0) diagnostics.error(at, fmt::format("'{}': expected a number, 0 or more", words[1]));
  if (!lambda || !value) return;
  if (!table.lambda_nm.empty() && !(*lambda > table.lambda_nm.back()))
    diagnostics.error(at,
                      fmt::format("wavelengths must ascend, but {} nm follows {} nm", *lambda, table.lambda_nm.back()));
  table.lambda_nm.push_back(*lambda);
  table.values.push_back(*value);
}

}  // namespace

Samples read_spectrum_file(const std::string& path, Diagnostics& diagnostics) {
  Samples samples{};
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) {
    diagnostics.error({path, 0}, "is a folder, not a file of a spectrum");
    return samples;
  }
  std::ifstream file(path);
  if (!file) {
    diagnostics.error({path, 0}, fmt::format("cannot be opened: {}", std::strerror(errno)));
    return samples;
  }
  Table table;
  bool is_first = true;
  std::string line;
  for (uint32_t at = 1; std::getline(file, line); ++at) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) continue;
    const bool is_header = is_first && !number(words[0]);
    is_first = false;
    if (!is_header) read_row(words, {path, at}, table, diagnostics);
  }
  if (diagnostics.has_errors()) return samples;
  if (table.lambda_nm.size() < 2) {
    diagnostics.error({path, 0}, fmt::format("{} rows; expected lines of a wavelength in nm and the light there, two "
                                             "or more",
                                             table.lambda_nm.size()));
    return samples;
  }
  if (table.lambda_nm.back() < lambda_min_nm || table.lambda_nm.front() > lambda_max_nm) {
    diagnostics.error({path, 0},
                      fmt::format("its wavelengths, {} to {}, are none of light; expected nm, within {} to {}",
                                  table.lambda_nm.front(), table.lambda_nm.back(), lambda_min_nm, lambda_max_nm));
    return samples;
  }
  return resample(table.lambda_nm, table.values, Extend::zero);
}

}  // namespace metamer
