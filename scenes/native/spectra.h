// Spectra of the native format: numbers, names, tables, black bodies, daylight and rgb.
#pragma once
#include "scenes/native/scene_context.h"

namespace metamer {

// Declares the file's "spectra", so that names can refer to them in any order.
void declare_spectra(SceneContext& context, const Json::Value& spectra);

// Checks the form of those that nothing has used.
void check_unused_spectra(SceneContext& context);

// The spectrum for a quantity; the zero spectrum where it is wrong, which is reported. `what` is its key.
SpectrumId read_spectrum(SceneContext& context, const Json::Value& value, std::string_view what, Quantity quantity);

// The real or imaginary index of a metal ("Au") and the index of a glass ("BK7") by name.
struct MetalSpectra {
  SpectrumId eta = zero_spectrum, kappa = zero_spectrum;
};
MetalSpectra read_metal(SceneContext& context, const Json::Value& name);
SpectrumId read_glass(SceneContext& context, const Json::Value& name);

}  // namespace metamer
