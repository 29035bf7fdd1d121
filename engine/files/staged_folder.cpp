#include "engine/files/staged_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace metamer {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string parent_of(const std::string& path) {
  const std::string parent = fs::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

FileError failure(const std::string& path, const char* doing) {
  return fmt::format("{}: {}: {}", path, doing, std::strerror(errno));
}

}  // namespace

StagedFolder::~StagedFolder() { discard(); }

void StagedFolder::discard() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  temporary_.clear();
  names_.clear();
}

FileError StagedFolder::open(const std::string& target) {
  discard();
  target_ = target;
  static std::atomic<uint32_t> serial = 0;
  for (;;) {
    const std::string name = fmt::format("{}/.metamer-{}-{}.files", parent_of(target), ::getpid(), serial++);
    if (::mkdir(name.c_str(), 0777) == 0) {
      temporary_ = name;
      return std::nullopt;
    }
    if (errno != EEXIST)
      return failure(target, fmt::format("no folder can be made in '{}'", parent_of(target)).c_str());
  }
}

FileError StagedFolder::write(const std::string& name, std::string_view bytes) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path_of(name).c_str(), "wbe"));
  if (file == nullptr || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() ||
      std::fflush(file.get()) != 0)
    return failure(target_ + "/" + name, "writing failed");
  note_written(name);
  return std::nullopt;
}

// After all were written: the first file's wait brings most of the others to the disk, too.
FileError StagedFolder::sync() const {
  for (const std::string& name : names_) {
    const int file = ::open(path_of(name).c_str(), O_RDONLY | O_CLOEXEC);
    const bool done = file >= 0 && ::fsync(file) == 0;
    const FileError error = done ? FileError() : failure(target_ + "/" + name, "writing failed");
    if (file >= 0) ::close(file);
    if (error) return error;
  }
  return std::nullopt;
}

FileError StagedFolder::commit() {
  if (const FileError error = sync()) return error;
  if (::rename(temporary_.c_str(), target_.c_str()) == 0) {
    temporary_.clear();
    return std::nullopt;
  }
  // A folder that is there and not empty.
  for (const std::string& name : names_)
    if (::rename(path_of(name).c_str(), (target_ + "/" + name).c_str()) != 0)
      return failure(target_ + "/" + name, "cannot be replaced by the finished file");
  discard();
  return std::nullopt;
}

FileError check_folder_target(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) {
    StagedFolder trial;
    return errno == ENOENT ? trial.open(path) : failure(path, "cannot be used");
  }
  if (!S_ISDIR(status.st_mode))
    return fmt::format("{}: is no folder; the scene's meshes and images belong there", path);
  return ::access(path.c_str(), W_OK | X_OK) == 0 ? FileError() : failure(path, "cannot be written to");
}

}  // namespace metamer
