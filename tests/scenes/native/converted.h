// A scene written as the native format and read again.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "scenes/native/write_native.h"
#include "scenes/read_scene.h"
#include "systems/freeze.h"
#include "systems/render.h"
#include "tests/scenes/support/files.h"

namespace metamer {

// Every file below a folder, by its path relative to it.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    files[std::filesystem::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return files;
}

inline void write_scene(const Scene& scene, const std::filesystem::path& folder) {
  NativeFiles files;
  const FileError error = write_native(scene, (folder / "scene.json").string(), Cancellation(), files);
  EXPECT_FALSE(error) << *error;
}

inline Scene read_without_remarks(const std::filesystem::path& path) {
  Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(read_scene(path.string(), scene, diagnostics));
  EXPECT_EQ(format_diagnostics(diagnostics), "");
  return scene;
}

inline Scene converted(const Scene& scene) {
  const TemporaryFolder folder;
  write_scene(scene, folder.path());
  return read_without_remarks(folder.path() / "scene.json");
}

// The exact sums of a picture of a few pixels; empty if the scene cannot be built.
inline std::unique_ptr<Film> tiny_film(Scene scene) {
  scene.settings.width = 20;
  scene.settings.height = 14;
  scene.settings.samples_per_pixel = 4;
  Diagnostics diagnostics;
  const std::unique_ptr<World> world = freeze(scene, diagnostics);
  if (world == nullptr) return nullptr;
  const TileRect rendered = rendered_pixels(scene.settings);
  auto film = std::make_unique<Film>(rendered.width(), rendered.height(), scene.settings.band_count);
  RenderProgress progress;
  render(*world, {}, Cancellation(), progress, *film);
  return film;
}

// The same pixels, and the same files when what was read back is written again.
inline void expect_converts(const Scene& scene) {
  const TemporaryFolder first, moved, second;
  write_scene(scene, first.path());
  const auto once = files_in(first.path());
  for (const auto& entry : std::filesystem::directory_iterator(first.path()))
    std::filesystem::rename(entry.path(), moved.path() / entry.path().filename());
  const Scene back = read_without_remarks(moved.path() / "scene.json");
  write_scene(back, second.path());
  const auto twice = files_in(second.path());
  ASSERT_EQ(once.size(), twice.size());
  for (const auto& [name, bytes] : once) {
    ASSERT_TRUE(twice.contains(name)) << name;
    EXPECT_TRUE(bytes == twice.at(name)) << name << "\n" << (name == "scene.json" ? bytes + twice.at(name) : "");
  }
  EXPECT_EQ(back.settings.width, scene.settings.width);
  EXPECT_EQ(back.settings.height, scene.settings.height);
  EXPECT_EQ(back.settings.samples_per_pixel, scene.settings.samples_per_pixel);
  const std::unique_ptr<Film> expected = tiny_film(scene), found = tiny_film(back);
  ASSERT_EQ(expected == nullptr, found == nullptr);
  EXPECT_TRUE(expected == nullptr || *expected == *found) << "the pixels differ";
}

}  // namespace metamer
