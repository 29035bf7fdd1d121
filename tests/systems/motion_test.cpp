// Motion blur: pictures of what moves against integrals over time, and against the mean of pictures of what stands.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "engine/spectrum/observers.h"
#include "engine/spectrum/wavelengths.h"
#include "systems/build_motion.h"
#include "tests/systems/support/scene_builder.h"

namespace metamer {
namespace {

Motion motion_to(const glm::dmat4& end, float start_time = 0, float end_time = 1) {
  const glm::mat4 m = glm::transpose(glm::mat4(end));
  return {m[0], m[1], m[2], start_time, end_time};
}

// An orthographic picture of black shapes before a white sky: a pixel is 1 less what they cover of it, over time.
struct Shadows {
  SceneBuilder b;
  explicit Shadows(uint32_t side, uint32_t samples) : b(side, side, samples, 1) {
    b.look_at({0, 0, 10}, {0, 0, 0}, orthographic(2));
    b.light(LightKind::environment, unit_spectrum, 1);
  }
  // Of every pixel.
  std::vector<double> cover() {
    const Film film = render_film(*b.freeze());
    EXPECT_EQ(film.invalid_samples(), 0u);
    std::vector<double> cover;
    const double white = luminous_efficacy * observer_table(Observer::cie1931).integrals[1];
    for (size_t p = 0; p < film.sums().size(); ++p) cover.push_back(1 - mean_xyz(film, p)[1] / white);
    return cover;
  }
};

// The edge x = s(t) of a wide black rectangle that moves from -1 to 1: a pixel at x is covered while s(t) > x.
void expect_edge(const std::vector<double>& cover, const std::function<double(double)>& covered_at) {
  const size_t side = 16;
  for (size_t x = 0; x < side; ++x) {
    double expected = 0, got = 0;
    for (int k = 0; k < 100; ++k) expected += covered_at(-1 + 2 * (double(x) + (k + 0.5) / 100) / side) / 100;
    for (size_t y = 0; y < side; ++y) got += cover[y * side + x] / side;
    EXPECT_NEAR(got, expected, 0.004) << "column " << x;
  }
}

Shadows edge(const Motion& motion, bool as_mesh) {
  Shadows s(16, 1024);
  Geometry shape = rectangle(4, 4);
  if (as_mesh) {
    s.b.scene.meshes.push_back(cube_mesh());
    shape = mesh(0);
  }
  const glm::dmat4 size = as_mesh ? stretched(4, 4, 1) : glm::dmat4(1);
  const Entity entity = s.b.add(shape, s.b.diffuse(0.0), moved(-3, 0, 0) * size);
  Motion moving = motion;
  for (glm::vec4* row : {&moving.row0, &moving.row1})
    for (int c = 0; c < 3; ++c) (*row)[c] *= as_mesh ? 4.0f : 1.0f;
  s.b.scene.registry.set(entity, moving);
  return s;
}

TEST(Motion, AMovingEdgeIsTheRampOfItsTime) {
  for (const bool as_mesh : {false, true})
    expect_edge(edge(motion_to(moved(-1, 0, 0)), as_mesh).cover(), [](double x) { return (1 - x) / 2; });
}

TEST(Motion, TheShutterCutsAPieceOutOfTheMotion) {
  Shadows s = edge(motion_to(moved(-1, 0, 0)), true);
  s.b.scene.settings.shutter_open = 0.25;
  s.b.scene.settings.shutter_close = 0.75;
  expect_edge(s.cover(), [](double x) { return std::clamp(0.5 - x, 0.0, 1.0); });
}

TEST(Motion, BeforeAndAfterItsTimesAShapeStands) {
  // It stands for a quarter, moves for a half, and stands again.
  expect_edge(edge(motion_to(moved(-1, 0, 0), 0.25f, 0.75f), true).cover(),
              [](double x) { return 0.25 + 0.5 * (1 - x) / 2; });
}

// A disc of radius r about (R, 0) that is turned by 90 degrees: at the radius p, within the turn, it covers a point
// while it passes, for an angle of 2 acos((p^2 + R^2 - r^2) / (2 p R)).
TEST(Motion, ATurningDiscCoversItsRingEvenly) {
  constexpr double r = 0.25, R = 0.625, pi = 3.14159265358979323846;
  for (const bool quadric : {true, false}) {
    Shadows s(16, 1024);
    Entity entity;
    if (quadric) {
      entity = s.b.add(disk(r), s.b.diffuse(0.0), moved(R, 0, 0));
    } else {
      Mesh mesh_disc;
      for (int i = 0; i < 256; ++i)
        mesh_disc.positions.push_back({r * std::cos(2 * pi * i / 256), r * std::sin(2 * pi * i / 256), 0});
      for (uint32_t i = 1; i + 1 < 256; ++i)
        for (const uint32_t v : {0u, i, i + 1}) mesh_disc.indices.push_back(v);
      s.b.scene.meshes.push_back(mesh_disc);
      entity = s.b.add(mesh(0), s.b.diffuse(0.0), moved(R, 0, 0));
    }
    // Around the origin, by a parent that turns.
    const Entity centre = s.b.place();
    s.b.scene.registry.set(entity, Parent{centre});
    s.b.scene.registry.set(centre, motion_to(turned(90, 0, 0, 1)));
    const std::vector<double> cover = s.cover();
    int compared = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        double expected = 0;
        bool within = true;
        for (int k = 0; k < 400; ++k) {
          const double px = -1 + (x + (k % 20 + 0.5) / 20) / 8, py = 1 - (y + (k / 20 + 0.5) / 20) / 8;
          const double p = std::hypot(px, py), angle = std::atan2(py, px);
          const double c = (p * p + R * R - r * r) / (2 * p * R);
          const double half = c < 1 ? std::acos(c) : 0;
          within = within && (half == 0 || (angle > half && angle < pi / 2 - half));
          expected += 2 * half / (pi / 2) / 400;
        }
        if (!within) continue;
        compared += expected > 0.02;
        EXPECT_NEAR(cover[static_cast<size_t>(y * 16 + x)], expected, 0.02) << x << ", " << y;
      }
    EXPECT_GT(compared, 8);
  }
}

// A scene as it is at time u within the shutter's.
using Arrange = std::function<void(SceneBuilder&, double u)>;

constexpr uint32_t side = 16;
SceneBuilder lit_scene(uint32_t samples) {
  SceneBuilder b(side, side, samples, 4);
  b.look_at({0, 1, 6}, {0, 0, 0}, perspective(40));
  b.light(LightKind::environment, unit_spectrum, 1);
  b.light(LightKind::point, unit_spectrum, 30, moved(2, 4, 3));
  b.add(rectangle(20, 20), b.diffuse(0.4), moved(0, -1.2, 0) * turned(-90, 1, 0, 0));
  b.scene.meshes.push_back(cube_mesh());
  return b;
}

struct Mean {
  std::vector<double> y, variance;
};
Mean mean_of(const Film& film) {
  Mean mean;
  for (size_t p = 0; p < film.sums().size(); ++p) {
    mean.y.push_back(mean_xyz(film, p)[1]);
    mean.variance.push_back(variance_of_mean_xyz(film, p)[1]);
  }
  return mean;
}

// Two pictures in blocks of 4x4: a block's z passes 5.5 by chance once in 26 million; the picture's 4.5.
void expect_same_picture(const Mean& a, const Mean& b, double more_variance = 0) {
  double whole = 0, whole_variance = 0;
  for (uint32_t y = 0; y < side; y += 4)
    for (uint32_t x = 0; x < side; x += 4) {
      double sum = 0, variance = 0, level = 0;
      for (uint32_t k = 0; k < 16; ++k) {
        const size_t p = (y + k / 4) * side + x + k % 4;
        sum += a.y[p] - b.y[p];
        level += a.y[p];
        variance += a.variance[p] + b.variance[p];
      }
      variance += std::pow(more_variance * level, 2);
      EXPECT_LT(std::abs(sum), 5.5 * std::sqrt(variance)) << "block at " << x << ", " << y << " of level " << level;
      EXPECT_LT(5.5 * std::sqrt(variance), 0.1 * level) << "too few samples to see a tenth";
      whole += sum;
      whole_variance += variance;
    }
  EXPECT_LT(std::abs(whole), 4.5 * std::sqrt(whole_variance));
}

// The mean of `count` pictures at times drawn one from each count-th part of the shutter's.
Mean mean_of_stills(const Arrange& arrange, uint32_t count, uint32_t samples) {
  std::mt19937 random(3);
  Mean mean{std::vector<double>(side * side, 0.0), std::vector<double>(side * side, 0.0)};
  for (uint32_t k = 0; k < count; ++k) {
    SceneBuilder b = lit_scene(samples);
    b.scene.settings.seed = 100 + k;
    arrange(b, (k + std::generate_canonical<double, 53>(random)) / count);
    const Mean still = mean_of(render_film(*b.freeze()));
    for (size_t p = 0; p < still.y.size(); ++p) {
      mean.y[p] += still.y[p] / count;
      mean.variance[p] += still.variance[p] / count / count;
    }
  }
  return mean;
}

// How much of a picture may differ because only so many moments were pictured.
constexpr double moments = 0.002;

TEST(Motion, ABlurredPictureIsTheMeanOfStillOnes) {
  const glm::dmat4 cube_start = moved(-1.5, 0, 0) * stretched(1, 0.6, 1.4),
                   cube_end = moved(1, 0.5, 1) * turned(140, 1, 1, 0) * stretched(1.2, 1, 1);
  const glm::dmat4 ball_start = moved(1, -0.4, 0) * stretched(1, 0.5, 1),
                   ball_end = moved(-1, 0.4, 0.5) * turned(90, 0, 0, 1) * stretched(1, 0.3, 1);
  const auto at = [](const glm::dmat4& a, const glm::dmat4& b, double u) {
    return interpolated(motion_parts(a), motion_parts(b), u);
  };
  const auto shapes = [&](SceneBuilder& b, double u) {
    return std::pair{b.add(mesh(0), b.diffuse(0.8), at(cube_start, cube_end, u)),
                     b.add(sphere(0.8f), b.diffuse(0.6), at(ball_start, ball_end, u))};
  };
  SceneBuilder moving = lit_scene(1024);
  const auto [cube, ball] = shapes(moving, 0);
  moving.scene.registry.set(cube, motion_to(cube_end));
  moving.scene.registry.set(ball, motion_to(ball_end));
  const std::unique_ptr<World> world = moving.freeze();
  ASSERT_TRUE(world->has_motion);
  expect_same_picture(mean_of(render_film(*world)),
                      mean_of_stills([&](SceneBuilder& b, double u) { shapes(b, u); }, 64, 32), moments);
}

// A cube that turns in a group that moves; twice, as instances of one mesh, one of them mirrored and one still.
TEST(Motion, InstancesMoveWithinWhatMoves) {
  const glm::dmat4 group_end = moved(0.5, 0.3, 1) * turned(60, 0, 1, 0), turn = turned(80, 0, 0, 1);
  const auto group = [&](SceneBuilder& b, double u) {
    const Entity node = b.place(interpolated(motion_parts(glm::dmat4(1)), motion_parts(group_end), u));
    const glm::dmat4 turned_by = interpolated(motion_parts(glm::dmat4(1)), motion_parts(turn), u);
    const Entity one = b.add(mesh(0), b.diffuse(0.8), turned_by);
    const Entity two = b.add(mesh(0), b.diffuse(0.3), moved(1.3, 0, 0) * stretched(-0.7, 1, 1));
    b.add(mesh(0), b.diffuse(0.6), moved(-1.6, 0, -1));
    for (const Entity child : {one, two}) b.scene.registry.set(child, Parent{node});
    return std::pair{node, one};
  };
  SceneBuilder moving = lit_scene(1024);
  const auto [node, cube] = group(moving, 0);
  moving.scene.registry.set(node, motion_to(group_end));
  moving.scene.registry.set(cube, motion_to(turn));
  expect_same_picture(mean_of(render_film(*moving.freeze())),
                      mean_of_stills([&](SceneBuilder& b, double u) { group(b, u); }, 64, 32), moments);
}

// Everything but the camera moved by the inverse of the camera's motion; the sky is the same from everywhere.
TEST(Motion, ACameraMovesAsTheWorldDoesTheOtherWay) {
  const auto build = [&](bool camera_moves) {
    SceneBuilder b(side, side, 1024, 3);
    const glm::dmat4 view = moved(0, 0, 6) * stretched(1, 1, -1);
    const Entity camera = b.place(view);
    b.scene.registry.set(camera, perspective(40));
    b.light(LightKind::environment, unit_spectrum, 1);
    b.scene.meshes.push_back(cube_mesh());
    const Entity node = b.place();
    for (const double x : {-1.2, 0.0, 1.2}) {
      const Entity cube = b.add(mesh(0), b.diffuse(0.7), moved(x, x / 3, -x * x) * turned(30, 1, 1, 1));
      b.scene.registry.set(cube, Parent{node});
    }
    // The camera's motion turns about its own place, so that the inverse is a rigid motion too.
    const glm::dmat4 from_camera = moved(0, 0, 6);
    if (camera_moves) {
      b.scene.registry.set(camera, motion_to(from_camera * turned(12, 0, 0, 1) * stretched(1, 1, -1)));
    } else {
      b.scene.registry.set(node, motion_to(from_camera * turned(-12, 0, 0, 1) * glm::inverse(from_camera)));
    }
    return mean_of(render_film(*b.freeze()));
  };
  expect_same_picture(build(true), build(false));
}

TEST(Motion, AMovingCameraBlursALine) {
  // The camera goes to the right by its whole window: an edge becomes the ramp of a moving edge.
  Shadows s(16, 1024);
  s.b.add(rectangle(4, 4), s.b.diffuse(0.0), moved(-2, 0, 0));
  const Entity camera = s.b.scene.registry.table<Camera>().owner(0);
  const Transform t = s.b.scene.registry.get<Transform>(camera);
  Motion motion{t.row0, t.row1, t.row2};
  motion.row0.w += 1;
  s.b.scene.registry.set(camera, motion);
  // Seen from the camera the edge goes from 0 to -1.
  expect_edge(s.cover(), [](double x) { return std::clamp(-x, 0.0, 1.0); });
}

SceneBuilder everything_moves(uint32_t samples) {
  SceneBuilder b = lit_scene(samples);
  const Entity cube = b.add(mesh(0), b.diffuse(0.8), moved(-1, 0, 0));
  b.scene.registry.set(cube, motion_to(moved(1, 0, 0) * turned(90, 0, 1, 0)));
  const Entity ball = b.add(sphere(0.5f), b.dielectric(b.named("BK7")), moved(1, 0, 1));
  b.scene.registry.set(ball, motion_to(moved(1, 1, 1)));
  const Entity camera = b.scene.registry.table<Camera>().owner(0);
  const Transform t = b.scene.registry.get<Transform>(camera);
  b.scene.registry.set(camera, Motion{t.row0 + glm::vec4(0, 0, 0, 0.2f), t.row1, t.row2});
  return b;
}

TEST(Motion, GivesTheSameBytesForAnyTilesAndThreads) {
  for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path}) {
    SceneBuilder b = everything_moves(8);
    b.scene.settings.integrator = integrator;
    const std::unique_ptr<World> world = b.freeze();
    const Film one = render_film(*world, {1, 32});
    EXPECT_TRUE(one == render_film(*world, {2, 4}));
    EXPECT_TRUE(one == render_film(*b.freeze(), {2, 12}));
  }
}

