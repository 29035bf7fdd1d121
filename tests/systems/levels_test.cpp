// Local and recursive light transport on scenes with closed-form answers: every path matches them on each of its
// wavelengths, without noise. Then path tracing, statistically.
#include <set>

#include "engine/spectrum/spectrum_set.h"
#include "systems/bsdf/reference.h"
#include "tests/reference_path.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double tolerance = 1e-4;

SceneBuilder scene(Integrator integrator, uint32_t max_depth = 8, uint32_t side = 4, uint32_t samples = 4) {
  SceneBuilder b(side, side, samples, max_depth);
  b.scene.settings.integrator = integrator;
  return b;
}
// A view of (almost) one point, `from` towards `to`.
void look_at_point(SceneBuilder& b, const glm::dvec3& from, const glm::dvec3& to, float width = 1e-5f) {
  b.look_at(from, to, orthographic(width), glm::dvec3(0.3, 0.2, 0.9));
}
glm::dvec3 from_angle(double degrees, double distance = 1) {
  return {distance * std::sin(glm::radians(degrees)), distance * std::cos(glm::radians(degrees)), 0};
}
const glm::dmat4 floor_up = turned(-90, 1, 0, 0), facing_down = turned(90, 1, 0, 0);

// Every path of the pipeline has the answer on each of its wavelengths, and so has the scalar oracle.
template <class Expected>
void expect_answer(const World& world, const Expected& expected) {
  expect_every_path(trace_radiances(world), expected, tolerance);
  const std::array<double, 4> lambda_nm = {420, 510, 600, 690};
  for (uint32_t y = 0; y < world.settings.height; ++y)
    for (uint32_t x = 0; x < world.settings.width; ++x) {
      const std::array<double, 4> radiance = reference_pixel_radiance(world, x, y, lambda_nm, y + 7 * x);
      for (size_t j = 0; j < 4; ++j)
        EXPECT_NEAR(radiance[j] / expected(lambda_nm[j]), 1, tolerance) << "oracle at " << lambda_nm[j] << " nm";
    }
}
void expect_dark(const std::vector<PathRadiance>& paths) {
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) EXPECT_EQ(radiance, 0);
}

constexpr Integrator noise_free[] = {Integrator::local, Integrator::recursive};

// Reflectance of a straight line over wavelengths, so that each wavelength has its own answer.
SpectrumId slope(SceneBuilder& b, double low, double high) {
  const std::vector<double> lambda_nm = {360, 830}, values = {low, high};
  return b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
}
double slope_at(double nm, double low, double high) { return low + (high - low) * (nm - 360) / 470; }

TEST(Levels, APointLightOnAPlane) {
  for (const Integrator integrator : noise_free)
    for (const double degrees : {0.0, 40.0, 80.0}) {
      SceneBuilder b = scene(integrator);
      look_at_point(b, {0.5, 1, 0.2}, {0, 0, 0});
      b.add(rectangle(4, 4), b.diffuse(slope(b, 0.2, 0.8)), floor_up);
      const glm::dvec3 lamp = from_angle(degrees, 2);
      b.light(LightKind::point, b.constant(5), 2, moved(lamp.x, lamp.y, lamp.z));
      const double irradiance = 10 * std::cos(glm::radians(degrees)) / 4;
      expect_answer(*b.freeze(), [&](double nm) { return slope_at(nm, 0.2, 0.8) / pi * irradiance; });
    }
}

TEST(Levels, APointLightOnASphere) {
  for (const Integrator integrator : noise_free)
    for (const double degrees : {0.0, 35.0, 70.0}) {
      SceneBuilder b = scene(integrator);
      const glm::dvec3 normal = from_angle(degrees);
      look_at_point(b, normal * 3.0, normal, 1e-5f);
      b.add(sphere(1), b.diffuse(0.6));
      b.light(LightKind::point, b.constant(3), 1, moved(0, 4, 0));
      const glm::dvec3 to_lamp = glm::dvec3(0, 4, 0) - normal;
      const double d = glm::length(to_lamp), cos_theta = glm::dot(to_lamp, normal) / d;
      expect_answer(*b.freeze(), [&](double) { return 0.6 / pi * 3 * cos_theta / (d * d); });
    }
}

