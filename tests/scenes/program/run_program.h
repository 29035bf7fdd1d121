// The built program as its users see it: arguments and files in, exit code, text and files out.
#pragma once
#include <fcntl.h>
#include <gmock/gmock.h>
#include <json/json.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/scenes/support/files.h"

namespace metamer {

struct ProgramResult {
  int exit_code = -1;  // -1: it did not exit by itself
  std::string out, err;
};

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

using Arguments = std::vector<std::string>;
using Variables = std::map<std::string, std::string>;

// The program at work in a folder; where it prints lies in another folder.
class RunningProgram {
 public:
  // A descriptor given for standard error (a terminal) replaces the file.
  RunningProgram(const Arguments& arguments, const std::filesystem::path& folder, const Variables& variables = {},
                 int standard_error = -1) {
    const std::string out = (printed_.path() / "out").string(), err = (printed_.path() / "err").string();
    std::vector<char*> argv = {const_cast<char*>(METAMER_PROGRAM)};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ != 0) return;
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    ::dup2(::open(out.c_str(), O_CREAT | O_WRONLY, 0600), STDOUT_FILENO);
    ::dup2(standard_error >= 0 ? standard_error : ::open(err.c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
    for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~RunningProgram() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }

  void send(int signal) const { ::kill(process_, signal); }
  std::string err_so_far() const { return read_bytes(printed_.path() / "err"); }
  // What the kernel knows the program catches; before that a signal would simply end it.
  bool catches(int signal) const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    uint64_t mask = 0;
    for (std::string word; status >> word;)
      if (word == "SigCgt:") status >> std::hex >> mask;
    return (mask >> (signal - 1) & 1) != 0;
  }

  // Threads that have used 50 ms of processor time or more.
  size_t threads_at_work() const {
    size_t threads = 0;
    std::error_code gone;
    const std::string tasks = "/proc/" + std::to_string(process_) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks, gone)) {
      std::ifstream stat(task.path() / "stat");
      std::string field;
      for (int i = 0; i < 14; ++i) stat >> field;  // the name, field 2, has no blank; 14 is user time in ticks
      threads += std::strtoul(field.c_str(), nullptr, 10) * 1000 >= 50 * static_cast<size_t>(::sysconf(_SC_CLK_TCK));
    }
    return threads;
  }

  ProgramResult wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(printed_.path() / "out"), err_so_far()};
  }

 private:
  TemporaryFolder printed_;
  pid_t process_ = -1;
};

inline ProgramResult run_program(const Arguments& arguments, const std::filesystem::path& folder,
                                 const Variables& variables = {}) {
  return RunningProgram(arguments, folder, variables).wait();
}

// Waits until `condition` holds, for at most half a minute.
template <class F>
bool wait_until(F&& condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// Names of all that is in a folder, hidden files too.
inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

inline Json::Value parse_json(const std::string& text) {
  Json::Value json;
  std::string errors;
  const std::unique_ptr<Json::CharReader> reader(Json::CharReaderBuilder().newCharReader());
  EXPECT_TRUE(reader->parse(text.data(), text.data() + text.size(), &json, &errors)) << errors << text;
  return json;
}

// A lamp above a floor with a ball: 16x12 pixels, 4 samples.
inline constexpr std::string_view small_scene = R"({
  "metamer": 1,
  "settings": {"size": [16, 12], "samples": 4, "max_depth": 3, "seed": 1, "filter": {"type": "box"}},
  "entities": [
    {"transform": {"look_at": {"from": [0, 1, 4], "to": [0, 0.5, 0], "up": [0, 1, 0]}},
     "camera": {"type": "perspective", "fov": 60}},
    {"transform": {"rotate": {"axis": [1, 0, 0], "degrees": -90}},
     "geometry": {"type": "rectangle", "width": 10, "depth": 10},
     "material": {"type": "diffuse", "reflectance": 0.5}},
    {"transform": {"translate": [0, 0.5, 0]},
     "geometry": {"type": "sphere", "radius": 0.5},
     "material": {"type": "diffuse", "reflectance": {"rgb": [0.7, 0.2, 0.1]}}},
    {"light": {"type": "environment", "radiance": {"constant": 2e-6}}},
    {"transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 3, 0]}],
     "geometry": {"type": "rectangle", "width": 1, "depth": 1},
     "light": {"type": "area", "radiance": {"constant": 3e-5}}}
  ]
})";

// The scene in a folder of its own, as small.json.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest() { folder_.write("small.json", small_scene); }
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::string bytes(const std::string& name) const { return read_bytes(folder() / name); }
  ProgramResult run(const Arguments& arguments, const Variables& variables = {}) const {
    return run_program(arguments, folder(), variables);
  }

  TemporaryFolder folder_;
};

}  // namespace metamer
