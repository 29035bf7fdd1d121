// Shading normals bent by displacements and normal maps: a diffuse surface under parallel light shows the cosine
// between the light and the bent normal.
#include <glm/geometric.hpp>

#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

const glm::dvec3 light_direction = glm::normalize(glm::dvec3(0.5, 0.3, 1));

// Towards +z of the light's own space the light is: columns of a rotation whose z is that direction.
glm::dmat4 shining_from(const glm::dvec3& z) {
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
  return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1)};
}

// The cosine that a white square 2 wide and 1 high shows at its (u, v) under that light.
double cosine_on_square(TexturedScene& s, Material material, double u, double v) {
  s.b.scene.settings.shadows = false;
  s.b.add(rectangle(2, 1), material);
  s.b.light(LightKind::directional, s.b.constant(pi), 1, shining_from(light_direction));
  const glm::dvec3 p = {2 * u - 1, v - 0.5, 0};
  s.b.look_at(p + glm::dvec3(0, 0, 1), p, orthographic(1e-5f));
  return mean(trace_radiances(*s.b.freeze()));
}

Texture height(Texture image) {
  image.is_number = 1;
  image.filter = TextureFilter::linear;
  return image;
}

TEST(Bump, AFlatDisplacementChangesNothing) {
  TexturedScene s;
  Material material = s.b.diffuse(1.0);
  material.displacement = s.number(0.7f);
  EXPECT_NEAR(cosine_on_square(s, material, 0.4, 0.6), light_direction.z, 1e-5);
}

// Heights 0 and 0.1 over texels whose centres are 1/2 of u apart, which is 1 m: a slope of 0.1 in x; and of 0.2 in y
// where rows of a distance of 0.5 m differ by 0.1.
TEST(Bump, ASlopeOfTheDisplacementTurnsTheNormal) {
  const auto cosine = [](const std::vector<float>& heights, uint32_t width, uint32_t rows, float u_scale) {
    TexturedScene s;
    Material material = s.b.diffuse(1.0);
    Texture texture = height(s.greys(width, rows, heights));
    texture.mapping.u_scale = u_scale;
    material.displacement = s.add(texture);
    return cosine_on_square(s, material, 0.4 / double{u_scale}, 0.55);
  };
  const auto of_slope = [](double x, double y) {
    return glm::dot(glm::normalize(glm::dvec3(-x, -y, 1)), light_direction);
  };
  EXPECT_NEAR(cosine({0, 0.1f}, 2, 1, 1), of_slope(0.1, 0), 1e-5);
  EXPECT_NEAR(cosine({0, 0.1f}, 2, 1, 3), of_slope(0.3, 0), 1e-5);
  EXPECT_NEAR(cosine({0.1f, 0}, 1, 2, 1), of_slope(0, 0.2), 1e-5);  // the upper row comes first
}

TEST(Bump, PatternsHaveSlopesToo) {
  TexturedScene s;
  Material material = s.b.diffuse(1.0);
  Texture coordinate;
  coordinate.kind = TextureKind::coordinate;
  coordinate.is_number = 1;
  coordinate.mapping.u_scale = 0.5f;  // a height of u / 2: a slope of 0.25 in x
  material.displacement = s.add(coordinate);
  EXPECT_NEAR(cosine_on_square(s, material, 0.4, 0.55),
              glm::dot(glm::normalize(glm::dvec3(-0.25, 0, 1)), light_direction), 1e-3);
}

TEST(Bump, NumericalAndExactSlopesOfOneImageAgree) {
  const auto cosine = [](TextureMapping::Kind kind) {
    TexturedScene s;
    Material material = s.b.diffuse(1.0);
    Texture texture = height(s.greys(4, 4, {0, .1f, .3f, .2f, .1f, .2f, .2f, .1f, 0, .1f, .4f, .1f, .2f, .2f, .1f, 0}));
    texture.mapping.kind = kind;
    if (kind == TextureMapping::Kind::planar) {
      texture.mapping.u_axis[0] = 0.5f;  // u = x / 2 + 1 / 2, v = y + 1 / 2: those of the square
      texture.mapping.u_offset = texture.mapping.v_offset = 0.5f;
    }
    material.displacement = s.add(texture);
    return cosine_on_square(s, material, 0.45, 0.55);
  };
  const double exact = cosine(TextureMapping::Kind::uv);
  EXPECT_GT(std::abs(exact - light_direction.z), 0.01);
  EXPECT_NEAR(cosine(TextureMapping::Kind::planar), exact, 1e-3);
}

