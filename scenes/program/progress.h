// How far the frame is, told to a person on a terminal or to a log.
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "engine/schedule/workers.h"
#include "systems/render.h"

namespace metamer {

// Reports to standard error from a thread of its own until it is destroyed: on a terminal a bar that is redrawn five
// times a second and taken away at the end; else a line after 1, 2, 5, 10, 30 seconds, and so on.
class ProgressReport {
 public:
  // All must outlive the report.
  ProgressReport(const RenderProgress& progress, const Cancellation& cancellation);
  ~ProgressReport();
  ProgressReport(const ProgressReport&) = delete;
  ProgressReport& operator=(const ProgressReport&) = delete;

 private:
  void run();
  void report(double seconds);

  const RenderProgress& progress_;
  const Cancellation& cancellation_;
  std::chrono::steady_clock::time_point start_;
  bool on_terminal_;
  bool told_of_interruption_ = false;
  double next_line_seconds_ = 1;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool finished_ = false;
  std::thread thread_;  // last: it uses all of the above
};

// "12.3 M", "845 k", "17".
std::string short_count(double count);
// "17 ms", "4.2 s", "3:07 min", "2:05:10 h".
std::string short_time(double seconds);
// "1.5 GiB", "208 bytes".
std::string short_bytes(double bytes);

}  // namespace metamer
