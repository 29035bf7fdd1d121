#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/gzip.h"
#include "scenes/meshes/ply_source.h"
#include "scenes/meshes/read_mesh.h"

namespace metamer {
namespace {

using namespace ply;

constexpr size_t attribute_count = 8;  // x y z nx ny nz u v
constexpr size_t first_normal = 3, first_uv = 6;
constexpr uint64_t most_vertices = no_index - 1;

// The property of an element that carries a name, or -1.
int find_property(const Element& element, std::string_view name) {
  for (size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name) return static_cast<int>(i);
  return -1;
}

const Element* find_element(const Header& header, std::string_view name) {
  for (const Element& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

// Which attribute each property of the vertices is, attribute_count for none.
struct VertexLayout {
  std::vector<size_t> attribute_of_property;
  bool has_normals = false, has_uvs = false;
};

VertexLayout layout_of(const Element& vertices) {
  constexpr std::string_view positions[] = {"x", "y", "z"}, normals[] = {"nx", "ny", "nz"};
  constexpr std::string_view uv_pairs[][2] = {
      {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
  VertexLayout layout;
  layout.attribute_of_property.assign(vertices.properties.size(), attribute_count);
  const auto bind = [&](std::span<const std::string_view> names, size_t first) {
    for (const std::string_view name : names) {
      const int found = find_property(vertices, name);
      if (found < 0 || vertices.properties[static_cast<size_t>(found)].is_list) return false;
    }
    for (size_t i = 0; i < names.size(); ++i)
      layout.attribute_of_property[static_cast<size_t>(find_property(vertices, names[i]))] = first + i;
    return true;
  };
  bind(positions, 0);
  layout.has_normals = bind(normals, first_normal);
  for (const auto& pair : uv_pairs) layout.has_uvs = layout.has_uvs || bind(pair, first_uv);
  return layout;
}

// The first of many mistakes of one kind.
struct Mistakes {
  size_t count = 0;
  uint64_t first_row = 0;
  size_t first_offset = 0;
  double value = 0;
  void add(uint64_t row, size_t offset, double wrong) {
    if (count++ == 0) first_row = row, first_offset = offset, value = wrong;
  }
};

template <class Source>
class PlyReader {
 public:
  PlyReader(std::string_view file, const Header& header, const std::string& path, Mesh& mesh, Diagnostics& diagnostics)
      : file_(file), header_(header), path_(path), mesh_(mesh), diagnostics_(diagnostics), source_(file, header.end) {}

  bool read() {
    const Element* vertices = find_element(header_, "vertex");
    const Element* faces = find_element(header_, "face");
    vertex_count_ = vertices->count;
    const size_t errors_before = diagnostics_.error_count();
    int wanted = 2;
    for (const Element& element : header_.elements) {
      const bool done = &element == vertices ? read_vertices(element)
                        : &element == faces  ? read_faces(element)
                                             : skip_rows(element);
      if (!done) return false;
      if ((&element == vertices || &element == faces) && --wanted == 0) break;
    }
    report_mistakes();
    return diagnostics_.error_count() == errors_before;
  }

 private:
  bool is_ascii() const { return header_.format == Format::ascii; }
  // Binary rows have no lines: line 0, and the message counts rows.
  SourceLocation location(size_t offset) const { return {path_, is_ascii() ? line_of(file_, offset) : 0}; }

  bool stopped(const Element& element, uint64_t row) {
    const bool cut_short = source_.at_end() || !is_ascii();
    diagnostics_.error(
        location(source_.offset()),
        cut_short ? fmt::format("the file ends within {} {} of {}; it was cut short", element.name, row, element.count)
                  : fmt::format("expected a number in {} {}", element.name, row));
    return false;
  }

  // A list's count and whether its entries fit into the rest of the file.
  bool read_count(const Property& list, uint64_t& count) {
    double number;
    if (!source_.read(list.count_type, number)) return false;
    if (!(number >= 0 && number <= 0xffffffffu && number == std::floor(number))) return false;
    count = static_cast<uint64_t>(number);
    return source_.may_hold(list.type, count);
  }

  bool skip_property(const Property& property) {
    uint64_t count = 1;
    if (property.is_list && !read_count(property, count)) return false;
    return source_.skip(property.type, count);
  }

  bool skip_rows(const Element& element) {
    if (element.properties.empty()) return true;
    for (uint64_t row = 0; row < element.count; ++row)
      for (const Property& property : element.properties)
        if (!skip_property(property)) return stopped(element, row);
    return true;
  }

  bool read_vertices(const Element& element) {
    const VertexLayout layout = layout_of(element);
    mesh_.positions.resize(element.count);
    if (layout.has_normals) mesh_.normals.resize(element.count);
    if (layout.has_uvs) mesh_.uvs.resize(element.count);
    for (uint64_t row = 0; row < element.count; ++row) {
      const size_t begin = source_.offset();
      std::array<float, attribute_count + 1> values{};
      for (size_t i = 0; i < element.properties.size(); ++i) {
        const size_t attribute = layout.attribute_of_property[i];
        double value = 0;
        const bool done = attribute == attribute_count ? skip_property(element.properties[i])
                                                       : source_.read(element.properties[i].type, value);
        if (!done) return stopped(element, row);
        values[attribute] = static_cast<float>(value);
        if (!(std::abs(values[attribute]) <= std::numeric_limits<float>::max())) not_finite_.add(row, begin, value);
      }
      mesh_.positions[row] = {values[0], values[1], values[2]};
      if (layout.has_normals) mesh_.normals[row] = {values[3], values[4], values[5]};
      if (layout.has_uvs) mesh_.uvs[row] = {values[6], values[7]};
    }
    return true;
  }

  bool read_faces(const Element& element) {
    const int named = find_property(element, "vertex_indices");
    const size_t list_index = static_cast<size_t>(named >= 0 ? named : find_property(element, "vertex_index"));
    const Property& list = element.properties[list_index];
    // No more triangles than the rest of the file could hold.
    const uint64_t triangle_bytes = is_ascii() ? 8 : size_of(list.count_type) + 3 * size_of(list.type);
    mesh_.indices.reserve(3 * std::min<uint64_t>(element.count, (file_.size() - source_.offset()) / triangle_bytes));
    for (uint64_t row = 0; row < element.count; ++row) {
      for (size_t i = 0; i < element.properties.size(); ++i) {
        const bool done = i == list_index ? read_polygon(list, row) : skip_property(element.properties[i]);
        if (!done) return stopped(element, row);
      }
    }
    return true;
  }

  bool read_polygon(const Property& list, uint64_t row) {
    const size_t begin = source_.offset();
    uint64_t corners;
    if (!read_count(list, corners)) return false;
    if (corners < 3) too_few_corners_.add(row, begin, static_cast<double>(corners));
    uint32_t first = 0, previous = 0;
    for (uint64_t corner = 0; corner < corners; ++corner) {
      uint32_t index;
      if (!read_index(list.type, row, begin, index)) return false;
      if (corner == 0) first = index;
      if (corner >= 2) {
        const size_t at = mesh_.indices.size();
        mesh_.indices.resize(at + 3);
        mesh_.indices[at] = first;
        mesh_.indices[at + 1] = previous;
        mesh_.indices[at + 2] = index;
      }
      previous = index;
    }
    return true;
  }

  bool read_index(Type type, uint64_t row, size_t row_begin, uint32_t& index) {
    double value;
    if (!source_.read(type, value)) return false;
    const bool good = value >= 0 && value < static_cast<double>(vertex_count_) && value == std::floor(value);
    if (!good) bad_index_.add(row, row_begin, value);
    index = good ? static_cast<uint32_t>(value) : 0;
    return true;
  }

  void report_mistakes() {
    const auto more = [](const Mistakes& mistakes) {
      return mistakes.count > 1 ? fmt::format(" (and {} more of this kind)", mistakes.count - 1) : std::string();
    };
    if (not_finite_.count > 0) {
      diagnostics_.error(location(first_of(not_finite_)),
                         fmt::format("vertex {}: {} is not a finite number in single precision{}",
                                     not_finite_.first_row, not_finite_.value, more(not_finite_)));
    }
    if (bad_index_.count > 0) {
      diagnostics_.error(
          location(first_of(bad_index_)),
          fmt::format("face {} names vertex {}, but the file has {} vertices, 0 to {}{}", bad_index_.first_row,
                      bad_index_.value, vertex_count_, static_cast<int64_t>(vertex_count_) - 1, more(bad_index_)));
    }
    if (too_few_corners_.count > 0) {
      diagnostics_.warning(location(first_of(too_few_corners_)),
                           fmt::format("face {} has {} corners and is left out{}", too_few_corners_.first_row,
                                       too_few_corners_.value, more(too_few_corners_)));
    }
  }

  // A text row begins after the end of the line before it.
  size_t first_of(const Mistakes& mistakes) const {
    const size_t begin = file_.find_first_not_of(" \t\r\n\v\f", mistakes.first_offset);
    return std::min(begin, file_.size());
  }

  std::string_view file_;
  const Header& header_;
  const std::string& path_;
  Mesh& mesh_;
  Diagnostics& diagnostics_;
  Source source_;
  uint64_t vertex_count_ = 0;
  Mistakes not_finite_, bad_index_, too_few_corners_;
};

// Whether the header names what a mesh needs.
bool check_elements(const Header& header, const std::string& path, Diagnostics& diagnostics) {
  const size_t errors_before = diagnostics.error_count();
  const Element* vertices = find_element(header, "vertex");
  const Element* faces = find_element(header, "face");
  if (vertices == nullptr) diagnostics.error({path, 0}, "the header declares no element 'vertex'");
  if (faces == nullptr) {
    diagnostics.error({path, 0}, find_element(header, "tristrips") != nullptr
                                     ? "triangle strips ('tristrips') are not supported; expected an element 'face'"
                                     : "the header declares no element 'face'; a point cloud is not a surface");
  }
  if (vertices != nullptr) {
    for (const std::string_view name : {"x", "y", "z"}) {
      const int found = find_property(*vertices, name);
      if (found < 0 || vertices->properties[static_cast<size_t>(found)].is_list)
        diagnostics.error({path, vertices->line}, fmt::format("element 'vertex' has no number '{}'", name));
    }
    if (vertices->count > most_vertices)
      diagnostics.error({path, vertices->line}, fmt::format("more than {} vertices", most_vertices));
  }
  if (faces != nullptr) {
    int list = find_property(*faces, "vertex_indices");
    if (list < 0) list = find_property(*faces, "vertex_index");
    if (list < 0 || !faces->properties[static_cast<size_t>(list)].is_list)
      diagnostics.error({path, faces->line}, "element 'face' has no list 'vertex_indices'");
  }
  return diagnostics.error_count() == errors_before;
}

}  // namespace

bool read_ply(const std::string& path, const SourceLocation& named_at, Mesh& mesh, Diagnostics& diagnostics) {
  FileBytes bytes;
  return read_packed_file(path, named_at, bytes, diagnostics) && read_ply_text(bytes.text(), path, mesh, diagnostics);
}

bool read_ply_text(std::string_view file, const std::string& path, Mesh& mesh, Diagnostics& diagnostics) {
  const std::optional<Header> header = parse_header(file, path, diagnostics);
  if (!header || !check_elements(*header, path, diagnostics)) return false;
  mesh = Mesh{};
  mesh.name = path;
  switch (header->format) {
    case Format::ascii: return PlyReader<AsciiSource>(file, *header, path, mesh, diagnostics).read();
    case Format::binary_little_endian:
      return PlyReader<BinarySource<std::endian::little>>(file, *header, path, mesh, diagnostics).read();
    case Format::binary_big_endian:
      return PlyReader<BinarySource<std::endian::big>>(file, *header, path, mesh, diagnostics).read();
  }
  return false;
}

}  // namespace metamer
