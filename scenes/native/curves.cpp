#include <fmt/format.h>

#include <cmath>

#include "scenes/native/components.h"
#include "scenes/native/rows.h"

namespace metamer {
namespace {

// Half of the widths, metres, into the points.
void read_widths(const SceneContext& context, const Json::Value& value, Curves& curves) {
  const size_t points = curves.points.size();
  if (!value.isArray() || value.size() != points) {
    context.reader.expected(value, "widths", fmt::format("an array of {} widths, one for each point", points));
    return;
  }
  for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
    const double width = context.reader.number(value[i], fmt::format("widths[{}]", i), not_negative, 0);
    curves.points[i].w = static_cast<float>(width * context.metres_per_unit / 2);
  }
}

void read_points(const SceneContext& context, const Json::Value& value, Curves& curves) {
  Column<glm::vec3> positions;
  read_rows(context, value, "points", positions);
  for (const glm::vec3& p : positions)
    curves.points.push_back(glm::vec4(glm::vec3(glm::dvec3(p) * context.metres_per_unit), 0));
}

void read_segments(const SceneContext& context, const Json::Value& value, Curves& curves) {
  if (!context.reader.array(value, "segments", "numbers of points")) return;
  const size_t points = curves.points.size();
  for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
    const double first = value[i].isNumeric() ? value[i].asDouble() : -1;
    const bool fits = first >= 0 && first + 4 <= static_cast<double>(points) && first == std::floor(first);
    if (!fits) {
      context.reader.expected(value[i], fmt::format("segments[{}]", i),
                              fmt::format("the number of the first of four of the {} points, counted from 0", points));
    }
    curves.segments.push_back(fits ? static_cast<uint32_t>(first) : 0);
  }
}

// One curve through all points: every third one ends a segment.
void join_segments(const SceneContext& context, const Json::Value& at, Curves& curves) {
  const size_t points = curves.points.size();
  if (points < 4 || points % 3 != 1)
    context.reader.error(at, fmt::format("{} points without 'segments'; expected 4 and a multiple of 3 more", points));
  for (uint32_t first = 0; first + 3 < points; first += 3) curves.segments.push_back(first);
}

CurvesId read_curves_object(SceneContext& context, const Json::Value& value, const std::string& name) {
  const JsonReader& reader = context.reader;
  const size_t errors_before = reader.diagnostics().error_count();
  const JsonObject object(reader, value, *find_object_spec("curves"), "curves");
  if (!object.is_valid()) return no_index;
  Curves curves;
  curves.name = name;
  if (const Json::Value* points = object.find("points")) read_points(context, *points, curves);
  if (const Json::Value* widths = object.find("widths")) read_widths(context, *widths, curves);
  if (const Json::Value* normals = object.find("normals")) {
    read_rows(context, *normals, "normals", curves.normals);
    if (curves.normals.size() != curves.points.size()) {
      reader.error(*normals, fmt::format("{} normals for {} points; expected one for each", curves.normals.size(),
                                         curves.points.size()));
    }
  }
  if (const Json::Value* segments = object.find("segments"))
    read_segments(context, *segments, curves);
  else if (reader.diagnostics().error_count() == errors_before)
    join_segments(context, value, curves);
  if (reader.diagnostics().error_count() != errors_before) return no_index;
  context.scene.curves.push_back(std::move(curves));
  return static_cast<CurvesId>(context.scene.curves.size() - 1);
}

CurvesId read_curves_reference(SceneContext& context, const Json::Value& value) {
  if (!value.isString()) {
    const SourceLocation at = context.reader.document().at(value);
    return read_curves_object(context, value, fmt::format("{}:{}", at.file, at.line));
  }
  const auto known = context.curves.find(value.asString());
  if (known != context.curves.end()) return known->second;
  context.reader.error(value, fmt::format("unknown curves '{}'{}", printable_text(value.asString()),
                                          did_you_mean_key(value.asString(), context.curves)));
  return no_index;
}

}  // namespace

void read_curves(SceneContext& context, const Json::Value& curves) {
  if (!curves.isObject()) {
    context.reader.expected(curves, "curves", "an object of named curves");
    return;
  }
  for (auto it = curves.begin(); it != curves.end(); ++it)
    if (!is_repeated_key(it.name())) context.curves[it.name()] = read_curves_object(context, *it, it.name());
}

bool read_curves_geometry(SceneContext& context, const JsonObject& object, Geometry& geometry) {
  constexpr std::string_view kinds[] = {"flat", "ribbons", "round"};
  constexpr ShapeKind shapes[] = {ShapeKind::flat_curves, ShapeKind::ribbons, ShapeKind::round_curves};
  geometry.kind = shapes[object.choice("kind", kinds, 0)];
  if (object.has("curves")) geometry.curves = read_curves_reference(context, *object.find("curves"));
  if (geometry.curves == no_index) return false;
  if (geometry.kind == ShapeKind::ribbons && context.scene.curves[geometry.curves].normals.empty())
    context.reader.error(object.value(), "ribbons whose curves lack 'normals'");
  return true;
}

}  // namespace metamer
