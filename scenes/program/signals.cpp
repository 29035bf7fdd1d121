#include "scenes/program/signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "engine/files/atomic_file.h"
#include "scenes/program/failure.h"

namespace metamer {
namespace {

std::atomic<Cancellation*> cancellation_to_request{nullptr};
std::atomic<bool> has_something_to_save{false};
std::atomic<int> signals_received{0};
static_assert(std::atomic<Cancellation*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// Only what is async-signal-safe.
[[noreturn]] void stop_at_once(std::string_view message, int code) {
  remove_unfinished_files();
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
  ::_exit(code);
}

void handle_signal(int signal) {
  if (signals_received.fetch_add(1) > 0) stop_at_once("\nmetamer: stopped at once\n", 128 + signal);
  if (!has_something_to_save.load())
    stop_at_once("\nmetamer: interrupted before the first pixel; nothing was written\n", exit_failed);
  cancellation_to_request.load()->request();
}

void handle(int signal) {
  struct sigaction action = {};
  action.sa_handler = handle_signal;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void install_signal_handlers(Cancellation& cancellation) {
  cancellation_to_request = &cancellation;
  handle(SIGINT);
  handle(SIGTERM);
  struct sigaction hangup = {};
  if (::sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) handle(SIGHUP);
  std::signal(SIGPIPE, SIG_IGN);
}

void save_when_interrupted() { has_something_to_save = true; }

}  // namespace metamer
