// A NanoVDB file is an image of memory whose nodes point to each other by offsets: NanoVDB follows them wherever they
// lead. Here every node is checked to lie within the grid before it is looked at, and there can be no more of them than
// fit into the file.
#include <blosc.h>
#include <fmt/format.h>
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/IO.h>

#include <cstring>
#include <fstream>
#include <glm/common.hpp>
#include <memory>

#include "scenes/gzip.h"
#include "scenes/volumes/bricks.h"
#include "scenes/volumes/read_grids.h"

namespace metamer {
namespace {

namespace io = nanovdb::io;

constexpr const char* damaged = "the file is cut short or damaged";
constexpr uint64_t blosc_chunk = uint64_t{1} << 30;  // bytes, unpacked

struct Entry {
  io::MetaData meta;
  std::string name;
  io::Codec codec;
  uint64_t start;  // place in the file
};

// The grid in memory, aligned as its nodes are.
struct GridMemory {
  explicit GridMemory(uint64_t bytes) : storage(std::make_unique_for_overwrite<uint8_t[]>(bytes + 31)), size(bytes) {
    const auto address = reinterpret_cast<uintptr_t>(storage.get());
    data = storage.get() + ((32 - address % 32) % 32);
  }
  std::unique_ptr<uint8_t[]> storage;
  uint8_t* data;
  uint64_t size;
};

class NvdbFile {
 public:
  explicit NvdbFile(const std::string& path) {
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    stream_.open(path, std::ios::binary);
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<uint64_t>(stream_.tellg());
    stream_.seekg(0);
    while (place() < size_) read_segment();
  }

  const std::vector<Entry>& entries() const { return entries_; }

  GridMemory unpack(const Entry& entry) {
    // What zip and blosc can make of a byte: files made to fill the memory state more.
    constexpr uint64_t most_ratio = 2048;
    const uint64_t unpacked = entry.meta.gridSize;
    if (unpacked < sizeof(nanovdb::GridData) || entry.start > size_ || unpacked / most_ratio > size_)
      throw GridError(damaged);
    if (unpacked > most_grid_bytes())
      throw GridError(
          fmt::format("the grid of {:.3g} GB is larger than half of this machine's memory", double(unpacked) / 1e9));
    if (entry.codec == io::Codec::NONE && unpacked > size_ - entry.start) throw GridError(damaged);
    GridMemory memory(unpacked);
    stream_.seekg(static_cast<int64_t>(entry.start));
    switch (entry.codec) {
      case io::Codec::NONE: read(memory.data, unpacked); break;
      case io::Codec::ZIP: {
        const std::string packed = read_packed();
        if (!inflate_zlib(packed, {reinterpret_cast<char*>(memory.data), unpacked})) throw GridError(damaged);
        break;
      }
      default:
        for (uint64_t at = 0; at < unpacked; at += blosc_chunk) {
          const uint64_t chunk = std::min(unpacked - at, blosc_chunk);
          unpack_blosc(read_packed(), memory.data + at, chunk);
        }
    }
    return memory;
  }

 private:
  uint64_t place() { return static_cast<uint64_t>(stream_.tellg()); }
  void read(void* out, uint64_t bytes) {
    if (bytes > size_ - place()) throw GridError(damaged);
    stream_.read(static_cast<char*>(out), static_cast<int64_t>(bytes));
  }
  std::string read_packed() {
    uint64_t bytes = 0;
    read(&bytes, sizeof(bytes));
    if (bytes > size_ - place()) throw GridError(damaged);
    std::string packed(bytes, '\0');
    read(packed.data(), bytes);
    return packed;
  }
  static void unpack_blosc(const std::string& packed, uint8_t* out, uint64_t bytes) {
    size_t unpacked = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) < 0 || unpacked != bytes ||
        blosc_decompress_ctx(packed.data(), out, bytes, 1) != static_cast<int>(bytes))
      throw GridError(damaged);
  }

  // A header, the names and sizes of some grids, and then these.
  void read_segment() {
    struct {
      char magic[8];
      uint32_t version;
      uint16_t grid_count;
      io::Codec codec;
    } header;
    static_assert(sizeof(header) == sizeof(io::Header));
    read(&header, sizeof(header));
    if (std::memcmp(header.magic, "NanoVDB", 7) != 0) throw GridError(damaged);
    const uint32_t major = header.version >> 21;
    if (major != NANOVDB_MAJOR_VERSION_NUMBER)
      throw GridError(fmt::format("it has version {} of NanoVDB's format; expected {}: make it anew from the .vdb",
                                  major, NANOVDB_MAJOR_VERSION_NUMBER));
    if (header.codec >= io::Codec::END) throw GridError(damaged);
    const size_t first = entries_.size();
    for (uint16_t i = 0; i < header.grid_count; ++i) {
      Entry entry{{}, {}, header.codec, 0};
      read(&entry.meta, sizeof(entry.meta));
      if (entry.meta.nameSize > size_ - place()) throw GridError(damaged);
      entry.name.resize(entry.meta.nameSize);
      read(entry.name.data(), entry.name.size());
      entry.name.resize(std::strlen(entry.name.c_str()));
      entries_.push_back(std::move(entry));
    }
    uint64_t at = place();
    for (size_t i = first; i < entries_.size(); ++i) {
      entries_[i].start = at;
      if (entries_[i].meta.fileSize > size_ - at) throw GridError(damaged);
      at += entries_[i].meta.fileSize;
    }
    if (at == place() && header.grid_count == 0) throw GridError(damaged);
    stream_.seekg(static_cast<int64_t>(at));
  }

