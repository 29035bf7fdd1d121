// See ../any.hpp. A member of openvdb::io::Archive: the size and alignment of Boost's.
#pragma once
#include <cstdint>
namespace boost::uuids {
struct uuid {
  uint8_t data[16];
};
}  // namespace boost::uuids
