// The order of the systems, one function for each arrangement of them: the only place that knows it.
#pragma once
#include "systems/systems.h"

namespace metamer {

// Traces samples [sample_begin, sample_end) of every pixel of a tile by the integrator of the world's settings and adds
// them to `film`, which covers the tile. A pure function of the world, the tile and the range: no state survives in the
// batch.
void trace_tile(const World& world, const TileRect& tile, uint32_t sample_begin, uint32_t sample_end, Batch& batch,
                TileFilm& film, Counters& counters);

// What each integrator does with the rays of `batch.paths`, which come from the camera; the radiance they see is added
// to the slots.
// path: global illumination by path tracing with next-event estimation and multiple importance sampling.
void trace_path(const World& world, Batch& batch, Counters& counters);
// local: emission, and on rough surfaces the light that comes straight from the light sources. Smooth ones show nothing
// but their emission.
void trace_local(const World& world, Batch& batch, Counters& counters);
// recursive (T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980): the same for rays of
// `depth`, and where they meet smooth surfaces, all directions that light takes there become nodes of their ray trees,
// which wait in `batch.nodes`, weighted by the Fresnel function. Each node has a slot of its own: the film's sums are
// exact, so that no order of nodes or batches changes a bit. A node whose throughput falls below least_node_importance
// is dropped: of what it would have seen the picture loses at most that fraction.
void trace_recursive(const World& world, uint32_t depth, Batch& batch, Counters& counters);

// The one that the settings name; `depth` is 0 but for nodes of ray trees.
void trace_rays(const World& world, uint32_t depth, Batch& batch, Counters& counters);

// Rays that a batch may start with: their children are never more than batch_capacity.
uint32_t rays_per_batch(const World& world);

}  // namespace metamer
