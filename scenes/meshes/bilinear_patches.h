// Bilinear patches: quadrilaterals whose corners need not lie in a plane.
#pragma once
#include "engine/ecs/scene.h"

namespace metamer {

// What was cut: how many quadrilaterals along an edge at most, and how far from the patch they may be, in shares of the
// patch's size (the largest distance between two of its corners). 1 and 0 where all patches are flat.
struct PatchCut {
  uint32_t most_steps = 1;
  double tolerance = 0;
};

// `patches.indices` name four corners each, at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1); indices are within the
// vertices, normals and uvs one per vertex or none. Adds triangles to `mesh`: two for a flat convex patch, for others
// as many as keep within 1e-4 of its size, or a coarser tolerance where that were more than 2e7. The normal is on the
// side of dp/du x dp/dv; where the mesh has no normals of its own and some patch is curved it gets those of the
// patches.
PatchCut cut_patches(const Mesh& patches, Mesh& mesh);

}  // namespace metamer
