// Furnaces: in an enclosure of one radiance everything that absorbs nothing is invisible. On each wavelength.
#include "systems/bsdf/reference.h"
#include "tests/support/chi_square.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr uint32_t many_events = 400;

SceneBuilder furnace(uint32_t samples_per_pixel, uint32_t max_depth, Integrator integrator = Integrator::path) {
  SceneBuilder b(16, 16, samples_per_pixel, max_depth);
  b.scene.settings.integrator = integrator;
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  return b;
}
// What meets the light at once is the same at all levels; what mirrors or refracts, at the upper two.
constexpr Integrator all_levels[] = {Integrator::local, Integrator::recursive, Integrator::path};
constexpr Integrator upper_levels[] = {Integrator::recursive, Integrator::path};
SceneBuilder plane_in_furnace(double theta, Integrator integrator) {
  SceneBuilder b(16, 16, 1024, 2);
  b.scene.settings.integrator = integrator;
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({std::sin(theta), 0, std::cos(theta)}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
  return b;
}
const auto one = [](double) { return 1.0; };

TEST(Furnace, AWhiteSphereVanishes) {
  SceneBuilder b = furnace(256, many_events);
  b.add(sphere(1), b.diffuse(1.0));
  expect_mean(trace_radiances(*b.freeze()), one, 0.02);
}

TEST(Furnace, WhiteBodiesThatSeeEachOtherVanish) {
  SceneBuilder b = furnace(256, many_events);
  b.add(sphere(0.6f), b.diffuse(1.0), moved(-0.5, 0, 0));
  b.add(sphere(0.6f), b.diffuse(1.0), moved(0.5, 0, 0.3));
  b.add(rectangle(4, 4), b.diffuse(1.0), moved(0, -0.6, 0) * turned(-70, 1, 0, 0));
  expect_mean(trace_radiances(*b.freeze()), one, 0.02);
}

TEST(Furnace, AGreySphereShowsItsReflectance) {
  SceneBuilder b = furnace(256, many_events);
  b.add(sphere(3.5f), b.diffuse(0.0), moved(0, 0, -4));  // fills the view: nothing of the sky is seen
  SceneBuilder c = furnace(256, many_events);
  const std::vector<double> lambda_nm = {360, 830}, values = {0.1, 0.9};
  c.add(sphere(3.5f), c.diffuse(c.scene.spectra.add_table(lambda_nm, values, Extend::constant).id), moved(0, 0, -4));
  for (const PathRadiance& path : trace_radiances(*b.freeze()))
    for (const double radiance : path.radiance) ASSERT_EQ(radiance, 0);
  const auto reflectance = [](double nm) { return 0.1 + 0.8 * (nm - 360) / 470; };
  expect_mean(trace_radiances(*c.freeze()), reflectance, 0.02);
}

// A closed sphere of reflectance r that emits e inwards: after N scatterings e (1 + r + ... + r^N).
TEST(Furnace, AClosedSphereSumsItsReflections) {
  for (const uint32_t depth : {0u, 1u, 3u, 60u}) {
    SceneBuilder b(16, 16, 512, depth);
    const std::vector<double> lambda_nm = {360, 830}, values = {0.2, 0.8};
    Geometry shell = sphere(2);
    shell.flip_normal = 1;
    const Entity wall =
        b.add(shell, b.diffuse(b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id), moved(0.3, 0, 0));
    b.emit(wall, unit_spectrum, 0.5f);
    b.look_at({0, 0, 0}, {0, 0, 1}, perspective(60));
    const auto sum = [&](double nm) {
      const double r = 0.2 + 0.6 * (nm - 360) / 470;
      return 0.5 * (1 - std::pow(r, depth + 1)) / (1 - r);
    };
    SCOPED_TRACE(depth);
    expect_mean(trace_radiances(*b.freeze()), sum, 0.02);
  }
}

TEST(Furnace, APerfectMirrorVanishesOnEveryPath) {
  for (const Integrator integrator : upper_levels) {
    SceneBuilder b = furnace(8, many_events, integrator);
    b.add(sphere(0.6f), b.conductor(b.constant(1), b.constant(1e8)), moved(-0.5, 0, 0));
    b.add(sphere(0.6f), b.conductor(b.constant(1), b.constant(1e8)), moved(0.5, 0, 0.3));
    expect_every_path(trace_radiances(*b.freeze()), one, 1e-5);
  }
}

TEST(Furnace, ALosslessGlassSphereVanishesOnEveryPath) {
  for (const Integrator integrator : upper_levels) {
    SceneBuilder b = furnace(32, many_events, integrator);
    b.add(sphere(1), b.dielectric(b.constant(1.5)));
    expect_every_path(trace_radiances(*b.freeze()), one, 1e-4);
  }
}

TEST(Furnace, ALosslessGlassCubeVanishesOnEveryPath) {
  for (const Integrator integrator : upper_levels) {
    SceneBuilder b = furnace(32, many_events, integrator);
    b.scene.meshes.push_back(cube_mesh());
    b.add(mesh(0), b.dielectric(b.constant(1.5)), turned(30, 1, 0.5, 0.2));
    expect_every_path(trace_radiances(*b.freeze()), one, 1e-4);
  }
}

TEST(Furnace, AThinPlateVanishesOnEveryPath) {
  SceneBuilder b = furnace(32, many_events);
  b.add(sphere(1), b.thin(b.constant(1.5), zero_spectrum, 0));
  b.add(rectangle(1, 1), b.thin(b.constant(2.4), zero_spectrum, 0), moved(0, 0, 1.5) * turned(40, 1, 0.3, 0));
  expect_every_path(trace_radiances(*b.freeze()), one, 1e-5);
}

// A rough boundary in its furnace: what facets scatter twice is lost, from either side, and nothing is gained. One
// event: what is refracted meets the furnace there.
TEST(Furnace, RoughGlassShowsItsAlbedo) {
  struct Case {
    float alpha_x, alpha_y;
    double eta, degrees;
  };
  for (const auto& [alpha_x, alpha_y, eta, degrees] : {Case{0.1f, 0.1f, 1.5, 20},
                                                       {0.5f, 0.5f, 1.5, 0},
                                                       {0.4f, 0.4f, 1.33, 75},
                                                       {0.15f, 0.6f, 1.5, 50},
                                                       {0.4f, 0.4f, 0.7, 30}}) {
    const double theta = glm::radians(degrees);
    const reference::Direction wo = {std::sin(theta), 0, std::cos(theta)};
    reference::DielectricOptics optics;
    optics.eta.fill(eta);
    const reference::Roughness roughness{double{alpha_x}, double{alpha_y}};
    const auto f_cos = [&](double cos_theta, double phi) {
      const double s = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
      return reference::eval_rough_dielectric(wo, roughness, optics, {s * std::cos(phi), s * std::sin(phi), cos_theta})
          .f_cos[0];
    };
    const double albedo = integrate_rectangle(f_cos, -1, 1, -glm::radians(180.0), glm::radians(180.0), 128);
    SceneBuilder b(16, 16, 1024, 1);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({std::sin(theta), 0, std::cos(theta)}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
    b.add(rectangle(1, 1), b.rough_glass(b.constant(eta), alpha_x, alpha_y));
    SCOPED_TRACE(testing::Message() << alpha_x << " " << alpha_y << ", " << eta << " at " << degrees);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return albedo; }, 0.02);
  }
}