// No ray from within a closed room that moves gets out: new rays keep off surfaces whose matrices Embree interpolates.
TEST(Motion, NothingLeaksThroughWallsThatMove) {
  for (const bool quadric : {true, false}) {
    SceneBuilder b(32, 32, 64, 12);
    b.look_at({0.3, 0.1, 0}, {0, 0, -1}, perspective(100));
    b.light(LightKind::environment, unit_spectrum, 1);
    b.scene.meshes.push_back(cube_mesh());
    const glm::dmat4 start = moved(3, -2, 1) * turned(30, 1, 2, 3) * stretched(17, 13, 15);
    const Entity room = b.add(quadric ? sphere(0.5f) : mesh(0), b.diffuse(0.9), start);
    b.scene.registry.set(room, motion_to(moved(2, 1, -1) * turned(75, 2, 1, 0) * stretched(15, 17, 14)));
    const Film film = render_film(*b.freeze());
    for (size_t p = 0; p < film.sums().size(); ++p) EXPECT_EQ(mean_xyz(film, p)[1], 0) << p;
  }
}

TEST(Motion, LightsStandAndSayThatTheyDo) {
  SceneBuilder b = lit_scene(1);
  const Entity lamp = b.add(sphere(0.2f), b.diffuse(0.5), moved(0, 2, 0));
  b.emit(lamp, unit_spectrum, 1);
  b.scene.registry.set(lamp, motion_to(moved(0, 5, 0)));
  Diagnostics diagnostics;
  const std::unique_ptr<World> world = freeze(b.scene, diagnostics);
  ASSERT_NE(world, nullptr);
  EXPECT_FALSE(world->has_motion);
  EXPECT_THAT(format_diagnostics(diagnostics), testing::HasSubstr("emits light and does not move"));
}

TEST(Motion, WithoutItNothingIsCarriedAlong) {
  const std::unique_ptr<World> world = lit_scene(1).freeze();
  EXPECT_FALSE(world->has_motion);
  EXPECT_TRUE(world->motion_keys.empty());
  EXPECT_TRUE(world->camera_keys.empty());
}

}  // namespace
}  // namespace metamer