// L = L_in (kd cos theta + ks cos^s delta), the sum over a directional and two point lights.
TEST(Levels, SeveralAbstractLightsOnTaughtRoughMatterAddUpWithoutNoise) {
  constexpr double kd = 0.2, ks = 0.3, shininess = 12;
  for (const Integrator integrator : noise_free) {
    SceneBuilder b = scene(integrator);
    const glm::dvec3 eye = from_angle(30);
    look_at_point(b, eye, {0, 0, 0});
    b.add(rectangle(4, 4), b.rough(b.constant(kd), b.constant(ks), shininess, false), floor_up);
    b.light(LightKind::directional, b.constant(2), 1, turned(-90 + 25, 1, 0, 0));
    b.light(LightKind::point, b.constant(4), 1, moved(-1, 2, 0));
    b.light(LightKind::point, slope(b, 1, 3), 1, moved(0.5, 1, 0.5));
    const auto reflected = [&](const glm::dvec3& to_light) {
      const glm::dvec3 l = glm::normalize(to_light), h = glm::normalize(l + eye);
      return kd * l.y + ks * std::pow(h.y, shininess);
    };
    const glm::dvec3 sun = {0, std::cos(glm::radians(25.0)), std::sin(glm::radians(25.0))};
    const auto wanted = [&](double nm) {
      return 2 * reflected(sun) + 4 * reflected({-1, 2, 0}) / 5 + slope_at(nm, 1, 3) * reflected({0.5, 1, 0.5}) / 1.5;
    };
    expect_answer(*b.freeze(), wanted);
  }
}

TEST(Levels, WhatStandsBeforeALightShadesItUnlessThereAreNoShadows) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path})
    for (const bool shadows : {true, false}) {
      SceneBuilder b = scene(integrator, 1);
      b.scene.settings.shadows = shadows;
      look_at_point(b, {0.5, 1, 0.2}, {0, 0, 0});
      b.add(rectangle(4, 4), b.diffuse(0.5), floor_up);
      b.add(rectangle(0.1f, 0.1f), b.diffuse(0.0), moved(0, 1, 0) * floor_up);
      b.light(LightKind::point, b.constant(5), 1, moved(0, 2, 0));
      if (shadows)
        expect_dark(trace_radiances(*b.freeze()));
      else
        expect_answer(*b.freeze(), [](double) { return 0.5 / pi * 5 / 4; });
    }
}

// A mirror at 45 degrees shows a lit wall: its Fresnel reflectance times the wall, on each wavelength.
TEST(Levels, AMirrorShowsWhatTheLightsDoToAWall) {
  for (const bool is_recursive : {true, false}) {
    SceneBuilder b = scene(is_recursive ? Integrator::recursive : Integrator::local);
    look_at_point(b, from_angle(45), {0, 0, 0});
    const SpectrumId n = b.named("Au.n"), k = b.named("Au.k");
    b.add(rectangle(4, 4), b.conductor(n, k), floor_up);
    // The mirrored ray meets x = -2 at a height of 2.
    b.add(rectangle(8, 8), b.diffuse(0.7), moved(-2, 0, 0) * turned(90, 0, 1, 0));
    b.light(LightKind::point, b.constant(3), 1, moved(1, 2, 0));
    const SpectrumSet& set = b.scene.spectra;
    const auto wanted = [&](double nm) {
      return reference::fresnel_conductor(set.value(n, nm), set.value(k, nm), std::cos(glm::radians(45.0))) * 0.7 / pi *
             3 / 9;
    };
    if (is_recursive)
      expect_answer(*b.freeze(), wanted);
    else
      expect_dark(trace_radiances(*b.freeze()));
  }
}

// A slab of glass over an emitter: with two further reflections inside for each term the light that passes sums to
// T = (1 - F)^2 / (1 - F^2) = (1 - F) / (1 + F). Under an emitter the same series gives R = 2 F / (1 + F).
double fresnel_at(double n, double degrees) {
  return reference::fresnel_dielectric(n, std::cos(glm::radians(degrees)));
}
template <class Glass>
void expect_slab(const Glass& glass, bool dispersive) {
  for (const double degrees : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0})
    for (const bool below : {true, false}) {
      SceneBuilder b = scene(Integrator::recursive, 400);
      look_at_point(b, from_angle(degrees, 2), {0, 0, 0}, 1e-2f);
      b.scene.meshes.push_back(cube_mesh());
      const SpectrumId n = glass(b);
      b.add(mesh(0), b.dielectric(n), moved(0, -0.05, 0) * stretched(100, 0.1, 100));
      const glm::dmat4 place = below ? moved(0, -1, 0) * floor_up : moved(0, 4, 0) * facing_down;
      b.emit(b.add(rectangle(500, 500), b.diffuse(0.0), place), b.constant(3), 1);
      const SpectrumSet& set = b.scene.spectra;
      const auto wanted = [&](double nm) {
        const double f = fresnel_at(set.value(n, nm), degrees);
        return 3 * (below ? (1 - f) / (1 + f) : 2 * f / (1 + f));
      };
      SCOPED_TRACE(testing::Message() << degrees << " degrees, " << (below ? "through" : "mirrored")
                                      << (dispersive ? ", dispersive" : ""));
      expect_answer(*b.freeze(), wanted);
    }
}
TEST(Levels, ASlabOfGlassSumsItsReflections) {
  expect_slab([](SceneBuilder& b) { return b.constant(1.5); }, false);
}
TEST(Levels, ASlabOfDispersingGlassSumsItsReflectionsOnEachWavelength) {
  expect_slab([](SceneBuilder& b) { return b.named("SF66"); }, true);
}

