// A spectrum as an argument of a command: the name of one that is built in, or a file.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "engine/spectrum/samples.h"

namespace metamer {

// An illuminant or a ColorChecker patch by name, else a file, see spectrum_file.h. Throws Failure (exit 2).
Samples read_light(const std::string& text);

// All of the text as a number, nothing if it is none.
std::optional<double> number_argument(std::string_view text);

}  // namespace metamer