  std::ifstream stream_;
  uint64_t size_ = 0;
  std::vector<Entry> entries_;
};

// Walks the nodes of a tree of values that are stored as Build.
template <class Build>
class TreeWalk {
  using Root = typename nanovdb::NanoRoot<Build>::DataType;
  using Upper = typename nanovdb::NanoUpper<Build>::DataType;
  using Lower = typename nanovdb::NanoLower<Build>::DataType;
  using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
  using Value = typename nanovdb::NanoLeaf<Build>::ValueType;
  static constexpr bool is_vector = nanovdb::TensorTraits<Value>::Rank == 1;

 public:
  TreeWalk(const GridMemory& memory, BrickSink& sink) : memory_(memory), sink_(sink) {}

  void walk() {
    const auto* tree = node<nanovdb::TreeData<3>>(memory_.data, sizeof(nanovdb::GridData));
    const Root* root = node<Root>(tree, static_cast<int64_t>(tree->mNodeOffset[3]));
    check_head(reinterpret_cast<const uint8_t*>(root) - memory_.data + sizeof(Root) +
               uint64_t{root->mTableSize} * sizeof(typename Root::Tile));
    Grid& grid = sink_.grid;
    grid.channels = is_vector ? 3 : 1;
    float background[3];
    put(root->mBackground, background);
    for (int c = 0; c < 3; ++c) grid.background[c] = background[is_vector ? c : 0];
    using Tile = typename Root::Tile;
    for (uint32_t i = 0; i < root->mTableSize; ++i) {
      const auto* tile = node<Tile>(root, static_cast<int64_t>(sizeof(Root) + i * sizeof(Tile)));
      const glm::ivec3 origin = place(tile->origin());
      if (tile->isChild()) {
        walk_upper(*node<Upper>(root, tile->child), origin);
      } else {
        add_constant(origin, 4096, tile->value, tile->state != 0);
      }
    }
  }

 private:
  // The node at a distance of bytes from another; throws unless all of it lies within the grid.
  template <class Node>
  const Node* node(const void* from, int64_t distance) const {
    const int64_t base = static_cast<const uint8_t*>(from) - memory_.data;
    const auto size = static_cast<int64_t>(memory_.size);
    if (distance <= 0 || distance > size) throw GridError(damaged);  // children follow their parents
    const int64_t at = base + distance;
    if (at < 0 || at > size - static_cast<int64_t>(sizeof(Node)) || at % 32 != 0) throw GridError(damaged);
    return reinterpret_cast<const Node*>(memory_.data + at);
  }

  // The checksum of everything in front of the first node, if there is one; 32.5 and before (GridChecksum.h).
  void check_head(uint64_t end) const {
    constexpr uint64_t start = 16;  // behind the checksum itself
    const auto& data = *reinterpret_cast<const nanovdb::GridData*>(memory_.data);
    const auto stated = static_cast<uint32_t>(data.mChecksum);
    if (end > memory_.size) throw GridError(damaged);
    if (stated == nanovdb::CRC32::EMPTY || data.mVersion.getMinor() > 5) return;
    if (nanovdb::crc32(memory_.data + start, end - start) != stated) throw GridError(damaged);
  }

  static glm::ivec3 place(const nanovdb::Coord& c) { return {c[0], c[1], c[2]}; }
  static void put(const Value& value, float* out) {
    if constexpr (is_vector) {
      for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(value[c]);
    } else {
      out[0] = static_cast<float>(value);
    }
  }

  void add_constant(glm::ivec3 origin, int side, const Value& value, bool is_active) {
    float numbers[3] = {};
    put(value, numbers);
    if (is_active) add_active(sink_, origin, origin + side);
    add_tile(sink_, origin, side, numbers);
  }

  // The i-th child of a node with `side` of them along each axis, z fastest, each of `step` voxels.
  static glm::ivec3 offset(uint32_t i, uint32_t side, int step) {
    return glm::ivec3(int(i / (side * side)), int(i / side % side), int(i % side)) * step;
  }