TEST(Levels, PathTracingFindsTheSameSlabOnAverage) {
  for (const double degrees : {45.0, 75.0}) {
    SceneBuilder b = scene(Integrator::path, 100, 4, 8192);
    look_at_point(b, from_angle(degrees, 2), {0, 0, 0}, 1e-2f);
    b.scene.meshes.push_back(cube_mesh());
    b.add(mesh(0), b.dielectric(b.constant(1.5)), moved(0, -0.05, 0) * stretched(100, 0.1, 100));
    b.emit(b.add(rectangle(500, 500), b.diffuse(0.0), moved(0, -1, 0) * floor_up), b.constant(3), 1);
    const double f = fresnel_at(1.5, degrees);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 3 * (1 - f) / (1 + f); }, 0.05);
  }
}

// Behind a dispersing surface each wavelength is a node of its own, and leads: what follows asks the first.
TEST(Levels, WavelengthsThatPartLeadTheirNodes) {
  SceneBuilder b = scene(Integrator::recursive);
  look_at_point(b, from_angle(45, 2), {0, 0, 0});
  b.add(rectangle(4, 4), b.dielectric(b.named("SF66")), floor_up);
  const std::unique_ptr<World> world = b.freeze();
  Batch batch;
  Counters counters;
  const RayPacket packet{0, 0, 0};
  camera_rays(*world, {&packet, 1}, {0, 0, 4, 4}, batch.paths, batch.slots);
  std::multiset<float> from_camera, refracted;
  for (const float* column : batch.slots.lambda_nm) from_camera.insert(column, column + 16);
  trace_recursive(*world, 0, batch, counters);
  uint32_t depth = 0, reflected = 0;
  ASSERT_TRUE(pop_nodes(rays_per_batch(*world), batch.nodes, &depth, batch.paths, batch.slots));
  EXPECT_EQ(depth, 1u);
  for (uint32_t i = 0; i < batch.paths.size; ++i) {
    EXPECT_GT(batch.paths.throughput[0][i], 0);
    if (batch.paths.throughput[1][i] > 0)
      ++reflected;
    else
      refracted.insert(batch.paths.lambda_nm[0][i]);
    EXPECT_EQ(batch.paths.lambda_nm[0][i], batch.slots.lambda_nm[0][i]);
  }
  EXPECT_EQ(reflected, 16u);
  EXPECT_EQ(refracted, from_camera);
}

// From below the surface: the sky is (1 - F) n^2 bright within the window, outside it everything is mirrored.
TEST(Levels, TheSurfaceOfWaterSeenFromBelow) {
  constexpr double n = 4.0 / 3;
  const double critical = std::asin(1 / n) * 180 / pi;
  for (const double degrees : {0.0, 20.0, 40.0, critical - 1, critical + 0.5, 60.0, 85.0}) {
    SceneBuilder b = scene(Integrator::recursive, 8);
    const glm::dvec3 eye = from_angle(degrees);
    look_at_point(b, {eye.x, -eye.y, eye.z}, {0, 0, 0});
    b.add(rectangle(100, 100), b.dielectric(b.constant(n)), floor_up);
    b.emit(b.add(rectangle(900, 900), b.diffuse(0.0), moved(0, 5, 0) * facing_down), b.constant(1), 1);
    b.emit(b.add(rectangle(900, 900), b.diffuse(0.0), moved(0, -5, 0) * floor_up), b.constant(1), 0.25);
    const double f = reference::fresnel_dielectric(1 / n, std::cos(glm::radians(degrees)));
    SCOPED_TRACE(degrees);
    expect_answer(*b.freeze(), [&](double) { return (1 - f) * n * n + 0.25 * f; });
  }
}

// Two mirrors face each other around a grey pane that emits: each of max_depth reflections adds one more image.
TEST(Levels, MaxDepthCountsReflections) {
  for (const uint32_t depth : {0u, 1u, 2u, 5u}) {
    SceneBuilder b = scene(Integrator::recursive, depth);
    b.look_at({0, 0.5, 0}, {0, 0, 0}, orthographic(1e-3f), {0, 0, 1});
    const Material mirror = b.conductor(b.constant(1), b.constant(1e8));
    for (const bool upper : {true, false}) {
      const Entity plate = b.add(rectangle(2, 2), mirror, upper ? moved(0, 1, 0) * facing_down : floor_up);
      b.emit(plate, b.constant(1), 1);
    }
    expect_answer(*b.freeze(), [&](double) { return depth + 1.0; });
  }
}

