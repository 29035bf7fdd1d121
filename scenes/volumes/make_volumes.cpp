// make_volumes FOLDER: writes the OpenVDB files of scenes/library, cloud.vdb, plume.vdb and flame.vdb, in 16-bit
// floats.
#include <cstdio>
#include <string>

#include "scenes/volumes/library_volumes.h"
#include "scenes/volumes/write_vdb.h"

namespace {

bool write(const std::string& path, std::span<const metamer::NamedGrid> grids) {
  const metamer::FileError error = metamer::write_vdb(path, grids);
  if (error) std::fprintf(stderr, "make_volumes: %s\n", error->c_str());
  return !error;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_volumes FOLDER\n");
    return 2;
  }
  const std::string folder = std::string(argv[1]) + "/";
  const metamer::Grid cloud = metamer::cloud_volume(), plume = metamer::plume_volume();
  const metamer::FlameVolume flame = metamer::flame_volume();
  const metamer::NamedGrid clouds[] = {{"density", &cloud, true}}, plumes[] = {{"density", &plume, true}};
  const metamer::NamedGrid flames[] = {{"density", &flame.density, true}, {"temperature", &flame.temperature, true}};
  const bool is_done =
      write(folder + "cloud.vdb", clouds) && write(folder + "plume.vdb", plumes) && write(folder + "flame.vdb", flames);
  return is_done ? 0 : 1;
}
