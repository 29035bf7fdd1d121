// See ../../any.hpp.
#pragma once
#include <string>
namespace boost {
inline void to_lower(std::string& s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
}
}  // namespace boost
