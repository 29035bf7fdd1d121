#include "systems/build_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "engine/simd/portable_math.h"

namespace metamer {
namespace {

constexpr int most_segments = 128;  // Embree takes 129 keys

glm::dmat4 from_rows(const glm::vec4& row0, const glm::vec4& row1, const glm::vec4& row2) {
  return glm::transpose(glm::dmat4(glm::dvec4(row0), glm::dvec4(row1), glm::dvec4(row2), glm::dvec4(0, 0, 0, 1)));
}

// The rotation of a matrix: Higham's iteration, towards the mean of the matrix and its inverse transpose.
glm::dmat3 rotation_of(const glm::dmat3& m) {
  glm::dmat3 r = m;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 next = 0.5 * (r + glm::inverse(glm::transpose(r)));
    double change = 0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - r[c]));
    r = next;
    if (change < 1e-14) break;
  }
  return r;
}

// Of a proper rotation, by its largest component (S. W. Shepperd, J. Guidance and Control 1(3), 1978).
glm::dvec4 quaternion_of(const glm::dmat3& m) {
  const double trace = m[0][0] + m[1][1] + m[2][2];
  glm::dvec4 q;  // x y z w
  if (trace > 0) {
    q = {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0], 1 + trace};
    return glm::normalize(q);
  }
  const int i = m[0][0] > m[1][1] ? (m[0][0] > m[2][2] ? 0 : 2) : (m[1][1] > m[2][2] ? 1 : 2);
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  q[i] = 1 + m[i][i] - m[j][j] - m[k][k];
  q[j] = m[j][i] + m[i][j];
  q[k] = m[k][i] + m[i][k];
  q.w = m[j][k] - m[k][j];
  return glm::normalize(q);
}

glm::dmat3 matrix_of(const glm::dvec4& q) {
  const glm::dvec3 v(q);
  glm::dmat3 m;
  for (int c = 0; c < 3; ++c) {
    glm::dvec3 e(0.0);
    e[c] = 1;
    m[c] = e + 2.0 * glm::cross(v, glm::cross(v, e) + q.w * e);
  }
  return m;
}

// K. Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985; along the shorter of the two arcs.
glm::dvec4 slerp(const glm::dvec4& from, glm::dvec4 to, double t) {
  if (glm::dot(from, to) < 0) to = -to;
  const glm::dvec4 across = to - from * glm::dot(from, to);
  const double sine = glm::length(across);
  if (!(sine > 1e-12)) return from;
  const double angle = portable::atan2(sine, glm::dot(from, to)) * t;
  return portable::cos(angle) * from + (portable::sin(angle) / sine) * across;
}

// One entity of a chain of parents.
struct Link {
  glm::dmat4 still;
  bool moves = false;
  MotionParts start, end;
  double start_time = 0, end_time = 1;

  glm::dmat4 at(double time) const {
    if (!moves || time <= start_time) return still;
    return interpolated(start, end, std::min((time - start_time) / (end_time - start_time), 1.0));
  }
};

Link link_of(const Registry& registry, Entity entity) {
  const Transform t = registry.get<Transform>(entity);
  Link link;
  link.still = from_rows(t.row0, t.row1, t.row2);
  if (!registry.has<Motion>(entity)) return link;
  const Motion motion = registry.get<Motion>(entity);
  link.moves = true;
  link.start = motion_parts(link.still);
  link.end = motion_parts(from_rows(motion.row0, motion.row1, motion.row2));
  link.start_time = double{motion.start_time};
  link.end_time = double{motion.end_time};
  return link;
}

class Path {
 public:
  Path(const Scene& scene, Entity entity) : open_(scene.settings.shutter_open), close_(scene.settings.shutter_close) {
    const Registry& registry = scene.registry;
    // A cycle of parents is reported by build_transforms.
    for (size_t n = 0; !entity.is_null() && n < registry.entity_count(); ++n) {
      links_.push_back(link_of(registry, entity));
      entity = registry.get<Parent>(entity).entity;
    }
  }
  bool has_motion() const {
    return std::any_of(links_.begin(), links_.end(), [](const Link& link) { return link.moves; });
  }
  // `u` is 0 as the shutter opens, 1 as it closes.
  glm::dmat4 at(double u) const {
    glm::dmat4 product(1.0);
    for (size_t i = links_.size(); i-- > 0;) product = product * links_[i].at(open_ + u * (close_ - open_));
    return product;
  }

 private:
  std::vector<Link> links_;
  double open_, close_;
};

