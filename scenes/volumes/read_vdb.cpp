// OpenVDB itself trusts its files: lengths of texts that a file states are allocated before they are read, and reads
// beyond the end go unnoticed. So everything up to the trees is walked here first with every length checked, and the
// stream throws at its end.
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <fstream>

#include "scenes/volumes/bricks.h"
#include "scenes/volumes/read_grids.h"

namespace metamer {
namespace {

// What stands in front of each grid.
struct Entry {
  std::string name, type, parent;
  int64_t start = 0, grid = 0, blocks = 0, next = 0;  // places in the file
};

class VdbFile : private openvdb::io::Archive {
 public:
  explicit VdbFile(const std::string& path) {
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    stream_.open(path, std::ios::binary);
    stream_.seekg(0, std::ios::end);
    size_ = stream_.tellg();
    stream_.seekg(0);
    read_start();
  }

  const std::vector<std::string>& names() const { return names_; }
  const Entry& entry(size_t i) const { return entries_[i]; }

  // The grid with its tree; one that shares the tree of another is given that.
  openvdb::GridBase::Ptr read(size_t i) {
    const Entry& entry = entries_[i];
    openvdb::GridBase::Ptr grid = read_entry(entry);
    if (entry.parent.empty()) return grid;
    for (const Entry& other : entries_)
      if (other.name == entry.parent && other.type == entry.type && other.parent.empty()) {
        grid->setTree(read_entry(other)->baseTreePtr());
        return grid;
      }
    throw GridError(fmt::format("the file is damaged: it has no grid '{}' to share voxels with", entry.parent));
  }

 private:
  template <class T>
  T number() {
    T x;
    stream_.read(reinterpret_cast<char*>(&x), sizeof(x));
    return x;
  }
  void skip(uint64_t bytes) {
    if (bytes > static_cast<uint64_t>(size_ - stream_.tellg())) throw GridError("the file is cut short or damaged");
    stream_.seekg(static_cast<int64_t>(bytes), std::ios::cur);
  }
  std::string text() {
    const auto length = number<uint32_t>();
    const std::streampos at = stream_.tellg();
    skip(length);
    stream_.seekg(at);
    std::string s(length, '\0');
    stream_.read(s.data(), length);
    return s;
  }
  // Names, types and values, as MetaMap writes them.
  void skip_metadata() {
    const auto count = number<uint32_t>();
    for (uint32_t i = 0; i < count; ++i) {
      skip(number<uint32_t>());
      skip(number<uint32_t>());
      skip(number<uint32_t>());
    }
  }
  void read_start() {
    constexpr uint32_t newest = openvdb::OPENVDB_FILE_VERSION;
    number<int64_t>();
    if (const auto version = number<uint32_t>(); version > newest)
      throw GridError(fmt::format("its format is version {}; expected {} or earlier", version, newest));
    stream_.seekg(0);
    readHeader(stream_);
    if (!inputHasGridOffsets()) throw GridError("it was written as a stream without a table of its grids");
    skip_metadata();
    const auto count = number<int32_t>();
    for (int32_t i = 0; i < count; ++i) {
      Entry entry;
      entry.start = stream_.tellg();
      const std::string unique_name = text();
      entry.name = openvdb::io::GridDescriptor::stripSuffix(unique_name);
      entry.type = text();
      entry.parent = openvdb::io::GridDescriptor::stripSuffix(text());
      entry.grid = number<int64_t>();
      entry.blocks = number<int64_t>();
      entry.next = number<int64_t>();
      if (entry.grid != stream_.tellg() || entry.next < entry.grid || entry.next > size_)
        throw GridError("the file is cut short or damaged");
      stream_.seekg(entry.next);
      names_.push_back(entry.name);
      entries_.push_back(std::move(entry));
    }
  }

  openvdb::GridBase::Ptr read_entry(const Entry& entry) {
    stream_.clear();
    stream_.seekg(entry.start);
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid = descriptor.read(stream_);
    descriptor.setGridPos(entry.grid);
    descriptor.setBlockPos(entry.blocks);
    descriptor.setEndPos(entry.next);
    stream_.seekg(entry.grid);
    number<uint32_t>();  // compression
    skip_metadata();
    skip(number<uint32_t>());  // the kind of transform
    stream_.seekg(entry.grid);
    setFormatVersion(stream_);
    setLibraryVersion(stream_);
    if (entry.parent.empty()) {
      readGrid(grid, descriptor, stream_);
    } else {  // readGrid would look for a tree
      readGridCompression(stream_);
      grid->readMeta(stream_);
      grid->readTransform(stream_);
    }
    return grid;
  }

