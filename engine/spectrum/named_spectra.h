// Spectra by name: the measured data that scene files may refer to.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "engine/spectrum/samples.h"

namespace metamer {

// Our names: CIE illuminants ("A", "D65", "FL11", "LED-B1", "E", ...) in relative power; metals "Au.n" and "Au.k";
// refractive indices "BK7", "SF11", "SF66", "SF10", "LAK33", "FK51", "fused-silica", "sapphire", "diamond", "water",
// "PMMA"; ColorChecker patches "colorchecker.dark_skin". Those of pbrt-v4 for the same media: "metal-Au-eta",
// "metal-Au-k", "glass-BK7", "stdillum-D65", "stdillum-F11", "illum-acesD60". Reflectances and indices keep their end
// values outside the measured range. Nothing for an unknown name.
std::optional<Samples> named_spectrum(std::string_view name);

// Every valid name, sorted.
std::span<const std::string_view> spectrum_names();

}  // namespace metamer
