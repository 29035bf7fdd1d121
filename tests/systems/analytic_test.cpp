// Pictures whose values are known in closed form.
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

constexpr double pi = 3.14159265358979323846;

// A view of (almost) one point, `from` towards `to`.
SceneBuilder point_view(const glm::dvec3& from, const glm::dvec3& to, uint32_t samples_per_pixel, uint32_t max_depth,
                        float width = 1e-4f) {
  SceneBuilder b(4, 4, samples_per_pixel, max_depth);
  b.look_at(from, to, orthographic(width), glm::dvec3(0.3, 0.2, 0.9));
  return b;
}

TEST(Analytic, APointLightFallsWithTheSquareOfItsDistance) {
  for (const double distance : {0.1, 1.0, 3.0, 100.0, 1e4}) {
    SceneBuilder b = point_view({0.5 * distance, 1, 0}, {0, 0, 0}, 4, 1);
    b.add(rectangle(1, 1), b.diffuse(0.8), turned(-90, 1, 0, 0));
    b.light(LightKind::point, b.constant(5), 2, moved(0, distance, 0));
    const double wanted = 0.8 / pi * 10 / (distance * distance);
    expect_every_path(
        trace_radiances(*b.freeze()), [&](double) { return wanted; }, 1e-4);
  }
}

TEST(Analytic, ADirectionalLightGivesItsIrradianceTimesTheCosine) {
  for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
    SceneBuilder b = point_view({0, 1, 0}, {0, 0, 0}, 4, 1);
    b.add(rectangle(1, 1), b.diffuse(0.8), turned(-90, 1, 0, 0));
    b.light(LightKind::directional, b.constant(3), 1, turned(-90 + degrees, 1, 0, 0));
    const double wanted = 0.8 / pi * 3 * std::cos(degrees * pi / 180);
    expect_every_path(
        trace_radiances(*b.freeze()), [&](double) { return wanted; }, 1e-5);
  }
}

TEST(Analytic, AnEmittersRadianceDoesNotDependOnItsDistance) {
  for (const double distance : {0.01, 1.0, 1e3, 1e5}) {
    SceneBuilder b = point_view({0, distance, 0}, {0, 0, 0}, 4, 0);
    b.emit(b.add(rectangle(1, 1), b.diffuse(0.0), turned(-90, 1, 0, 0)), b.constant(7), 0.5f);
    expect_every_path(
        trace_radiances(*b.freeze()), [](double) { return 3.5; }, 1e-6);
  }
}

// The picture itself: at 1, 2 and 4 m, and tilted by 60 degrees, every pixel within the lamp is the same to the last
// bit.
TEST(Analytic, ALampLooksTheSameFromAnyDistanceAndTilted) {
  struct View {
    double distance, tilt_deg;
  };
  std::vector<Film> films;
  for (const View view : {View{1, 0}, View{2, 0}, View{4, 0}, View{2, 60}}) {
    SceneBuilder b(8, 8, 16, 4);
    b.look_at({0, 0, view.distance}, {0, 0, 0}, perspective(10));
    b.emit(b.add(rectangle(2, 2), b.diffuse(0.3), turned(view.tilt_deg, 0, 1, 0)), b.named("D65"), 1);
    films.push_back(render_film(*b.freeze()));
  }
  const double luminance = SceneBuilder(1, 1, 1, 1).scene.spectra.luminance(unit_spectrum);
  for (const Film& film : films)
    for (size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
      EXPECT_EQ(mean_xyz(film, pixel), mean_xyz(films[0], pixel));
      EXPECT_GT(mean_xyz(film, pixel)[1], 50 * luminance);  // of D65, about 100 everywhere
    }
}

