// Reads a pbrt scene given as text, for tests.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scenes/pbrt/read_pbrt.h"
#include "tests/scenes/support/files.h"

namespace metamer {

struct ReadScene {
  Scene scene;
  bool ok = false;
  std::vector<std::string> messages;  // "line: severity: message", in the order of the file; line 0 without a number
  Diagnostics diagnostics;

  // The only entity, or the n-th, that has the component.
  template <class C>
  Entity entity(uint32_t n = 0) const {
    return scene.registry.table<C>().size() > n ? scene.registry.table<C>().owner(n) : Entity{};
  }
  template <class C>
  C get(uint32_t n = 0) const {
    return scene.registry.get<C>(entity<C>(n));
  }
  template <class C>
  size_t count() const {
    return scene.registry.table<C>().size();
  }
  // The material of the n-th shape.
  Material material(uint32_t n = 0) const {
    return scene.registry.get<Material>(scene.registry.get<MaterialSlot>(entity<Geometry>(n)).material);
  }
};

inline ReadScene read_scene_at(const std::string& path) {
  ReadScene read;
  read.ok = read_pbrt(path, read.scene, read.diagnostics);
  std::istringstream lines(format_diagnostics(read.diagnostics));
  for (std::string line; std::getline(lines, line);) {
    const size_t folder_end = line.find(": ") == std::string::npos ? 0 : line.substr(0, line.find(": ")).rfind('/');
    read.messages.push_back(folder_end == std::string::npos ? line : line.substr(folder_end + 1));
  }
  return read;
}

inline ReadScene read_text(const std::string& text) {
  const TemporaryFolder folder;
  return read_scene_at(folder.write("scene", text));
}

// A scene whose world is `text`; it begins in line 2.
inline ReadScene read_world(const std::string& text) { return read_text("Camera \"perspective\" WorldBegin\n" + text); }

}  // namespace metamer
