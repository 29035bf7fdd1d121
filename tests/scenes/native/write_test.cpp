// What the writer says, and that nothing is lost.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "scenes/native/json_text.h"
#include "tests/scenes/native/converted.h"
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

using testing::HasSubstr;

template <class C>
constexpr size_t field_count = std::tuple_size_v<decltype(C::fields)>;
template <class R>
constexpr size_t component_count = 0;
template <class... C>
constexpr size_t component_count<BasicRegistry<C...>> = sizeof...(C);

// A new field is to be written in scenes/native/write_*.cpp and read beside; new kinds stop the compiler there (the
// switches have no default). Counting is how the one who adds a field is told.
TEST(NativeWriter, KnowsEveryFieldThatASceneHas) {
  EXPECT_EQ(component_count<Registry>, 14u);
  EXPECT_EQ(field_count<Transform>, 3u);
  EXPECT_EQ(field_count<Motion>, 5u);
  EXPECT_EQ(field_count<Parent>, 1u);
  EXPECT_EQ(field_count<Geometry>, 13u);
  EXPECT_EQ(field_count<Material>, 24u);
  EXPECT_EQ(field_count<MaterialSlot>, 1u);
  EXPECT_EQ(field_count<Light>, 15u);
  EXPECT_EQ(field_count<Camera>, 7u);
  EXPECT_EQ(field_count<Name>, 1u);
  EXPECT_EQ(field_count<Visibility>, 1u);
  EXPECT_EQ(field_count<Medium>, 8u);
  EXPECT_EQ(field_count<MediumGrid>, 11u);
  EXPECT_EQ(field_count<MediumSlot>, 2u);
  EXPECT_EQ(field_count<Source>, 2u);  // a new file has lines of its own
  EXPECT_EQ(sizeof(RenderSettings), 152u);
  EXPECT_EQ(sizeof(Filter), 28u);
  EXPECT_EQ(sizeof(Image), 120u);  // what textures leave in files is in memory where nothing limits it
  EXPECT_EQ(sizeof(Texture), 176u);
  EXPECT_EQ(sizeof(TextureMapping), 92u);
  EXPECT_EQ(sizeof(Layer), 60u);
  EXPECT_EQ(sizeof(Mix), 24u);
  EXPECT_EQ(sizeof(Hair), 16u);
}

double through_double(float value) { return std::strtod(number_text(value).c_str(), nullptr); }

TEST(NativeWriter, NumbersReadBackThroughDoubles) {
  EXPECT_EQ(number_text(0.1f), "0.1");
  EXPECT_EQ(number_text(640), "640");
  EXPECT_EQ(number_text(1e-7f), "1e-07");
  EXPECT_TRUE(std::signbit(through_double(-0.0f)));
  for (const float value : {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::min(),
                            std::numeric_limits<float>::max(), 1.0f / 3, 16777217.0f})
    EXPECT_EQ(static_cast<float>(through_double(value)), value);
  uint32_t bits = 12345;
  for (int i = 0; i < 200000; ++i) {
    bits = bits * 1664525 + 1013904223;
    const float value = std::bit_cast<float>(bits);
    ASSERT_TRUE(!std::isfinite(value) || static_cast<float>(through_double(value)) == value) << bits;
  }
}