TEST(Bump, ANormalMapIsReadInTheTangentFrame) {
  const glm::dvec3 bent = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
  TexturedScene s;
  Material material = s.b.diffuse(1.0);
  const glm::dvec3 code = 0.5 * bent + 0.5;
  s.image(1, 1, {float(code.x), float(code.y), float(code.z)});
  material.normal_map = 0;
  EXPECT_NEAR(cosine_on_square(s, material, 0.4, 0.6), glm::dot(bent, light_direction), 1e-5);
}

// The frame turns with the object, a shared mesh's as well.
TEST(Bump, InstancesTurnTheirBumps) {
  const glm::dvec3 bent = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
  for (const int copies : {1, 2}) {
    TexturedScene s;
    s.b.scene.settings.shadows = false;
    Mesh square;
    for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      square.positions.push_back({uv.x - 0.5f, uv.y - 0.5f, 0});
      square.normals.push_back({0, 0, 1});
      square.uvs.push_back(uv);
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) square.indices.push_back(i);
    s.b.scene.meshes.push_back(square);
    Material material = s.b.diffuse(1.0);
    const glm::dvec3 code = 0.5 * bent + 0.5;
    s.image(1, 1, {float(code.x), float(code.y), float(code.z)});
    material.normal_map = 0;
    const glm::dmat4 turn = turned(90, 0, 0, 1);
    for (int copy = 0; copy < copies; ++copy) s.b.add(mesh(0), material, moved(3 * copy, 0, 0) * turn);
    s.b.light(LightKind::directional, s.b.constant(pi), 1, shining_from(light_direction));
    s.b.look_at({0.1, 0.2, 1}, {0.1, 0.2, 0}, orthographic(1e-5f));
    const glm::dvec3 turned_normal = glm::dvec3(turn * glm::dvec4(bent, 0));
    EXPECT_NEAR(mean(trace_radiances(*s.b.freeze())), glm::dot(turned_normal, light_direction), 1e-5) << copies;
  }
}

// On a sphere of radius r a height d(v) tilts the normal by d'(v) over the length of dp/dv at the displaced place,
// which is pi (r + d): the term with dn/dv.
TEST(Bump, OnASphereTheDisplacedPlaceCounts) {
  for (const float base : {0.0f, 0.5f}) {
    TexturedScene s;
    s.b.scene.settings.shadows = false;
    Material material = s.b.diffuse(1.0);
    Texture coordinate;  // v / 4 + base
    coordinate.kind = TextureKind::coordinate;
    coordinate.is_number = 1;
    coordinate.axis = 1;
    coordinate.mapping.v_scale = 0.25f;
    coordinate.mapping.v_offset = base - 0.125f;  // `base` at the equator
    material.displacement = s.add(coordinate);
    s.b.add(sphere(2), material);
    const glm::dvec3 from = glm::normalize(glm::dvec3(1, 0, 0.4));
    s.b.light(LightKind::directional, s.b.constant(pi), 1, shining_from(from));
    s.b.look_at({4, 0, 0}, {2, 0, 0}, orthographic(1e-5f), {0, 0, 1});
    // Upwards (v grows towards +z) by 0.25 per pi (2 + base) metres.
    const glm::dvec3 bent = glm::normalize(glm::dvec3(1, 0, -0.25 / (pi * (2 + double{base}))));
    EXPECT_NEAR(mean(trace_radiances(*s.b.freeze())), glm::dot(bent, from), 1e-4) << base;
  }
}

}  // namespace
}  // namespace metamer