// Smaller than a pixel it covers a part of it, in proportion to the solid angle under which it is seen. The scene has
// no triangles: vectors of dead lanes must find something to fetch all the same.
TEST(Analytic, ALampBelowAPixelFallsWithTheSquareOfItsDistance) {
  for (const double distance : {1.0, 2.0, 4.0}) {
    SceneBuilder b(4, 4, 1 << 14, 0);
    b.look_at({0, 0, distance}, {0, 0, 0}, perspective(40));
    const double pixel = 2 * std::tan(20 * pi / 180) / 4;  // its side at a distance of 1
    b.emit(b.add(disk(0.08f), b.diffuse(0.0), moved(0.05, 0.06, 0)), b.constant(1), 1);
    const Film film = render_film(*b.freeze());
    double sum = 0;
    for (size_t i = 0; i < film.pixel_count(); ++i) sum += mean_xyz(film, i)[1];
    const double share = pi * 0.0064 / (distance * distance) / (pixel * pixel);
    const double luminance = b.scene.spectra.luminance(b.constant(1));
    EXPECT_NEAR(sum / luminance / share, 1, 0.01) << distance;
  }
}

// Factors from an element, J. Howell, A Catalog of Radiation Heat Transfer Configuration Factors, third edition.
struct ElementCase {
  const char* name;
  Geometry light;
  glm::dmat4 place;
  double factor;
  double visible;
};
// B-3: the element faces a rectangle's corner, a and b long, at distance c.
double parallel_rectangle(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
}
// B-4: the element's plane is perpendicular to the rectangle, which stands at distance c on it with the nearest corner
// opposite the element: b along the plane, a high.
double perpendicular_rectangle(double a, double b, double c) {
  const double x = a / b, y = c / b, s = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / s * std::atan(1 / s)) / (2 * pi);
}

TEST(Analytic, AreaLightsArriveByTheirConfigurationFactors) {
  const glm::dmat4 down = turned(90, 1, 0, 0);
  const ElementCase cases[] = {
      // Its four quarters each have the element at a corner.
      {"parallel rectangle", rectangle(1, 2), moved(0, 0.7, 0) * down, 4 * parallel_rectangle(0.5, 1, 0.7), 0.03},
      // It stands on the element's plane, in two halves on both sides of the element.
      {"perpendicular rectangle", rectangle(2, 1.2f), moved(0.8, 0.6, 0) * turned(-90, 0, 1, 0),
       2 * perpendicular_rectangle(1.2, 1, 0.8), 0.05},
      // B-12 and B-32: r^2 / (r^2 + h^2), and (r / h)^2.
      {"disk", disk(0.6f), moved(0, 0.9, 0) * down, 0.36 / (0.36 + 0.81), 0.02},
      {"ring", disk(0.6f, 0.3f), moved(0, 0.9, 0) * down, 0.36 / (0.36 + 0.81) - 0.09 / (0.09 + 0.81), 0.02},
      {"sphere", sphere(0.5f), moved(0, 1.5, 0), 1.0 / 9, 0.02},
      {"sphere as an ellipsoid", sphere(1), moved(0, 1.5, 0) * stretched(0.5, 0.5, 0.50001), 1.0 / 9, 0.05},
  };
  for (const ElementCase& c : cases) {
    SCOPED_TRACE(c.name);
    SceneBuilder b = point_view({-2, 0.5, 0.1}, {0, 0, 0}, 12000, 1);
    b.add(rectangle(0.01f, 0.01f), b.diffuse(0.8), turned(-90, 1, 0, 0));
    b.emit(b.add(c.light, b.diffuse(0.0), c.place), b.constant(4), 1);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 0.8 * 4 * c.factor; }, c.visible);
  }
}

// C-11 and C-14 of Howell's catalog for unit squares, opposite each other at unit distance and sharing an edge.
TEST(Analytic, UnitSquaresExchangeByTheirViewFactors) {
  constexpr double opposite = 0.1998249, adjacent = 0.2000438;
  for (const bool parallel : {true, false}) {
    SceneBuilder b(16, 16, 1024, 1);
    b.look_at({0, 3, 0}, {0, 0, 0}, orthographic(1), {0, 0, 1});
    b.add(rectangle(1, 1), b.diffuse(0.8), turned(-90, 1, 0, 0));
    const glm::dmat4 place =
        parallel ? moved(0, 1, 0) * turned(90, 1, 0, 0) : moved(0.5, 0.5, 0) * turned(-90, 0, 1, 0);
    const Entity light = b.add(rectangle(1, 1), b.diffuse(0.0), place);
    b.emit(light, b.constant(4), 1);
    Visibility unseen;
    unseen.mask = visible_to_bounces | visible_to_shadows;
    b.scene.registry.set(light, unseen);
    const double factor = parallel ? opposite : adjacent;
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return 0.8 * 4 * factor; }, 0.03);
  }
}