double largest_difference(const glm::dmat4& a, const glm::dmat4& b, int first_column, int end_column) {
  double largest = 0;
  for (int c = first_column; c < end_column; ++c)
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
  return largest;
}

std::vector<glm::dmat4> keys_of(const Path& path, int segments) {
  std::vector<glm::dmat4> keys;
  for (int i = 0; i <= segments; ++i) keys.push_back(path.at(static_cast<double>(i) / segments));
  return keys;
}

// Whether lines between the keys follow the path: compared where curves are farthest from their chords, and off the
// middle.
bool follows(const std::vector<glm::dmat4>& keys, const Path& path) {
  double way = 0, size = 0;
  for (const glm::dmat4& key : keys) {
    way = std::max(way, largest_difference(key, keys.front(), 3, 4));
    size = std::max(size, largest_difference(key, glm::dmat4(0.0), 0, 3));
  }
  const double segments = static_cast<double>(keys.size() - 1);
  for (size_t i = 0; i + 1 < keys.size(); ++i)
    for (const double t : {0.25, 0.5, 0.8}) {
      const glm::dmat4 line = keys[i] * (1 - t) + keys[i + 1] * t,
                       true_one = path.at((static_cast<double>(i) + t) / segments);
      if (largest_difference(line, true_one, 0, 3) > motion_tolerance * size) return false;
      if (largest_difference(line, true_one, 3, 4) > motion_tolerance * std::max(way, size)) return false;
    }
  return true;
}

bool is_flat(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const double edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return !(std::abs(glm::determinant(linear)) > 1e-9 * edges);
}

}  // namespace

MotionParts motion_parts(const glm::dmat4& matrix) {
  const glm::dmat3 linear(matrix);
  const double sign = glm::determinant(linear) < 0 ? -1 : 1;
  const glm::dmat3 rotation = rotation_of(sign * linear);
  const glm::dvec4 q = quaternion_of(rotation);
  return {glm::dvec3(matrix[3]), {q.x, q.y, q.z, q.w}, glm::transpose(rotation) * linear};
}

glm::dmat4 interpolated(const MotionParts& from, const MotionParts& to, double t) {
  const auto quaternion = [](const double(&q)[4]) { return glm::dvec4(q[0], q[1], q[2], q[3]); };
  const glm::dmat3 rotation = matrix_of(slerp(quaternion(from.rotation), quaternion(to.rotation), t));
  glm::dmat4 matrix(rotation * (from.stretch * (1 - t) + to.stretch * t));
  matrix[3] = glm::dvec4(from.translation * (1 - t) + to.translation * t, 1.0);
  return matrix;
}

std::vector<glm::dmat4> motion_keys(const Scene& scene, Entity entity, Diagnostics& diagnostics) {
  if (scene.registry.table<Motion>().size() == 0) return {};
  const Path path(scene, entity);
  if (!path.has_motion()) return {};
  std::vector<glm::dmat4> keys = keys_of(path, 1);
  for (int segments = 2; segments <= most_segments && !follows(keys, path); segments *= 2)
    keys = keys_of(path, segments);
  if (std::any_of(keys.begin(), keys.end(), is_flat)) {
    diagnostics.error(
        scene.location(entity),
        fmt::format("{} is flattened while it moves: its motion turns it inside out", scene.describe(entity)));
    return {};
  }
  const bool stands = std::all_of(keys.begin(), keys.end(), [&](const glm::dmat4& key) { return key == keys.front(); });
  if (stands && keys.front() == path.at(-1e30)) return {};
  return keys;
}

Place place_of(const Scene& scene, Entity entity, const glm::dmat4& to_world, Diagnostics& diagnostics) {
  Place place{to_world, motion_keys(scene, entity, diagnostics)};
  if (!place.moves()) return place;
  if (scene.registry.has<Light>(entity)) {
    diagnostics.warning(scene.location(entity),
                        fmt::format("{} emits light and does not move: lights stand as at the start of their motion",
                                    scene.describe(entity)));
    return {to_world, {}};
  }
  place.to_world = place.keys.front();
  return place;
}

void add_motion(World& world, const Place& place) {
  world.objects.first_key.push_back(static_cast<uint32_t>(world.motion_keys.size()));
  world.objects.key_count.push_back(static_cast<uint32_t>(place.keys.size()));
  if (place.moves()) world.has_motion = true;
  for (const glm::dmat4& matrix : place.keys) {
    MotionKey key;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        key.to_world[row * 4 + column] = static_cast<float>(matrix[column][row]);
    world.motion_keys.push_back(key);
  }
}

}  // namespace metamer
