#include "engine/files/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <memory>
#include <vector>

#include "engine/files/output_kind.h"
#include "tests/engine/files/support.h"

namespace metamer {
namespace {

using testing::HasSubstr;
using testing::Optional;

class AtomicFiles : public FolderTest {};

FileError write_text(const std::string& path, const std::string& text) {
  AtomicFile file;
  if (const FileError error = file.open(path)) return error;
  if (const FileError error = file.write(text.data(), text.size())) return error;
  return file.commit();
}

TEST_F(AtomicFiles, AppearOnlyWhenCommitted) {
  AtomicFile file;
  ASSERT_EQ(file.open(path("a.exr")), std::nullopt);
  ASSERT_EQ(file.write("123456", 6), std::nullopt);
  ASSERT_EQ(file.seek(2), std::nullopt);
  ASSERT_EQ(file.write("x", 1), std::nullopt);
  EXPECT_EQ(file.position(), 3u);
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
  ASSERT_EQ(file.commit(), std::nullopt);
  EXPECT_EQ(bytes_of(path("a.exr")), "12x456");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFiles, LeaveNothingWhenDropped) {
  write_bytes(path("a.exr"), "old");
  {
    AtomicFile file;
    ASSERT_EQ(file.open(path("a.exr")), std::nullopt);
    ASSERT_EQ(file.write("new", 3), std::nullopt);
    EXPECT_EQ(file_count(), 2u);
  }
  EXPECT_EQ(file_count(), 1u);
  EXPECT_EQ(bytes_of(path("a.exr")), "old");
}

TEST_F(AtomicFiles, ReplaceAndKeepPermissionsAndLinks) {
  write_bytes(path("real.exr"), "old");
  ::chmod(path("real.exr").c_str(), 0640);
  std::filesystem::create_symlink("real.exr", path("link.exr"));
  ASSERT_EQ(write_text(path("link.exr"), "new"), std::nullopt);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.exr")));
  EXPECT_EQ(bytes_of(path("real.exr")), "new");
  struct stat status = {};
  ::stat(path("real.exr").c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(AtomicFiles, HonourTheUmaskForNewFiles) {
  const mode_t before = ::umask(027);
  ASSERT_EQ(write_text(path("a.exr"), "new"), std::nullopt);
  ::umask(before);
  struct stat status = {};
  ::stat(path("a.exr").c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(AtomicFiles, TakeNamesAsLongAsTheFileSystemDoes) {
  const std::string longest = path(std::string(251, 'n') + ".exr");
  EXPECT_EQ(check_target(longest), std::nullopt);
  EXPECT_EQ(write_text(longest, "new"), std::nullopt);
  EXPECT_THAT(check_target(path(std::string(252, 'n') + ".exr")), Optional(HasSubstr("File name too long")));
  EXPECT_EQ(file_count(), 1u);
}

// A file size limit stands in for a full disk: the write fails after some bytes went through.
TEST_F(AtomicFiles, ReportAFullDiskAndLeaveNothing) {
  write_bytes(path("a.exr"), "old");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before = {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small = {5000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const FileError at_write = write_text(path("a.exr"), std::string(100000, 'x'));
  const FileError at_commit = write_text(path("a.exr"), std::string(5001, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(at_write, path("a.exr") + ": writing failed: File too large");
  EXPECT_EQ(at_commit, path("a.exr") + ": writing failed: File too large");
  EXPECT_EQ(bytes_of(path("a.exr")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFiles, KeepTheFirstError) {
  AtomicFile file;
  EXPECT_TRUE(file.open(path("none/a.exr")).has_value());
  EXPECT_THAT(file.write("x", 1), Optional(HasSubstr("none")));
  EXPECT_THAT(file.seek(0), Optional(HasSubstr("none")));
  EXPECT_THAT(file.commit(), Optional(HasSubstr("No such file or directory")));
}

TEST_F(AtomicFiles, AreRemovedByASignalHandlersHand) {
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile one, two;
    const bool opened = !one.open(path("a.exr")) && !two.open(path("b.exr"));
    remove_unfinished_files();
    ::_exit(opened ? 7 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(AtomicFiles, AnyNumberMayBeOpenAtOnce) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (int i = 0; i < 20; ++i) {
    files.push_back(std::make_unique<AtomicFile>());
    ASSERT_EQ(files.back()->open(path("same.exr")), std::nullopt);
    const std::string text = std::to_string(i);
    ASSERT_EQ(files.back()->write(text.data(), text.size()), std::nullopt);
  }
  for (auto& file : files) ASSERT_EQ(file->commit(), std::nullopt);
  EXPECT_EQ(bytes_of(path("same.exr")), "19");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFiles, SayWhatIsWrongWithATargetBeforeAnythingIsRendered) {
  std::filesystem::create_directory(path("folder.exr"));
  write_bytes(path("file"), "");
  std::filesystem::create_symlink("/dev/full", path("device.exr"));
  EXPECT_EQ(check_target(""), "an empty name was given for an output file");
  EXPECT_EQ(check_target(path("folder.exr")), path("folder.exr") + ": is a folder, a file's name was expected");
  EXPECT_EQ(check_target(path("x.exr/")), path("x.exr/") + ": names a folder, a file's name was expected");
  EXPECT_EQ(check_target(path("none/a.exr")),
            path("none/a.exr") + ": the folder '" + path("none") + "' cannot be used: No such file or directory");
  EXPECT_EQ(check_target(path("file/a.exr")), path("file/a.exr") + ": '" + path("file") + "' is not a folder");
  EXPECT_EQ(check_target(path("device.exr")),
            path("device.exr") + ": is a device or pipe, an ordinary file was expected");
  EXPECT_EQ(check_target("/dev/full"), "/dev/full: is a device or pipe, an ordinary file was expected");
  EXPECT_THAT(check_target("/proc/a.exr"), Optional(HasSubstr("no file can be made in the folder '/proc'")));
  EXPECT_EQ(check_target(path("a.exr")), std::nullopt);
  EXPECT_EQ(file_count(), 3u) << "a check leaves nothing behind";
}

TEST_F(AtomicFiles, ReadOnlyFoldersAreFoundBeforeRendering) {
  if (::geteuid() == 0) {
    // Root may write anywhere; an ordinary user in a child process may not.
    ::chmod(folder_.c_str(), 0755);
    const pid_t child = ::fork();
    if (child == 0) {
      const bool dropped = ::setgid(65534) == 0 && ::setuid(65534) == 0;
      const FileError error = check_target(path("a.exr"));
      ::_exit(dropped && error && error->find("Permission denied") != std::string::npos ? 7 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
  } else {
    ::chmod(folder_.c_str(), 0555);
    EXPECT_THAT(check_target(path("a.exr")), Optional(HasSubstr("Permission denied")));
    ::chmod(folder_.c_str(), 0755);
  }
}

TEST_F(AtomicFiles, KindsAreKnownByTheirEnding) {
  EXPECT_EQ(output_kind("a.exr"), OutputKind::exr);
  EXPECT_EQ(output_kind("b.c/a.b.PNG"), OutputKind::png);
  for (const char* unknown : {"a", "a.jpg", "a.exr.gz", ".exr", "folder.exr/a", "folder/.png", "", "a."})
    EXPECT_EQ(output_kind(unknown), std::nullopt) << unknown;
  EXPECT_EQ(check_writable(path("a.jpg")),
            path("a.jpg") +
                ": '.jpg' is an unknown kind of picture; the kinds that can be written are .exr (linear, "
                "32-bit float) and .png (8-bit, display-encoded)");
  EXPECT_THAT(check_writable(path("a")), Optional(HasSubstr("no ending that says its kind; the kinds")));
  EXPECT_EQ(check_writable(path("a.png"), OutputKind::exr), path("a.png") + ": an .exr file was expected here");
  EXPECT_EQ(check_writable(path("a.exr"), OutputKind::png), path("a.exr") + ": a .png file was expected here");
  EXPECT_EQ(check_writable(path("a.exr"), OutputKind::exr), std::nullopt);
  EXPECT_THAT(check_writable(path("none/a.png"), OutputKind::png), Optional(HasSubstr("No such file")));
  EXPECT_EQ(file_count(), 0u);
}

}  // namespace
}  // namespace metamer
