// The BSDFs in scalar double precision, in the textbooks' own words: what the SIMD kernels are measured against and
// what the scalar oracle renders with. Nothing here feeds a pixel of the renderer. Conventions as the kernels:
// directions are unit vectors in the local shading frame (z = shading normal) and point away from the surface,
// f_cos = f |cos(theta_i)|, pdfs per solid angle, a delta lobe carries a probability.
#pragma once
#include <array>
#include <cstddef>

namespace metamer::reference {

using Spectrum4 = std::array<double, 4>;  // one value per wavelength of a path, the hero first

struct Direction {
  double x = 0, y = 0, z = 0;
};
double dot(const Direction& a, const Direction& b);
Direction normalize(const Direction& v);

// R = v + 2 N cos(alpha), v towards the surface. DESIGN.md, section 1.
Direction reflect(const Direction& v, const Direction& n);
// T = v / eta + N (cos(alpha) / eta - sqrt(1 - (1 - cos^2(alpha)) / eta^2)), v towards the surface, N against v; false
// in total internal reflection. DESIGN.md, section 1.
bool refract(const Direction& v, const Direction& n, double eta, Direction& t);

// Fresnel reflectances of unpolarised light; eta = n_transmitted / n_incident, cos_theta_i in [0, 1].
// cos_transmitted returns 0 in total internal reflection.
double cos_transmitted(double eta, double cos_theta_i);
// The s and p terms of a boundary between transparent media, r_s = (c - eta c_t) / (c + eta c_t) and
// r_p = (eta c - c_t) / (eta c + c_t), squared: Hecht, Optics, equations 4.34 and 4.40.
struct Polarised {
  double s, p;
};
Polarised fresnel_dielectric_polarised(double eta, double cos_theta_i);
double fresnel_dielectric(double eta, double cos_theta_i);
double schlick_dielectric(double eta, double cos_theta_i);
double fresnel_conductor(double n, double kappa, double cos_theta_i);
double schlick_conductor(double n, double kappa, double cos_theta_i);

struct BsdfValue {
  Spectrum4 f_cos{};
  double pdf = 0;
};
struct BsdfSample {
  Direction wi;
  Spectrum4 weight{};  // f_cos / pdf
  double pdf = 0;      // 0: the draw is void
  bool delta = false;
  bool transmitted = false;
  bool terminate_secondary = false;  // only the hero wavelength goes on
};

BsdfValue eval_diffuse(const Direction& wo, const Spectrum4& albedo, const Direction& wi);
BsdfSample sample_diffuse(const Direction& wo, const Spectrum4& albedo, double u, double v);

// The sheet that scatters to both sides: see diffuse_transmission-inl.h.
struct SheetOptics {
  Spectrum4 reflectance{}, transmittance{};
};
BsdfValue eval_sheet(const Direction& wo, const SheetOptics& optics, const Direction& wi);
BsdfSample sample_sheet(const Direction& wo, const SheetOptics& optics, double choice, double u, double v);

// Both forms of the rough reflector: see rough-inl.h. `choice` takes the lobe.
struct RoughOptics {
  Spectrum4 kd{}, ks{};
  double shininess = 0;
  bool normalized = false;
};
BsdfValue eval_rough(const Direction& wo, const RoughOptics& optics, const Direction& wi);
BsdfSample sample_rough(const Direction& wo, const RoughOptics& optics, double choice, double u, double v);

struct Roughness {
  double alpha_x = 0, alpha_y = 0;
};
bool is_smooth(const Roughness& roughness);
double ggx_d(const Roughness& roughness, const Direction& m);
double ggx_lambda(const Roughness& roughness, const Direction& w);

struct ConductorOptics {
  Spectrum4 n{}, kappa{};
  bool schlick = false;
};
BsdfValue eval_conductor(const Direction& wo, const Roughness& roughness, const ConductorOptics& optics,
                         const Direction& wi);
BsdfSample sample_conductor(const Direction& wo, const Roughness& roughness, const ConductorOptics& optics, double u,
                            double v);

// The smooth dielectric: see dielectric-inl.h for the choice of lobe. eta = n_inside / n_outside.
struct DielectricOptics {
  Spectrum4 eta{};
  bool schlick = false;
  bool dispersive = false;  // the wavelengths part and all four are alive
  std::array<bool, 4> opaque{};
  Spectrum4 kappa{};  // of the opaque ones
};
BsdfSample sample_dielectric(const Direction& wo, const DielectricOptics& optics, double u);

// The rough dielectric: see rough_dielectric-inl.h; nothing of it is opaque. `pdf` of each wavelength as the hero.
struct RoughDielectricValue {
  Spectrum4 f_cos{}, pdf{};
};
RoughDielectricValue eval_rough_dielectric(const Direction& wo, const Roughness& roughness,
                                           const DielectricOptics& optics, const Direction& wi);
BsdfSample sample_rough_dielectric(const Direction& wo, const Roughness& roughness, const DielectricOptics& optics,
                                   double choice, double u, double v);

// The thin plate: see thin-inl.h. eta and kappa against what is around.
struct ThinOptics {
  Spectrum4 eta{}, kappa{}, optical_depth{};
  std::array<bool, 4> opaque{};
  bool schlick = false, companions = true;
};
struct ThinShares {
  double reflected = 0, transmitted = 0;
};
ThinShares thin_shares(const ThinOptics& optics, std::size_t j, double cos_theta);
BsdfSample sample_thin(const Direction& wo, const ThinOptics& optics, double u);

// The phase function: see phase-inl.h.
double eval_phase(double cos_theta, double g);
Direction sample_phase(double g, double u, double v);
struct PhaseLobes {
  double g = 0, g2 = 0, g2_share = 0;
};
double eval_phase(double cos_theta, const PhaseLobes& lobes);
Direction sample_phase(const PhaseLobes& lobes, double choice, double u, double v);

}  // namespace metamer::reference
