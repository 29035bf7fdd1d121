// The order of the systems: the only place that knows it.
#pragma once
#include "systems/systems.h"

namespace metamer {

// Traces samples [sample_begin, sample_end) of every pixel of a tile to the end of their paths (global illumination by
// path tracing with next-event estimation and multiple importance sampling) and adds them to `film`, which covers the
// tile. A pure function of the world, the tile and the range: no state survives in the batch.
void trace_tile(const World& world, const TileRect& tile, uint32_t sample_begin, uint32_t sample_end, Batch& batch,
                TileFilm& film, Counters& counters);

}  // namespace metamer
