#include <cmath>

#include "scenes/volumes/write_vdb.h"
#include "tests/scenes/pbrt/read_text.h"
#include "tests/scenes/support/volume_files.h"

namespace metamer {
namespace {

constexpr const char* sphere = " Shape \"sphere\"\n";

struct MediumRead : ReadScene {
  Medium m;
  explicit MediumRead(const std::string& parameters)
      : ReadScene(read_world("MakeNamedMedium \"m\" " + parameters)), m(get<Medium>()) {
    EXPECT_TRUE(ok) << parameters << "\n" << format_diagnostics(diagnostics);
  }
  double value(SpectrumId id, double lambda_nm) const { return scene.spectra.value(id, lambda_nm); }
  // Linear sRGB of an unbounded spectrum under its white.
  Color3 rgb(SpectrumId id) {
    SpectrumSet& set = scene.spectra;
    const SpectrumId white = set.add_white(ColorSpace::srgb);
    const Color3 lit = set.xyz(set.product(id, white).id);
    const double scale = set.luminance(white);
    return multiply(xyz_to_rgb(ColorSpace::srgb), Color3{lit[0] / scale, lit[1] / scale, lit[2] / scale});
  }
  void expect_rgb(SpectrumId id, double red, double green, double blue) {
    const Color3 got = rgb(id);
    const double size = std::max({red, green, blue});
    EXPECT_NEAR(got[0], red, 2e-3 * size);
    EXPECT_NEAR(got[1], green, 2e-3 * size);
    EXPECT_NEAR(got[2], blue, 2e-3 * size);
  }
};

// https://pbrt.org/fileformat-v4, "homogeneous".
TEST(PbrtMedia, HomogeneousIsWholeMilkByDefault) {
  MediumRead milk("\"string type\" \"homogeneous\"");
  milk.expect_rgb(milk.m.sigma_a, 0.0011, 0.0024, 0.014);
  milk.expect_rgb(milk.m.sigma_s, 2.55, 3.21, 3.77);
  EXPECT_EQ(milk.m.scale, 1.0f);
  EXPECT_EQ(milk.m.g, 0.0f);
  EXPECT_EQ(milk.m.emission, zero_spectrum);
  EXPECT_EQ(milk.count<MediumGrid>(), 0u);
}

TEST(PbrtMedia, HomogeneousHasItsOwnCoefficients) {
  MediumRead gas(
      "\"string type\" \"homogeneous\" \"rgb sigma_a\" [ 3 .2 .1 ] \"spectrum sigma_s\" [ 400 1 700 2 ] "
      "\"float scale\" 10 \"float g\" -0.25");
  gas.expect_rgb(gas.m.sigma_a, 3, 0.2, 0.1);
  EXPECT_NEAR(gas.value(gas.m.sigma_s, 550), 1.5, 1e-6);
  EXPECT_EQ(gas.m.scale, 10.0f);
  EXPECT_EQ(gas.m.g, -0.25f);
}

// The tables of Jensen et al. 2001, figure 5, and of pbrt after Narasimhan et al. 2006.
TEST(PbrtMedia, PresetsAreMeasured) {
  MediumRead skin("\"string type\" \"homogeneous\" \"string preset\" \"Skin1\" \"float scale\" 2");
  skin.expect_rgb(skin.m.sigma_s, 0.74, 0.88, 1.01);
  skin.expect_rgb(skin.m.sigma_a, 0.032, 0.17, 0.48);
  EXPECT_EQ(skin.m.scale, 2.0f);
  MediumRead cream("\"string type\" \"homogeneous\" \"string preset\" \"Cream\"");
  cream.expect_rgb(cream.m.sigma_s, 7.38, 5.47, 3.15);
  MediumRead espresso("\"string type\" \"homogeneous\" \"string preset\" \"Espresso\"");
  espresso.expect_rgb(espresso.m.sigma_a, 4.7984, 6.5751, 8.8493);
  MediumRead shampoo("\"string type\" \"homogeneous\" \"string preset\" \"Head & Shoulders Shampoo\"");
  shampoo.expect_rgb(shampoo.m.sigma_s, 0.023805, 0.028804, 0.034306);
  MediumRead water("\"string type\" \"homogeneous\" \"string preset\" \"Pacific Ocean Surface Water\"");
  water.expect_rgb(water.m.sigma_a, 0.031845, 0.031324, 0.030147);
}

TEST(PbrtMedia, APresetCountsMoreThanCoefficients) {
  const ReadScene read = read_world(
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"string preset\" \"Apple\" \"rgb sigma_a\" [1 1 1]");
  EXPECT_THAT(read.messages,
              testing::ElementsAre("scene:2: warning: 'preset' is given, so 'sigma_a' and 'sigma_s' are not used"));
  EXPECT_LT(read.scene.spectra.max_value(read.get<Medium>().sigma_a), 0.1);
}

// As lights: the luminance of a spectrum is divided out, of rgb that of its white.
TEST(PbrtMedia, EmissionIsScaledAsLightsAre) {
  MediumRead fire("\"string type\" \"homogeneous\" \"blackbody Le\" 2000 \"float Lescale\" 5");
  EXPECT_NEAR(fire.m.emission_scale * fire.scene.spectra.luminance(fire.m.emission), 5, 1e-4);
  MediumRead lamp("\"string type\" \"homogeneous\" \"rgb Le\" [ 2 2 2 ]");
  EXPECT_NEAR(lamp.m.emission_scale * lamp.scene.spectra.luminance(lamp.m.emission), 2, 1e-3);
}

TEST(PbrtMedia, AreOnBothSidesOfTheShapesThatFollow) {
  const ReadScene read = read_text(std::string(R"(MakeNamedMedium "fog" "string type" "homogeneous"
MediumInterface "tea" "fog"
Camera "perspective"
WorldBegin
)") + sphere + "AttributeBegin MediumInterface \"tea\" \"\"" +
                                   sphere + "AttributeEnd MediumInterface \"\"" + sphere + "MediumInterface \"fog\"" +
                                   sphere + "MakeNamedMedium \"tea\" \"string type\" \"homogeneous\"");
  EXPECT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  ASSERT_EQ(read.count<Geometry>(), 4u);
  ASSERT_EQ(read.count<MediumSlot>(), 3u) << "the same on both sides changes nothing";
  const Entity fog = read.entity<Medium>(0), tea = read.entity<Medium>(1);
  EXPECT_EQ(read.scene.describe(fog), "'fog'");
  const auto slot = [&](Entity entity) { return read.scene.registry.get<MediumSlot>(entity); };
  EXPECT_EQ(slot(read.entity<Camera>()).outside, fog) << "the camera is in the outer medium";
  EXPECT_EQ(slot(read.entity<Geometry>(0)).inside, tea);
  EXPECT_EQ(slot(read.entity<Geometry>(0)).outside, fog);
  EXPECT_EQ(slot(read.entity<Geometry>(1)).inside, tea);
  EXPECT_TRUE(slot(read.entity<Geometry>(1)).outside.is_null());
}

TEST(PbrtMedia, GoWithTheShapesOfObjects) {
  const ReadScene read = read_world(std::string("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n") +
                                    "ObjectBegin \"o\" MediumInterface \"fog\" \"\" Material \"interface\"" + sphere +
                                    "ObjectEnd ObjectInstance \"o\" Translate 1 0 0 ObjectInstance \"o\"");
  EXPECT_TRUE(read.messages.empty()) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.count<Geometry>(), 2u);
  EXPECT_EQ(read.count<MediumSlot>(), 2u);
  EXPECT_EQ(read.material(1).kind, MaterialKind::interface);
}

TEST(PbrtMedia, AttributesAreDefaults) {
  const ReadScene read = read_world(
      "Attribute \"medium\" \"float g\" 0.5 MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
      "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"float g\" 0.25");
  EXPECT_EQ(read.get<Medium>(0).g, 0.5f);
  EXPECT_EQ(read.get<Medium>(1).g, 0.25f);
}

TEST(PbrtMedia, UniformGridsAreHandedOver) {
  const ReadScene read = read_world(
      "Translate 1 2 3 MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 3 \"integer ny\" 2 "
      "\"float density\" [ 0 1 2 3 4 5 ] \"float Lescale\" [ 1 1 1 2 2 2 ] \"rgb Le\" [ 1 1 1 ] \"float g\" .3 "
      "\"point3 p0\" [ -1 2 -3 ] \"point3 p1\" [ 1 1 1 ] \"float scale\" 4 \"spectrum sigma_s\" [ 300 2 900 2 ]");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const MediumGrid grid = read.get<MediumGrid>();
  EXPECT_EQ(grid.lower, glm::vec3(-1, 1, -3));
  EXPECT_EQ(grid.upper, glm::vec3(1, 2, 1));
  ASSERT_EQ(read.scene.grids.size(), 2u);
  const Grid& density = read.scene.grids[grid.density];
  EXPECT_EQ(density.upper, glm::ivec3(3, 2, 1));
  EXPECT_EQ(density.channels, 1u);
  EXPECT_EQ(grid_value(density, {1, 1, 0}).x, 4.0f);
  EXPECT_EQ(grid_value(density, {3, 1, 0}).x, 0.0f) << "beyond the box there is nothing";
  EXPECT_EQ(grid_mean(density).x, 2.5);
  EXPECT_EQ(density.index_to_local * glm::dvec4(0, 1, 0, 1), glm::dvec4(-1 + 1 / 3.0, 1.75, -1, 1));
  EXPECT_EQ(grid_value(read.scene.grids[grid.emission], {2, 1, 0}).x, 2.0f);
  EXPECT_EQ(grid.temperature, no_index);
  EXPECT_EQ(read.get<Medium>().sigma_a, unit_spectrum);
  EXPECT_NEAR(read.scene.spectra.value(read.get<Medium>().sigma_s, 500), 2, 1e-6);
  EXPECT_EQ(read.get<Medium>().g, 0.3f);
  EXPECT_EQ(read.scene.registry.get<Transform>(read.entity<MediumGrid>()).row1.w, 2.0f);
}

TEST(PbrtMedia, TemperaturesAreHandedOver) {
  const ReadScene read = read_world(
      "MakeNamedMedium \"fire\" \"string type\" \"uniformgrid\" \"float density\" 2 \"float temperature\" 900 "
      "\"float temperatureoffset\" 10 \"float temperaturescale\" 3");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const MediumGrid grid = read.get<MediumGrid>();
  EXPECT_EQ(read.scene.grids[grid.temperature].values[0], 900.0f);
  EXPECT_EQ(grid.temperature_offset, 10.0f);
  EXPECT_EQ(grid.temperature_scale, 3.0f);
}

TEST(PbrtMedia, RgbGridsAreHandedOver) {
  const ReadScene read = read_world(
      "ColorSpace \"rec2020\" MakeNamedMedium \"cloud\" \"string type\" \"rgbgrid\" \"integer nz\" 2 "
      "\"rgb sigma_a\" [ 1 2 3 4 5 6 ] \"rgb Le\" [ 1 1 1 2 2 2 ] \"float Lescale\" 7");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const MediumGrid grid = read.get<MediumGrid>();
  const Grid& sigma_a = read.scene.grids[grid.sigma_a];
  EXPECT_EQ(sigma_a.channels, 3u);
  EXPECT_EQ(sigma_a.color_space, ColorSpace::rec2020);
  EXPECT_EQ(grid_value(sigma_a, {0, 0, 0}), glm::vec3(1, 2, 3));
  EXPECT_EQ(grid_value(sigma_a, {0, 0, 1}), glm::vec3(4, 5, 6));
  EXPECT_EQ(sigma_a.upper, glm::ivec3(1, 1, 2));
  EXPECT_EQ(grid.sigma_s, no_index);
  const Medium medium = read.get<Medium>();
  EXPECT_NEAR(medium.emission_scale * read.scene.spectra.luminance(medium.emission), 7, 1e-3);
}

// A file with a density of 1.5 in 20 voxels along each axis, and a temperature, as pbrt's.
struct NanovdbFile {
  TemporaryFolder folder;
  NanovdbFile() {
    Grid density, temperature;
    density.index_to_local[3] = {1, 2, 3, 1};
    set_dense_values(density, glm::ivec3(20), std::vector<float>(8000, 1.5f));
    set_dense_values(temperature, glm::ivec3(4, 4, 30), std::vector<float>(480, 900.0f));
    const NamedGrid grids[] = {{"density", &density}, {"temperature", &temperature}, {"heat", &temperature}};
    const std::string vdb = (folder.path() / "smoke.vdb").string();
    EXPECT_FALSE(write_vdb(vdb, grids));
    write_nvdb(vdb, (folder.path() / "smoke.nvdb").string(), "float", "zip");
  }
  ReadScene read(const std::string& world) const {
    return read_scene_at(folder.write("scene", "Camera \"perspective\" WorldBegin " + world));
  }
};

TEST(PbrtMedia, NanovdbFilesAreRead) {
  const NanovdbFile file;
  const ReadScene read = file.read(
      "Translate 0 5 0 MakeNamedMedium \"s\" \"string type\" \"nanovdb\" \"string filename\" \"smoke.nvdb\" "
      "\"float Lescale\" 2 \"float temperaturecutoff\" 5 \"float temperaturescale\" 3 \"rgb sigma_a\" [ 2 2 2 ]");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  const MediumGrid medium = read.get<MediumGrid>();
  EXPECT_EQ(grid_value(read.scene.grids[medium.density], {19, 0, 0}).x, 1.5f);
  EXPECT_EQ(grid_value(read.scene.grids[medium.temperature], {0, 0, 29}).x, 900.0f);
  EXPECT_EQ(medium.temperature_offset, 5.0f);
  EXPECT_EQ(medium.temperature_scale, 3.0f);
  EXPECT_EQ(medium.blackbody, BlackbodyUnit::peak);
  EXPECT_EQ(medium.lower, glm::vec3(0, 0, 0)) << "the box of the active voxels of both";
  EXPECT_EQ(medium.upper, glm::vec3(21, 22, 30));
  EXPECT_FLOAT_EQ(read.get<Medium>().emission_scale, 2 / 683.0f);
  EXPECT_NEAR(read.scene.spectra.value(read.get<Medium>().sigma_a, 550), 2, 1e-3);
  EXPECT_EQ(read.scene.registry.get<Transform>(read.entity<MediumGrid>()).row1.w, 5.0f);
}

TEST(PbrtMedia, AGridOfAFileIsReadOnceForAllMedia) {
  const NanovdbFile file;
  const std::string medium = "\"string type\" \"nanovdb\" \"string filename\" \"smoke.nvdb\" ";
  const ReadScene read = file.read("MakeNamedMedium \"a\" " + medium + "Translate 1 0 0 MakeNamedMedium \"b\" " +
                                   medium + "MakeNamedMedium \"c\" " + medium + "\"string temperaturename\" \"heat\"");
  ASSERT_TRUE(read.ok) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.scene.grids.size(), 3u);
  EXPECT_EQ(read.get<MediumGrid>(0).density, read.get<MediumGrid>(1).density);
  EXPECT_EQ(read.get<MediumGrid>(1).density, read.get<MediumGrid>(2).density);
  EXPECT_NE(read.get<MediumGrid>(1).temperature, read.get<MediumGrid>(2).temperature);
}

