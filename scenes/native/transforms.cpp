#include "scenes/native/transforms.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <numbers>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

constexpr std::string_view operations[] = {"matrix", "translate", "rotate", "scale", "look_at"};

// Exact at multiples of 90 degrees.
struct SinCos {
  double sin, cos;
};
SinCos sin_cos_degrees(double degrees) {
  const double within_turn = std::fmod(degrees, 360.0);
  const double quarter = std::round(within_turn / 90.0);
  const double radians = (within_turn - 90.0 * quarter) * (std::numbers::pi / 180.0);
  const double s = portable::sin(radians), c = portable::cos(radians);
  switch ((static_cast<int>(quarter) + 4) % 4) {
    case 1: return {c, -s};
    case 2: return {-s, -c};
    case 3: return {-c, s};
    default: return {s, c};
  }
}

glm::dmat4 from_columns(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z, const glm::dvec3& origin) {
  return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(origin, 1)};
}

// The direction of a vector whose length neither over- nor underflows; zero has none.
std::optional<glm::dvec3> direction(const glm::dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0)) return std::nullopt;
  return glm::normalize(v / largest);
}

// Rodrigues' formula, counter-clockwise seen against the axis.
glm::dmat4 rotation(const glm::dvec3& k, double degrees) {
  const auto [s, c] = sin_cos_degrees(degrees);
  const auto turned = [&, sine = s, cosine = c](const glm::dvec3& v) {
    return v * cosine + glm::cross(k, v) * sine + k * (glm::dot(k, v) * (1 - cosine));
  };
  return from_columns(turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {0, 0, 0});
}

glm::dmat4 read_rotate(const SceneContext& context, const Json::Value& value) {
  const JsonReader& reader = context.reader;
  const JsonObject object(reader, value, *find_object_spec("rotate"), "rotate");
  const double degrees = object.number("degrees", any_number, 0);
  if (!object.has("axis")) return glm::dmat4(1);
  const auto axis = direction(reader.vector(*object.find("axis"), "axis", {0, 0, 1}));
  if (!axis) reader.error(*object.find("axis"), "'axis' is zero; expected a direction");
  return axis ? rotation(*axis, degrees) : glm::dmat4(1);
}

glm::dmat4 read_look_at(const SceneContext& context, const Json::Value& value) {
  const JsonReader& reader = context.reader;
  const JsonObject object(reader, value, *find_object_spec("look_at"), "look_at");
  const auto vector = [&](std::string_view key, const glm::dvec3& fallback) {
    return object.has(key) ? reader.vector(*object.find(key), key, fallback) : fallback;
  };
  const glm::dvec3 from = vector("from", {0, 0, 0}), to = vector("to", {0, 0, -1}), up = vector("up", {0, 1, 0});
  const auto backwards = direction(from - to), upwards = direction(up);
  if (!backwards) reader.error(value, "'from' and 'to' are the same point; expected two");
  if (!upwards) reader.error(value, "'up' is zero; expected a direction");
  if (!backwards || !upwards) return glm::dmat4(1);
  const glm::dvec3 across = glm::cross(*upwards, *backwards);
  if (!(glm::length(across) > 1e-6)) {
    reader.error(value, "'up' is parallel to the direction from 'from' to 'to'; expected another direction");
    return glm::dmat4(1);
  }
  const glm::dvec3 right = glm::normalize(across);
  return from_columns(right, glm::cross(*backwards, right), *backwards, from * context.metres_per_unit);
}

glm::dmat4 read_matrix(const SceneContext& context, const Json::Value& value) {
  glm::dmat4 matrix(1);
  if (!value.isArray() || value.size() != 3) {
    context.reader.expected(value, "matrix", "three rows of four numbers");
    return matrix;
  }
  for (Json::ArrayIndex row = 0; row < 3; ++row) {
    std::array<double, 4> numbers{};
    numbers[row] = 1;
    context.reader.numbers(value[row], "matrix", any_number, numbers);
    for (int column = 0; column < 3; ++column)
      matrix[column][static_cast<int>(row)] = numbers[static_cast<size_t>(column)];
    matrix[3][static_cast<int>(row)] = numbers[3] * context.metres_per_unit;
  }
  return matrix;
}

