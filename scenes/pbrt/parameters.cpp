#include "scenes/pbrt/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::pbrt {
namespace {

// In the order of ParameterType.
constexpr std::array<std::string_view, 13> type_names = {"bool",     "integer", "float",  "point2", "vector2",
                                                         "point3",   "vector3", "normal", "rgb",    "blackbody",
                                                         "spectrum", "string",  "texture"};
// Suggestions: for the pbrt-v3 types "point", "vector" and "color" what they are called now.
constexpr std::array<std::string_view, 13> suggested_names = {"point3",   "vector3", "normal",  "bool", "integer",
                                                              "float",    "point2",  "vector2", "rgb",  "blackbody",
                                                              "spectrum", "string",  "texture"};

bool takes_strings(ParameterType type) {
  return type == ParameterType::string || type == ParameterType::texture || type == ParameterType::spectrum;
}
bool takes_numbers(ParameterType type) {
  return type != ParameterType::string && type != ParameterType::texture && type != ParameterType::boolean;
}

std::string_view expected_values(ParameterType type) {
  if (type == ParameterType::boolean) return "true or false";
  if (type == ParameterType::integer) return "integers";
  if (type == ParameterType::spectrum) return "numbers or a name";
  return takes_numbers(type) ? "numbers" : "a string";
}

struct ListParser {
  Tokenizer& tokens;
  NameId file;
  ColorSpace color_space;

  void error(Parameter& parameter, uint32_t line, std::string message) {
    // One mistake per parameter: the others mostly follow from it.
    if (!parameter.broken) tokens.diagnostics().error({tokens.file(), line}, std::move(message));
    parameter.broken = true;
  }

  // "type name" into a parameter.
  Parameter declaration() {
    const Token token = tokens.next();
    Parameter parameter;
    parameter.source = {file, token.line};
    parameter.color_space = color_space;
    constexpr std::string_view blanks = " \t";
    const size_t type_begin = std::min(token.text.find_first_not_of(blanks), token.text.size());
    const size_t type_end = std::min(token.text.find_first_of(blanks, type_begin), token.text.size());
    const size_t name_begin = std::min(token.text.find_first_not_of(blanks, type_end), token.text.size());
    const size_t name_end = std::min(token.text.find_last_not_of(blanks) + 1, token.text.size());
    const std::string_view type = token.text.substr(type_begin, type_end - type_begin);
    if (name_begin < name_end) parameter.name = token.text.substr(name_begin, name_end - name_begin);
    if (parameter.name.empty()) {
      error(parameter, token.line, fmt::format("{} should be \"type name\", as in \"float radius\"", show(token)));
      return parameter;
    }
    const auto found = std::find(type_names.begin(), type_names.end(), type);
    if (found == type_names.end()) {
      error(parameter, token.line,
            fmt::format("unknown parameter type '{}'{}", type, did_you_mean(type, suggested_names)));
    } else {
      parameter.type = static_cast<ParameterType>(found - type_names.begin());
    }
    return parameter;
  }

  void add_number(Parameter& parameter, const Token& token) {
    const std::optional<double> value = parse_number(token.text);
    if (!value) return error(parameter, token.line, fmt::format("{} is not a finite number", show(token)));
    if (parameter.type == ParameterType::integer) {
      constexpr double least = std::numeric_limits<int32_t>::min(), greatest = std::numeric_limits<int32_t>::max();
      if (*value != std::floor(*value) || *value < least || *value > greatest) {
        return error(parameter, token.line, fmt::format("{} is not a 32-bit integer", show(token)));
      }
    } else if (std::abs(*value) > static_cast<double>(std::numeric_limits<float>::max())) {
      return error(parameter, token.line, fmt::format("{} is too large", show(token)));
    }
    parameter.numbers.push_back(*value);
  }

  void add_value(Parameter& parameter, const Token& token) {
    if (parameter.broken) return;
    const bool is_boolean = token.text == "true" || token.text == "false";
    if (parameter.type == ParameterType::boolean && is_boolean) {
      parameter.booleans.push_back(token.text == "true");
    } else if (token.kind == TokenKind::string && takes_strings(parameter.type)) {
      parameter.strings.emplace_back(token.text);
    } else if (token.kind == TokenKind::word && takes_numbers(parameter.type)) {
      add_number(parameter, token);
    } else {
      error(parameter, token.line,
            fmt::format("'{} {}' expects {}, not {}", type_name(parameter.type), parameter.name,
                        expected_values(parameter.type), show(token)));
    }
  }

