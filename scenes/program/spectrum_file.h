// A measured light in a text file.
#pragma once
#include <string>

#include "engine/diagnostics.h"
#include "engine/spectrum/samples.h"

namespace metamer {

// Reads lines of "nm value" (comma, semicolon, tab or blank between; `#` begins a comment; a first line of column names
// is skipped): two or more, wavelengths ascending and above 0, values finite and not negative. Zero outside its range,
// linear in between. All mistakes go to `diagnostics`, then the result is of no use.
Samples read_spectrum_file(const std::string& path, Diagnostics& diagnostics);

}  // namespace metamer