  void walk_upper(const Upper& upper, glm::ivec3 origin) {
    // Every node takes its own room: more visits than room for nodes means that nodes share theirs.
    if (++uppers_ > memory_.size / sizeof(Upper)) throw GridError(damaged);
    for (uint32_t i = 0; i < 32 * 32 * 32; ++i) {
      const glm::ivec3 at = origin + offset(i, 32, 128);
      if (upper.mChildMask.isOn(i)) {
        walk_lower(*node<Lower>(&upper, upper.mTable[i].child), at);
      } else {
        add_constant(at, 128, upper.mTable[i].value, upper.mValueMask.isOn(i));
      }
    }
  }

  void walk_lower(const Lower& lower, glm::ivec3 origin) {
    if (++lowers_ > memory_.size / sizeof(Lower)) throw GridError(damaged);
    for (uint32_t i = 0; i < 16 * 16 * 16; ++i) {
      const glm::ivec3 at = origin + offset(i, 16, 8);
      if (lower.mChildMask.isOn(i)) {
        add_leaf(*node<Leaf>(&lower, lower.mTable[i].child), at);
      } else {
        add_constant(at, 8, lower.mTable[i].value, lower.mValueMask.isOn(i));
      }
    }
  }

  void add_leaf(const Leaf& leaf, glm::ivec3 origin) {
    if (++leaves_ > memory_.size / sizeof(Leaf)) throw GridError(damaged);
    if constexpr (std::is_same_v<Build, nanovdb::FpN>) {
      if ((leaf.mFlags >> 5) > 4) throw GridError(damaged);
      const auto end = reinterpret_cast<const uint8_t*>(&leaf) - memory_.data + leaf.memUsage();
      if (static_cast<uint64_t>(end) > memory_.size) throw GridError(damaged);
    }
    const uint32_t channels = sink_.grid.channels;
    float* out = add_brick(sink_, origin);
    glm::ivec3 low(8), high(-1);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x, out += channels) {
          const auto i = static_cast<uint32_t>((x * 8 + y) * 8 + z);
          put(leaf.getValue(i), out);
          if (!leaf.mValueMask.isOn(i)) continue;
          low = glm::min(low, glm::ivec3(x, y, z));
          high = glm::max(high, glm::ivec3(x, y, z));
        }
    if (high.x >= 0) add_active(sink_, origin + low, origin + high + 1);
  }

  const GridMemory& memory_;
  BrickSink& sink_;
  uint64_t uppers_ = 0, lowers_ = 0, leaves_ = 0;
};

void walk_tree(const GridMemory& memory, nanovdb::GridType type, BrickSink& sink) {
  switch (type) {
    case nanovdb::GridType::Float:
    case nanovdb::GridType::Half: return TreeWalk<float>(memory, sink).walk();
    case nanovdb::GridType::Double: return TreeWalk<double>(memory, sink).walk();
    case nanovdb::GridType::Vec3f: return TreeWalk<nanovdb::Vec3f>(memory, sink).walk();
    case nanovdb::GridType::Vec3d: return TreeWalk<nanovdb::Vec3d>(memory, sink).walk();
    case nanovdb::GridType::Fp4: return TreeWalk<nanovdb::Fp4>(memory, sink).walk();
    case nanovdb::GridType::Fp8: return TreeWalk<nanovdb::Fp8>(memory, sink).walk();
    case nanovdb::GridType::Fp16: return TreeWalk<nanovdb::Fp16>(memory, sink).walk();
    case nanovdb::GridType::FpN: return TreeWalk<nanovdb::FpN>(memory, sink).walk();
    default: break;
  }
  const std::string name = type < nanovdb::GridType::End ? nanovdb::toStr(type) : std::to_string(uint32_t(type));
  throw GridError(
      fmt::format("its type is '{}'; expected floats, also quantised ones, doubles or vectors of three", name));
}

}  // namespace

void read_nvdb(const std::string& path, GridRequest& request) {
  NvdbFile file(path);
  std::vector<std::string> names;
  for (const Entry& entry : file.entries()) names.push_back(entry.name);
  const std::optional<size_t> index = choose_grid(request, names);
  if (!index) return;
  request.grid_name = names[*index];
  request.found = true;
  const GridMemory memory = file.unpack(file.entries()[*index]);
  const auto& data = *reinterpret_cast<const nanovdb::GridData*>(memory.data);
  if (std::memcmp(&data.mMagic, "NanoVDB", 7) != 0) throw GridError(damaged);
  if (data.mGridClass == nanovdb::GridClass::LevelSet) refuse_level_set(request);
  Grid& grid = request.grid;
  grid.index_to_local = glm::dmat4(1.0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) grid.index_to_local[j][i] = data.mMap.mMatD[3 * i + j];
    grid.index_to_local[3][i] = data.mMap.mVecD[i];
  }
  BrickSink sink{grid};
  walk_tree(memory, data.mGridType, sink);
  grid.stored_as = nanovdb::toStr(data.mGridType);
  finish_bricks(sink);
}

}  // namespace metamer
