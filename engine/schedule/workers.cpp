#include "engine/schedule/workers.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include "engine/simd/instruction_set.h"

namespace metamer {

uint32_t available_threads() { return static_cast<uint32_t>(oneapi::tbb::info::default_concurrency()); }

void run_units(uint32_t threads, size_t units, const Cancellation& cancellation, UnitFunction function, void* context) {
  namespace tbb = oneapi::tbb;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  std::atomic<size_t> next{0};
  // One task per worker, each taking units until none is left: the order in which they begin is the queue's.
  arena.execute([&] {
    tbb::parallel_for(
        uint32_t{0}, threads,
        [&](uint32_t worker) {
          const FlushDenormals flush;
          while (!cancellation.requested()) {
            const size_t unit = next.fetch_add(1, std::memory_order_relaxed);
            if (unit >= units) return;
            function(context, worker, unit);
          }
        },
        tbb::simple_partitioner());
  });
}

}  // namespace metamer
