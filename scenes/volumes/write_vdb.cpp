#include "scenes/volumes/write_vdb.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <exception>
#include <fstream>

namespace metamer {
namespace {

template <class Value>
Value value_of(const float* numbers) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    return Value(numbers[0], numbers[1], numbers[2]);
  } else {
    return numbers[0];
  }
}

// Active is what differs from the background, and the two corners of what counts, so that the bounds come back.
template <class GridType>
openvdb::GridBase::Ptr make_grid(const Grid& grid) {
  using Value = typename GridType::ValueType;
  const float background_numbers[3] = {grid.background.x, grid.background.y, grid.background.z};
  const Value background = value_of<Value>(background_numbers);
  auto made = GridType::create(background);
  const float* numbers = grid.values.data();
  for (const glm::ivec3& origin : grid.origins) {
    auto* leaf = made->tree().touchLeaf(openvdb::Coord(origin.x, origin.y, origin.z));
    for (uint32_t z = 0; z < 8; ++z)
      for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x, numbers += grid.channels) {
          const Value value = value_of<Value>(numbers);
          if (value != background) leaf->setValueOn((x * 8 + y) * 8 + z, value);
        }
  }
  if (grid.lower.x < grid.upper.x) {
    const auto activate = [&](glm::ivec3 at) { made->tree().setActiveState({at.x, at.y, at.z}, true); };
    activate(grid.lower);
    activate(grid.upper - 1);
  }
  return made;
}

openvdb::GridBase::Ptr make_named(const NamedGrid& named) {
  const Grid& grid = *named.grid;
  openvdb::GridBase::Ptr made =
      grid.channels == 3 ? make_grid<openvdb::Vec3SGrid>(grid) : make_grid<openvdb::FloatGrid>(grid);
  made->setName(named.name);
  made->setGridClass(grid.channels == 3 ? openvdb::GRID_UNKNOWN : openvdb::GRID_FOG_VOLUME);
  made->setSaveFloatAsHalf(named.as_half);
  openvdb::Mat4d rows;  // points are rows
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) rows[i][j] = grid.index_to_local[i][j];
  // Not Transform::createLinearTransform, which would take the matrix apart.
  const auto map = openvdb::SharedPtr<openvdb::math::MapBase>(new openvdb::math::AffineMap(rows));
  made->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(map)));
  return made;
}

// Each file gets a random identifier, at this place of it; equal grids shall give equal files.
void clear_identifier(const std::string& path) {
  constexpr std::streamoff place = 21;
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.seekp(place);
  file << "00000000-0000-0000-0000-000000000000";
}

}  // namespace

FileError write_vdb(const std::string& path, std::span<const NamedGrid> grids) {
  try {
    openvdb::initialize();
    openvdb::GridPtrVec made;
    for (const NamedGrid& grid : grids) made.push_back(make_named(grid));
    openvdb::io::File file(path);
    file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(made);
    file.close();
    clear_identifier(path);
  } catch (const std::exception& e) {
    return fmt::format("cannot write '{}': {}", path, e.what());
  }
  return std::nullopt;
}

}  // namespace metamer
