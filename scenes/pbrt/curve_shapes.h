// Shape "curve".
#pragma once
#include <optional>

#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

// Curves of one kind that follow each other and share all that the state says about a shape become one shape: hair
// comes a fibre at a time. Nothing where the curve has joined the one before, or after reporting why there is none.
std::optional<Geometry> read_curve(Reader& reader, Parameters& parameters, TextureId alpha);

}  // namespace metamer::pbrt