glm::dmat4 read_scale(const SceneContext& context, const Json::Value& value) {
  if (value.isNumeric()) {
    const double factor = context.reader.number(value, "scale", any_number, 1);
    return from_columns({factor, 0, 0}, {0, factor, 0}, {0, 0, factor}, {0, 0, 0});
  }
  if (!value.isArray()) {
    context.reader.expected(value, "scale", "a number or an array of 3 numbers");
    return glm::dmat4(1);
  }
  const glm::dvec3 factors = context.reader.vector(value, "scale", {1, 1, 1});
  return from_columns({factors.x, 0, 0}, {0, factors.y, 0}, {0, 0, factors.z}, {0, 0, 0});
}

glm::dmat4 read_operation(const SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, *find_object_spec("transform"), "a transform");
  const std::string_view operation = object.one_of(operations);
  if (operation.empty()) return glm::dmat4(1);
  const Json::Value& argument = *object.find(operation);
  if (operation == "matrix") return read_matrix(context, argument);
  if (operation == "rotate") return read_rotate(context, argument);
  if (operation == "scale") return read_scale(context, argument);
  if (operation == "look_at") return read_look_at(context, argument);
  const glm::dvec3 offset = context.reader.vector(argument, operation, {0, 0, 0}) * context.metres_per_unit;
  return from_columns({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, offset);
}

Transform to_component(const glm::dmat4& m) {
  const auto row = [&](int i) { return glm::vec4(m[0][i], m[1][i], m[2][i], m[3][i]); };
  return {row(0), row(1), row(2)};
}

// Whether the matrix, as single precision holds it, can be inverted; the columns' lengths do not matter.
bool check_invertible(const SceneContext& context, const Json::Value& at, const glm::dmat4& m) {
  glm::dmat3 directions;
  for (int column = 0; column < 4; ++column) {
    const glm::dvec3 v{glm::vec3(m[column])};
    if (!(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= largest_float)) {
      context.reader.error(at, "the transform is beyond single precision");
      return false;
    }
    if (column == 3) continue;
    const auto unit = direction(v);
    directions[column] = unit.value_or(glm::dvec3(0));
  }
  if (std::abs(glm::determinant(directions)) > 1e-10) return true;
  context.reader.error(at, "the transform is singular: it flattens everything; expected one that can be inverted");
  return false;
}

}  // namespace

Transform read_transform(const SceneContext& context, const Json::Value* value) {
  if (value == nullptr) return {};
  const JsonReader& reader = context.reader;
  const bool is_list = value->isArray();
  if (!is_list && !value->isObject()) {
    reader.expected(*value, "transform", "an operation such as {\"translate\": [0, 1, 0]}, or an array of them");
    return {};
  }
  const size_t errors_before = reader.diagnostics().error_count();
  glm::dmat4 total(1);
  bool is_good = true;
  for (Json::ArrayIndex i = 0; i < (is_list ? value->size() : 1); ++i) {
    const Json::Value& item = is_list ? (*value)[i] : *value;
    const glm::dmat4 operation = read_operation(context, item);
    total = i == 0 ? operation : operation * total;  // a product would turn -0 into 0
    is_good = is_good && check_invertible(context, item, total);
  }
  return reader.diagnostics().error_count() == errors_before ? to_component(total) : Transform{};
}

glm::dvec2 read_times(const JsonReader& reader, const Json::Value& value, std::string_view what) {
  constexpr Range seconds{-1e6, 1e6};
  std::array<double, 2> times{0, 1};
  if (!reader.numbers(value, what, seconds, times)) return {0, 1};
  if (static_cast<float>(times[0]) < static_cast<float>(times[1])) return {times[0], times[1]};
  reader.expected(value, what, "[first, second] in seconds, the second after the first");
  return {0, 1};
}

Motion read_motion(const SceneContext& context, const Json::Value& value) {
  const JsonObject object(context.reader, value, *find_object_spec("motion"), "motion");
  Motion motion;
  if (!object.is_valid()) return motion;
  const Transform end = read_transform(context, object.find("end"));
  motion.row0 = end.row0;
  motion.row1 = end.row1;
  motion.row2 = end.row2;
  if (const Json::Value* times = object.find("times")) {
    const glm::dvec2 seconds = read_times(context.reader, *times, "times");
    motion.start_time = static_cast<float>(seconds.x);
    motion.end_time = static_cast<float>(seconds.y);
  }
  return motion;
}

Transform mirrored_z(const Transform& then) {
  Transform result = then;
  for (glm::vec4* row : {&result.row0, &result.row1, &result.row2}) row->z = -row->z;
  return result;
}

Transform then_mirrored_z(const Transform& first) {
  Transform result = first;
  result.row2 = -result.row2;
  return result;
}

}  // namespace metamer
