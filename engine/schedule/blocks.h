// A range cut into blocks for several threads.
#pragma once
#include <algorithm>
#include <cstddef>

#include "engine/schedule/workers.h"

namespace metamer {

// Calls items(begin, end) for all of `count`, in blocks on several threads (0: all there are). Blocks are a multiple of
// every vector, but the last; which thread takes which is left open.
template <class Items>
void for_blocks(size_t count, uint32_t threads, size_t block, Items&& items) {
  if (count == 0) return;
  struct Context {
    Items& items;
    size_t count, block;
  } context{items, count, block};
  const size_t blocks = (count + block - 1) / block;
  const size_t workers = std::min<size_t>(threads == 0 ? available_threads() : threads, blocks);
  run_units(
      static_cast<uint32_t>(workers), blocks, Cancellation(),
      [](void* shared, uint32_t, size_t unit) {
        const Context& c = *static_cast<Context*>(shared);
        c.items(unit * c.block, std::min(c.count, (unit + 1) * c.block));
      },
      &context);
}

}  // namespace metamer
