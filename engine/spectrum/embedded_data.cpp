#include "engine/spectrum/embedded_data.h"

#include <cstdio>
#include <cstdlib>

namespace metamer {

const DataTable* find_embedded_data(std::string_view name) {
  for (const DataTable& table : embedded_data()) {
    if (table.name == name) return &table;
  }
  return nullptr;
}

const DataTable& require_embedded_data(std::string_view name) {
  const DataTable* table = find_embedded_data(name);
  if (table == nullptr) {
    std::fprintf(stderr, "metamer: the build lacks the spectral data '%.*s'\n", static_cast<int>(name.size()),
                 name.data());
    std::abort();
  }
  return *table;
}

}  // namespace metamer
