// Parameter lists: "type name" [ values ], and how a directive asks for what it understands.
#pragma once
#include <glm/vec3.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/ecs/components.h"
#include "engine/ecs/scene.h"
#include "scenes/pbrt/tokens.h"

namespace metamer::pbrt {

enum class ParameterType : uint8_t {
  boolean,
  integer,
  real,
  point2,
  vector2,
  point3,
  vector3,
  normal,
  rgb,
  blackbody,
  spectrum,
  string,
  texture
};

struct Parameter {
  ParameterType type = ParameterType::real;
  std::string name;
  Source source;
  std::vector<double> numbers;  // also of integers, which are within 32 bits
  std::vector<std::string> strings;
  std::vector<bool> booleans;
  ColorSpace color_space = ColorSpace::srgb;  // of rgb values
  bool broken = false;                        // already reported: its value is not to be used
};

using ParameterList = std::vector<Parameter>;
using ParameterPointers = std::vector<const Parameter*>;

// Messages about a file under way, some of them said once only.
struct Messages {
  Diagnostics& diagnostics;
  const NameTable& names;
  std::set<std::string> said = {};

  SourceLocation at(Source source) const {
    return source.file == no_index ? SourceLocation{} : SourceLocation{names[source.file], source.line};
  }
  void error(Source source, std::string message) { diagnostics.error(at(source), std::move(message)); }
  void warning(Source source, std::string message) { diagnostics.warning(at(source), std::move(message)); }
  void note(Source source, std::string message) { diagnostics.note(at(source), std::move(message)); }
  // The first time that `kind` comes up; repetitions would bury the rest.
  void warning_once(const std::string& kind, Source source, std::string message) {
    if (said.insert(kind).second) warning(source, std::move(message));
  }
  void note_once(const std::string& kind, Source source, std::string message, Strict strict = Strict::refuses) {
    if (said.insert(kind).second) diagnostics.note(at(source), std::move(message), strict);
  }
};

// Parses the parameters that follow. `file` is the tokenizer's file in the scene's names.
ParameterList parse_parameters(Tokenizer& tokens, NameId file, ColorSpace color_space);

// Asks a list for typed values, remembers what was asked for, and reports the rest. `defaults` (from Attribute
// directives) answer what the list does not and need not be used.
class Parameters {
 public:
  // `what` is how messages call the directive: `Shape "sphere"`.
  Parameters(std::string what, Source source, const ParameterList& list, const ParameterPointers& defaults,
             Messages& messages);

  // Null if absent, broken, or of another type (which is reported). `types` is not empty.
  const Parameter* find(std::string_view name, std::span<const ParameterType> types);
  const Parameter* find(std::string_view name, ParameterType type) { return find(name, {&type, 1}); }

  bool has(std::string_view name) const;
  bool is_texture(std::string_view name) const;  // given, and as a texture
  double number(std::string_view name, double fallback);
  // A number from `least` up; else an error and the fallback.
  double number_from(std::string_view name, double fallback, double least);
  double positive(std::string_view name, double fallback);
  int integer(std::string_view name, int fallback, int least);
  bool boolean(std::string_view name, bool fallback);
  std::string string(std::string_view name, std::string_view fallback);
  glm::dvec3 point3(std::string_view name, glm::dvec3 fallback) {
    return triple(name, ParameterType::point3, fallback);
  }
  glm::dvec3 vector3(std::string_view name, glm::dvec3 fallback) {
    return triple(name, ParameterType::vector3, fallback);
  }
  // All values of an array parameter, a multiple of `per_item`; empty if absent or broken.
  std::span<const double> array(std::string_view name, ParameterType type, size_t per_item);

  // Says once per kind of directive that a parameter, if given, is not supported, and what happens instead.
  void unsupported(std::string_view name, std::string_view instead);
  // The whole directive is not supported: its parameters are nobody's mistake.
  void ignore_the_rest() { ignore_rest_ = true; }
  // Reports what nobody asked for. Call it last.
  void report_unused();

  const std::string& what() const { return what_; }
  Source source() const { return source_; }
  Messages& messages() { return messages_; }
  // An error at a parameter if it is given, else at the directive.
  void error(std::string_view name, std::string message);

 private:
  const Parameter* lookup(std::string_view name);
  glm::dvec3 triple(std::string_view name, ParameterType type, glm::dvec3 fallback);

  std::string what_;
  Source source_;
  const ParameterList& list_;
  const ParameterPointers& defaults_;
  Messages& messages_;
  std::vector<bool> used_;
  std::vector<std::string> asked_;
  bool ignore_rest_ = false;
};

std::string_view type_name(ParameterType type);

}  // namespace metamer::pbrt
