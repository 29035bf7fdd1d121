#include "scenes/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

namespace metamer {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

std::string cannot_read(const std::string& path, std::string_view why) {
  return fmt::format("cannot read '{}': {}", path, why);
}

// A descriptor of a regular file of that size, or -1 after telling `fail` why not.
template <class F>
int open_regular(const std::string& path, size_t& size, const F& fail) {
  const auto failed = [&](std::string_view why) { return fail(why), -1; };
  // A path with a zero byte would be cut short there by the operating system.
  if (path.empty() || path.find('\0') != std::string::npos) return failed("not a file name");
  // Non-blocking, so that opening a pipe without a writer returns.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return failed(std::strerror(errno));
  struct stat status {};
  std::string_view why;
  if (fstat(file, &status) != 0)
    why = std::strerror(errno);
  else if (S_ISDIR(status.st_mode))
    why = "it is a folder";
  else if (!S_ISREG(status.st_mode))
    why = "not a regular file";
  size = static_cast<size_t>(status.st_size);
  if (why.empty()) return file;
  close(file);
  return failed(why);
}

}  // namespace

FileBytes copy_bytes(std::string_view text) {
  FileBytes bytes{std::make_unique_for_overwrite<char[]>(text.size()), text.size()};
  std::copy(text.begin(), text.end(), bytes.data.get());
  return bytes;
}

bool read_file(const std::string& path, const SourceLocation& named_at, FileBytes& bytes, Diagnostics& diagnostics) {
  const auto fail = [&](std::string_view why) {
    diagnostics.error(named_at, cannot_read(path, why));
    return false;
  };
  size_t size = 0;
  const Descriptor file(open_regular(path, size, fail));
  if (file.get() < 0) return false;
  try {
    bytes.data = std::make_unique_for_overwrite<char[]>(std::max<size_t>(size, 1));
  } catch (const std::bad_alloc&) {
    return fail(fmt::format("its {} bytes do not fit in memory", size));
  }
  bytes.size = 0;
  while (bytes.size < size) {
    const ssize_t got = ::read(file.get(), bytes.data.get() + bytes.size, size - bytes.size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(std::strerror(errno));
    if (got == 0) break;  // shortened meanwhile
    bytes.size += static_cast<size_t>(got);
  }
  return true;
}

bool check_readable(const std::string& path, const SourceLocation& named_at, Diagnostics& diagnostics) {
  size_t size = 0;
  const Descriptor file(
      open_regular(path, size, [&](std::string_view why) { diagnostics.error(named_at, cannot_read(path, why)); }));
  return file.get() >= 0;
}

std::string resolve_path(const std::string& path, const std::string& named_in) {
  return (std::filesystem::path(named_in).parent_path() / path).string();
}

std::string file_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace metamer
