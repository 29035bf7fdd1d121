// OpenVDB's headers name a few of Boost's, which Debian's libopenvdb-dev does not bring along. What they need of them for
// reading and writing files is here; it is seen by read_vdb.cpp and write_vdb.cpp only (scenes/CMakeLists.txt).
#pragma once
#include <any>
namespace boost {
using std::any;
using std::any_cast;
}  // namespace boost
