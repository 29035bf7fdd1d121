#include <algorithm>
#include <cmath>

#include "scenes/pbrt/parameters.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"

namespace metamer::fuzz {
namespace {

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void check_tokens(std::string_view input) {
  Diagnostics mistakes;
  pbrt::Tokenizer tokenizer(input, "scene", mistakes);
  const size_t lines = 1 + static_cast<size_t>(std::count(input.begin(), input.end(), '\n'));
  size_t count = 0;
  uint32_t line = 1;
  for (pbrt::Token token = tokenizer.next(); token.kind != pbrt::TokenKind::end; token = tokenizer.next()) {
    require(++count <= input.size(), "a token takes a byte at least");
    require(token.line >= line && token.line <= lines, "lines ascend and exist");
    line = token.line;
    require(token.kind == pbrt::TokenKind::string || !token.text.empty(), "words are not empty");
    require(is_printable(pbrt::show(token)) && pbrt::show(token).size() < 60, "messages are short and printable");
    const auto number = pbrt::parse_number(token.text);
    require(!number || std::isfinite(*number), "numbers are finite");
  }
  require(tokenizer.next().kind == pbrt::TokenKind::end, "the end stays the end");
}

// The list, and what asks for it: every kind of question to whatever is there.
void check_parameters(std::string_view input) {
  Diagnostics mistakes;
  NameTable names;
  const NameId file = names.add("scene");
  pbrt::Tokenizer tokenizer(input, "scene", mistakes);
  const pbrt::ParameterList list = pbrt::parse_parameters(tokenizer, file, ColorSpace::srgb);
  const size_t errors = mistakes.error_count();
  pbrt::Messages messages{mistakes, names};
  const pbrt::ParameterPointers none;
  pbrt::Parameters parameters("Shape \"sphere\"", {file, 1}, list, none, messages);
  for (const pbrt::Parameter& p : list) {
    require(p.broken ? errors > 0 : p.numbers.size() + p.strings.size() + p.booleans.size() > 0,
            "a parameter has values or was reported");
    for (const double number : p.numbers) require(std::isfinite(number), "numbers are finite");
    require(std::isfinite(parameters.number(p.name, 1)), "a number is finite");
    require(parameters.number_from(p.name, 0, 0) >= 0, "a number keeps its bound");
    require(parameters.positive(p.name, 1) > 0, "a positive number is positive");
    require(parameters.integer(p.name, 7, 3) >= 3, "an integer keeps its bound");
    require(parameters.array(p.name, pbrt::ParameterType::point3, 3).size() % 3 == 0, "points have three coordinates");
    parameters.boolean(p.name, true);
    parameters.string(p.name, "");
    parameters.point3(p.name, glm::dvec3(0));
  }
  parameters.report_unused();
}

}  // namespace

void tokens(std::string_view input) {
  check_tokens(input);
  check_parameters(input);
}

}  // namespace metamer::fuzz
