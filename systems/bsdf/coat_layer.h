// pbrt-v4's coat (LayeredBxDF; Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, section 14.3) over a
// diffuse base, where nothing scatters in the layer. pbrt walks at random; what its walks amount to on average is a
// sum in closed form, because a diffuse base forgets where light came from:
//
//   f = f_surface + A(wi) A(wo) a S / (pi eta^2),  S = 1 + a K + ... + (a K)^(n - 1)
//
// f_surface: the surface's reflection. a: the base's albedo. eta: the layer's index against the outside. A(w): the
// share of light from w that reaches the base, refracted by the surface and less by exp(-thickness / |cos|) along the
// way it takes through the layer. K: the share of light from the base that comes back to it, through the layer twice,
// averaged over the hemisphere. n: hits of the base, half of pbrt's `maxdepth`. Facets of a rough surface pass and
// reflect light once; what would meet a second one is lost. f(wi, wo) = f(wo, wi).
//
// The tables are those of coat_albedo.h with 1 - A in place of E and 1 - eta^2 (1 - K) in place of its average, so that
// one kernel serves both coats: with no thickness, n = infinity and a smooth surface they are the same.
//
// All in double precision from + - * /, sqrt and portable functions, the same on every machine.
#pragma once

namespace metamer {

// A of a rough surface; alpha at least least_alpha, eta > 0, thickness >= 0, cos_theta in [0, 1]; to 2e-3.
double rough_layer_entry(double alpha, double eta, double thickness, double cos_theta);

// K under a smooth (alpha 0) or rough surface; to 1e-5 and 2e-3.
double layer_return(double alpha, double eta, double thickness);

// What is left of light that crosses the layer; |cos| inside of it.
double layer_transmittance(double thickness, double cos_inside);

}  // namespace metamer
