#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "engine/simd/instruction_set.h"
#include "scenes/program/commands.h"
#include "scenes/program/failure.h"

namespace metamer {
namespace {

// Every line of a message says whose it is.
void print_error(const std::string& message) {
  size_t begin = 0;
  while (begin < message.size()) {
    const size_t end = std::min(message.find('\n', begin), message.size());
    std::fprintf(stderr, "metamer: error: %.*s\n", static_cast<int>(end - begin), message.data() + begin);
    begin = end + 1;
  }
}

int run(const Command& command) {
  if (const auto* text = std::get_if<ShowText>(&command)) {
    std::fputs(text->text.c_str(), stdout);
    return exit_done;
  }
  if (const std::string error = apply_isa_environment(); !error.empty()) throw Failure(exit_wrong_input, error);
  if (const auto* render = std::get_if<RenderArguments>(&command)) return run_render(*render);
  if (const auto* develop_it = std::get_if<DevelopArguments>(&command)) return run_develop(*develop_it);
  if (const auto* match = std::get_if<MatchArguments>(&command)) return run_match(*match);
  if (const auto* metamers = std::get_if<MetamersArguments>(&command)) return run_metamers(*metamers);
  if (const auto* compare = std::get_if<CompareArguments>(&command)) return run_compare(*compare);
  if (const auto* sky = std::get_if<SkyArguments>(&command)) return run_sky(*sky);
  if (const auto* convert = std::get_if<ConvertArguments>(&command)) return run_convert(*convert);
  if (const auto* info = std::get_if<InfoArguments>(&command)) return run_info(*info);
  return run_version();
}

// What was printed has to have arrived, unless the reader did not want more.
int finish(int code) {
  errno = 0;
  if ((std::fflush(stdout) == 0 && std::ferror(stdout) == 0) || errno == EPIPE) return code;
  print_error(std::string("standard output cannot be written: ") + std::strerror(errno));
  return code == exit_done ? exit_failed : code;
}

// Started with a standard stream closed, the next file that is opened would take its place and receive what is printed.
void open_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) < 0) ::_exit(exit_failed);
}

int run_program(int argc, char** argv) {
  open_standard_streams();
  try {
    return finish(run(parse_command_line(argc, argv)));
  } catch (const Failure& failure) {
    print_error(failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return exit_failed;
}

}  // namespace
}  // namespace metamer

int main(int argc, char** argv) { return metamer::run_program(argc, argv); }
