#include "tests/scenes/support/volume_files.h"

#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <limits>
#include <stdexcept>

namespace metamer {
namespace {

using openvdb::Coord;

// Values are multiples of 1/64 below 8: halves hold them.
float test_value(int x, int y, int z) { return static_cast<float>((x * 7 + y * 5 + z * 3) & 511) / 64; }

template <class GridType>
typename GridType::Ptr make(const std::string& name) {
  using Value = typename GridType::ValueType;
  const auto value = [](int x, int y, int z) {
    const float v = test_value(x, y, z);
    if constexpr (openvdb::VecTraits<Value>::IsVec) {
      return Value(v, v / 2, v / 4);
    } else {
      return static_cast<Value>(v);
    }
  };
  auto grid = GridType::create(Value(0.25f));
  for (int z = -9; z <= 9; ++z)
    for (int y = -9; y <= 9; ++y)
      for (int x = -9; x <= 9; ++x)
        if (x * x + y * y + z * z <= 81) grid->tree().setValueOn(Coord(x, y, z), value(x, y, z));
  grid->tree().setValueOff(Coord(3, 2, 1), Value(0.5f));
  grid->tree().addTile(1, Coord(40, 16, -48), Value(0.75f), true);
  grid->tree().addTile(2, Coord(-256, 0, 128), Value(0.125f), true);
  grid->tree().addTile(1, Coord(48, 16, -48), Value(0.875f), false);
  grid->setName(name);
  openvdb::Mat4d m = openvdb::math::rotation<openvdb::Mat4d>(openvdb::Vec3d(1, 2, 3).unit(), 0.7);
  m = openvdb::math::shear<openvdb::Mat4d>(openvdb::math::X_AXIS, openvdb::math::Y_AXIS, 0.3) * m;
  m.preScale(openvdb::Vec3d(0.1, 0.2, 0.15));
  m.postTranslate(openvdb::Vec3d(3, -2, 0.1));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(m));
  return grid;
}

openvdb::FloatGrid::Ptr make_wrong(const std::string& name, float value) {
  auto grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOn(Coord(0, 0, 0), 1);
  grid->tree().setValueOn(Coord(1, 2, 3), value);
  grid->setName(name);
  return grid;
}

template <class Build>
nanovdb::GridHandle<> quantised(const openvdb::FloatGrid& grid) {
  nanovdb::OpenToNanoVDB<float, Build> convert;
  return convert(grid);
}

nanovdb::GridHandle<> to_nano(const openvdb::GridBase::Ptr& grid, const std::string& type) {
  const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
  if (floats && type == "Fp4") return quantised<nanovdb::Fp4>(*floats);
  if (floats && type == "Fp8") return quantised<nanovdb::Fp8>(*floats);
  if (floats && type == "Fp16") return quantised<nanovdb::Fp16>(*floats);
  if (floats && type == "FpN") return quantised<nanovdb::FpN>(*floats);
  return nanovdb::openToNanoVDB(grid);
}

}  // namespace

void write_test_vdb(const std::string& path) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  const auto density = make<openvdb::FloatGrid>("density");
  grids.push_back(density);
  grids.push_back(make<openvdb::FloatGrid>("half"));
  grids.back()->setSaveFloatAsHalf(true);
  grids.push_back(make<openvdb::DoubleGrid>("double"));
  grids.push_back(make<openvdb::Vec3SGrid>("color"));
  grids.push_back(make<openvdb::Vec3DGrid>("color64"));
  const auto sharer = openvdb::FloatGrid::create(density->treePtr());
  sharer->setName("sharer");
  grids.push_back(sharer);
  const auto integer = openvdb::Int32Grid::create(0);
  integer->setName("integer");
  grids.push_back(integer);
  grids.push_back(make_wrong("frustum", 1));
  grids.back()->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 10));
  grids.push_back(make_wrong("surface", -1));
  grids.back()->setGridClass(openvdb::GRID_LEVEL_SET);
  grids.push_back(make_wrong("negative", -0.5f));
  grids.push_back(make_wrong("nan", std::numeric_limits<float>::quiet_NaN()));
  grids.push_back(make_wrong("infinite", std::numeric_limits<float>::infinity()));
  const auto huge = make_wrong("huge", 1);
  huge->tree().addTile(3, Coord(4096, 0, 0), 1, true);
  grids.push_back(huge);
  openvdb::io::File file(path);
  file.write(grids);
}

void write_cube_vdb(const std::string& path, const std::string& name, int voxels) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0);
  grid->denseFill(openvdb::CoordBBox(Coord(0), Coord(voxels - 1)), 1.5f);
  grid->setName(name);
  openvdb::io::File file(path);
  file.write({grid});
}

void write_nvdb(const std::string& from_vdb, const std::string& path, const std::string& type,
                const std::string& codec) {
  openvdb::initialize();
  openvdb::io::File file(from_vdb);
  file.open();
  std::vector<nanovdb::GridHandle<>> handles;
  for (auto name = file.beginName(); name != file.endName(); ++name)
    if (*name != "frustum" && *name != "color64") handles.push_back(to_nano(file.readGrid(*name), type));
  const auto code = codec == "zip"     ? nanovdb::io::Codec::ZIP
                    : codec == "blosc" ? nanovdb::io::Codec::BLOSC
                                       : nanovdb::io::Codec::NONE;
  nanovdb::io::writeGrids(path, handles, code);
}

}  // namespace metamer
