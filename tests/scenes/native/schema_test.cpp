// The schema and the page say what the reader does.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <json/reader.h>

#include <fstream>
#include <set>
#include <sstream>

#include "scenes/native/keys.h"
#include "scenes/native/read_native.h"

namespace metamer {
namespace {

const std::string schema_path = METAMER_SOURCE_DIR "/scenes/native/metamer-scene.schema.json";
// Media of grids have a page of their own.
const std::string page_paths[] = {METAMER_SOURCE_DIR "/docs/scene-format.md", METAMER_SOURCE_DIR "/docs/volumes.md"};

Json::Value read_schema() {
  std::ifstream file(schema_path);
  Json::Value schema;
  std::string errors;
  EXPECT_TRUE(Json::parseFromStream(Json::CharReaderBuilder(), file, &schema, &errors)) << errors;
  return schema;
}

std::string read_page() {
  std::ostringstream text;
  for (const std::string& path : page_paths) text << std::ifstream(path).rdbuf();
  EXPECT_FALSE(text.str().empty());
  return text.str();
}

std::set<std::string> strings(const Json::Value& array) {
  std::set<std::string> result;
  for (const Json::Value& value : array) result.insert(value.asString());
  return result;
}

TEST(NativeSchema, HasTheKeysOfTheReader) {
  const Json::Value definitions = read_schema()["$defs"];
  for (const ObjectSpec& spec : all_object_specs()) {
    const Json::Value& object = definitions[std::string(spec.name)];
    std::set<std::string> keys, required;
    for (const KeySpec& key : spec.keys) {
      keys.emplace(key.name);
      if (key.is_required) required.emplace(key.name);
    }
    const auto members = object["properties"].getMemberNames();
    EXPECT_EQ(std::set<std::string>(members.begin(), members.end()), keys) << spec.name;
    EXPECT_EQ(strings(object["required"]), required) << spec.name;
    EXPECT_TRUE(object["additionalProperties"].isBool() && !object["additionalProperties"].asBool()) << spec.name;
  }
}

TEST(NativeSchema, HasNoObjectThatTheReaderDoesNotKnow) {
  const Json::Value definitions = read_schema()["$defs"];
  for (const std::string& name : definitions.getMemberNames()) {
    if (definitions[name].isMember("properties")) {
      EXPECT_NE(find_object_spec(name), nullptr) << name;
    }
  }
}

void check_references(const Json::Value& value, const Json::Value& definitions, const std::string& key = {}) {
  if (key == "$ref") {
    const std::string prefix = "#/$defs/", reference = value.asString();
    ASSERT_TRUE(reference.starts_with(prefix)) << reference;
    EXPECT_TRUE(definitions.isMember(reference.substr(prefix.size()))) << reference;
  }
  for (auto it = value.begin(); it != value.end(); ++it) check_references(*it, definitions, it.name());
}

TEST(NativeSchema, RefersToWhatItHas) {
  const Json::Value schema = read_schema();
  check_references(schema, schema["$defs"]);
}

TEST(NativePage, MentionsEveryKeyAndType) {
  const std::string page = read_page();
  for (const ObjectSpec& spec : all_object_specs()) {
    for (const KeySpec& key : spec.keys) {
      const std::string name(key.name);
      const bool is_there = page.find(fmt::format("`{}`", name)) != std::string::npos ||
                            page.find(fmt::format("\"{}\":", name)) != std::string::npos;
      EXPECT_TRUE(is_there) << spec.name << " " << key.name;
    }
    const size_t dot = spec.name.find('.');
    if (dot == std::string_view::npos) continue;
    EXPECT_NE(page.find(fmt::format("\"{}\"", spec.name.substr(dot + 1))), std::string::npos) << spec.name;
  }
}

TEST(NativePage, ShowsASceneThatCanBeRead) {
  const std::string page = read_page(), fence = "```json\n";
  const size_t begin = page.find(fence) + fence.size();
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_native("page.json",
                          copy_bytes(std::string_view(page).substr(begin, page.find("```", begin) - begin)), scene,
                          diagnostics))
      << format_diagnostics(diagnostics);
  EXPECT_EQ(scene.registry.table<Geometry>().size(), 3u);
  EXPECT_EQ(scene.registry.table<Camera>().size(), 1u);
}

// Snippets are members of an object: in braces, with what a scene requires, they are scenes or entities.
TEST(NativePage, ShowsSnippetsThatCanBeRead) {
  const std::string page = read_page(), fence = "```json\n\"";
  int found = 0;
  for (size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at + 1), ++found) {
    const size_t begin = at + fence.size() - 1;
    const std::string member = page.substr(begin, page.find("```", begin) - begin);
    const bool is_component = member.starts_with("\"transform\"") || member.starts_with("\"light\"");
    const std::string text = is_component ? fmt::format("{{\"metamer\": 1, \"entities\": [{{{}}}]}}", member)
                                          : fmt::format("{{\"metamer\": 1, \"entities\": [], {}}}", member);
    Scene scene;
    Diagnostics diagnostics;
    EXPECT_TRUE(read_native("page.json", copy_bytes(text), scene, diagnostics))
        << format_diagnostics(diagnostics) << text;
  }
  EXPECT_EQ(found, 12);
}

}  // namespace
}  // namespace metamer
