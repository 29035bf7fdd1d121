// See ../../any.hpp.
#pragma once
#include <string>
namespace boost {
inline void trim(std::string& s) {
  const char* blanks = " \t\n\v\f\r";
  s.erase(0, s.find_first_not_of(blanks));
  s.erase(s.find_last_not_of(blanks) + 1);
}
}  // namespace boost
