// A file that appears whole or not at all: written under another name in the target's folder, synced, then
// renamed over the target. Every function that can fail returns the message for the user, or nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace metamer {

// What failed: "<path>: <what, and why>".
using FileError = std::optional<std::string>;

class AtomicFile {
 public:
  AtomicFile() = default;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  // what was not committed is removed

  // Creates the temporary file. A symbolic link is followed, so that the file it names is replaced. The
  // permissions of an existing target are kept.
  FileError open(const std::string& target);

  // The first failure is kept and reported again by commit.
  FileError write(const void* data, size_t bytes);
  FileError seek(uint64_t position);
  uint64_t position() const { return position_; }
  const FileError& error() const { return error_; }

  // Everything on the disk under the target's name. After an error the target is what it was before.
  FileError commit();

 private:
  FileError fail(const std::string& doing);
  void discard();

  std::string target_;     // as the user wrote it, for messages
  std::string resolved_;   // with symbolic links followed
  std::string temporary_;  // empty: no file of ours exists
  std::FILE* stream_ = nullptr;
  int slot_ = -1;  // in the table that remove_unfinished_files reads
  uint64_t position_ = 0;
  FileError error_;
};

// What would prevent a file from being written there, found without waiting for the frame: no folder, no
// permission, a folder or device in the way. Leaves nothing behind and does not touch an existing file.
FileError check_target(const std::string& path);

// Removes the temporary files of this process. Async-signal-safe: for a handler that then calls _exit.
void remove_unfinished_files() noexcept;

}  // namespace metamer
