#include <fmt/format.h>

#include "engine/simd/instruction_set.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"

namespace metamer {

int run_version() {
  fmt::print("metamer {}\n", METAMER_VERSION);
  fmt::print("libraries: {}\n", METAMER_LIBRARIES);
  fmt::print("instruction sets compiled: {}\n", fmt::join(compiled_isa_names(), ", "));
  fmt::print("instruction sets this machine can run: {}\n", fmt::join(available_isa_names(), ", "));
  fmt::print("instruction set chosen: {}\n", chosen_isa_name());
  return exit_done;
}

}  // namespace metamer
