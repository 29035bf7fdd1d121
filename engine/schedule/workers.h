// Threads that take units of work from one queue.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace metamer {

// Set from a signal handler or another thread: no further unit is begun.
class Cancellation {
 public:
  void request() { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const { return requested_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> requested_{false};
};

// Hardware threads the process may use.
uint32_t available_threads();

using UnitFunction = void (*)(void* context, uint32_t worker, size_t unit);

// Calls function(context, worker, unit) once for each unit in [0, units), begun in this order, on `threads` threads;
// `worker` in [0, threads) is held by one thread at a time. Workers have denormals flushed to zero. Returns when all
// that was begun is done; after a cancellation units at the end were not begun.
void run_units(uint32_t threads, size_t units, const Cancellation& cancellation, UnitFunction function, void* context);

}  // namespace metamer
