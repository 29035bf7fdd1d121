// What the native reader says of a text.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "scenes/native/read_native.h"
#include "tests/scenes/support/files.h"

namespace metamer {

inline const std::string native_folder = METAMER_SOURCE_DIR "/tests/scenes/native/";

// The messages about a file, one a line, with the name of the file instead of its path.
inline std::string messages_of(const std::string& text) {
  Scene scene;
  Diagnostics diagnostics;
  const bool ok = read_native(native_folder + "scene.json", copy_bytes(text), scene, diagnostics);
  EXPECT_NE(ok, diagnostics.has_errors());
  std::string messages = format_diagnostics(diagnostics);
  for (size_t at; (at = messages.find(native_folder)) != std::string::npos;) messages.erase(at, native_folder.size());
  return messages;
}

inline std::string text_of_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace metamer
