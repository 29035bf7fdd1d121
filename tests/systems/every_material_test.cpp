// Every kind of matter in light of 1 from everywhere, at each level of light transport, on each wavelength: what it
// shows is its albedo, by closed form or by quadrature of its scalar twin, or exactly what the level leaves out less.
// Other angles, roughnesses and shapes: furnace_test.cpp, coated_material_test.cpp, media_test.cpp.
#include <functional>
#include <set>

#include "systems/bsdf/coat_albedo.h"
#include "systems/bsdf/reference.h"
#include "systems/bsdf/reference_coat.h"
#include "tests/support/chi_square.h"
#include "tests/systems/support/layered_walk.h"
#include "tests/systems/support/radiances.h"

namespace metamer {
namespace {

using reference::Direction;
using reference::Spectrum4;
using Radiance = std::function<double(double lambda_nm)>;

constexpr double pi = 3.14159265358979323846;
const double theta = glm::radians(50.0), cos_theta = std::cos(theta);
const Direction viewer = {std::sin(theta), 0, cos_theta};

// `exact`: on every path; else in the mean, where a bias of `visible` would be seen.
struct Answer {
  Radiance radiance;
  bool exact = false;
  double visible = 0.02;
};
Answer exactly(Radiance radiance) { return {std::move(radiance), true}; }
Answer on_average(Radiance radiance, double visible = 0.02) { return {std::move(radiance), false, visible}; }
const Radiance black = [](double) { return 0.0; }, white = [](double) { return 1.0; };

struct Answers {
  Answer local, recursive, path;
};
// What is lit by light samples looks the same at all levels where nothing else is in sight.
Answers at_all_levels(const Answer& answer) { return {answer, answer, answer}; }
// What only mirrors and refracts is black to `local` and free of chance in `recursive`.
Answers without_local(const Radiance& radiance, const Answer& path) {
  return {exactly(black), exactly(radiance), path};
}

// In the scene's spectra: from `blue` at 360 nm to `red` at 830 nm.
SpectrumId slope(SceneBuilder& b, double blue, double red) {
  const std::vector<double> lambda_nm = {360, 830}, values = {blue, red};
  return b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id;
}
double slope_at(double lambda_nm, double blue, double red) { return blue + (red - blue) * (lambda_nm - 360) / 470; }
Radiance curve(const SceneBuilder& b, SpectrumId id) {
  return [samples = b.scene.spectra.samples(id)](double nm) { return interpolate(samples, nm); };
}

// The integral of f_cos(wi) over the sphere, or the hemisphere of the viewer.
template <class FCos>
double albedo(const FCos& f_cos, double end = pi / 2) {
  return integrate_rectangle(
      [&](double polar, double phi) {
        return std::sin(polar) *
               f_cos(Direction{std::sin(polar) * std::cos(phi), std::sin(polar) * std::sin(phi), std::cos(polar)});
      },
      0, end, -pi, pi, 48);
}
// From values at 24 wavelengths, linear in between.
template <class Value>
Radiance tabulated(const Value& value) {
  std::vector<double> nodes;
  for (int i = 0; i < 24; ++i) nodes.push_back(value(360 + 470 * i / 23.0));
  return [nodes](double nm) {
    const double t = (nm - 360) / 470 * 23;
    const size_t i = std::min<size_t>(22, static_cast<size_t>(t));
    return nodes[i] + (nodes[i + 1] - nodes[i]) * (t - double(i));
  };
}

void plane(SceneBuilder& b, const Material& material) { b.add(rectangle(1, 1), material); }
// From z = top - thickness to z = top, wide enough for all reflections inside.
void slab(SceneBuilder& b, const Material& material, double top, double thickness) {
  if (b.scene.meshes.empty()) b.scene.meshes.push_back(cube_mesh());
  b.add(mesh(0), material, moved(0.1, 0.05, top - thickness / 2) * stretched(1, 1, thickness));
}

Answers add_diffuse(SceneBuilder& b) {
  plane(b, b.diffuse(slope(b, 0.1, 0.9)));
  return at_all_levels(on_average([](double nm) { return slope_at(nm, 0.1, 0.9); }));
}
Answers add_black(SceneBuilder& b) {
  plane(b, b.diffuse(0.0));
  return at_all_levels(exactly(black));
}
// As taught both terms are sr^-1: kd shows pi times its value.
Answers add_rough(SceneBuilder& b, bool normalized) {
  const double ks = normalized ? 0.6 : 0.2, unit = normalized ? 1 : pi;
  plane(b, b.rough(slope(b, 0.1, 0.2), b.constant(ks), 15, normalized));
  const double glossy = albedo([&](const Direction& wi) {
    return reference::eval_rough(viewer, {{}, {ks, ks, ks, ks}, 15, normalized}, wi).f_cos[0];
  });
  return at_all_levels(on_average([=](double nm) { return unit * slope_at(nm, 0.1, 0.2) + glossy; }));
}
Answers add_taught(SceneBuilder& b) { return add_rough(b, false); }
Answers add_normalized(SceneBuilder& b) { return add_rough(b, true); }

// Nothing is lost in a white coated body, but `local` leaves out the image in its mirror.
Answers add_smooth_coat(SceneBuilder& b) {
  plane(b, b.coated(unit_spectrum, slope(b, 1.8, 1.4)));
  const auto body = [](double nm) { return 1 - coat_fresnel(slope_at(nm, 1.8, 1.4), cos_theta, false); };
  return {on_average(body), on_average(white), on_average(white)};
}
Answers add_rough_coat(SceneBuilder& b) {
  plane(b, b.coated(unit_spectrum, b.named("BK7"), 0.3f));
  return at_all_levels(on_average(white));
}
// pbrt's coat: what its closed form adds up to, each wavelength with its own index and albedo.
Answers add_layered(SceneBuilder& b, float alpha_x, float alpha_y) {
  Material coat = b.coated(slope(b, 0.2, 0.9), slope(b, 1.7, 1.4));
  coat.kind = MaterialKind::layered;
  coat.alpha_x = alpha_x;
  coat.alpha_y = alpha_y;
  coat.layer.thickness = 0.2f;
  coat.layer.max_depth = 4;
  plane(b, coat);
  Column<float> table;
  const double width = alpha_x > 0 ? coat_table_alpha(double{alpha_x}, double{alpha_y}) : 0;
  const CoatRows rows = add_coat_rows({width, false, true, double{0.2f}}, 1.4, 1.7, table);
  const Radiance body = tabulated([&](double nm) {
    const double a = slope_at(nm, 0.2, 0.9), eta = slope_at(nm, 1.7, 1.4);
    reference::CoatOptics optics{{a, a, a, a}, {eta, eta, eta, eta}, double{alpha_x}, false, table.data(), rows};
    optics.alpha_y = double{alpha_y};
    optics.thickness = double{0.2f};
    optics.hits = 2;
    return albedo([&](const Direction& wi) { return reference::eval_coated(viewer, optics, wi).f_cos[0]; });
  });
  if (alpha_x > 0) return at_all_levels(on_average(body));
  const Radiance all = [=](double nm) { return body(nm) + coat_fresnel(slope_at(nm, 1.7, 1.4), cos_theta, false); };
  return {on_average(body), on_average(all), on_average(all)};
}
// A lossless mirror under a clear coat without thickness: nothing is lost, whatever the angle.
Answers add_coated_mirror(SceneBuilder& b) {
  Material coat = b.coated(zero_spectrum, b.constant(1.5));
  coat.kind = MaterialKind::layered;
  coat.layer.base = LayerBase::conductor;
  coat.layer.base_eta = unit_spectrum;
  coat.layer.base_kappa = b.constant(1e8);
  coat.layer.thickness = 0;
  coat.layer.max_depth = 1000;
  plane(b, coat);
  return without_local(white, exactly(white));
}
// What walks from the viewer bring: the scalar twin's.
Answers add_coated_rough_metal(SceneBuilder& b) {
  Material coat = b.coated(zero_spectrum, b.constant(1.5), 0.2f);
  coat.kind = MaterialKind::layered;
  coat.layer.base = LayerBase::conductor;
  coat.layer.base_eta = slope(b, 0.2, 0.4);
  coat.layer.base_kappa = slope(b, 2, 6);
  coat.layer.base_alpha_x = coat.layer.base_alpha_y = 0.3f;
  coat.layer.albedo = slope(b, 0.9, 0.5);
  coat.layer.thickness = 0.3f;
  plane(b, coat);
  const Radiance shown = tabulated([&](double nm) {
    testing::LayeredWalk walk;
    walk.conductor = true;
    walk.surface = {double{0.2f}, double{0.2f}};
    walk.base = {double{0.3f}, double{0.3f}};
    walk.n = slope_at(nm, 0.2, 0.4) / 1.5;
    walk.kappa = slope_at(nm, 2, 6) / 1.5;
    walk.albedo = slope_at(nm, 0.9, 0.5);
    walk.thickness = double{0.3f};
    double sum = 0;
    constexpr int count = 40000;
    for (int i = 0; i < count; ++i) sum += walk.sample(viewer).weight / count;
    return sum;
  });
  return at_all_levels(on_average(shown, 0.03));
}
// Without absorption all light leaves; meshes as hair are lit on both sides.
Answers add_white_hair(SceneBuilder& b) {
  Material hair;
  hair.kind = MaterialKind::hair;
  hair.eta = b.constant(1.55);
  plane(b, hair);
  return at_all_levels(on_average(white));
}
Answers add_smooth_layered(SceneBuilder& b) { return add_layered(b, 0, 0); }
Answers add_rough_layered(SceneBuilder& b) { return add_layered(b, 0.2f, 0.4f); }
// Lit from both sides.
Answers add_sheet(SceneBuilder& b) {
  Material sheet = b.diffuse(slope(b, 0.1, 0.4));
  sheet.kind = MaterialKind::diffuse_transmission;
  sheet.transmittance = slope(b, 0.5, 0.3);
  plane(b, sheet);
  return at_all_levels(on_average([](double nm) { return slope_at(nm, 0.6, 0.7); }));
}
Answers add_mixed(SceneBuilder& b) {
  Material mixed;
  mixed.kind = MaterialKind::mix;
  for (Entity* part : {&mixed.mix.first, &mixed.mix.second}) *part = b.scene.registry.create();
  b.scene.registry.set(mixed.mix.first, b.diffuse(0.25));
  b.scene.registry.set(mixed.mix.second, b.coated(unit_spectrum, b.named("BK7"), 0.3f));
  mixed.mix.amount = 0.6f;
  plane(b, mixed);
  return at_all_levels(on_average([](double) { return 0.7; }));
}
Answers add_perfect_mirror(SceneBuilder& b) {
  plane(b, b.conductor(b.constant(1), b.constant(1e8)));
  return without_local(white, exactly(white));
}
Answers add_gold_mirror(SceneBuilder& b) {
  const SpectrumId n = b.named("Au.n"), kappa = b.named("Au.k");
  plane(b, b.conductor(n, kappa));
  const Radiance f = [n = curve(b, n), kappa = curve(b, kappa)](double nm) {
    return reference::fresnel_conductor(n(nm), kappa(nm), cos_theta);
  };
  return without_local(f, exactly(f));
}
// What facets scatter twice is lost: a lossless rough metal shows less than 1.
Answers add_rough_metal(SceneBuilder& b, double kappa_blue, double kappa_red) {
  plane(b, b.conductor(b.constant(1), slope(b, kappa_blue, kappa_red), 0.15f, 0.5f));
  const Radiance shown = tabulated([&](double nm) {
    const double kappa = slope_at(nm, kappa_blue, kappa_red);
    const reference::ConductorOptics optics{{1, 1, 1, 1}, {kappa, kappa, kappa, kappa}, false};
    return albedo([&](const Direction& wi) {
      return reference::eval_conductor(viewer, {double{0.15f}, 0.5}, optics, wi).f_cos[0];
    });
  });
  return at_all_levels(on_average(shown));
}
Answers add_lossless_rough_metal(SceneBuilder& b) {
  const Answers answers = add_rough_metal(b, 1e8, 1e8);
  EXPECT_LT(answers.path.radiance(550), 1);
  EXPECT_GT(answers.path.radiance(550), 0.75);
  return answers;
}
Answers add_coloured_rough_metal(SceneBuilder& b) { return add_rough_metal(b, 1, 6); }

// One boundary: what is refracted shows the light below, less by eta^2.
double boundary(double eta) {
  const double f = reference::fresnel_dielectric(eta, cos_theta);
  return f + (1 - f) / (eta * eta);
}
Answers add_boundary(SceneBuilder& b) {
  plane(b, b.dielectric(b.constant(1.5)));
  const Radiance shown = [](double) { return boundary(1.5); };
  return without_local(shown, on_average(shown));
}
Answers add_dispersing_boundary(SceneBuilder& b) {
  plane(b, b.dielectric(slope(b, 1.9, 1.5)));
  const Radiance shown = [](double nm) { return boundary(slope_at(nm, 1.9, 1.5)); };
  return without_local(shown, on_average(shown, 0.06));
}
Answers add_clear_slab(SceneBuilder& b) {
  slab(b, b.dielectric(b.constant(1.5)), 0, 0.02);
  return without_local(white, exactly(white));
}
// All reflections between the faces: the thin plate's series, with Beer's law on each way through.
Radiance plate(double eta, double kappa, double thickness) {
  return [=](double nm) {
    reference::ThinOptics optics;
    optics.eta.fill(eta);
    optics.optical_depth.fill(4 * pi * kappa / (nm * 1e-9) * thickness);
    const reference::ThinShares shares = reference::thin_shares(optics, 0, cos_theta);
    return shares.reflected + shares.transmitted;
  };
}
Answers add_absorbing_slab(SceneBuilder& b) {
  Material glass = b.dielectric(b.constant(1.5));
  glass.kappa = b.constant(1e-6);
  slab(b, glass, 0, 0.02);
  return without_local(plate(1.5, 1e-6, 0.02), on_average(plate(1.5, 1e-6, 0.02)));
}
Answers add_clear_sheet(SceneBuilder& b) {
  plane(b, b.thin(b.constant(1.5), zero_spectrum, 0));
  return without_local(white, exactly(white));
}
Answers add_absorbing_sheet(SceneBuilder& b) {
  plane(b, b.thin(b.constant(1.5), b.constant(1e-6), 0.02f));
  return without_local(plate(1.5, 1e-6, 0.02), on_average(plate(1.5, 1e-6, 0.02)));
}
// Lit from both sides; what facets scatter twice is lost.
Answers add_rough_boundary(SceneBuilder& b) {
  plane(b, b.rough_glass(b.constant(1.5), 0.4f, 0.4f));
  const reference::DielectricOptics optics{{1.5, 1.5, 1.5, 1.5}, false, false, {}, {}};
  const double shown = albedo(
      [&](const Direction& wi) {
        return reference::eval_rough_dielectric(viewer, {double{0.4f}, double{0.4f}}, optics, wi).f_cos[0];
      },
      pi);
  EXPECT_LT(shown, boundary(1.5));
  EXPECT_GT(shown, 0.9 * boundary(1.5));
  return at_all_levels(on_average([=](double) { return shown; }));
}
Answers add_clear_smooth(SceneBuilder& b) {
  slab(b, b.smooth(b.constant(1.7), zero_spectrum), 0, 0.02);
  return without_local(white, exactly(white));
}
Answers add_opaque_smooth(SceneBuilder& b) {
  plane(b, b.smooth(slope(b, 0.4, 1.6), b.constant(2)));
  const Radiance f = [](double nm) { return reference::fresnel_conductor(slope_at(nm, 0.4, 1.6), 2, cos_theta); };
  return without_local(f, exactly(f));
}
// Glass below 549 nm, metal above; where it absorbs a little, what enters never leaves.
Answers add_partly_opaque_smooth(SceneBuilder& b) {
  const std::vector<double> lambda_nm = {549, 550}, values = {0, 2};
  plane(b, b.smooth(b.constant(1.5), b.scene.spectra.add_table(lambda_nm, values, Extend::constant).id));
  const Radiance shown = [](double nm) {
    const double kappa = std::clamp(2 * (nm - 549), 0.0, 2.0);
    if (kappa == 0) return boundary(1.5);
    return kappa < 0.01 ? reference::fresnel_dielectric(1.5, cos_theta)
                        : reference::fresnel_conductor(1.5, kappa, cos_theta);
  };
  return without_local(shown, on_average(shown, 0.06));
}
// Glass fills the space that it shares with the water above it.
Answers add_nested(SceneBuilder& b) {
  slab(b, b.smooth(b.constant(1.33), zero_spectrum, 1), 0, 0.02);
  slab(b, b.smooth(b.constant(1.6), zero_spectrum, 2), -0.01, 0.02);
  return without_local(white, exactly(white));
}

// Nothing to see.
Answers add_interface(SceneBuilder& b) {
  plane(b, b.interface());
  return at_all_levels(exactly(white));
}

struct Row {
  const char* name;
  Answers (*add)(SceneBuilder&);
};
constexpr Row rows[] = {
    {"interface", add_interface},
    {"diffuse", add_diffuse},
    {"black", add_black},
    {"rough as taught", add_taught},
    {"rough, normalised", add_normalized},
    {"smooth coat, white", add_smooth_coat},
    {"rough coat, white", add_rough_coat},
    {"smooth surface of a layer", add_smooth_layered},
    {"rough surface of a layer", add_rough_layered},
    {"mirror under a coat", add_coated_mirror},
    {"rough metal under a coat", add_coated_rough_metal},
    {"white hair", add_white_hair},
    {"sheet", add_sheet},
    {"mix", add_mixed},
    {"perfect mirror", add_perfect_mirror},
    {"gold mirror", add_gold_mirror},
    {"rough metal, lossless", add_lossless_rough_metal},
    {"rough metal, coloured", add_coloured_rough_metal},
    {"boundary of glass", add_boundary},
    {"boundary of dispersing glass", add_dispersing_boundary},
    {"clear slab", add_clear_slab},
    {"absorbing slab", add_absorbing_slab},
    {"clear sheet", add_clear_sheet},
    {"absorbing sheet", add_absorbing_sheet},
    {"rough boundary of glass", add_rough_boundary},
    {"smooth, clear", add_clear_smooth},
    {"smooth, opaque", add_opaque_smooth},
    {"smooth, opaque on some wavelengths", add_partly_opaque_smooth},
    {"glass in water, by priority", add_nested},
};

void expect_answer(const World& world, const Answer& answer) {
  const std::vector<PathRadiance> paths = trace_radiances(world);
  if (!answer.exact) return expect_mean(paths, answer.radiance, answer.visible);
  if (answer.radiance(550) > 0) return expect_every_path(paths, answer.radiance, 1e-4);
  for (const PathRadiance& path : paths)
    for (const double radiance : path.radiance) ASSERT_EQ(radiance, 0);
}

// And a kind that is added needs a row.
TEST(EveryMaterial, ShowsItsAlbedoInAFurnaceAtEveryLevel) {
  std::set<uint32_t> missing;
  for (uint32_t kind = 0; kind < shade_kind_count; ++kind) missing.insert(kind);
  missing.erase(static_cast<uint32_t>(ShadeKind::miss));
  missing.erase(static_cast<uint32_t>(ShadeKind::phase));  // no surface: volumes_test.cpp
  for (const Row& row : rows)
    for (const Integrator integrator : {Integrator::local, Integrator::recursive, Integrator::path}) {
      SceneBuilder b(16, 16, 0, 64);
      b.scene.settings.integrator = integrator;
      b.light(LightKind::environment, unit_spectrum, 1);
      b.look_at({std::sin(theta), 0, std::cos(theta)}, {0, 0, 0}, orthographic(1e-3f), {0, 1, 0});
      const Answers answers = row.add(b);
      const Answer& answer = integrator == Integrator::local       ? answers.local
                             : integrator == Integrator::recursive ? answers.recursive
                                                                   : answers.path;
      b.scene.settings.samples_per_pixel = answer.exact ? 8 : 1024;
      const std::unique_ptr<World> world = b.freeze();
      for (const uint32_t kind : world->objects.shade_kind) missing.erase(kind);
      SCOPED_TRACE(::testing::Message() << row.name << ", " << integrator_name(integrator));
      expect_answer(*world, answer);
    }
  EXPECT_EQ(missing, std::set<uint32_t>()) << "kinds without a row";
}

}  // namespace
}  // namespace metamer