// What each level adds: a floor beside a lit wall is lit by the lamp alone but in path tracing.
TEST(Levels, OnlyPathTracingSeesIndirectLight) {
  double sums[3] = {};
  for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path}) {
    SceneBuilder b = scene(integrator, 4, 4, 512);
    look_at_point(b, {0.5, 1, 0.2}, {0, 0, 0});
    b.add(rectangle(4, 4), b.diffuse(0.5), floor_up);
    b.add(rectangle(4, 4), b.diffuse(0.9), moved(-0.5, 0, 0) * turned(90, 0, 1, 0));
    b.light(LightKind::point, b.constant(5), 1, moved(0.5, 0.5, 0));
    for (const PathRadiance& path : trace_radiances(*b.freeze()))
      sums[static_cast<size_t>(integrator)] += path.radiance[0];
  }
  const double paths = 16 * 512, direct = 0.5 / pi * 5 * 0.5 / std::pow(0.5, 1.5);
  EXPECT_NEAR(sums[0] / paths, direct, tolerance * direct);
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_GT(sums[2], 1.05 * sums[0]);
}

// An area light is integrated by sampling: on average its configuration factor, here of a disk, at all levels.
TEST(Levels, AnAreaLightArrivesByItsConfigurationFactor) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path})
    for (const bool shadows : {true, false}) {
      SceneBuilder b = scene(integrator, 3, 4, 6000);
      b.scene.settings.shadows = shadows;
      look_at_point(b, {-2, 0.5, 0.1}, {0, 0, 0});
      b.add(rectangle(0.01f, 0.01f), b.diffuse(0.8), floor_up);
      b.emit(b.add(disk(0.6f), b.diffuse(0.0), moved(0, 0.9, 0) * facing_down), b.constant(4), 1);
      b.light(LightKind::point, b.constant(1), 1, moved(0, 0.5, 0));
      expect_mean(
          trace_radiances(*b.freeze()), [&](double) { return 0.8 * 4 * 0.36 / (0.36 + 0.81) + 0.8 / pi * 4; }, 0.02);
    }
}

// Without shadows the sky lights a surface through what covers it.
TEST(Levels, WithoutShadowsTheSkyShinesThroughALid) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path}) {
    SceneBuilder b = scene(integrator, 1, 4, 20000);
    b.scene.settings.shadows = false;
    b.look_at({0, 0.5, 0}, {0, 0, 0}, orthographic(1e-3f), {0, 0, 1});
    b.add(rectangle(4, 4), b.diffuse(0.5), floor_up);
    b.add(rectangle(40, 40), b.diffuse(0.0), moved(0, 1, 0) * facing_down);
    b.light(LightKind::environment, b.constant(2), 1);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 0.5 * 2; }, 0.03);
  }
}

// Whatever the smooth body, in light of 1 from everywhere its rays lose nothing.
TEST(Levels, LosslessSmoothBodiesVanishInAFurnace) {
  SceneBuilder b = scene(Integrator::recursive, 64, 8, 2);
  b.light(LightKind::environment, unit_spectrum, 1);
  b.look_at({0, 0, 3}, {0, 0, 0}, perspective(30));
  b.add(sphere(0.4f), b.conductor(b.constant(1), b.constant(1e8)), moved(-0.5, 0, 0));
  b.add(sphere(0.4f), b.dielectric(b.constant(1.5)), moved(0.5, 0, 0.3));
  b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), b.dielectric(b.named("SF66")), moved(0, 0.6, 0) * turned(30, 1, 0.5, 0.2) * stretched(0.5, 0.5, 0.5));
  expect_every_path(
      trace_radiances(*b.freeze()), [](double) { return 1.0; }, 1e-3);
}

// Rough matter under the sky alone: local and recursive see what one scattering does.
TEST(Levels, RoughMatterShowsItsAlbedoUnderTheSky) {
  for (const Integrator integrator : noise_free) {
    SceneBuilder b = scene(integrator, 8, 4, 4000);
    b.light(LightKind::environment, unit_spectrum, 1);
    b.look_at({0, 0.5, 0}, {0, 0, 0}, orthographic(1e-3f), {0, 0, 1});
    b.add(rectangle(4, 4), b.diffuse(slope(b, 0.1, 0.9)), floor_up);
    expect_mean(
        trace_radiances(*b.freeze()), [](double nm) { return slope_at(nm, 0.1, 0.9); }, 0.03);
  }
}

}  // namespace
}  // namespace metamer