  std::ifstream stream_;
  int64_t size_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::string> names_;
};

float as_float(float x) { return x; }
float as_float(double x) { return static_cast<float>(x); }

template <class Value>
void put(const Value& value, float* out) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    for (int c = 0; c < 3; ++c) out[c] = as_float(value[c]);
  } else {
    out[0] = as_float(value);
  }
}

glm::ivec3 to_ivec3(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

// OpenVDB counts the voxels of a leaf with z fastest.
template <class Leaf>
void add_leaf(BrickSink& sink, const Leaf& leaf) {
  static_assert(Leaf::DIM == brick_side);
  const glm::ivec3 origin = to_ivec3(leaf.origin());
  const uint32_t channels = sink.grid.channels;
  float* out = add_brick(sink, origin);
  for (uint32_t z = 0; z < 8; ++z)
    for (uint32_t y = 0; y < 8; ++y)
      for (uint32_t x = 0; x < 8; ++x, out += channels) put(leaf.getValue((x * 8 + y) * 8 + z), out);
  if (leaf.isValueMaskOff()) return;
  openvdb::CoordBBox active;
  leaf.evalActiveBoundingBox(active);
  add_active(sink, to_ivec3(active.min()), to_ivec3(active.max()) + 1);
}

template <class GridType>
void add_tree(BrickSink& sink, const openvdb::GridBase& base) {
  using Value = typename GridType::ValueType;
  const auto& tree = static_cast<const GridType&>(base).tree();
  float background[3] = {};
  put(tree.background(), background);
  sink.grid.channels = openvdb::VecTraits<Value>::IsVec ? 3 : 1;
  for (int c = 0; c < 3; ++c) sink.grid.background[c] = background[sink.grid.channels == 3 ? c : 0];
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) add_leaf(sink, *leaf);
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(GridType::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    float value[3] = {};
    put(*tile, value);
    if (tile.isValueOn()) add_active(sink, to_ivec3(box.min()), to_ivec3(box.max()) + 1);
    add_tile(sink, to_ivec3(box.min()), box.max().x() - box.min().x() + 1, value);
  }
}

template <class GridType>
bool add_if(BrickSink& sink, const openvdb::GridBase& base) {
  if (!base.isType<GridType>()) return false;
  add_tree<GridType>(sink, base);
  return true;
}

glm::dmat4 matrix_of(const openvdb::GridBase& grid) {
  const auto map = grid.transform().baseMap();
  if (!map->isLinear())
    throw GridError("its transform is perspective (a frustum); expected one that keeps straight lines parallel");
  const openvdb::Mat4d rows = map->getAffineMap()->getMat4();  // points are rows
  glm::dmat4 m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m[i][j] = rows[i][j];
  return m;
}

constexpr std::string_view half_suffix = "_HalfFloat";

void check_type(std::string type) {
  if (type.ends_with(half_suffix)) type.resize(type.size() - half_suffix.size());
  for (const std::string_view known : {"Tree_float_5_4_3", "Tree_double_5_4_3", "Tree_vec3s_5_4_3", "Tree_vec3d_5_4_3"})
    if (type == known) return;
  throw GridError(fmt::format("its type is '{}'; expected float, double, vec3s or vec3d in a 5_4_3 tree", type));
}

}  // namespace

void read_vdb(const std::string& path, GridRequest& request) {
  openvdb::initialize();
  VdbFile file(path);
  const std::optional<size_t> index = choose_grid(request, file.names());
  if (!index) return;
  request.grid_name = file.names()[*index];
  request.found = true;
  const Entry& entry = file.entry(*index);
  check_type(entry.type);
  const openvdb::GridBase::Ptr base = file.read(*index);
  if (base->getGridClass() == openvdb::GRID_LEVEL_SET) refuse_level_set(request);
  Grid& grid = request.grid;
  grid.stored_as = std::string(base->valueType()) + (entry.type.ends_with(half_suffix) ? ", half" : "");
  grid.index_to_local = matrix_of(*base);
  BrickSink sink{grid};
  const bool is_known = add_if<openvdb::FloatGrid>(sink, *base) || add_if<openvdb::DoubleGrid>(sink, *base) ||
                        add_if<openvdb::Vec3SGrid>(sink, *base) || add_if<openvdb::Vec3DGrid>(sink, *base);
  if (!is_known) throw GridError(fmt::format("its type is '{}', which is not supported", base->type()));
  finish_bricks(sink);
}

}  // namespace metamer
