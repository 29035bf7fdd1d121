// Directives that open and close blocks: attributes, objects, the world, other files.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/pbrt/directives.h"

namespace metamer::pbrt {
namespace {

void push(Reader& reader, Block block, Source source) { reader.stack.push_back({reader.state, block, source}); }

// Ends the innermost block if it is of this kind.
bool pop(Reader& reader, Block block, std::string_view directive, std::string_view begin, Source source) {
  if (reader.stack.empty() || reader.stack.back().block != block) {
    reader.messages.error(source, fmt::format("{} without {}", directive, begin));
    return false;
  }
  reader.state = std::move(reader.stack.back().state);
  reader.stack.pop_back();
  return true;
}

}  // namespace

std::optional<std::string> read_string(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  if (tokens.peek().kind == TokenKind::string) return std::string(tokens.next().text);
  reader.messages.error(source, fmt::format("{} expects a quoted name, not {}", directive, show(tokens.peek())));
  tokens.skip_to_directive();
  return std::nullopt;
}

void attribute_begin(Reader& reader, Tokenizer&, std::string_view, Source source) {
  push(reader, Block::attribute, source);
}
void attribute_end(Reader& reader, Tokenizer&, std::string_view directive, Source source) {
  pop(reader, Block::attribute, directive, "AttributeBegin", source);
}

// Deprecated in pbrt-v4, which takes them as AttributeBegin and AttributeEnd.
void transform_begin(Reader& reader, Tokenizer&, std::string_view, Source source) {
  reader.messages.warning_once("TransformBegin", source, "TransformBegin is deprecated; it means AttributeBegin");
  push(reader, Block::transform, source);
}
void transform_end(Reader& reader, Tokenizer&, std::string_view directive, Source source) {
  pop(reader, Block::transform, directive, "TransformBegin", source);
}

void object_begin(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  push(reader, Block::object, source);
  if (!name) return;
  if (reader.object) return reader.messages.error(source, "ObjectBegin inside ObjectBegin");
  if (reader.objects.contains(*name)) reader.messages.error(source, fmt::format("object '{}' is defined twice", *name));
  reader.objects.try_emplace(*name);
  reader.object = *name;
}

void object_end(Reader& reader, Tokenizer&, std::string_view directive, Source source) {
  if (!pop(reader, Block::object, directive, "ObjectBegin", source)) return;
  const bool inside = std::any_of(reader.stack.begin(), reader.stack.end(),
                                  [](const SavedState& s) { return s.block == Block::object; });
  if (!inside) reader.object.reset();
}

void object_instance(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  if (reader.object) return reader.messages.error(source, "ObjectInstance inside ObjectBegin");
  reader.instances.push_back({*name, reader.state.transforms(), source});
}

void reverse_orientation(Reader& reader, Tokenizer&, std::string_view, Source) {
  reader.state.reverse_orientation = !reader.state.reverse_orientation;
}

void world_begin(Reader& reader, Tokenizer&, std::string_view, Source source) {
  default_camera(reader, source);
  reader.in_world = true;
  reader.state.transform = reader.state.end_transform = glm::dmat4(1.0);
  reader.state.start_time_active = reader.state.end_time_active = true;
  reader.coordinate_systems["world"] = {};
}

void world_end(Reader& reader, Tokenizer&, std::string_view, Source source) {
  reader.messages.warning_once("WorldEnd", source, "WorldEnd is of pbrt-v3 and means nothing any more");
}

void include(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (name) read_scene_file(reader, reader.resolve(*name), source);
}

// As Include, but what the file does to the graphics state ends with it.
void import(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source) {
  const auto name = read_string(reader, tokens, directive, source);
  if (!name) return;
  const size_t depth = reader.stack.size();
  push(reader, Block::import, source);
  read_scene_file(reader, reader.resolve(*name), source);
  while (reader.stack.size() > depth + 1) {
    reader.messages.error(reader.stack.back().source, "this block is not closed at the end of the imported file");
    if (reader.stack.back().block == Block::object) reader.object.reset();
    reader.stack.pop_back();
  }
  pop(reader, Block::import, directive, "Import", source);
}

}  // namespace metamer::pbrt
