// What lights send, against closed forms.
#include "systems/light_rows.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;
double degrees(double d) { return d * pi / 180; }

// A view of (almost) one point of a diffuse floor in y = 0.
SceneBuilder floor_view(uint32_t samples_per_pixel, const glm::dvec3& at = glm::dvec3(0)) {
  SceneBuilder b(4, 4, samples_per_pixel, 1);
  b.look_at(at + glm::dvec3(0.9, 0.3, 0), at, orthographic(1e-5f), glm::dvec3(0.3, 0.9, 0.2));
  b.add(rectangle(2, 2), b.diffuse(0.8), moved(at.x, at.y, at.z) * turned(-90, 1, 0, 0));
  return b;
}

void emit(SceneBuilder& b, const Geometry& geometry, const glm::dmat4& place, Light light) {
  b.scene.registry.set(b.add(geometry, b.diffuse(0.0), place), light);
}
Light area_light(SpectrumId spectrum, float cosine_power, bool two_sided = false, bool is_power = false) {
  Light light;
  light.spectrum = spectrum;
  light.cosine_power = cosine_power;
  light.two_sided = two_sided;
  light.is_power = is_power;
  return light;
}
void shine(SceneBuilder& b, const glm::dmat4& place, const Light& light) {
  b.scene.registry.set(b.place(place), light);
}
Light spot_light(SpectrumId intensity, float cone_deg, float falloff_deg) {
  Light light;
  light.kind = LightKind::spot;
  light.spectrum = intensity;
  light.cone_deg = cone_deg;
  light.falloff_deg = falloff_deg;
  return light;
}

TEST(CosinePower, TheRadianceFallsWithThePowerOfTheCosine) {
  for (const bool round : {false, true})
    for (const float power : {0.0f, 1.0f, 7.5f, 300.0f})
      for (const double angle : {0.0, 20.0, 60.0, 80.0}) {
        SceneBuilder b(4, 4, 4, 0);
        const glm::dvec3 from(std::sin(degrees(angle)), std::cos(degrees(angle)), 0);
        // Of a sphere the point is at its top: seen from the side, its normal is that of the rectangle.
        const glm::dvec3 at(0, round ? 2 : 0, 0);
        b.look_at(at + from, at, orthographic(1e-5f), glm::dvec3(0, 0, 1));
        emit(b, round ? sphere(2) : rectangle(1, 1), turned(-90, 1, 0, 0), area_light(b.constant(7), power));
        const double wanted = 7 * std::pow(std::cos(degrees(angle)), double{power});
        if (wanted < 1e-30) continue;
        expect_every_path(
            trace_radiances(*b.freeze()), [&](double) { return wanted; }, 2e-4 + 1e-4 * double{power});
      }
}

// On the axis of a disk, whose rim is seen at theta: E = 2 pi L0 (1 - cos^(k+2) theta) / (k + 2).
TEST(CosinePower, ADiskLightsAPointOnItsAxis) {
  for (const float power : {0.0f, 2.0f, 12.0f}) {
    SceneBuilder b = floor_view(4096);
    emit(b, disk(1.5f), moved(0, 1, 0) * turned(90, 1, 0, 0), area_light(b.constant(3), power));
    const double k = double{power} + 2, irradiance = 2 * pi * 3 * (1 - std::pow(1 / std::sqrt(3.25), k)) / k;
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 0.8 / pi * irradiance; }, 0.08);
  }
}

// A sphere of radius r sends the same in all directions, whatever its profile: E = 2 pi L0 r^2 / ((k + 2) d^2).
TEST(CosinePower, ASphereFallsWithTheSquareOfTheDistanceToItsCentre) {
  for (const float power : {0.0f, 3.0f}) {
    SceneBuilder b = floor_view(4096);
    emit(b, sphere(0.6f), moved(0, 1, 0), area_light(b.constant(3), power));
    const double irradiance = 2 * pi * 3 * 0.36 / (double{power} + 2);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 0.8 / pi * irradiance; }, 0.06);
  }
}

