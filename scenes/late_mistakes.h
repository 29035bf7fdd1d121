// Mistakes that only the building of a world finds, for files that the reader refuses.
#pragma once
#include "engine/ecs/scene.h"

namespace metamer {

// Adds to the mistakes of a reader those that freeze would report of what it did read, so that the author sees all in
// one go. Left out is what may follow from the reader's mistakes: whatever has no line, or is about an entity
// one of whose lines the reader has complained about.
void add_late_mistakes(const Scene& scene, Diagnostics& diagnostics);

}  // namespace metamer
