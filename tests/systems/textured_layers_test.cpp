// Coats and hair whose parameters are textures: where the textures are constant, the same as with the numbers.
#include <gmock/gmock.h>

#include "systems/bsdf/hair.h"
#include "tests/systems/support/textured_scene.h"

namespace metamer {
namespace {

struct CoatScene : TexturedScene {
  CoatScene() { b.scene.settings.integrator = Integrator::path; }
  Material metal() {
    Material m;
    m.kind = MaterialKind::layered;
    m.eta = b.constant(1.5);
    m.alpha_x = 0.3f;
    m.alpha_y = 0.2f;
    m.layer.base = LayerBase::conductor;
    m.layer.base_eta = b.constant(1.2);
    m.layer.base_kappa = b.constant(3);
    m.layer.base_alpha_x = 0.15f;
    m.layer.base_alpha_y = 0.25f;
    m.layer.thickness = 0.4f;
    m.layer.albedo = b.constant(0.7);
    m.layer.asymmetry = 0.3f;
    return m;
  }
  std::vector<PathRadiance> look_at(const Material& material) {
    b.scene.settings.samples_per_pixel = 16;
    b.add(sphere(1), material);
    b.light(LightKind::directional, b.constant(pi), 1, turned(30, 0, 1, 0));
    b.emit(b.add(rectangle(1, 1), b.diffuse(0.5), moved(2, 0, 1)), b.constant(3), 1, true);
    b.look_at({0, 0, 4}, {0, 0, 0}, perspective(30));
    return trace_radiances(*b.freeze());
  }
};

double worst_difference(const std::vector<PathRadiance>& a, const std::vector<PathRadiance>& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < 4; ++j) worst = std::max(worst, std::abs(a[i].radiance[j] - b[i].radiance[j]));
  return worst;
}

// What changes one parameter, by its value or by a texture of it.
struct Change {
  const char* name;
  void (*by_value)(CoatScene&, Material&);
  void (*by_texture)(CoatScene&, Material&);
};
constexpr Change changes[] = {
    {"roughness along u", [](CoatScene&, Material& m) { m.alpha_x = 0.5f; },
     [](CoatScene& s, Material& m) { m.alpha_x_texture = s.number(0.5f); }},
    {"roughness along v", [](CoatScene&, Material& m) { m.alpha_y = 0.4f; },
     [](CoatScene& s, Material& m) { m.alpha_y_texture = s.number(0.4f); }},
    {"no roughness at all", [](CoatScene&, Material& m) { m.alpha_x = m.alpha_y = 0; },
     [](CoatScene& s, Material& m) { m.alpha_x_texture = m.alpha_y_texture = s.number(0); }},
    {"roughness of the base along u", [](CoatScene&, Material& m) { m.layer.base_alpha_x = 0.4f; },
     [](CoatScene& s, Material& m) { m.layer.base_alpha_x_texture = s.number(0.4f); }},
    {"roughness of the base along v", [](CoatScene&, Material& m) { m.layer.base_alpha_y = 0.5f; },
     [](CoatScene& s, Material& m) { m.layer.base_alpha_y_texture = s.number(0.5f); }},
    {"thickness", [](CoatScene&, Material& m) { m.layer.thickness = 1.5f; },
     [](CoatScene& s, Material& m) { m.layer.thickness_texture = s.number(1.5f); }},
    {"asymmetry", [](CoatScene&, Material& m) { m.layer.asymmetry = -0.5f; },
     [](CoatScene& s, Material& m) { m.layer.asymmetry_texture = s.number(-0.5f); }},
    {"albedo", [](CoatScene& s, Material& m) { m.layer.albedo = s.b.constant(0.25); },
     [](CoatScene& s, Material& m) { m.layer.albedo_texture = s.spectrum(0.25); }},
    {"no albedo", [](CoatScene& s, Material& m) { m.layer.albedo = s.b.constant(0); },
     [](CoatScene& s, Material& m) { m.layer.albedo_texture = s.spectrum(0); }},
    {"reflectance of the base",
     [](CoatScene& s, Material& m) {
       m.layer.base_eta = s.b.constant(1);
       m.layer.base_kappa = s.b.constant(2);
     },
     [](CoatScene& s, Material& m) { m.reflectance_texture = s.spectrum(0.5); }},  // 2 sqrt(0.5) / sqrt(1 - 0.5)
};

TEST(TexturedLayers, TexturesThatAreConstantAreTheirNumbers) {
  CoatScene plain;
  const auto usual = plain.look_at(plain.metal());
  for (const Change& change : changes) {
    CoatScene by_value, by_texture;
    Material value = by_value.metal(), texture = by_texture.metal();
    change.by_value(by_value, value);
    change.by_texture(by_texture, texture);
    const auto wanted = by_value.look_at(value), found = by_texture.look_at(texture);
    EXPECT_LT(worst_difference(wanted, found), 2e-4) << change.name;
    EXPECT_GT(worst_difference(wanted, usual), 0.01) << change.name;
  }
}

// A diffuse base under a coat that varies is walked, and comes to what the closed form does.
TEST(TexturedLayers, AWalkUnderATexturedCoatIsTheClosedFormOnAverage) {
  const auto seen = [](bool textured) {
    CoatScene s;
    Material m;
    m.kind = MaterialKind::layered;
    m.eta = s.b.constant(1.5);
    m.reflectance = s.b.constant(0.8);
    m.layer.thickness = 0.1f;
    if (textured) m.layer.thickness_texture = s.number(0.1f);
    s.b.scene.settings.samples_per_pixel = 4096;
    s.b.add(rectangle(1, 1), m);
    s.b.light(LightKind::directional, s.b.constant(pi), 1, turned(40, 0, 1, 0));
    s.b.look_at({0, -0.6, 0.8}, {0, 0, 0}, orthographic(0.01f));
    return mean(trace_radiances(*s.b.freeze()));
  };
  const double closed = seen(false);
  EXPECT_GT(closed, 0.1);
  EXPECT_NEAR(seen(true) / closed, 1, 0.02);
}

TEST(TexturedLayers, TheColourOfHairIsItsAbsorption) {
  const auto seen = [](bool textured) {
    CoatScene s;
    Material m;
    m.kind = MaterialKind::hair;
    m.eta = s.b.constant(1.55);
    m.hair.beta_n = 0.4f;
    if (textured)
      m.reflectance_texture = s.spectrum(0.35);
    else
      m.hair.sigma_a = s.b.constant(hair_absorption_of_reflectance(0.35, double{m.hair.beta_n}));
    return s.look_at(m);
  };
  const auto wanted = seen(false);
  EXPECT_GT(mean(wanted), 0.01);
  EXPECT_LT(worst_difference(wanted, seen(true)), 1e-3);
}

}  // namespace
}  // namespace metamer