TEST(NativeWriter, TextStandsInLinesOf120Characters) {
  JsonText many = JsonText::array();
  for (int i = 0; i < 100; ++i) many.add(JsonText::number(1000.5f));
  const std::string text =
      JsonText::object().add("few", JsonText::numbers(std::array{1.0f, 2.0f})).add("many", many).text();
  EXPECT_THAT(text, testing::StartsWith("{\n  \"few\": [1, 2],\n  \"many\": [\n    1000.5, 1000.5,"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u);
}

TEST(NativeWriter, NamesAreMadeValidAndUnique) {
  EXPECT_EQ(valid_text("caf\xe9 \x01"), "caf\xc3\xa9 ?");
  EXPECT_EQ(valid_text("caf\xc3\xa9"), "caf\xc3\xa9");
  EXPECT_EQ(JsonText::string("a\"\\\n").text(), "\"a\\\"\\\\\\u000a\"\n");
  const ReadScene read = read_world(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"a 2\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"\xe9\" \"string type\" \"diffuse\"\n"
      "ObjectBegin \"a\" Shape \"sphere\" ObjectEnd ObjectInstance \"a\" ObjectInstance \"a\" ObjectInstance \"\xe9\"\n"
      "ObjectBegin \"\xe9\" NamedMaterial \"\xe9\" Shape \"disk\" ObjectEnd\n");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  expect_converts(read.scene);
  const Scene back = converted(read.scene);
  const Name first = back.registry.get<Name>(back.registry.table<Geometry>().owner(0));
  EXPECT_EQ(back.names[first.name], "a 3");
}

// Rows of spectra, one after another, as bytes; tables by their content.
std::string spectrum_bytes(const SpectrumSet& set, SpectrumId id) {
  SpectrumRow row = set.row(id);
  const SpectrumView view = set.view();
  const std::string table(reinterpret_cast<const char*>(view.tables + row.table * view.table_stride),
                          lambda_count * sizeof(float));
  row.table = row.table == 0 ? 0 : 1;
  return std::string(reinterpret_cast<const char*>(&row), sizeof(row)) + table;
}

TEST(NativeWriter, SpectraOfEveryKindAreTheSameToTheLastBit) {
  const ReadScene read = read_world(R"(
    Material "diffuse" "rgb reflectance" [0.63 0.065 0.05]  Shape "sphere"
    ColorSpace "rec2020"
    Material "diffuse" "rgb reflectance" [0.1 0.9 0.2]  Shape "sphere"
    Material "diffuse" "spectrum reflectance" [400 0.1 500 0.7 640.5 0.33]  Shape "sphere"
    Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Ag-k"  Shape "sphere"
    Material "conductor" "rgb reflectance" [0.2 0.3 0.9]  Shape "sphere"
    Material "dielectric" "spectrum eta" "glass-BK7"  Shape "sphere"
    Material "dielectric" "float eta" 1.3333  Shape "sphere"
    ColorSpace "aces2065-1"
    Material "diffuse" "rgb reflectance" [0.1 0.3 0.2]
    AttributeBegin AreaLightSource "diffuse" "rgb L" [17 12 4] "float scale" 3  Shape "sphere" AttributeEnd
    LightSource "point" "blackbody I" [3000] "float power" 100
    LightSource "infinite" "rgb L" [0.1 0.2 0.3]
    LightSource "spot" "spectrum I" "stdillum-A"
    LightSource "distant" "spectrum L" [360 1 830 0.1])");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Scene back = converted(read.scene);
  ASSERT_EQ(back.registry.table<Material>().size(), read.scene.registry.table<Material>().size());
  for (uint32_t row = 0; row < back.registry.table<Material>().size(); ++row) {
    const Material a = read.scene.registry.table<Material>().get(row), b = back.registry.table<Material>().get(row);
    EXPECT_EQ(a.kind, b.kind);
    for (const auto field : {&Material::reflectance, &Material::eta, &Material::kappa})
      EXPECT_TRUE(spectrum_bytes(read.scene.spectra, a.*field) == spectrum_bytes(back.spectra, b.*field)) << row;
  }
  ASSERT_EQ(back.registry.table<Light>().size(), 5u);
  for (uint32_t row = 0; row < 5; ++row) {
    // The abstract ones first: that is their order among themselves; see the test of the order.
    const Light b = back.registry.table<Light>().get(row);
    bool found = false;
    for (uint32_t i = 0; i < 5; ++i) {
      const Light a = read.scene.registry.table<Light>().get(i);
      found = found || (a.kind == b.kind && a.scale == b.scale &&
                        spectrum_bytes(read.scene.spectra, a.spectrum) == spectrum_bytes(back.spectra, b.spectrum));
    }
    EXPECT_TRUE(found) << row;
  }
  expect_converts(read.scene);
}

TEST(NativeWriter, BuiltInSpectraKeepTheirNames) {
  const ReadScene read = read_world(
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" Shape \"sphere\"\n"
      "LightSource \"point\" \"spectrum I\" \"stdillum-D65\"\n");
  const TemporaryFolder folder;
  write_scene(read.scene, folder.path());
  const std::string text = files_in(folder.path()).at("scene.json");
  EXPECT_THAT(text, HasSubstr(R"("eta": "Au.n", "kappa": "Au.k")"));
  EXPECT_THAT(text, HasSubstr(R"("intensity": "D65")"));
  EXPECT_EQ(text.find("samples\": ["), std::string::npos);
}

TEST(NativeWriter, ReflectancesOfFewDecimalsAreRgbAgain) {
  const ReadScene read = read_world(
      "Material \"diffuse\" \"rgb reflectance\" [0.63 0.065 0.05] Shape \"sphere\"\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.712345 0.3 1] Shape \"sphere\"\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.1234567891 0.2 0.3] Shape \"sphere\"\n"
      "ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [0.8 0.3 0.2] Shape \"sphere\"\n");
  const TemporaryFolder folder;
  write_scene(read.scene, folder.path());
  const std::string text = files_in(folder.path()).at("scene.json");
  EXPECT_THAT(text, HasSubstr(R"("reflectance": { "rgb": [0.63, 0.065, 0.05] })"));
  EXPECT_THAT(text, HasSubstr(R"("reflectance": { "rgb": [0.712345, 0.3, 1] })"));
  EXPECT_THAT(text, HasSubstr(R"("reflectance": { "sigmoid": [)"));
  EXPECT_THAT(text, HasSubstr(R"("reflectance": { "rgb": [0.8, 0.3, 0.2], "space": "rec2020" })"));
  expect_converts(read.scene);
}

TEST(NativeWriter, FiltersWithNegativeLobesAreKept) {
  const Filter mitchell = converted(read_text("PixelFilter \"mitchell\" \"float B\" 0.2 \"float C\" 0.4\n"
                                              "Camera \"perspective\" WorldBegin LightSource \"infinite\"")
                                        .scene)
                              .settings.filter;
  EXPECT_EQ(mitchell.kind, FilterKind::mitchell);
  EXPECT_EQ(mitchell.b, 0.2f);
  EXPECT_EQ(mitchell.c, 0.4f);
  const Filter sinc = converted(read_text("PixelFilter \"sinc\" \"float tau\" 2.5\n"
                                          "Camera \"perspective\" WorldBegin LightSource \"infinite\"")
                                    .scene)
                          .settings.filter;
  EXPECT_EQ(sinc.kind, FilterKind::sinc);
  EXPECT_EQ(sinc.tau, 2.5f);
}

TEST(NativeWriter, SettingsAndCameraAreKept) {
  const ReadScene read = read_text(R"(
    ColorSpace "rec2020" Film "rgb" "integer xresolution" 33 "integer yresolution" 21 "float iso" 250
      "float maxcomponentvalue" 7.5 "float whitebalance" 5123
    PixelFilter "triangle" "float xradius" 0.3 "float yradius" 3.25
    Sampler "halton" "integer pixelsamples" 5 "integer seed" 99
    Integrator "path" "integer maxdepth" 70000
    LookAt 1 2 3  4 5 6  0.1 1 0
    Camera "orthographic" "float screenwindow" [-0.7 1 -0.2 0.9] "float lensradius" 0.01 "float focaldistance" 3
    WorldBegin LightSource "infinite" Shape "sphere")");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Scene back = converted(read.scene);
  EXPECT_EQ(back.settings.width, 33u);
  EXPECT_EQ(back.settings.height, 21u);
  EXPECT_EQ(back.settings.sensor_scale, read.scene.settings.sensor_scale);
  EXPECT_EQ(back.settings.filter.kind, FilterKind::triangle);
  EXPECT_EQ(back.settings.filter.radius_x, 0.3f);
  EXPECT_EQ(back.settings.filter.radius_y, 3.25f);
  EXPECT_EQ(back.settings.samples_per_pixel, 5u);
  EXPECT_EQ(back.settings.seed, 99u);
  EXPECT_EQ(back.settings.max_depth, 70000u);
  EXPECT_EQ(back.settings.largest_component, 7.5f);
  EXPECT_EQ(back.settings.white_balance_kelvin, read.scene.settings.white_balance_kelvin);
  EXPECT_EQ(back.settings.primaries, ColorSpace::rec2020);
  const Camera camera = back.registry.table<Camera>().get(0);
  EXPECT_EQ(camera.kind, CameraKind::orthographic);
  EXPECT_EQ(camera.screen_window, read.get<Camera>().screen_window);
  EXPECT_EQ(camera.lens_radius, 0.01f);
  EXPECT_EQ(camera.focal_distance, 3);
  const Transform a = read.get<Transform>(), b = back.registry.get<Transform>(back.registry.table<Camera>().owner(0));
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
  expect_converts(read.scene);
}

TEST(NativeWriter, MediaAndTheirGridsAreKept) {
  const ReadScene read = read_world(R"(LightSource "infinite" Translate 0 0 4
    MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [0.3 0.2 0.1] "float g" 0.3 "float scale" 2
    MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1
      "float density" [0.5 0] "spectrum sigma_a" [400 0.1 700 0.4] "float temperature" [300 1200]
      "float temperaturescale" 2 "float temperatureoffset" -10 "point3 p1" [0.3 1 1]
    ColorSpace "rec2020"
    MakeNamedMedium "milk" "string type" "rgbgrid" "integer nx" 9 "integer ny" 1 "integer nz" 1
      "rgb sigma_a" [1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9] "float scale" 0.1
    MediumInterface "fog" "smoke" Material "interface" Shape "sphere"
    MediumInterface "smoke" "milk" Material "interface" Shape "sphere" "float radius" 2
    MediumInterface "milk" "" Material "interface" Shape "sphere" "float radius" 3)");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Scene back = converted(read.scene);
  EXPECT_EQ(back.registry.table<Medium>().size(), 3u);
  ASSERT_EQ(back.registry.table<MediumGrid>().size(), 2u);
  for (uint32_t i = 0; i < 2; ++i) {
    const MediumGrid a = read.get<MediumGrid>(i), b = back.registry.table<MediumGrid>().get(i);
    EXPECT_EQ(a.lower, b.lower);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.temperature_offset, b.temperature_offset);
    EXPECT_EQ(a.temperature_scale, b.temperature_scale);
    EXPECT_EQ(a.temperature != no_index, b.temperature != no_index);
    EXPECT_EQ(a.temperature == no_index ? BlackbodyUnit::radiance : a.blackbody, b.blackbody);
    for (const GridId MediumGrid::*handle : {&MediumGrid::density, &MediumGrid::sigma_a, &MediumGrid::temperature}) {
      ASSERT_EQ(a.*handle == no_index, b.*handle == no_index);
      if (a.*handle == no_index) continue;
      const Grid &from = read.scene.grids[a.*handle], &to = back.grids[b.*handle];
      EXPECT_EQ(from.index_to_local, to.index_to_local);
      EXPECT_EQ(from.origins, to.origins);
      EXPECT_EQ(from.values, to.values);
      EXPECT_EQ(from.lower, to.lower);
      EXPECT_EQ(from.upper, to.upper);
      EXPECT_EQ(from.color_space, to.color_space);
    }
  }
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

TEST(NativeWriter, MotionCropAndShutterAreKept) {
  const ReadScene read = read_text(R"(
    Film "rgb" "integer xresolution" 40 "integer yresolution" 30 "float cropwindow" [0.1 0.7 0.25 0.9]
    TransformTimes 0.25 1.5
    ActiveTransform EndTime Translate 0.1 0 0.3 ActiveTransform All
    Camera "spherical" "string mapping" "equalarea" "float shutteropen" 0.1 "float shutterclose" 0.7
    WorldBegin LightSource "infinite" Translate 0 0 3
    ActiveTransform EndTime Rotate 30 0 0 1 Translate 1 0 0 ActiveTransform All Shape "sphere" "float radius" 0.6)");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_GT(read.count<Motion>(), 0u);
  const Scene back = converted(read.scene);
  EXPECT_EQ(back.registry.table<Motion>().size(), read.count<Motion>());
  EXPECT_EQ(back.settings.crop, read.scene.settings.crop);
  EXPECT_EQ(back.settings.shutter_close, 0.7);
  EXPECT_EQ(back.registry.table<Camera>().get(0).mapping, ImageMapping::equal_area);
  ASSERT_NE(tiny_film(read.scene), nullptr);
  expect_converts(read.scene);
}

// Meshes that are shown twice are instances, whose arithmetic is another: sharing must neither vanish nor appear.
TEST(NativeWriter, MeshesAreSharedAsBefore) {
  const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0.1 0 1 0] \"integer indices\" [0 1 2]";
  const ReadScene read = read_world(
      "LightSource \"infinite\"\nObjectBegin \"tree\" " + mesh + " ObjectEnd\n" +
      "ObjectInstance \"tree\" Translate 1 0.3 2 Rotate 30 1 2 3 ObjectInstance \"tree\"\n" + mesh + "\n" + mesh);
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const TemporaryFolder folder;
  write_scene(read.scene, folder.path());
  const auto files = files_in(folder.path());
  EXPECT_EQ(files.size(), 4u) << "the scene and three meshes";
  EXPECT_TRUE(files.contains("scene-files/scene-3.ply"));
  EXPECT_EQ(read_without_remarks(folder.path() / "scene.json").meshes.size(), 3u);
  expect_converts(read.scene);
}

