// metamer convert as its users see it.
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using ConvertCommand = ProgramTest;

TEST_F(ConvertCommand, WritesAndTellsWhereAndRenderingGivesTheSameFilm) {
  folder_.write("box.pbrt", R"(Film "rgb" "integer xresolution" 12 "integer yresolution" 9
    Sampler "sobol" "integer pixelsamples" 4 LookAt 0 0 5 0 0 0 0 1 0 Camera "perspective" WorldBegin
    LightSource "infinite" "rgb L" [0.3 0.4 0.5]
    Material "diffuse" "rgb reflectance" [0.6 0.2 0.1]
    Shape "trianglemesh" "point3 P" [-1 -1 0 1 -1 0 0 1 0.5] "integer indices" [0 1 2])");
  const ProgramResult result = run({"convert", "box.pbrt", "out.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("JSON  out.json\nfiles out-files: 1 mesh, 0 images, "));
  EXPECT_THAT(names_in(folder()), ElementsAre("box.pbrt", "out-files", "out.json", "small.json"));
  EXPECT_EQ(run({"render", "box.pbrt", "-q", "-o", "a.exr"}).exit_code, 0);
  EXPECT_EQ(run({"render", "out.json", "-q", "-o", "b.exr"}).exit_code, 0);
  EXPECT_TRUE(bytes("a.png") == bytes("b.png"));
  EXPECT_THAT(run({"compare", "a.exr", "b.exr", "-q"}).out, HasSubstr("max 0.000"));
}

TEST_F(ConvertCommand, RefusesWhatItCannotDoAndLeavesNothing) {
  EXPECT_THAT(run({"convert"}).err, HasSubstr("a scene and the file to write were expected, not nothing"));
  EXPECT_THAT(run({"convert", "small.json"}).err, HasSubstr("not 1 name: metamer convert SCENE OUT.json"));
  EXPECT_EQ(run({"convert", "small.json", "a.json", "b.json"}).exit_code, 2);
  EXPECT_THAT(run({"convert", "small.json", "out.pbrt"}).err, HasSubstr("out.pbrt: expected a name ending in .json"));
  EXPECT_THAT(run({"convert", "small.json", "./small.json"}).err, HasSubstr("is the scene itself"));
  EXPECT_EQ(run({"convert", "none.json", "out.json"}).exit_code, 2);
  const ProgramResult no_folder = run({"convert", "small.json", "none/out.json"});
  EXPECT_EQ(no_folder.exit_code, 1);
  EXPECT_THAT(no_folder.err, HasSubstr("none/out.json: the folder 'none' cannot be used"));
  folder_.write("out-files", "in the way");
  EXPECT_THAT(run({"convert", "small.json", "out.json"}).err, HasSubstr("out-files: is no folder"));
  EXPECT_THAT(names_in(folder()), ElementsAre("out-files", "small.json"));
}

TEST_F(ConvertCommand, ReplacesWhatExists) {
  folder_.write("out.json", "old");
  EXPECT_EQ(run({"convert", "small.json", "out.json", "-q"}).out, "");
  EXPECT_THAT(bytes("out.json"), HasSubstr("\"metamer\": 1"));
}

}  // namespace
}  // namespace metamer
