// Files of grids, made by the libraries themselves.
#pragma once
#include <string>

namespace metamer {

// An OpenVDB file with the grids
//   density   float: a ball of leaves across the origin, a tile of 8 and one of 128 voxels, inactive values; background
//             0.25; rotated, sheared, scaled and moved
//   half      the same as 16-bit floats;  double  the same as doubles
//   color     three floats;  color64  three doubles
//   sharer    shares the voxels of density, unrotated
//   integer   of a type that is no amount;  frustum  in perspective;  surface  a level set
//   negative  -0.5 at voxel (1, 2, 3);  nan, infinite  the same place;  huge  a tile of 4096 voxels
void write_test_vdb(const std::string& path);
// One float grid: `voxels` along each axis, each 1.5, at the origin.
void write_cube_vdb(const std::string& path, const std::string& name, int voxels);

// The grids of an OpenVDB file that NanoVDB 10.0 can be made of (not "frustum" and "color64"), in a NanoVDB file.
// Values are stored as `type`: float (as they are), Fp4, Fp8, Fp16 or FpN (floats only); the codec is none, zip or
// blosc.
void write_nvdb(const std::string& from_vdb, const std::string& path, const std::string& type,
                const std::string& codec);

}  // namespace metamer