// The stated power, however it is spread: over 4 pi d^2 around a sphere; along the normal of what is flat and far
// I = Phi (k + 2) / (2 pi), half of it where both sides shine.
TEST(AreaPower, IsWhatTheWholeShapeSends) {
  for (const float power : {0.0f, 3.0f}) {
    SceneBuilder around = floor_view(4096);
    emit(around, sphere(0.6f), moved(0, 1, 0), area_light(around.constant(5), power, false, true));
    expect_mean(
        trace_radiances(*around.freeze()), [&](double) { return 0.8 / pi * 5 / (4 * pi); }, 0.06);
    for (const bool two_sided : {false, true})
      for (const Geometry& shape : {disk(2, 0.5f), rectangle(3, 2), mesh(0)}) {
        SceneBuilder b = floor_view(4);
        b.scene.meshes.push_back(cube_mesh());
        b.scene.meshes[0].indices.resize(6);  // the face towards -z
        const bool is_mesh = shape.kind == ShapeKind::mesh;
        emit(b, shape, moved(0, 1000, 0) * turned(is_mesh ? -90 : 90, 1, 0, 0) * stretched(1.5, 0.8, 1),
             area_light(b.constant(5), power, two_sided, true));
        const double intensity = 5 * (double{power} + 2) / (2 * pi) / (two_sided ? 2 : 1);
        expect_every_path(
            trace_radiances(*b.freeze()), [&](double) { return 0.8 / pi * intensity / 1e6; }, 2e-3);
      }
  }
}

TEST(AreaPower, WithoutAnAreaIsAnError) {
  SceneBuilder b(4, 4, 1, 1);
  b.look_at({0, 0, 5}, {0, 0, 0}, perspective(40));
  Mesh flat = cube_mesh();
  for (auto& position : flat.positions) position = glm::vec3(position.x, 0, 0);
  b.scene.meshes.push_back(flat);
  emit(b, mesh(0), glm::dmat4(1), area_light(unit_spectrum, 0, false, true));
  Diagnostics diagnostics;
  freeze(b.scene, diagnostics);
  EXPECT_EQ(diagnostics.error_count(), 1u);
  EXPECT_NE(format_diagnostics(diagnostics).find("no area to emit its power from"), std::string::npos);
}

double smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
double spot_falloff(double angle_deg, double cone_deg, double falloff_deg) {
  const double cone = std::cos(degrees(cone_deg)), start = std::cos(degrees(falloff_deg));
  return smoothstep((std::cos(degrees(angle_deg)) - cone) / (start - cone));
}

// Every path: I f(theta) cos theta / d^2 with the height 2 of the lamp, theta off its axis.
TEST(Spot, LightsAFloorByItsFalloff) {
  struct Cone {
    float cone_deg, falloff_deg;
  };
  for (const Cone cone : {Cone{30, 22.5f}, Cone{40, 0}, Cone{90, 60}, Cone{25, 25}, Cone{1, 0.5f}})
    for (const double share : {0.0, 0.3, 0.7, 0.8, 0.95, 0.99, 1.01}) {
      const double angle = share * double{cone.cone_deg};
      if (angle > 89) continue;
      SceneBuilder b = floor_view(4, {2 * std::tan(degrees(angle)), 0, 0});
      shine(b, moved(0, 2, 0) * turned(-90, 1, 0, 0), spot_light(b.constant(5), cone.cone_deg, cone.falloff_deg));
      const double falloff = cone.cone_deg == cone.falloff_deg
                                 ? (share < 1 ? 1 : 0)
                                 : spot_falloff(angle, double{cone.cone_deg}, double{cone.falloff_deg});
      const double wanted = 0.8 / pi * 5 * falloff * std::pow(std::cos(degrees(angle)), 3) / 4;
      for (const PathRadiance& path : trace_radiances(*b.freeze()))
        for (const double radiance : path.radiance) ASSERT_NEAR(radiance, wanted, 3e-3) << angle;
    }
}

TEST(Spot, AimsAlongMinusZOfItsEntity) {
  for (const double turn : {0.0, 40.0}) {
    SceneBuilder b = floor_view(4);
    shine(b, turned(turn, 0, 0, 1) * moved(0, 2, 0) * turned(-90, 1, 0, 0), spot_light(b.constant(5), 10, 0));
    const double wanted = 0.8 / pi * 5 / 4 * std::cos(degrees(turn));
    expect_every_path(
        trace_radiances(*b.freeze()), [&](double) { return wanted; }, 1e-3);
  }
}