TEST(NativeWriter, MirrorsAndNegativeZerosAreKept) {
  const ReadScene read = read_world(
      "LightSource \"infinite\" Scale -1 1 1 ReverseOrientation Shape \"sphere\" Identity Scale 1 -0.5 2 Shape "
      "\"disk\"");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const Scene back = converted(read.scene);
  for (uint32_t row = 0; row < 2; ++row) {
    const Transform a = read.scene.registry.get<Transform>(read.entity<Geometry>(row));
    const Transform b = back.registry.get<Transform>(back.registry.table<Geometry>().owner(row));
    EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0) << row;
    EXPECT_EQ(back.registry.table<Geometry>().get(row).flip_normal, 1u);
  }
}

// After entities were destroyed rows stand in another order than entities: that of the rows counts.
TEST(NativeWriter, TheOrderOfShapesAndOfLightsIsThatOfTheirTables) {
  Scene scene;
  std::vector<Entity> made;
  for (int i = 0; i < 6; ++i) {
    const Entity entity = scene.registry.create();
    made.push_back(entity);
    if (i % 2 == 0) scene.registry.set(entity, Geometry{.kind = ShapeKind::sphere, .radius = float(i + 1)});
    if (i % 2 == 1) scene.registry.set(entity, Light{.kind = LightKind::point, .spectrum = 1, .scale = float(i + 1)});
  }
  scene.registry.destroy(made[0]);
  scene.registry.destroy(made[1]);
  const Scene back = converted(scene);
  ASSERT_EQ(back.registry.table<Geometry>().size(), 2u);
  EXPECT_EQ(back.registry.table<Geometry>().get(0).radius, 5);
  EXPECT_EQ(back.registry.table<Geometry>().get(1).radius, 3);
  EXPECT_EQ(back.registry.table<Light>().get(0).scale, 6);
  EXPECT_EQ(back.registry.table<Light>().get(1).scale, 4);
}

