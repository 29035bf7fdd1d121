// The directives that change the current transformation matrix.
#include <fmt/format.h>

#include <array>
#include <glm/matrix.hpp>

#include "scenes/pbrt/directives.h"
#include "scenes/pbrt/matrix.h"

namespace metamer::pbrt {
namespace {

// `count` numbers, with or without brackets; else an error.
std::optional<std::vector<double>> read_numbers(Reader& reader, Tokenizer& tokens, std::string_view directive,
                                                Source source, size_t count) {
  const bool bracket = tokens.peek().kind == TokenKind::open_bracket;
  if (bracket) tokens.next();
  std::vector<double> numbers;
  while (tokens.peek().kind == TokenKind::word && !looks_like_directive(tokens.peek()) && numbers.size() < count) {
    const Token token = tokens.next();
    const std::optional<double> number = parse_number(token.text);
    if (!number) {
      reader.messages.error({source.file, token.line},
                            fmt::format("{} expects numbers, not {}", directive, show(token)));
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  if (numbers.size() == count && (!bracket || tokens.peek().kind == TokenKind::close_bracket)) {
    if (bracket) tokens.next();
    return numbers;
  }
  const Token& token = tokens.peek();
  reader.messages.error({source.file, token.line},
                        fmt::format("{} expects {} numbers{}, but after {} comes {}", directive, count,
                                    bracket ? " and ']'" : "", numbers.size(), show(token)));
  return std::nullopt;
}

// Changes what is active with `change`, a function of the old matrix.
template <class Change>
void change_transforms(Reader& reader, Source source, const Change& change) {
  GraphicsState& state = reader.state;
  std::string_view mistake;
  const auto change_one = [&](glm::dmat4& transform) {
    const glm::dmat4 changed = change(transform);
    const std::string_view wrong = transform_mistake(changed);
    if (wrong.empty()) transform = changed;
    if (mistake.empty()) mistake = wrong;
  };
  if (state.start_time_active) change_one(state.transform);
  if (state.end_time_active) change_one(state.end_transform);
  if (!mistake.empty()) reader.messages.error(source, fmt::format("this transformation is {}", mistake));
}

void set_transform(Reader& reader, Source source, const glm::dmat4& m) {
  change_transforms(reader, source, [&](const glm::dmat4&) { return m; });
}

void concatenate(Reader& reader, Source source, const std::optional<glm::dmat4>& m, std::string_view undefined = "") {
  if (!m) return reader.messages.error(source, fmt::format("this transformation is {}", undefined));
  change_transforms(reader, source, [&](const glm::dmat4& old) { return old * *m; });
}

// Both of its matrices, whatever is active, as in pbrt.
void coordinate_system_transform(Reader& reader, const std::string& name, Source source) {
  const auto found = reader.coordinate_systems.find(name);
  if (found != reader.coordinate_systems.end()) {
    reader.state.transform = found->second.start;
    reader.state.end_transform = found->second.end;
    return;
  }
  std::vector<std::string_view> known;
  for (const auto& [key, matrix] : reader.coordinate_systems) known.push_back(key);
  reader.messages.error(source, fmt::format("there is no coordinate system '{}'{}", name, did_you_mean(name, known)));
}

void active_transform(Reader& reader, Tokenizer& tokens, Source source) {
  const Token token = tokens.next();
  if (token.text != "All" && token.text != "StartTime" && token.text != "EndTime") {
    return reader.messages.error(source,
                                 fmt::format("ActiveTransform expects All, StartTime or EndTime, not {}", show(token)));
  }
  reader.state.start_time_active = token.text != "EndTime";
  reader.state.end_time_active = token.text != "StartTime";
}

void transform_times(Reader& reader, Source source, double start, double end) {
  if (reader.in_world) reader.messages.error(source, "TransformTimes must stand before WorldBegin");
  if (!(static_cast<float>(start) < static_cast<float>(end))) {
    return reader.messages.error(source, fmt::format("the motion ends at {} s but starts at {} s", end, start));
  }
  reader.motion_start = start;
  reader.motion_end = end;
}

void apply_numbers(Reader& reader, std::string_view directive, Source source, std::span<const double> v) {
  if (directive == "LookAt") {
    concatenate(reader, source, look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}),
                "undefined: eye and target coincide, or the up vector points along the view");
  } else if (directive == "Translate") {
    concatenate(reader, source, translation({v[0], v[1], v[2]}));
  } else if (directive == "Scale") {
    concatenate(reader, source, scaling({v[0], v[1], v[2]}));
  } else if (directive == "Rotate") {
    concatenate(reader, source, rotation(v[0], {v[1], v[2], v[3]}), "undefined: its axis is zero");
  } else if (directive == "ConcatTransform") {
    concatenate(reader, source, from_columns(v));
  } else if (directive == "Transform") {
    set_transform(reader, source, from_columns(v));
  } else {
    transform_times(reader, source, v[0], v[1]);
  }
}

struct NumberDirective {
  std::string_view name;
  size_t count;
};
constexpr std::array<NumberDirective, 7> number_directives = {{{"LookAt", 9},
                                                               {"Translate", 3},
                                                               {"Scale", 3},
                                                               {"Rotate", 4},
                                                               {"ConcatTransform", 16},
                                                               {"Transform", 16},
                                                               {"TransformTimes", 2}}};

}  // namespace

void set_place(Reader& reader, Entity entity, const TransformPair& transforms) {
  Registry& registry = reader.scene.registry;
  registry.set(entity, to_component(transforms.start));
  if (!transforms.moves()) return;
  const Transform end = to_component(transforms.end);
  registry.set(entity, Motion{end.row0, end.row1, end.row2, static_cast<float>(reader.motion_start),
                              static_cast<float>(reader.motion_end)});
}

void report_moving_light(Reader& reader, Source source) {
  if (!reader.state.transforms().moves()) return;
  reader.messages.warning_once("moving light", source,
                               "lights that move are not supported; they stand as at the start of their motion, as in "
                               "pbrt");
}

bool read_transform_directive(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  for (const NumberDirective& known : number_directives) {
    if (directive != known.name) continue;
    const auto numbers = read_numbers(reader, tokens, directive, source, known.count);
    if (numbers) {
      apply_numbers(reader, directive, source, *numbers);
    } else {
      tokens.skip_to_directive();
    }
    return true;
  }
  if (directive == "Identity") {
    set_transform(reader, source, glm::dmat4(1.0));
  } else if (directive == "ActiveTransform") {
    active_transform(reader, tokens, source);
  } else if (directive == "CoordinateSystem") {
    if (const auto name = read_string(reader, tokens, directive, source))
      reader.coordinate_systems[*name] = reader.state.transforms();
  } else if (directive == "CoordSysTransform") {
    if (const auto name = read_string(reader, tokens, directive, source))
      coordinate_system_transform(reader, *name, source);
  } else {
    return false;
  }
  return true;
}

}  // namespace metamer::pbrt
