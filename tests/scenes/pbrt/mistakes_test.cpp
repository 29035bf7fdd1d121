// Every message about a mistake, with its line.
#include "tests/scenes/pbrt/read_text.h"

namespace metamer {
namespace {

struct Mistake {
  const char* world;     // from line 2 on
  const char* expected;  // the first message, without the file's name
};

// Where gtest would print addresses.
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.world; }

class PbrtMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(PbrtMistakes, AreNamedWithTheirLine) {
  const ReadScene read = read_world(GetParam().world);
  EXPECT_FALSE(read.ok);
  ASSERT_FALSE(read.messages.empty());
  EXPECT_EQ(read.messages[0], std::string("scene:") + GetParam().expected);
  EXPECT_EQ(read.messages.size(), 1u) << format_diagnostics(read.diagnostics);
}

INSTANTIATE_TEST_SUITE_P(Words, PbrtMistakes,
                         testing::ValuesIn(std::vector<Mistake>{
                             {"\nShappe \"sphere\" \"float radius\" 1",
                              "3: error: expected a directive, not 'Shappe' (did you mean 'Shape'?)"},
                             {"Shape \"sphere\" radius 1", "2: error: expected a directive, not 'radius'"},
                             {"] Shape \"sphere\"", "2: error: expected a directive, not ']'"},
                             {"Shape sphere", "2: error: Shape expects a quoted name, not 'sphere'"},
                             {"Shape", "2: error: Shape expects a quoted name, not the end of the file"},
                             {"Shape \"sphere\n", "2: error: the string is not closed by '\"' on its line"},
                             {"CoordinateSystem \"a\\qb\"",
                              "2: error: unknown escape in a string; known are \\b \\f \\n \\r \\t \\\\ \\' \\\""},
                         }));

INSTANTIATE_TEST_SUITE_P(
    Parameters, PbrtMistakes,
    testing::ValuesIn(std::vector<Mistake>{
        {"Shape \"sphere\"\n\"float raduis\" 2",
         "3: error: Shape \"sphere\" has no parameter 'float raduis' (did you mean 'radius'?)"},
        {"Shape \"sphere\" \"integer radius\" 2",
         "2: error: Shape \"sphere\": 'integer radius' should be 'float radius'"},
        {"Shape \"sphere\" \"flot radius\" 2", "2: error: unknown parameter type 'flot' (did you mean 'float'?)"},
        {"Shape \"trianglemesh\" \"point P\" [0 0 0]",
         "2: error: unknown parameter type 'point' (did you mean 'point3'?)"},
        {"Shape \"sphere\" \"radius\" 2", "2: error: \"radius\" should be \"type name\", as in \"float radius\""},
        {"Shape \"sphere\" \"float radius\"\nShape \"sphere\"", "2: error: 'radius' has no value"},
        {"Shape \"sphere\" \"float radius\" []", "2: error: 'radius' has no value"},
        {"Shape \"sphere\" \"float radius\"\n[ 2\nShape \"sphere\"", "3: error: the '[' of 'radius' is never closed"},
        {"Shape \"sphere\" \"float radius\" \"big\"", "2: error: 'float radius' expects numbers, not \"big\""},
        {"Shape \"sphere\" \"float radius\" true", "2: error: 'true' is not a finite number"},
        {"Shape \"sphere\" \"float radius\" [\n1e999]", "3: error: '1e999' is not a finite number"},
        {"Shape \"sphere\" \"float radius\" NaN", "2: error: 'NaN' is not a finite number"},
        {"Shape \"sphere\" \"float radius\" nan", "2: error: 'nan' is not a finite number"},
        {"Shape \"sphere\" \"float radius\" 1e39", "2: error: '1e39' is too large"},
        {"Shape \"sphere\" \"float radius\" 1.5x", "2: error: '1.5x' is not a finite number"},
        {"Shape \"sphere\" \"float radius\" [1 2]", "2: error: Shape \"sphere\": 'radius' expects one number, not 2"},
        {"Shape \"sphere\" \"float radius\" 0", "2: error: Shape \"sphere\": 'radius' is 0, but must be positive"},
        {"Shape \"sphere\" \"float radius\" 1e-60",
         "2: error: Shape \"sphere\": 'radius' is 1e-60, but must be positive"},
        {"AreaLightSource \"diffuse\" \"bool twosided\" [True]",
         "2: error: 'bool twosided' expects true or false, not 'True'"},
        {"AreaLightSource \"diffuse\" \"bool twosided\" [true true]",
         "2: error: AreaLightSource \"diffuse\": 'twosided' expects one of true and false, not 2 values"},
        {"Shape \"plymesh\" \"string filename\" [\"a\" \"b\"]",
         "2: error: Shape \"plymesh\": 'filename' expects one string, not 2"},
        {"LightSource \"point\" \"point3 from\" [1 2]",
         "2: error: LightSource \"point\": 'from' expects three numbers, not 2"},
        {"LightSource \"point\" \"spectrum I\" [400 \"x\"]", "2: error: 'I' mixes numbers and strings"},
        {"Attribute \"shapes\" \"float radius\" 1",
         "2: error: Attribute expects shape, light, material, medium or texture, not \"shapes\" (did you mean "
         "'shape'?)"},
    }));

INSTANTIATE_TEST_SUITE_P(
    State, PbrtMistakes,
    testing::ValuesIn(std::vector<Mistake>{
        {"Translate 1 2", "2: error: Translate expects 3 numbers, but after 2 comes the end of the file"},
        {"Translate 1 x 2", "2: error: Translate expects numbers, not 'x'"},
        {"Transform [1 0 0 0]", "2: error: Transform expects 16 numbers and ']', but after 4 comes ']'"},
        {"\nScale 1 0 1", "3: error: this transformation is singular: it flattens space"},
        {"Scale 1e30 1e30 1e30 Scale 1e30 1 1", "2: error: this transformation is too large for single precision"},
        {"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]",
         "2: error: this transformation is not affine: its last row is not 0 0 0 1"},
        {"Rotate 30 0 0 0", "2: error: this transformation is undefined: its axis is zero"},
        {"LookAt 0 0 0 0 5 0 0 1 0",
         "2: error: this transformation is undefined: eye and target coincide, or the up vector points along the view"},
        {"CoordSysTransform \"camara\"", "2: error: there is no coordinate system 'camara' (did you mean 'camera'?)"},
        {"TransformTimes 0 1", "2: error: TransformTimes must stand before WorldBegin"},
        {"ActiveTransform EndTime Scale 0 1 1", "2: error: this transformation is singular: it flattens space"},
        {"ActiveTransform Both", "2: error: ActiveTransform expects All, StartTime or EndTime, not 'Both'"},
        {"\n\nAttributeBegin", "4: error: this AttributeBegin is never ended"},
        {"AttributeEnd", "2: error: AttributeEnd without AttributeBegin"},
        {"ObjectBegin \"a\" AttributeEnd\nObjectEnd", "2: error: AttributeEnd without AttributeBegin"},
        {"ObjectEnd", "2: error: ObjectEnd without ObjectBegin"},
        {"ObjectBegin \"a\"\nObjectBegin \"b\" ObjectEnd ObjectEnd", "3: error: ObjectBegin inside ObjectBegin"},
        {"ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd", "3: error: object 'a' is defined twice"},
        {"ObjectBegin \"a\"\nObjectInstance \"a\" ObjectEnd", "3: error: ObjectInstance inside ObjectBegin"},
        {"ObjectBegin \"chair\" ObjectEnd\nObjectInstance \"chai\"",
         "3: error: there is no object 'chai' (did you mean 'chair'?)"},
        {"ObjectBegin \"a\" Scale 1e30 1e30 1e30 Shape \"sphere\" ObjectEnd\nScale 1e30 1e30 1e30 ObjectInstance \"a\"",
         "3: error: the transformation of this instance is too large for single precision"},
        {"ColorSpace \"rgb\"", "2: error: there is no colour space 'rgb' (did you mean 'srgb'?)"},
        {"\nFilm \"rgb\"", "3: error: Film must stand before WorldBegin"},
        {"Option \"seed\" 1", "2: error: Option must stand before WorldBegin"},
    }));

INSTANTIATE_TEST_SUITE_P(
    Things, PbrtMistakes,
    testing::ValuesIn(std::vector<Mistake>{
        {"Shape \"spere\" \"float radius\" 1", "2: error: there is no shape \"spere\" (did you mean 'sphere'?)"},
        {"Shape \"sphere\" \"float zmin\" 1",
         "2: error: Shape \"sphere\": 'zmin' 1 and 'zmax' 1 leave nothing of the shape"},
        {"Shape \"disk\" \"float phimax\" -90", "2: error: Shape \"disk\": 'phimax' is -90, but must be positive"},
        {"Shape \"disk\" \"float innerradius\" 2", "2: error: Shape \"disk\": 'innerradius' 2 is not below 'radius' 1"},
        {"Shape \"trianglemesh\"", "2: error: Shape \"trianglemesh\": 'P', the positions, is missing"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 1]",
         "2: error: Shape \"trianglemesh\": 'P' has 5 numbers, which is not a multiple of 3"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0]",
         "2: error: Shape \"trianglemesh\": 'indices' is missing, and there are 4 vertices instead of 3"},
        {"Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n\"integer indices\" [0 1 2 -3]",
         "3: error: Shape \"bilinearmesh\": index -3 is out of range: there are 4 vertices"},
        {"Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2]",
         "2: error: Shape \"bilinearmesh\": 3 indices are not a multiple of 4"},
        {"Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"normal N\" [0 0 1]",
         "2: error: Shape \"bilinearmesh\": there must be one normal and one uv per vertex, or none"},
        {"Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"" METAMER_SOURCE_DIR
         "/docs/pictures/prism.png\"\n\"float maxanisotropy\" 0",
         "3: error: Texture \"imagemap\": 'maxanisotropy' must be at least 1"},
        {"Shape \"plymesh\"", "2: error: Shape \"plymesh\": 'filename' is missing"},
        {"Material \"difuse\" \"float x\" 1", "2: error: there is no material \"difuse\" (did you mean 'diffuse'?)"},
        {"Material \"diffuse\" \"rgb reflectance\" [.5 -.1 0]",
         "2: error: Material \"diffuse\": 'reflectance': negative values are not possible"},
        {"Material \"diffuse\" \"rgb reflectance\" [.5 .1]",
         "2: error: Material \"diffuse\": 'reflectance': an rgb value has three numbers, not 2"},
        {"Material \"diffuse\" \"float reflectance\" .5",
         "2: error: Material \"diffuse\": 'float reflectance' should be 'rgb reflectance' or 'spectrum reflectance' or "
         "'blackbody reflectance' or 'texture reflectance'"},
        {"Material \"diffuse\" \"spectrum reflectance\" [400 .1 500]",
         "2: error: Material \"diffuse\": 'reflectance': 3 numbers are not pairs of wavelength and value"},
        {"Material \"diffuse\" \"spectrum reflectance\" [500 .1 400 .2]",
         "2: error: Material \"diffuse\": 'reflectance': wavelengths must ascend, but 400 nm follows 500 nm"},
        {"Material \"diffuse\" \"spectrum reflectance\" [400 -.1 500 .2]",
         "2: error: Material \"diffuse\": 'reflectance': negative values are not possible"},
        {"Material \"diffuse\" \"texture reflectance\" \"wood\"",
         "2: error: Material \"diffuse\": there is no texture 'wood'"},
        {"Material \"conductor\" \"spectrum eta\" \"metal-Agg-eta\"",
         "2: error: Material \"conductor\": 'eta': the spectrum 'metal-Agg-eta' is unknown or not supported yet (did "
         "you mean 'metal-Ag-eta'?)"},
        {"Material \"conductor\" \"spectrum eta\" [\"metal-Ag-eta\" \"metal-Ag-k\"]",
         "2: error: Material \"conductor\": 'eta': expects one name, not 2"},
        {"Material \"conductor\" \"rgb reflectance\" [.5 .5 .5]\n\"rgb k\" [1 1 1]",
         "2: error: Material \"conductor\": 'reflectance' and 'eta' or 'k' exclude each other"},
        {"Material \"conductor\" \"float roughness\" -1",
         "2: error: Material \"conductor\": roughness must not be negative"},
        {"Material \"dielectric\" \"float eta\" 0",
         "2: error: Material \"dielectric\": an index of refraction must be positive"},
        {"Material \"dielectric\" \"float eta\" [1 2]", "2: error: Material \"dielectric\": 'eta': expects one number"},
        {"MakeNamedMaterial \"a\"", "2: error: MakeNamedMaterial \"a\": 'string type' is missing"},
        {"MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
         "3: error: material 'a' is made twice"},
        {"MakeNamedMaterial \"blue\" \"string type\" \"diffuse\"\nNamedMaterial \"blu\"",
         "3: error: there is no material 'blu' (did you mean 'blue'?)"},
        {"Texture \"a\" \"colour\" \"constant\"", "2: error: a texture is \"spectrum\" or \"float\", not \"colour\""},
        {"Texture \"a\" \"float\" \"marbel\"", "2: error: there is no texture \"marbel\" (did you mean 'marble'?)"},
        {"LightSource \"pont\"", "2: error: there is no light source \"pont\" (did you mean 'point'?)"},
        {"LightSource \"point\" \"rgb I\" [-1 0 0]",
         "2: error: LightSource \"point\": 'I': negative values are not possible"},
        {"LightSource \"point\" \"blackbody I\" 0",
         "2: error: LightSource \"point\": 'I': a blackbody has one temperature in kelvin above 0"},
        {"LightSource \"point\" \"spectrum I\" [300 0 900 0]",
         "2: error: LightSource \"point\": 'I' has no luminance, by which pbrt divides it"},
        {"LightSource \"point\" \"float scale\" -2",
         "2: error: LightSource \"point\": 'scale' is -2, but must be at least 0"},
        {"LightSource \"point\" \"float scale\" 1e38 \"float power\" 1e30",
         "2: error: LightSource \"point\": the light is scaled by 1.10259e+60, which is too large"},
        {"LightSource \"distant\" \"point3 to\" [0 0 0]",
         "2: error: LightSource \"distant\": 'from' and 'to' coincide"},
        {"Scale 1e30 1e30 1e30\nLightSource \"point\"\n\"point3 from\" [1e30 0 0]",
         "4: error: LightSource \"point\": the light's transformation is too large for single precision"},
        {"AreaLightSource \"defuse\"", "2: error: there is no area light source \"defuse\" (did you mean 'diffuse'?)"},
    }));

class PbrtSettingMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(PbrtSettingMistakes, AreNamedWithTheirLine) {
  const ReadScene read = read_text(std::string(GetParam().world) + "\nWorldBegin\n");
  EXPECT_FALSE(read.ok);
  std::vector<std::string> errors;
  for (const std::string& message : read.messages) {
    if (message.find(": error: ") != std::string::npos) errors.push_back(message);
  }
  EXPECT_THAT(errors, testing::ElementsAre(std::string("scene:") + GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Options, PbrtSettingMistakes,
    testing::ValuesIn(std::vector<Mistake>{
        {"Camera \"perspective\" \"float fov\" 180",
         "1: error: Camera \"perspective\": 'fov' is 180, but must be below 180 degrees"},
        {"Camera \"perspective\" \"float screenwindow\" [1 -1 0 1]",
         "1: error: Camera \"perspective\": 'screenwindow' expects x_min x_max y_min y_max, each minimum below its "
         "maximum"},
        {"Camera \"perspective\" \"float shutterclose\" 0",
         "1: error: Camera \"perspective\": the shutter closes at 0 s but opens at 0 s"},
        {"Camera \"perspective\"\nCamera \"perspective\"", "2: error: there is more than one Camera"},
        {"Scale 1e-39 1e-39 1e-39\nCamera \"perspective\"",
         "2: error: the inverse of the camera's transformation is too large for single precision"},
        {"Camera \"perspective\" \"float lensradius\" -1",
         "1: error: Camera \"perspective\": 'lensradius' is -1, but must be at least 0"},
        {"Film \"rgb\" \"integer xresolution\" 0",
         "1: error: Film \"rgb\": 'xresolution' is 0, but must be at least 1"},
        {"Film \"rgb\" \"integer xresolution\" 12.5", "1: error: '12.5' is not a 32-bit integer"},
        {"Film \"rgb\" \"integer xresolution\" 5000000000", "1: error: '5000000000' is not a 32-bit integer"},
        {"Film \"rgb\" \"integer xresolution\" [1 2]",
         "1: error: Film \"rgb\": 'xresolution' expects one integer, not 2"},
        {"Sampler \"sobel\"", "1: error: there is no Sampler \"sobel\" (did you mean 'sobol'?)"},
        {"Sampler \"stratified\" \"integer xsamples\" 100000 \"integer ysamples\" 100000",
         "1: error: Sampler \"stratified\": 10000000000 samples are too many"},
        {"Integrator \"pth\"", "1: error: there is no Integrator \"pth\" (did you mean 'path'?)"},
        {"Integrator \"path\" \"integer maxdepth\" -1",
         "1: error: Integrator \"path\": 'maxdepth' is -1, but must be at least 0"},
        {"Option \"seed\" -1", "1: error: Option \"seed\" expects a non-negative integer, not '-1'"},
        {"Option \"seed\"", "1: error: Option \"seed\" has no value"},
        {"TransformTimes 1 1", "1: error: the motion ends at 1 s but starts at 1 s"},
        {"Camera \"sphrical\"", "1: error: there is no Camera \"sphrical\" (did you mean 'spherical'?)"},
        {"Camera \"spherical\" \"string mapping\" \"equirect\"",
         "1: error: Camera \"spherical\": there is no mapping \"equirect\""},
        {"Option \"seed\" 1.5", "1: error: Option \"seed\" expects a non-negative integer, not '1.5'"},
        {"Option \"disablepixeljitter\" 1", "1: error: Option \"disablepixeljitter\" expects true or false, not '1'"},
        {"Option \"msereferenceimage\" a", "1: error: Option \"msereferenceimage\" expects a quoted string, not 'a'"},
        {"Option \"displacementedgescale\" \"1\"",
         "1: error: Option \"displacementedgescale\" expects a number, not \"1\""},
        {"Option \"force\" true", "1: error: there is no Option \"force\""},
        {"Option \"sed\" 1", "1: error: there is no Option \"sed\" (did you mean 'seed'?)"},
        {"Film \"rbg\"", "1: error: there is no Film \"rbg\" (did you mean 'rgb'?)"},
        {"Film \"rgb\" \"string sensor\" \"canon_eos_5\"",
         "1: error: Film \"rgb\": there is no sensor \"canon_eos_5\" (did you mean 'canon_eos_5d'?)"},
        {"Film \"rgb\" \"float cropwindow\" [0 1.5 0 1]",
         "1: error: Film \"rgb\": 'cropwindow' expects x_min x_max y_min y_max, each minimum below its maximum, from 0 "
         "up to 1 and 1"},
        {"Film \"rgb\" \"integer pixelbounds\" [4 4 0 1]",
         "1: error: Film \"rgb\": 'pixelbounds' expects x_min x_max y_min y_max, each minimum below its maximum, from "
         "0 "
         "up to 1280 and 720"},
        {"PixelFilter \"gausian\"", "1: error: there is no PixelFilter \"gausian\" (did you mean 'gaussian'?)"},
        {"Shape \"sphere\"", "1: error: Shape must stand after WorldBegin"},
    }));

TEST(PbrtMistakesInOneGo, AllOfAFileAreReportedAndWhatIsRightIsKept) {
  const ReadScene read = read_world(R"(Shape "sphere" "float raduis" 1
Scale 0 0 0
Bogus 1 2 [ 3 ] "x"
Shape "sphere" "float radius" [ 2 "x" ]
Shape "sphere" "float radius" 3)");
  EXPECT_EQ(read.diagnostics.error_count(), 4u) << format_diagnostics(read.diagnostics);
  EXPECT_EQ(read.get<Geometry>(2).radius, 3.0f);
}

TEST(PbrtMistakesInOneGo, AMeshOutOfRangeIsNamedAtItsShape) {
  const ReadScene read =
      read_world("\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0]\n\"integer indices\" [0 1 9]");
  ASSERT_EQ(read.messages.size(), 1u);
  EXPECT_THAT(read.messages[0], testing::StartsWith("scene:3: error: "));
  EXPECT_EQ(read.count<Geometry>(), 0u);
}

TEST(PbrtMistakesInOneGo, AParameterGivenTwiceIsRemarkedOn) {
  const ReadScene read = read_world("Shape \"sphere\" \"float radius\" 1\n\"float radius\" 2");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages, testing::ElementsAre("scene:3: warning: 'radius' is given twice; the first one counts"));
  EXPECT_EQ(read.get<Geometry>().radius, 1.0f);
}

TEST(PbrtMistakesInOneGo, WithoutWorldBeginNothingIsRendered) {
  const ReadScene read = read_text("Camera \"perspective\"");
  EXPECT_FALSE(read.ok);
  EXPECT_THAT(read.messages,
              testing::ElementsAre("scene: error: there is no WorldBegin, so there is nothing to render"));
}

TEST(PbrtMistakesInOneGo, TooManyAttributesAreAnErrorAsBlocksCopyThem) {
  std::string world;
  for (int i = 0; i < 300; ++i)
    world.append("Attribute \"shape\" \"float p").append(std::to_string(i)).append("\" 1\n");
  const ReadScene read = read_world(world);
  EXPECT_EQ(read.diagnostics.error_count(), 300u - 256u);
  EXPECT_EQ(read.messages[0], "scene:258: error: more than 256 attributes are set");
}

TEST(PbrtMistakesInOneGo, Version3sBlocksAreExplained) {
  const ReadScene read = read_world("TransformBegin Translate 1 0 0 TransformEnd\nWorldEnd");
  EXPECT_TRUE(read.ok);
  EXPECT_THAT(read.messages,
              testing::ElementsAre("scene:2: warning: TransformBegin is deprecated; it means AttributeBegin",
                                   "scene:3: warning: WorldEnd is of pbrt-v3 and means nothing any more"));
}

}  // namespace
}  // namespace metamer