  void values(Parameter& parameter) {
    const uint32_t line = tokens.peek().line;
    if (tokens.peek().kind == TokenKind::end || tokens.peek().kind == TokenKind::close_bracket ||
        looks_like_directive(tokens.peek())) {
      error(parameter, parameter.source.line, fmt::format("'{}' has no value", parameter.name));
      if (tokens.peek().kind == TokenKind::close_bracket) tokens.next();
      return;
    }
    if (tokens.peek().kind != TokenKind::open_bracket) return add_value(parameter, tokens.next());
    tokens.next();
    while (tokens.peek().kind != TokenKind::close_bracket) {
      if (tokens.peek().kind == TokenKind::end || looks_like_directive(tokens.peek())) {
        parameter.broken = false;  // worth saying, whatever else was wrong
        return error(parameter, line, fmt::format("the '[' of '{}' is never closed", parameter.name));
      }
      add_value(parameter, tokens.next());
    }
    tokens.next();
    if (!parameter.broken && parameter.numbers.empty() && parameter.strings.empty() && parameter.booleans.empty()) {
      error(parameter, line, fmt::format("'{}' has no value", parameter.name));
    }
    if (!parameter.numbers.empty() && !parameter.strings.empty()) {
      error(parameter, line, fmt::format("'{}' mixes numbers and strings", parameter.name));
    }
  }
};

}  // namespace

std::string_view type_name(ParameterType type) { return type_names[static_cast<size_t>(type)]; }

ParameterList parse_parameters(Tokenizer& tokens, NameId file, ColorSpace color_space) {
  ListParser parser{tokens, file, color_space};
  ParameterList list;
  while (tokens.peek().kind == TokenKind::string) {
    Parameter parameter = parser.declaration();
    parser.values(parameter);
    list.push_back(std::move(parameter));
  }
  return list;
}

Parameters::Parameters(std::string what, Source source, const ParameterList& list, const ParameterPointers& defaults,
                       Messages& messages)
    : what_(std::move(what)), source_(source), list_(list), defaults_(defaults), messages_(messages) {
  used_.resize(list.size());
}

const Parameter* Parameters::lookup(std::string_view name) {
  asked_.emplace_back(name);
  const Parameter* first = nullptr;
  for (size_t i = 0; i < list_.size(); ++i) {
    if (list_[i].name != name) continue;
    if (first == nullptr) {
      first = &list_[i];
    } else if (!used_[i]) {
      messages_.warning(list_[i].source, fmt::format("'{}' is given twice; the first one counts", name));
    }
    used_[i] = true;
  }
  for (size_t i = 0; first == nullptr && i < defaults_.size(); ++i) {
    if (defaults_[i]->name == name) first = defaults_[i];
  }
  return first;
}

const Parameter* Parameters::find(std::string_view name, std::span<const ParameterType> types) {
  const Parameter* parameter = lookup(name);
  if (parameter == nullptr || parameter->broken) return nullptr;
  if (std::find(types.begin(), types.end(), parameter->type) != types.end()) return parameter;
  std::string expected;
  for (const ParameterType type : types) {
    expected += fmt::format("{}'{} {}'", expected.empty() ? "" : " or ", type_name(type), name);
  }
  messages_.error(parameter->source,
                  fmt::format("{}: '{} {}' should be {}", what_, type_name(parameter->type), name, expected));
  return nullptr;
}

bool Parameters::has(std::string_view name) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Parameter& p) { return p.name == name; }) ||
         std::any_of(defaults_.begin(), defaults_.end(), [&](const Parameter* p) { return p->name == name; });
}

bool Parameters::is_texture(std::string_view name) const {
  const auto named = [&](const Parameter& p) { return p.name == name; };
  const auto own = std::find_if(list_.begin(), list_.end(), named);
  if (own != list_.end()) return own->type == ParameterType::texture;
  return std::any_of(defaults_.begin(), defaults_.end(),
                     [&](const Parameter* p) { return named(*p) && p->type == ParameterType::texture; });
}

