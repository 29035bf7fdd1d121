// Files that belong together and appear together: written to a temporary folder beside the target, then moved there.
// Functions that can fail return the message for the user, or nothing.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/atomic_file.h"

namespace metamer {

class StagedFolder {
 public:
  StagedFolder() = default;
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  ~StagedFolder();  // what was not committed is removed

  // Creates the temporary folder beside `target`.
  FileError open(const std::string& target);

  FileError write(const std::string& name, std::string_view bytes);
  // For files that a library writes: where to, and that it is done.
  std::string path_of(const std::string& name) const { return temporary_ + "/" + name; }
  void note_written(const std::string& name) { names_.push_back(name); }

  // Everything on the disk, then under the target's name: a new folder, or files that replace those of the same names
  // in an existing one, whose other files stay.
  FileError commit();

 private:
  FileError sync() const;
  void discard();

  std::string target_, temporary_;  // temporary_ empty: no folder of ours exists
  std::vector<std::string> names_;
};

// What would prevent it: something other than a folder in the way, or one that cannot be written to.
FileError check_folder_target(const std::string& path);

}  // namespace metamer
