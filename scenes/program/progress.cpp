#include "scenes/program/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace metamer {
namespace {

constexpr std::chrono::milliseconds redraw_interval{200};
constexpr std::array line_seconds = {1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0};
constexpr size_t widest_bar = 40;  // characters

// In one call, so that a terminal never shows half of it.
void print(const std::string& text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

bool is_terminal() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && kind != nullptr && std::string_view(kind) != "dumb";
}

size_t terminal_columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

// What there is to say, the most important first.
std::vector<std::string> facts(double fraction, double rate, double seconds) {
  std::vector<std::string> words = {fmt::format("{:3.0f} %", std::floor(100 * fraction))};
  if (rate <= 0) return words;
  words.push_back(short_time(seconds * (1 - fraction) / fraction) + " left");
  words.push_back(short_count(rate) + " samples/s");
  return words;
}

// A line that fits into `columns`: facts are left out from the end, and what remains is the bar.
std::string bar_line(const std::vector<std::string>& words, double fraction, size_t columns) {
  std::string line;
  for (const std::string& word : words) {
    const size_t gap = line.empty() ? 0 : 2;
    if (line.size() + gap + word.size() >= columns) break;
    line += std::string(gap, ' ') + word;
  }
  const size_t room = columns > line.size() + 5 ? columns - line.size() - 5 : 0;  // brackets, gap, last column
  if (room < 5) return line;
  const size_t width = std::min(room, widest_bar);
  const size_t full = std::min(width, static_cast<size_t>(fraction * static_cast<double>(width)));
  return fmt::format("[{:#<{}}{:-<{}}] {}", "", full, "", width - full, line);
}

double next_line_after(double seconds) {
  const auto next = std::upper_bound(line_seconds.begin(), line_seconds.end(), seconds);
  return next != line_seconds.end() ? *next : (std::floor(seconds / 600) + 1) * 600;
}

}  // namespace

ProgressReport::ProgressReport(const RenderProgress& progress, const Cancellation& cancellation)
    : progress_(progress),
      cancellation_(cancellation),
      start_(std::chrono::steady_clock::now()),
      on_terminal_(is_terminal()),
      thread_([this] { run(); }) {}

ProgressReport::~ProgressReport() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  wake_.notify_one();
  thread_.join();
  if (on_terminal_) print("\r\033[K");
}

void ProgressReport::run() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, redraw_interval, [this] { return finished_; }))
    report(std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
}

void ProgressReport::report(double seconds) {
  if (cancellation_.requested()) {
    if (told_of_interruption_) return;
    told_of_interruption_ = true;
    print(fmt::format("{}metamer: interrupted; finishing the tiles that were begun, once more stops at once\n",
                      on_terminal_ ? "\r\033[K" : ""));
    return;
  }
  const double done = static_cast<double>(progress_.samples_done.load(std::memory_order_relaxed));
  const double total = static_cast<double>(progress_.samples_total.load(std::memory_order_relaxed));
  const double fraction = total > 0 ? std::min(1.0, done / total) : 0;
  const std::vector<std::string> words = facts(fraction, done / seconds, seconds);
  if (on_terminal_) {
    print(fmt::format("\r{}\033[K", bar_line(words, fraction, terminal_columns())));
  } else if (seconds >= next_line_seconds_) {
    next_line_seconds_ = next_line_after(seconds);
    print(fmt::format("metamer: {}\n", fmt::join(words, ", ")));
  }
}

std::string short_count(double count) {
  if (count >= 9.995e8) return fmt::format("{:.3g} G", count * 1e-9);
  if (count >= 9.995e5) return fmt::format("{:.3g} M", count * 1e-6);
  if (count >= 999.5) return fmt::format("{:.3g} k", count * 1e-3);
  return fmt::format("{:.0f}", count);
}

std::string short_time(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1e3);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<uint64_t>(std::min(seconds, 1e12) + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string short_bytes(double bytes) {
  constexpr std::array units = {"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return fmt::format("{:.0f} bytes", bytes);
  size_t unit = 0;
  for (bytes /= 1024; bytes >= 1024 && unit + 1 < units.size(); ++unit) bytes /= 1024;
  return fmt::format("{:.1f} {}", bytes, units[unit]);
}

}  // namespace metamer