void Parameters::error(std::string_view name, std::string message) {
  const Parameter* parameter = lookup(name);
  messages_.error(parameter != nullptr ? parameter->source : source_, what_ + ": " + message);
}

std::span<const double> Parameters::array(std::string_view name, ParameterType type, size_t per_item) {
  const Parameter* parameter = find(name, type);
  if (parameter == nullptr) return {};
  if (parameter->numbers.size() % per_item == 0) return parameter->numbers;
  error(name,
        fmt::format("'{}' has {} numbers, which is not a multiple of {}", name, parameter->numbers.size(), per_item));
  return {};
}

double Parameters::number(std::string_view name, double fallback) {
  const Parameter* parameter = find(name, ParameterType::real);
  if (parameter == nullptr) return fallback;
  if (parameter->numbers.size() == 1) return parameter->numbers[0];
  error(name, fmt::format("'{}' expects one number, not {}", name, parameter->numbers.size()));
  return fallback;
}

double Parameters::number_from(std::string_view name, double fallback, double least) {
  const double value = number(name, fallback);
  if (value >= least || value == fallback) return value;
  error(name, fmt::format("'{}' is {}, but must be at least {}", name, value, least));
  return fallback;
}

double Parameters::positive(std::string_view name, double fallback) {
  const double value = number(name, fallback);
  // What single precision would round to zero counts as zero.
  if (static_cast<float>(value) > 0.0f) return value;
  error(name, fmt::format("'{}' is {}, but must be positive", name, value));
  return fallback;
}

int Parameters::integer(std::string_view name, int fallback, int least) {
  const Parameter* parameter = find(name, ParameterType::integer);
  if (parameter == nullptr) return fallback;
  if (parameter->numbers.size() != 1) {
    error(name, fmt::format("'{}' expects one integer, not {}", name, parameter->numbers.size()));
    return fallback;
  }
  const int value = static_cast<int>(parameter->numbers[0]);
  if (value >= least) return value;
  error(name, fmt::format("'{}' is {}, but must be at least {}", name, value, least));
  return fallback;
}

bool Parameters::boolean(std::string_view name, bool fallback) {
  const Parameter* parameter = find(name, ParameterType::boolean);
  if (parameter == nullptr) return fallback;
  if (parameter->booleans.size() == 1) return parameter->booleans[0];
  error(name, fmt::format("'{}' expects one of true and false, not {} values", name, parameter->booleans.size()));
  return fallback;
}

std::string Parameters::string(std::string_view name, std::string_view fallback) {
  const Parameter* parameter = find(name, ParameterType::string);
  if (parameter == nullptr) return std::string(fallback);
  if (parameter->strings.size() == 1) return parameter->strings[0];
  error(name, fmt::format("'{}' expects one string, not {}", name, parameter->strings.size()));
  return std::string(fallback);
}

glm::dvec3 Parameters::triple(std::string_view name, ParameterType type, glm::dvec3 fallback) {
  const Parameter* parameter = find(name, type);
  if (parameter == nullptr) return fallback;
  if (parameter->numbers.size() == 3) return {parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]};
  error(name, fmt::format("'{}' expects three numbers, not {}", name, parameter->numbers.size()));
  return fallback;
}

void Parameters::unsupported(std::string_view name, std::string_view instead) {
  const Parameter* parameter = lookup(name);
  if (parameter == nullptr) return;
  messages_.warning_once(what_ + " " + std::string(name), parameter->source,
                         fmt::format("{}: '{}' is not supported yet; {}", what_, name, instead));
}

void Parameters::report_unused() {
  if (ignore_rest_) return;
  const std::vector<std::string_view> names(asked_.begin(), asked_.end());
  for (size_t i = 0; i < list_.size(); ++i) {
    if (used_[i] || list_[i].broken) continue;
    messages_.error(list_[i].source, fmt::format("{} has no parameter '{} {}'{}", what_, type_name(list_[i].type),
                                                 list_[i].name, did_you_mean(list_[i].name, names)));
  }
}

}  // namespace metamer::pbrt