// The closed form against the integral of what the kernel says, on a sphere around the lamp.
TEST(Spot, SendsTheFluxOfItsClosedForm) {
  for (const auto& [cone, falloff] :
       {std::pair{30.0f, 22.5f}, {40.0f, 0.0f}, {90.0f, 60.0f}, {25.0f, 25.0f}, {170.0f, 100.0f}}) {
    SceneBuilder b(4, 4, 1, 1);
    b.look_at({0, 0, 50}, {0, 0, 0}, perspective(40));
    const Light light = spot_light(b.constant(1), cone, falloff);
    shine(b, turned(50, 1, 2, 0.5), light);
    const std::unique_ptr<World> world = b.freeze();
    Batch batch;
    ShadeStream& shade = batch.shade;
    for (Group& group : shade.groups) group = {0, 0};
    shade.size = batch_capacity;
    shade.groups[0] = {0, batch_capacity};
    constexpr uint32_t batches = 100, count = batches * batch_capacity;
    double flux = 0;
    for (uint32_t n = 0; n < batches; ++n) {
      for (uint32_t i = 0; i < batch_capacity; ++i) {
        const double k = n * batch_capacity + i + 0.5, z = 1 - 2 * k / count, phi = k * pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        shade.position[0][i] = static_cast<float>(r * std::cos(phi));
        shade.position[1][i] = static_cast<float>(r * std::sin(phi));
        shade.position[2][i] = static_cast<float>(z);
        shade.pixel_seed[i] = shade.index[i] = 0;
        shade.slot[i] = i;
        for (size_t j = 0; j < 4; ++j) shade.lambda_nm[j][i] = 550;
      }
      light_sample(*world, 0, shade);
      for (uint32_t i = 0; i < batch_capacity; ++i) flux += double{shade.light_radiance[0][i]} * 4 * pi / count;
      EXPECT_EQ(shade.light_pdf[0], 0);
    }
    const double cone_cos = std::cos(degrees(double{cone})), falloff_cos = std::cos(degrees(double{falloff}));
    const double wanted = 2 * pi * ((1 - falloff_cos) + (falloff_cos - cone_cos) / 2);  // pbrt-v4's form
    EXPECT_NEAR(flux / wanted, 1, cone == falloff ? 2e-3 : 2e-4) << cone;
    EXPECT_NEAR(flux_per_unit(abstract_light(glm::dmat4(1), light)) / wanted, 1, 1e-6);
  }
}

TEST(DistantDisk, GivesItsIrradianceOnAPlaneFacingIt) {
  for (const float diameter : {0.01f, 0.531f, 60.0f}) {
    SceneBuilder b = floor_view(256);
    Light sun;
    sun.kind = LightKind::directional;
    sun.spectrum = b.constant(3);
    sun.angular_diameter_deg = diameter;
    shine(b, turned(-90, 1, 0, 0), sun);
    expect_mean(
        trace_radiances(*b.freeze()), [](double) { return 0.8 / pi * 3; }, 0.02);
  }
}

TEST(DistantDisk, IsSeenWithItsRadianceWithinItsDiameter) {
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = unit_spectrum;
  sun.angular_diameter_deg = 0.531f;
  const double radiance = 1 / (pi * std::pow(std::sin(degrees(0.2655)), 2));
  for (const double off : {0.0, 0.2, 0.264, 0.267, 1.0}) {
    SceneBuilder b(4, 4, 4, 2);
    shine(b, turned(-70, 1, 0, 0), sun);
    const double angle = degrees(-70 + off);
    b.look_at({0, 0, 0}, {0, -std::sin(angle), std::cos(angle)}, orthographic(0.01f), {1, 0, 0});
    for (const PathRadiance& path : trace_radiances(*b.freeze()))
      EXPECT_NEAR(path.radiance[0] / radiance, off < 0.2655 ? 1 : 0, 1e-4) << off;
  }
}

// Its shadows are soft: behind an edge in its middle half of it is left.
TEST(DistantDisk, HalfOfItStandsOverAnEdge) {
  SceneBuilder b = floor_view(4096);
  Light sun;
  sun.kind = LightKind::directional;
  sun.spectrum = b.constant(3);
  sun.angular_diameter_deg = 0.531f;
  shine(b, turned(-90, 1, 0, 0), sun);
  b.add(rectangle(100, 100), b.diffuse(0.0), moved(0, 10, 50) * turned(-90, 1, 0, 0));
  expect_mean(
      trace_radiances(*b.freeze()), [](double) { return 0.8 / pi * 3 / 2; }, 0.06);
}

}  // namespace
}  // namespace metamer