TEST(Furnace, ARoughGlassBodyLosesLittleAndGainsNothing) {
  SceneBuilder b = furnace(256, many_events);
  b.add(sphere(0.6f), b.rough_glass(b.constant(1.5), 0.2f, 0.2f), moved(-0.5, 0, 0));
  b.add(sphere(0.6f), b.rough_glass(b.named("SF66"), 0.3f, 0.1f), moved(0.5, 0, 0.3));
  double sum = 0;
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) sum += radiance;
  EXPECT_GT(sum, 0.8 * 4 * double(paths.size()));
  EXPECT_LT(sum, 1.001 * 4 * double(paths.size()));
}

TEST(Furnace, DispersingGlassVanishesOnEachWavelength) {
  SceneBuilder b = furnace(2048, many_events);
  b.add(sphere(1), b.dielectric(b.named("SF66")));
  expect_mean(trace_radiances(*b.freeze()), one, 0.03);
}

// A lossless microfacet surface loses what would scatter twice between its facets: its albedo is the integral of the
// scalar f cos over the hemisphere, below 1.
TEST(Furnace, LosslessRoughMetalShowsItsAlbedo) {
  struct Case {
    float alpha_x, alpha_y;
    double degrees;
  };
  for (const auto& [alpha_x, alpha_y, degrees] :
       {Case{0.05f, 0.05f, 20}, {0.4f, 0.4f, 0}, {0.4f, 0.4f, 75}, {0.15f, 0.5f, 50}, {0.9f, 0.9f, 30}}) {
    const double theta = glm::radians(degrees);
    const reference::Direction wo = {std::sin(theta), 0, std::cos(theta)};
    const reference::ConductorOptics lossless{{1, 1, 1, 1}, {1e8, 1e8, 1e8, 1e8}, false};
    const auto f_cos = [&](double angle, double phi) {
      const reference::Direction wi = {std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                       std::cos(angle)};
      return reference::eval_conductor(wo, {alpha_x, alpha_y}, lossless, wi).f_cos[0] * std::sin(angle);
    };
    const double albedo =
        integrate_rectangle(f_cos, 0, glm::radians(90.0), -glm::radians(180.0), glm::radians(180.0), 64);
    EXPECT_LT(albedo, 1);
    for (const Integrator integrator : all_levels) {
      SceneBuilder b = plane_in_furnace(theta, integrator);
      b.add(rectangle(1, 1), b.conductor(b.constant(1), b.constant(1e8), alpha_x, alpha_y));
      SCOPED_TRACE(testing::Message() << alpha_x << " " << alpha_y << " at " << degrees << ", "
                                      << integrator_name(integrator));
      expect_mean(
          trace_radiances(*b.freeze()), [&](double) { return albedo; }, 0.02);
    }
  }
}