TEST(NativeWriter, ChildrenOfACameraStayWhereTheyAre) {
  const TemporaryFile file("scene.json", R"({"metamer": 1, "entities": [
    {"name": "eye", "transform": {"look_at": {"from": [0, 1, 4], "to": [0, 0, 0]}}, "camera": {"type": "perspective"}},
    {"parent": "eye", "transform": {"translate": [1, 2, -3]}, "light": {"type": "point", "candela": 3}},
    {"parent": "eye", "light": {"type": "area", "power": 3, "two_sided": true}, "geometry": {"type": "disk"}},
    {"geometry": {"type": "sphere", "radius": 2}, "visibility": {"shadows": false},
     "material": {"type": "rough", "kd": 0.1, "ks": 0.3, "shininess": 12.5, "normalized": true}}]})");
  Scene scene;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_scene(file.path(), scene, diagnostics)) << format_diagnostics(diagnostics);
  expect_converts(scene);
  const Scene back = converted(scene);
  EXPECT_EQ(back.registry.get<Visibility>(back.registry.table<Geometry>().owner(1)).mask,
            visible_to_camera | visible_to_bounces);
}

TEST(NativeWriter, WhatWasThereStaysWhenItFails) {
  const TemporaryFolder folder;
  folder.write("scene.json", "old");
  const ReadScene read = read_world(
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2] LightSource \"infinite\"");
  Cancellation cancellation;
  cancellation.request();
  NativeFiles files;
  const std::string path = (folder.path() / "scene.json").string();
  EXPECT_EQ(write_native(read.scene, path, cancellation, files).value_or(""), "interrupted; nothing was written");
  EXPECT_EQ(files_in(folder.path()), (std::map<std::string, std::string>{{"scene.json", "old"}}));
  std::filesystem::create_directory(folder.path() / "scene-files");
  folder.write("scene-files/mine.txt", "kept");
  EXPECT_FALSE(write_native(read.scene, path, Cancellation(), files));
  const auto all = files_in(folder.path());
  EXPECT_EQ(all.size(), 3u);
  EXPECT_EQ(all.at("scene-files/mine.txt"), "kept");
}

}  // namespace
}  // namespace metamer
