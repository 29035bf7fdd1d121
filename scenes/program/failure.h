// How a command of the program ends other than well.
#pragma once
#include <stdexcept>
#include <string>

namespace metamer {

// 0 done, 1 could not do it, 2 wrong usage or wrong scene.
enum ExitCode : int { exit_done = 0, exit_failed = 1, exit_wrong_input = 2 };

// Caught in main. The message has one line per mistake; it is empty where all has been said already.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace metamer
