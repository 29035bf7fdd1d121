// The kinds of picture that can be written, known by the ending of the file's name.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/files/atomic_file.h"

namespace metamer {

enum class OutputKind : uint8_t { exr, png };

// By the part of the last path component after its last dot, in either case. Nothing for all others.
std::optional<OutputKind> output_kind(std::string_view path);

// What is wrong with `path` as the target of a picture of this kind: another or no ending, or anything that
// check_target finds. For use before rendering.
FileError check_writable(const std::string& path, OutputKind expected);
// The same where any kind is welcome.
FileError check_writable(const std::string& path);

}  // namespace metamer
