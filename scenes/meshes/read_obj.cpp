#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

#include "scenes/gzip.h"
#include "scenes/meshes/read_mesh.h"

namespace metamer {
namespace {

// The loader takes "v nan x 1" for zeros and drops faces of unknown vertices, so the statements a mesh is made of are
// checked before it runs; that also gives mistakes their lines.
class ObjChecker {
 public:
  ObjChecker(std::string_view text, const std::string& path, Diagnostics& diagnostics)
      : text_(text), path_(path), diagnostics_(diagnostics) {}

  bool check() {
    const size_t errors_before = diagnostics_.error_count();
    each_statement([&](std::string_view word, std::string_view rest, const Counts&) {
      const int numbers = word == "v" || word == "vn" ? 3 : word == "vt" ? 1 : 0;
      if (numbers > 0) check_numbers(word, rest, numbers);
    });
    const Counts all = seen_;
    each_statement([&](std::string_view word, std::string_view rest, const Counts& before) {
      if (word == "f") check_face(rest, before, all);
    });
    if (all[0] == 0 || faces_ == 0) {
      diagnostics_.error({path_, 0}, all[0] == 0 ? "no vertex ('v x y z') in the file; expected an OBJ mesh"
                                                 : "no face ('f 1 2 3') in the file; points and lines are no surface");
    }
    return diagnostics_.error_count() == errors_before;
  }

 private:
  using Counts = std::array<int64_t, 3>;  // v, vt, vn

  template <class F>
  void each_statement(F&& f) {
    seen_ = {};
    line_ = 0;
    for (size_t at = 0; at < text_.size();) {
      const size_t end = std::min(text_.find_first_of("\r\n", at), text_.size());
      std::string_view rest = text_.substr(at, end - at);
      const bool is_pair = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
      at = end + (is_pair ? 2 : 1);
      ++line_;
      const std::string_view word = next_word(rest);
      f(word, rest, seen_);
      if (word == "v") ++seen_[0];
      if (word == "vt") ++seen_[1];
      if (word == "vn") ++seen_[2];
    }
  }

  static std::string_view next_word(std::string_view& rest) {
    const size_t begin = std::min(rest.find_first_not_of(" \t"), rest.size());
    const size_t end = std::min(rest.find_first_of(" \t", begin), rest.size());
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
  }

  void error(const std::string& message) { diagnostics_.error({path_, line_}, message); }

  void check_numbers(std::string_view statement, std::string_view rest, int required) {
    for (int i = 0;; ++i) {
      std::string_view word = next_word(rest);
      if (word.empty() || word[0] == '#') {
        if (i < required) error(fmt::format("'{}' with {} numbers; expected at least {}", statement, i, required));
        return;
      }
      if (word[0] == '+') word.remove_prefix(1);
      double value = 0;
      const auto [end, status] = std::from_chars(word.begin(), word.end(), value);
      const bool good = status == std::errc() && end == word.end();
      if (!good || !(std::abs(value) <= std::numeric_limits<float>::max())) {
        error(fmt::format("'{}' is not a finite number", word.substr(0, 40)));
        return;
      }
    }
  }

  // A corner is v, v/vt, v//vn or v/vt/vn; numbers count from 1, negative ones back from the last so far.
  void check_face(std::string_view rest, const Counts& before, const Counts& all) {
    ++faces_;
    constexpr std::string_view names[] = {"vertex", "uv", "normal"};
    int corners = 0;
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest), ++corners) {
      const char* at = word.begin();
      for (size_t part = 0; part < 3; ++part) {
        int64_t index = 0;
        const auto [end, status] = std::from_chars(at, word.end(), index);
        const bool skipped = part == 1 && end == at && end != word.end() && *end == '/';
        if (!skipped) {
          const bool in_range = index > 0 ? index <= all[part] : index < 0 && -index <= before[part];
          if (status != std::errc() || !in_range) {
            error(fmt::format("face corner '{}' names no {}; the file has {}", word.substr(0, 40), names[part],
                              all[part]));
            return;
          }
        }
        at = end;
        if (at == word.end()) break;
        if (*at != '/' || part == 2) {
          error(fmt::format("face corner '{}'; expected v, v/vt, v//vn or v/vt/vn", word.substr(0, 40)));
          return;
        }
        ++at;
      }
    }
    if (corners < 3) error(fmt::format("a face of {} corners; expected at least 3", corners));
  }

