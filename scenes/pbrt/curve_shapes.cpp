#include "scenes/pbrt/curve_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/simd/portable_math.h"

namespace metamer::pbrt {
namespace {

constexpr std::string_view type_names[] = {"flat", "ribbon", "cylinder"};
constexpr ShapeKind types[] = {ShapeKind::flat_curves, ShapeKind::ribbons, ShapeKind::round_curves};
constexpr std::string_view basis_names[] = {"bezier", "bspline"};

// The index of a string parameter's value among the words; nothing after reporting that it is none of them.
std::optional<size_t> choose(Parameters& parameters, std::string_view name, std::span<const std::string_view> words) {
  const std::string value = parameters.string(name, words[0]);
  const auto found = std::find(words.begin(), words.end(), value);
  if (found != words.end()) return static_cast<size_t>(found - words.begin());
  parameters.error(name, fmt::format("'{}' is \"{}\"; expected one of {}{}", name, value, fmt::join(words, ", "),
                                     did_you_mean(value, words)));
  return std::nullopt;
}

// How many segments so many control points make; 0 after reporting that they make none.
size_t segment_count(Parameters& parameters, size_t points, size_t degree, bool is_spline) {
  const bool fits = points > degree && (is_spline || (points - 1) % degree == 0);
  if (fits) return is_spline ? points - degree : (points - 1) / degree;
  const std::string expected = is_spline ? fmt::format("at least {}", degree + 1)
                                         : fmt::format("{} and a multiple of {} more", degree + 1, degree);
  parameters.error("P", fmt::format("{} control points; a {} of degree {} takes {}", points, basis_names[is_spline],
                                    degree, expected));
  return 0;
}

using Segment = std::array<glm::dvec3, 4>;  // of a cubic Bezier curve

Segment elevated(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return {a, (a + 2.0 * b) / 3.0, (2.0 * b + c) / 3.0, c};
}
Segment segment_of(const glm::dvec3* p, size_t degree, bool is_spline) {
  if (degree == 2)
    return is_spline ? elevated((p[0] + p[1]) / 2.0, p[1], (p[1] + p[2]) / 2.0) : elevated(p[0], p[1], p[2]);
  if (!is_spline) return {p[0], p[1], p[2], p[3]};
  return {(p[0] + 4.0 * p[1] + p[2]) / 6.0, (2.0 * p[1] + p[2]) / 3.0, (p[1] + 2.0 * p[2]) / 3.0,
          (p[1] + 4.0 * p[2] + p[3]) / 6.0};
}

// Directions that turn evenly from one unit vector to another, as pbrt's normals do: the Bezier curve with the arc's
// ends and derivatives there.
Segment turning(const glm::dvec3& a, const glm::dvec3& b) {
  const double cos = glm::dot(a, b), sin = glm::length(glm::cross(a, b));
  const double speed = sin > 1e-6 ? portable::atan2(sin, cos) / sin : 1;
  return {a, a + speed / 3 * (b - cos * a), b - speed / 3 * (cos * b - a), b};
}

struct Fibre {
  ShapeKind kind = ShapeKind::flat_curves;
  std::vector<Segment> segments, normals;
  double first_width = 1, last_width = 1;
};

std::vector<glm::dvec3> vectors(std::span<const double> numbers) {
  std::vector<glm::dvec3> result(numbers.size() / 3);
  for (size_t i = 0; i < result.size(); ++i) result[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return result;
}

void read_ribbon_normals(Parameters& parameters, Fibre& fibre) {
  std::vector<glm::dvec3> normals = vectors(parameters.array("N", ParameterType::normal, 3));
  const size_t wanted = fibre.segments.size() + 1;
  if (fibre.kind != ShapeKind::ribbons) {
    if (!normals.empty()) {
      parameters.messages().warning_once("curve normals", parameters.source(),
                                         "Shape \"curve\": 'N' means nothing but for the type \"ribbon\"");
    }
    return;
  }
  if (normals.size() != wanted) {
    return parameters.error("N", fmt::format("{} normals for a ribbon of {} segments; expected {}", normals.size(),
                                             fibre.segments.size(), wanted));
  }
  for (glm::dvec3& n : normals) {
    if (!(glm::length(n) > 0)) return parameters.error("N", "a normal of length 0");
    n = glm::normalize(n);
  }
  for (size_t i = 0; i + 1 < wanted; ++i) fibre.normals.push_back(turning(normals[i], normals[i + 1]));
}

std::optional<Fibre> read_fibre(Parameters& parameters) {
  const size_t errors = parameters.messages().diagnostics.error_count();
  Fibre fibre;
  const auto type = choose(parameters, "type", type_names), basis = choose(parameters, "basis", basis_names);
  const int degree = parameters.integer("degree", 3, 2);
  if (degree > 3) parameters.error("degree", fmt::format("'degree' is {}; expected 2 or 3", degree));
  const double width = parameters.number_from("width", 1, 0);
  fibre.first_width = parameters.number_from("width0", width, 0);
  fibre.last_width = parameters.number_from("width1", width, 0);
  parameters.integer("splitdepth", 3, 0);  // how pbrt builds its tree
  const std::vector<glm::dvec3> points = vectors(parameters.array("P", ParameterType::point3, 3));
  if (!parameters.has("P")) parameters.error("P", "'P', the control points, is missing");
  if (parameters.messages().diagnostics.error_count() != errors) return std::nullopt;
  fibre.kind = types[*type];
  const bool is_spline = *basis == 1;
  const auto step = static_cast<size_t>(degree);
  const size_t count = segment_count(parameters, points.size(), step, is_spline);
  for (size_t i = 0; i < count; ++i)
    fibre.segments.push_back(segment_of(&points[i * (is_spline ? 1 : step)], step, is_spline));
  if (count > 0) read_ribbon_normals(parameters, fibre);
  if (parameters.messages().diagnostics.error_count() != errors) return std::nullopt;
  return fibre;
}

void append(const Fibre& fibre, Curves& curves) {
  const auto count = static_cast<double>(fibre.segments.size());
  const auto add = [&](size_t segment, size_t k) {
    const double along = (static_cast<double>(segment) + static_cast<double>(k) / 3) / count;
    const double width = fibre.first_width + along * (fibre.last_width - fibre.first_width);
    curves.points.push_back(glm::vec4(glm::dvec4(fibre.segments[segment][k], width / 2)));
    if (!fibre.normals.empty()) curves.normals.push_back(glm::vec3(fibre.normals[segment][k]));
  };
  add(0, 0);
  for (size_t segment = 0; segment < fibre.segments.size(); ++segment) {
    curves.segments.push_back(static_cast<uint32_t>(curves.points.size() - 1));
    for (size_t k = 1; k < 4; ++k) add(segment, k);
  }
}

}  // namespace

std::optional<Geometry> read_curve(Reader& reader, Parameters& parameters, TextureId alpha) {
  const std::optional<Fibre> fibre = read_fibre(parameters);
  if (!fibre) return std::nullopt;
  std::optional<OpenCurves>& open = reader.open_curves;
  const bool joins = open && open->kind == fibre->kind && open->alpha == alpha && open->object == reader.object &&
                     is_shaped_alike(open->state, reader.state);
  if (!joins) {
    open =
        OpenCurves{static_cast<CurvesId>(reader.scene.curves.size()), fibre->kind, alpha, reader.object, reader.state};
    reader.scene.curves.emplace_back().name =
        fmt::format("{}:{}", reader.scene.names[parameters.source().file], parameters.source().line);
  }
  append(*fibre, reader.scene.curves[open->id]);
  if (joins) return std::nullopt;
  return Geometry{.kind = fibre->kind, .curves = open->id};
}

}  // namespace metamer::pbrt