// Under a flat water surface the unit sky is (1 - F) 1.777 bright, 1.777 = n^2 (DESIGN.md, section 1); what comes out
// of the water is dimmer by the same factor.
TEST(Analytic, TheSkySeenFromUnderWaterIsBrighterByTheSquareOfTheIndex) {
  constexpr double n = 4.0 / 3, f = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
  for (const bool below : {true, false}) {
    const double y = below ? -1 : 1;
    SceneBuilder b = point_view({0, y, 0}, {0, 0, 0}, 4096, 4);
    b.add(rectangle(100, 100), b.dielectric(b.constant(n)), turned(-90, 1, 0, 0));
    // Black behind the viewer: what the surface reflects is not seen.
    b.add(rectangle(100, 100), b.diffuse(0.0), moved(0, 2 * y, 0) * turned(-90, 1, 0, 0));
    b.light(LightKind::environment, unit_spectrum, 1);
    const double wanted = below ? (1 - f) * n * n : (1 - f) / (n * n);
    expect_mean(
        trace_radiances(*b.freeze()), [&](double) { return wanted; }, 0.02);
  }
}

// A ray at 45 degrees leaves a plate of thickness d moved by d (tan 45 - tan b), sin 45 = n sin b.
TEST(Analytic, APlateShiftsTheRayBySnellsLaw) {
  constexpr double n = 1.5;
  const double tan_inside = std::sin(pi / 4) / n / std::sqrt(1 - 0.5 / (n * n));
  const double through = 1 + 0.5 * tan_inside + 0.5;  // x on the floor, 0.5 below a plate of 0.5, ray from (-1, 2)
  for (const double margin : {0.002, -0.002}) {
    SceneBuilder b = point_view({-1, 2, 0}, {0, 1, 0}, 64, 8, 1e-3f);
    b.scene.meshes.push_back(cube_mesh());
    b.add(mesh(0), b.dielectric(b.constant(n)), moved(0, 0.75, 0) * stretched(50, 0.5, 50));
    // Lit on the side of smaller x up to the place: inner reflections come out at larger x.
    const double edge = through - 1 + margin;
    b.emit(b.add(rectangle(2, 2), b.diffuse(0.0), moved(edge - 1, 0, 0) * turned(-90, 1, 0, 0)), unit_spectrum, 1);
    size_t lit = 0, all = 0;
    for (const PathRadiance& path : trace_radiances(*b.freeze())) lit += path.radiance[0] > 0, ++all;
    EXPECT_GE(double(lit), margin > 0 ? 0.8 * double(all) : 0);
    EXPECT_LE(double(lit), margin > 0 ? double(all) : 0);
  }
}

// All rays of a film point meet on the plane of focus; at twice its depth they spread over an image of the lens.
TEST(Analytic, AThinLensIsSharpAtItsFocusAndBlursBeyond) {
  constexpr double focus = 3, lens = 0.5, lamp = 0.4;
  for (const bool sharp : {true, false}) {
    SceneBuilder b(4, 4, 4096, 0);
    Camera camera = perspective(2);  // 0.105 m wide at the plane of focus
    camera.lens_radius = static_cast<float>(lens);
    camera.focal_distance = static_cast<float>(focus);
    b.look_at({0, 0, 0}, {0, 0, -1}, camera);
    const Geometry shape =
        sharp ? rectangle(0.106f, 0.106f) : rectangle(static_cast<float>(lamp), static_cast<float>(lamp));
    b.emit(b.add(shape, b.diffuse(0.0), moved(0, 0, sharp ? -focus : -2 * focus)), unit_spectrum, 1);
    const std::vector<PathRadiance> paths = trace_radiances(*b.freeze());
    if (sharp)
      expect_every_path(
          paths, [](double) { return 1.0; }, 1e-6);
    if (!sharp)
      expect_mean(
          paths, [](double) { return lamp * lamp / (pi * lens * lens); }, 0.1);
  }
}

}  // namespace
}  // namespace metamer