// A rough surface in light of 1 from everywhere shows the integral of its scalar f cos, on each wavelength: the diffuse
// part rises with the wavelength here.
TEST(Furnace, RoughMatterShowsItsAlbedo) {
  struct Case {
    double ks, degrees;
    float shininess;
    bool normalized;
  };
  for (const auto& [ks, degrees, shininess, normalized] : {Case{0.2, 30, 10, false},
                                                           {0.2, 75, 2, false},
                                                           {0.4, 0, 100, false},
                                                           {0.6, 30, 10, true},
                                                           {0.6, 80, 40, true}}) {
    const double theta = glm::radians(degrees);
    const reference::Direction wo = {std::sin(theta), 0, std::cos(theta)};
    const auto kd = [](double nm) { return 0.1 + 0.2 * (nm - 360) / 470; };
    const auto glossy = [&, &k = ks, &s = shininess, &n = normalized](double angle, double phi) {
      const reference::Direction wi = {std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                       std::cos(angle)};
      return reference::eval_rough(wo, {{}, {k, k, k, k}, s, n}, wi).f_cos[0] * std::sin(angle);
    };
    const double glossy_albedo =
        integrate_rectangle(glossy, 0, glm::radians(90.0), -glm::radians(180.0), glm::radians(180.0), 64);
    const double diffuse = normalized ? 1 : glm::radians(180.0);
    for (const Integrator integrator : all_levels) {
      SceneBuilder b = plane_in_furnace(theta, integrator);
      const std::vector<double> lambda_nm = {360, 830}, values = {0.1, 0.3};
      const SpectrumId slope = b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
      b.add(rectangle(1, 1), b.rough(slope, b.constant(ks), shininess, normalized));
      SCOPED_TRACE(testing::Message() << ks << " " << shininess << " at " << degrees
                                      << (normalized ? " normalised, " : ", ") << integrator_name(integrator));
      expect_mean(
          trace_radiances(*b.freeze()), [&](double nm) { return diffuse * kd(nm) + glossy_albedo; }, 0.02);
    }
  }
}

// White matter in the normalised form never outshines its furnace, whatever is asked of it.
TEST(Furnace, NormalisedRoughMatterLosesButNeverGains) {
  SceneBuilder b = furnace(256, many_events);
  b.add(sphere(0.6f), b.rough(b.constant(0.5), b.constant(1), 20, true), moved(-0.5, 0, 0));
  b.add(sphere(0.6f), b.rough(b.constant(0.3), b.constant(0.7), 200, true), moved(0.5, 0, 0.3));
  double sum = 0;
  const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) sum += radiance;
  EXPECT_GT(sum, 0.7 * 4 * double(paths.size()));
  EXPECT_LT(sum, 4 * double(paths.size()));
}

}  // namespace
}  // namespace metamer
