#include "engine/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>

namespace metamer {
namespace {

// Paths of unfinished files where a signal handler can reach them: a slot is 0 free, 1 being filled, 2 a path.
struct UnfinishedFile {
  std::atomic<int> state = 0;
  char path[PATH_MAX] = {};
};
std::array<UnfinishedFile, 8> unfinished_files;

int note_unfinished(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  for (size_t i = 0; i < unfinished_files.size(); ++i) {
    UnfinishedFile& file = unfinished_files[i];
    int free = 0;
    if (!file.state.compare_exchange_strong(free, 1)) continue;
    std::memcpy(file.path, path.c_str(), path.size() + 1);
    file.state = 2;
    return static_cast<int>(i);
  }
  return -1;
}

void forget_unfinished(int& slot) {
  if (slot >= 0) unfinished_files[static_cast<size_t>(slot)].state = 0;
  slot = -1;
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

std::string reason(int error) { return std::strerror(error); }

// The file that a symbolic link names, where it names one; else the path itself.
std::string follow_links(const std::string& path) {
  std::error_code failed;
  const std::filesystem::path real = std::filesystem::canonical(path, failed);
  return failed ? path : real.string();
}

// What stands at the target must be nothing or an ordinary file that a rename may replace.
FileError check_existing(const std::string& path) {
  struct stat target = {};
  if (::stat(path.c_str(), &target) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;  // what is wrong with the folder is said next
    return fmt::format("{}: cannot be written: {}", path, reason(errno));
  }
  if (S_ISDIR(target.st_mode)) return fmt::format("{}: is a folder, a file's name was expected", path);
  if (!S_ISREG(target.st_mode)) return fmt::format("{}: is a device or pipe, an ordinary file was expected", path);
  struct stat folder = {};
  const uid_t user = ::geteuid();
  if (::stat(folder_of(follow_links(path)).c_str(), &folder) == 0 && (folder.st_mode & S_ISVTX) != 0 && user != 0 &&
      user != target.st_uid && user != folder.st_uid)
    return fmt::format("{}: belongs to another user and its folder lets only the owner replace it", path);
  return std::nullopt;
}

FileError check_folder(const std::string& path, const std::string& resolved) {
  const std::string folder = folder_of(resolved);
  struct stat status = {};
  if (::stat(folder.c_str(), &status) != 0)
    return fmt::format("{}: the folder '{}' cannot be used: {}", path, folder, reason(errno));
  if (!S_ISDIR(status.st_mode)) return fmt::format("{}: '{}' is not a folder", path, folder);
  return std::nullopt;
}

}  // namespace

AtomicFile::~AtomicFile() { discard(); }

FileError AtomicFile::open(const std::string& target) {
  discard();
  error_.reset();
  position_ = 0;
  target_ = target;
  if (target.empty()) return error_ = "an empty name was given for an output file";
  if (target.back() == '/') return error_ = fmt::format("{}: names a folder, a file's name was expected", target);
  resolved_ = follow_links(target);
  if ((error_ = check_folder(target, resolved_)) || (error_ = check_existing(target))) return error_;
  // A short name of its own, so that a target whose name is as long as the file system allows works too.
  static std::atomic<uint32_t> serial = 0;
  const std::string folder = folder_of(resolved_);
  int descriptor = -1;
  std::string name;
  do {
    name = fmt::format("{}/.metamer-{}-{}.tmp", folder, ::getpid(), serial++);
    descriptor = ::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0)
    return error_ = fmt::format("{}: no file can be made in the folder '{}': {}", target, folder, reason(errno));
  temporary_ = name;
  slot_ = note_unfinished(temporary_);
  struct stat existing = {};
  if (::stat(resolved_.c_str(), &existing) == 0 && ::fchmod(descriptor, existing.st_mode & 07777) != 0)
    errno = 0;  // a file system without permissions: the default will do
  stream_ = ::fdopen(descriptor, "w+b");
  if (stream_ == nullptr) {
    const FileError failed = fail("cannot be written");
    ::close(descriptor);
    return failed;
  }
  return std::nullopt;
}

FileError AtomicFile::fail(const std::string& doing) {
  error_ = fmt::format("{}: {}: {}", target_, doing, reason(errno));
  discard();
  return error_;
}

FileError AtomicFile::write(const void* data, size_t bytes) {
  if (error_) return error_;
  if (std::fwrite(data, 1, bytes, stream_) != bytes) return fail("writing failed");
  position_ += bytes;
  return std::nullopt;
}

FileError AtomicFile::seek(uint64_t position) {
  if (error_) return error_;
  if (::fseeko(stream_, static_cast<off_t>(position), SEEK_SET) != 0) return fail("writing failed");
  position_ = position;
  return std::nullopt;
}

FileError AtomicFile::commit() {
  if (error_) return error_;
  if (std::fflush(stream_) != 0 || ::fsync(::fileno(stream_)) != 0) return fail("writing failed");
  std::FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) return fail("writing failed");
  if (::rename(temporary_.c_str(), resolved_.c_str()) != 0) return fail("cannot be replaced by the finished file");
  temporary_.clear();
  forget_unfinished(slot_);
  // The new name itself survives a power cut once the folder is synced; not every file system can do that.
  const int folder = ::open(folder_of(resolved_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
  return std::nullopt;
}

void AtomicFile::discard() {
  if (stream_ != nullptr) std::fclose(stream_);
  stream_ = nullptr;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget_unfinished(slot_);
}

FileError check_target(const std::string& path) {
  AtomicFile trial;
  return trial.open(path);
}

void remove_unfinished_files() noexcept {
  for (UnfinishedFile& file : unfinished_files)
    if (file.state == 2) ::unlink(file.path);
}

}  // namespace metamer