TEST(PbrtMedia, NanovdbFilesNeedADensityButNoTemperature) {
  const NanovdbFile file;
  const std::string medium = "MakeNamedMedium \"a\" \"string type\" \"nanovdb\" \"string filename\" \"smoke.nvdb\"\n";
  const ReadScene cold = file.read(medium + "\"string temperaturename\" \"t\"");
  ASSERT_TRUE(cold.ok) << format_diagnostics(cold.diagnostics);
  EXPECT_EQ(cold.get<MediumGrid>().temperature, no_index);
  const ReadScene empty = file.read(medium + "\"string densityname\" \"densty\"");
  EXPECT_FALSE(empty.ok);
  EXPECT_THAT(format_diagnostics(empty.diagnostics),
              testing::HasSubstr(
                  ":1: error: '" + (file.folder.path() / "smoke.nvdb").string() +
                  "': there is no grid 'densty' (did you mean 'density'?) in it; there are: 'density', 'heat', "));
}

struct Mistake {
  const char* world;
  const char* expected;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.world; }

class PbrtMediumMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(PbrtMediumMistakes, AreNamedWithTheirLine) {
  const ReadScene read = read_world(GetParam().world);
  EXPECT_FALSE(read.ok);
  EXPECT_THAT(read.messages, testing::ElementsAre(std::string("scene:") + GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Each, PbrtMediumMistakes,
    testing::ValuesIn(std::vector<Mistake>{
        {"MakeNamedMedium \"m\"", "2: error: MakeNamedMedium \"m\": 'string type' is missing"},
        {"MakeNamedMedium \"m\"\n\"string type\" \"homogenous\"",
         "3: error: MakeNamedMedium \"m\": there is no medium of type \"homogenous\" (did you mean 'homogeneous'?)"},
        {"MakeNamedMedium \"m\"\n\"string type\" \"cloud\" \"float wispiness\" 1",
         "3: error: MakeNamedMedium \"m\": media of type \"cloud\" are not supported; a grid of their density would "
         "be"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n\"float g\" 1",
         "3: error: MakeNamedMedium \"m\": 'g' is 1; expected a number between -1 and 1, both excluded"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n\"string preset\" \"Craem\"",
         "3: error: MakeNamedMedium \"m\": there is no preset 'Craem' (did you mean 'Cream'?)"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n\"rgb sigma_a\" [-1 0 0]",
         "3: error: MakeNamedMedium \"m\": 'sigma_a': negative values are not possible"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n\"float sigma_t\" 1",
         "3: error: MakeNamedMedium \"m\" has no parameter 'float sigma_t' (did you mean 'sigma_a'?)"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\nMakeNamedMedium \"m\" \"string type\" "
         "\"homogeneous\"",
         "3: error: medium 'm' is made twice"},
        {"MakeNamedMedium \"gas\" \"string type\" \"homogeneous\"\nMediumInterface \"gaz\" \"\"",
         "3: error: there is no medium 'gaz' (did you mean 'gas'?)"},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\"",
         "2: error: MakeNamedMedium \"m\": 'float density' is missing"},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 3\n\"float density\" [1 2]",
         "3: error: MakeNamedMedium \"m\": 'density' has 2 values; expected nx * ny * nz = 3"},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 2\n\"float density\" [1 -2]",
         "3: error: MakeNamedMedium \"m\": 'density' has negative values"},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1\n\"point3 p1\" [1 0 1]",
         "3: error: MakeNamedMedium \"m\": the box from 'p0' to 'p1' has no volume"},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1 \"float temperature\" 1\n\"rgb "
         "Le\" [1 1 1]",
         "3: error: MakeNamedMedium \"m\": 'Le' and 'temperature' exclude each other"},
        {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\"",
         "2: error: MakeNamedMedium \"m\": 'rgb sigma_a' or 'rgb sigma_s' is missing"},
        {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb sigma_s\" [1 1 1]\n\"rgb Le\" [1 1 1]",
         "3: error: MakeNamedMedium \"m\": 'rgb Le' needs 'rgb sigma_a': what absorbs nothing emits nothing"},
        {"MakeNamedMedium \"m\" \"string type\" \"nanovdb\"",
         "2: error: MakeNamedMedium \"m\": 'string filename' is missing"},
        {"MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"/nowhere.nvdb\"",
         "2: error: cannot read '/nowhere.nvdb': No such file or directory"},
    }));

}  // namespace
}  // namespace metamer