  std::string_view text_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  Counts seen_{};
  int64_t faces_ = 0;
  uint32_t line_ = 0;
};

struct CornerHash {
  size_t operator()(const std::array<int, 3>& corner) const {
    uint64_t hash = 0;
    for (const int index : corner) hash = (hash ^ static_cast<uint32_t>(index)) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 32);
  }
};

// One vertex for each distinct triple of indices. Corners without a normal in a file that has normals get their
// triangle's own.
class ObjMerger {
 public:
  ObjMerger(const tinyobj::attrib_t& attributes, Mesh& mesh) : attributes_(attributes), mesh_(mesh) {}

  void add_triangle(const tinyobj::index_t* corners) {
    const glm::vec3 a = position(corners[0]), b = position(corners[1]), c = position(corners[2]);
    const glm::vec3 face_normal = glm::cross(b - a, c - a);
    ++triangles_;
    for (int i = 0; i < 3; ++i) mesh_.indices.push_back(vertex(corners[i], face_normal));
  }

 private:
  glm::vec3 position(const tinyobj::index_t& corner) const {
    const float* v = attributes_.vertices.data() + 3 * static_cast<size_t>(corner.vertex_index);
    return {v[0], v[1], v[2]};
  }

  uint32_t vertex(const tinyobj::index_t& corner, const glm::vec3& face_normal) {
    const bool has_normals = !attributes_.normals.empty(), has_uvs = !attributes_.texcoords.empty();
    // Never shared between triangles: keys below -1 are no index.
    const int normal_key = has_normals && corner.normal_index < 0 ? -1 - triangles_ : corner.normal_index;
    const auto [found, is_new] = vertices_.try_emplace({corner.vertex_index, normal_key, corner.texcoord_index},
                                                       static_cast<uint32_t>(mesh_.positions.size()));
    if (!is_new) return found->second;
    mesh_.positions.push_back(position(corner));
    if (has_normals) {
      const float* n = attributes_.normals.data() + 3 * static_cast<size_t>(std::max(corner.normal_index, 0));
      mesh_.normals.push_back(corner.normal_index < 0 ? face_normal : glm::vec3(n[0], n[1], n[2]));
    }
    if (has_uvs) {
      const float* uv = attributes_.texcoords.data() + 2 * static_cast<size_t>(std::max(corner.texcoord_index, 0));
      mesh_.uvs.push_back(corner.texcoord_index < 0 ? glm::vec2(0) : glm::vec2(uv[0], uv[1]));
    }
    return found->second;
  }

  const tinyobj::attrib_t& attributes_;
  Mesh& mesh_;
  std::unordered_map<std::array<int, 3>, uint32_t, CornerHash> vertices_;
  int triangles_ = 0;
};

// The loader says "line 12" within its messages.
uint32_t line_in(const std::string& message) {
  const size_t at = message.find("line ");
  return at == std::string::npos ? 0 : static_cast<uint32_t>(std::strtoul(message.c_str() + at + 5, nullptr, 10));
}

// Comments blanked out: the loader takes one behind a face for another corner.
std::string without_comments(std::string_view text) {
  std::string result(text);
  for (size_t at = 0; (at = result.find('#', at)) != std::string::npos;)
    for (; at < result.size() && result[at] != '\n' && result[at] != '\r'; ++at) result[at] = ' ';
  return result;
}

}  // namespace

bool read_obj(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics) {
  FileBytes bytes;
  if (!read_packed_file(path, named_at, bytes, diagnostics)) return false;
  if (!ObjChecker(bytes.text(), path, diagnostics).check()) return false;
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(without_comments(bytes.text()), "", config)) {
    diagnostics.error({path, line_in(reader.Error())}, "not a valid OBJ mesh: " + reader.Error());
    return false;
  }
  mesh = Mesh{};
  mesh.name = path;
  ObjMerger merger(reader.GetAttrib(), mesh);
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    for (size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) merger.add_triangle(&shape.mesh.indices[i]);
  return validate_mesh(mesh, {path, 0}, diagnostics);
}

}  // namespace metamer
