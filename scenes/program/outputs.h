// Where a render's files go, decided and checked before the scene is even read.
#pragma once
#include <string>

#include "scenes/program/command_line.h"

namespace metamer {

struct Outputs {
  std::string exr, png;
  std::string stats;  // empty: none
};

// What a scene is called: its file's name without the ending; of "scene.*", which is what collections call theirs,
// the folder's name.
std::string scene_title(const std::string& scene_path);

// Whether two paths name one file, whether or not it exists yet.
bool is_same_file(const std::string& a, const std::string& b);

// The files named; else named after the scene, in the current folder; where only one picture is named the other goes
// beside it.
Outputs choose_outputs(const RenderArguments& arguments, const std::string& scene_path);

// Throws Failure where a file could not be written (exit 1), is of an unknown kind or named twice (exit 2). Leaves
// nothing behind.
void check_outputs(const Outputs& outputs, const std::string& scene_path);

}  // namespace metamer
