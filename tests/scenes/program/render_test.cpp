// Rendering from the command line: files, their names, their bytes, and what stands in their way.
#include "engine/files/exr_file.h"
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

using RenderCommand = ProgramTest;

TEST_F(RenderCommand, NamesItsFilesAfterTheSceneAndSaysWhereTheyAre) {
  const ProgramResult result = run({"render", "small.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "EXR   small.exr\nPNG   small.png\n");
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "small.exr", "small.png"));
}

TEST_F(RenderCommand, NamesFilesAfterTheFolderWhereTheSceneIsCalledScene) {
  std::filesystem::create_directory(folder() / "box");
  std::filesystem::copy_file(folder() / "small.json", folder() / "box/scene.json");
  EXPECT_EQ(run({"render", "box/scene.json", "--quiet"}).exit_code, 0);
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "box", "box.exr", "box.png"));
  EXPECT_EQ(run_program({"render", "scene.json", "--quiet"}, folder() / "box").exit_code, 0);
  EXPECT_THAT(names_in(folder() / "box"), UnorderedElementsAre("scene.json", "box.exr", "box.png"));
}

TEST_F(RenderCommand, PutsTheOtherPictureBesideTheOneNamed) {
  std::filesystem::create_directory(folder() / "a");
  EXPECT_EQ(run({"render", "small.json", "-o", "a/x.y.exr", "-q"}).exit_code, 0);
  EXPECT_EQ(run({"render", "small.json", "--png=a/z.PNG", "-q"}).exit_code, 0);
  EXPECT_THAT(names_in(folder() / "a"), UnorderedElementsAre("x.y.exr", "x.y.png", "z.PNG", "z.exr"));
}

TEST_F(RenderCommand, WithoutASceneTakesTheDefaultOne) {
  const ProgramResult result = run({"render", "-q"}, {{"METAMER_DEFAULT_SCENE", "small.json"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "small.exr", "small.png"));
}

TEST_F(RenderCommand, IsSilentWhenQuiet) {
  const ProgramResult result = run({"render", "small.json", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(RenderCommand, ACropHasThePixelsOfTheWhole) {
  std::string cropped(small_scene);
  cropped.replace(cropped.find("\"samples\""), 0, "\"crop\": [0.3, 0.8, 0.25, 1], ");
  folder_.write("crop.json", cropped);
  ASSERT_EQ(run({"render", "small.json", "-q"}).exit_code, 0);
  ASSERT_EQ(run({"render", "crop.json", "-q"}).exit_code, 0);
  Film whole, crop;
  FrameHeader header;
  ASSERT_EQ(read_film((folder() / "small.exr").string(), whole, header), std::nullopt);
  ASSERT_EQ(read_film((folder() / "crop.exr").string(), crop, header), std::nullopt);
  ASSERT_EQ(crop.width(), 13u - 5u);  // 16 pixels: 4.8 to 12.8, rounded up
  ASSERT_EQ(crop.height(), 12u - 3u);
  EXPECT_EQ(header.window.x, 5u);
  EXPECT_EQ(header.window.y, 3u);
  EXPECT_EQ(header.window.full_width, 16u);
  for (size_t y = 0; y < crop.height(); ++y)
    for (size_t x = 0; x < crop.width(); ++x)
      EXPECT_EQ(mean_xyz(crop, y * crop.width() + x), mean_xyz(whole, (y + 3) * whole.width() + x + 5))
          << x << "," << y;
}

TEST_F(RenderCommand, StrictMakesErrorsOfWhatIsNotSupported) {
  const std::string world = "WorldBegin\nLightSource \"infinite\"\n";
  folder_.write("good.pbrt",
                "Camera \"perspective\"\nSampler \"halton\" \"integer pixelsamples\" 1\n"
                "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n" +
                    world);
  folder_.write("bad.pbrt",
                "Camera \"perspective\"\nIntegrator \"function\"\nIntegrator \"bdpt\"\n"
                "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n" +
                    world);
  EXPECT_EQ(run({"render", "good.pbrt", "--strict"}).exit_code, 0);
  EXPECT_EQ(run({"render", "bad.pbrt", "-q", "--spp", "1", "-o", "loose.exr"}).exit_code, 0);
  for (const Arguments& command : std::vector<Arguments>{{"render", "bad.pbrt", "--strict", "-q"},
                                                         {"info", "bad.pbrt", "--strict"},
                                                         {"compare", "bad.pbrt", "--strict"}}) {
    const ProgramResult result = run(command);
    EXPECT_EQ(result.exit_code, 2) << command[0];
    EXPECT_THAT(result.err, AllOf(HasSubstr("bad.pbrt:2: error: Integrator \"function\" is not supported"),
                                  HasSubstr("bad.pbrt:3: error: Integrator \"bdpt\" is not supported")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder() / "bad.exr"));
}

TEST_F(RenderCommand, GivesTheSameBytesForAnyThreadsAndTiles) {
  const Arguments common = {"render", "small.json", "-q", "--size", "70x50", "--spp", "5", "-o", "a.exr"};
  std::set<std::string> exr, png;
  for (const Arguments& more : std::vector<Arguments>{{"--threads", "1", "--tile", "16"},
                                                      {"--threads", "2", "--tile", "16"},
                                                      {"--threads", "1", "--tile", "64"},
                                                      {"--threads", "2", "--tile", "64"},
                                                      {"--threads", "3", "--tile", "1"}}) {
    Arguments arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(run(arguments).exit_code, 0);
    exr.insert(bytes("a.exr"));
    png.insert(bytes("a.png"));
  }
  EXPECT_EQ(exr.size(), 1u);
  EXPECT_EQ(png.size(), 1u);
  EXPECT_GT(exr.begin()->size(), 1000u);
}

TEST_F(RenderCommand, FlagsOverrideTheScene) {
  Film film;
  FrameHeader header;
  ASSERT_EQ(
      run({"render", "small.json", "-q", "--size", "20x10", "--spp", "7", "--seed", "9", "--max-depth", "2"}).exit_code,
      0);
  ASSERT_EQ(read_film((folder() / "small.exr").string(), film, header), std::nullopt);
  EXPECT_EQ(film.width(), 20u);
  EXPECT_EQ(film.height(), 10u);
  EXPECT_EQ(sample_totals(film).fewest, 7u);
  EXPECT_EQ(sample_totals(film).most, 7u);
  EXPECT_EQ(header.seed, 9u);
  EXPECT_THAT(header.settings, testing::Contains(testing::Pair("max_depth", "2")));
  EXPECT_THAT(header.settings, testing::Contains(testing::Pair("color", "spectral")));
  ASSERT_EQ(run({"render", "small.json", "-q", "--color", "lamps"}).exit_code, 0);
  ASSERT_EQ(read_film((folder() / "small.exr").string(), film, header), std::nullopt);
  EXPECT_THAT(header.settings, testing::Contains(testing::Pair("color", "lamps")));
}

TEST_F(RenderCommand, SeedsDepthsAndExposuresMakeADifferenceWhereTheyShould) {
  const auto pixels = [&](const Arguments& more) {
    Arguments arguments = {"render", "small.json", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    Film film;
    FrameHeader header;
    EXPECT_EQ(read_film((folder() / "small.exr").string(), film, header), std::nullopt);
    return std::pair(std::move(film), bytes("small.png"));
  };
  const auto plain = pixels({}), seed = pixels({"--seed", "2"}), depth = pixels({"--max-depth", "0"}),
             bright = pixels({"--exposure", "+2"});
  EXPECT_FALSE(plain.first == seed.first);
  EXPECT_FALSE(plain.first == depth.first);
  EXPECT_TRUE(plain.first == bright.first);
  EXPECT_NE(plain.second, bright.second);
}

// What the scene says of the integrator and of shadows, and what the flags say, are in the file and in the picture.
TEST_F(RenderCommand, TheIntegratorIsTheFlagsElseTheScenes) {
  folder_.write("room.json", R"({
    "metamer": 1,
    "settings": {"size": [12, 8], "samples": 2, "integrator": "recursive"},
    "entities": [
      {"transform": {"look_at": {"from": [0, 1, 3], "to": [0, 0, 0]}}, "camera": {"type": "perspective"}},
      {"transform": {"rotate": {"axis": [1, 0, 0], "degrees": -90}}, "geometry": {"type": "rectangle", "width": 9, "depth": 9}},
      {"transform": {"translate": [0, 0.5, 0]}, "geometry": {"type": "sphere", "radius": 0.5},
       "material": {"type": "dielectric", "eta": 1.5}},
      {"transform": {"translate": [0, 2, 0]}, "light": {"type": "point", "intensity": 1}}
    ]})");
  struct Rendered {
    Film film;
    std::string integrator, shadows;
  };
  const auto render = [&](const Arguments& more) {
    Arguments arguments = {"render", "room.json", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    Rendered result;
    FrameHeader header;
    EXPECT_EQ(read_film((folder() / "room.exr").string(), result.film, header), std::nullopt);
    for (const auto& [name, value] : header.settings) {
      if (name == "integrator") result.integrator = value;
      if (name == "shadows") result.shadows = value;
    }
    return result;
  };
  const Rendered scene = render({}), same = render({"--integrator", "recursive"}),
                 local = render({"--integrator", "local"}), path = render({"--integrator", "PATH"}),
                 lit = render({"--no-shadows"});
  EXPECT_EQ(scene.integrator, "recursive");
  EXPECT_EQ(scene.shadows, "true");
  EXPECT_TRUE(scene.film == same.film);
  EXPECT_EQ(local.integrator, "local");
  EXPECT_FALSE(scene.film == local.film);
  EXPECT_EQ(path.integrator, "path");
  EXPECT_FALSE(scene.film == path.film);
  EXPECT_EQ(lit.shadows, "false");
  EXPECT_FALSE(scene.film == lit.film);
}

TEST_F(RenderCommand, PreviewOnlyLeavesTheFilmOut) {
  ASSERT_EQ(run({"render", "small.json", "-q", "--preview-only"}).exit_code, 0);
  Film film;
  FrameHeader header;
  EXPECT_NE(read_film((folder() / "small.exr").string(), film, header), std::nullopt);
}

TEST_F(RenderCommand, FindsOutputsThatCannotBeWrittenBeforeRendering) {
  std::filesystem::create_directory(folder() / "folder.exr");
  struct Case {
    Arguments arguments;
    int code;
    std::string words;
  };
  // The frame would take hours: what is said is said before.
  for (const Case& c : std::vector<Case>{{{"-o", "no/such/a.exr"}, 1, "no/such/a.exr: "},
                                         {{"--png", "no/such/a.png"}, 1, "no/such/a.png: "},
                                         {{"--stats", "no/such/a.json"}, 1, "no/such/a.json: "},
                                         {{"-o", "/proc/a.exr"}, 1, "/proc/a.exr: "},
                                         {{"-o", "folder.exr"}, 1, "is a folder"},
                                         {{"-o", "small.json/a.exr"}, 1, "small.json/a.exr: "},
                                         {{"-o", "a.jpg"}, 2, "'.jpg' is an unknown kind of picture"},
                                         {{"-o", "a"}, 2, "no ending"},
                                         {{"-o", "a.png"}, 2, "an .exr file was expected"},
                                         {{"--png", "a.exr"}, 2, "a .png file was expected"},
                                         {{"--stats", "small.json"}, 2, "is the scene itself"},
                                         {{"--stats", "./small.png"}, 2, "named for two outputs"}}) {
    Arguments arguments = {"render", "small.json", "--spp", "4000000", "--size", "512x512"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, c.code) << c.words;
    EXPECT_THAT(result.err, HasSubstr(c.words));
  }
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "folder.exr"));
  EXPECT_THAT(names_in(folder() / "folder.exr"), ElementsAre());
  EXPECT_EQ(bytes("small.json"), small_scene);
}

TEST_F(RenderCommand, RefusesScenesThatAreWrongWithExit2) {
  folder_.write("broken.json", "{\n  \"metamer\": 1,\n  \"entitys\": [],\n  \"settings\": {\"samples\": -1}\n}\n");
  folder_.write("scene.txt", "hello");
  const ProgramResult missing = run({"render", "none.json"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.json"));
  const ProgramResult broken = run({"render", "broken.json", "--quiet"});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.err, AllOf(HasSubstr("broken.json:3: error: "), HasSubstr("broken.json:4: error: ")));
  EXPECT_EQ(run({"render", "scene.txt"}).exit_code, 2);
  EXPECT_EQ(run({"render", "."}).exit_code, 2);
  EXPECT_EQ(run({"info", "none.json"}).exit_code, 2);
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "broken.json", "scene.txt"));
}

TEST_F(RenderCommand, RefusesAFrameOfTheSceneThatDoesNotFitInMemory) {
  std::string huge(small_scene);
  huge.replace(huge.find("[16, 12]"), 8, "[1000000, 1000000]");
  folder_.write("huge.json", huge);
  const ProgramResult result = run({"render", "huge.json"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("huge.json"));
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "huge.json"));
}

TEST_F(RenderCommand, SaysSoWhenMemoryRunsOut) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than the limit leaves";
#endif
  const std::string command = "cd '" + folder().string() + "' && ulimit -v 1500000 && '" + METAMER_PROGRAM +
                              "' render small.json --threads 1 --size 2800x2800 2> err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1) << bytes("err");
  EXPECT_THAT(bytes("err"), HasSubstr("metamer: error: out of memory"));
  EXPECT_THAT(names_in(folder()), UnorderedElementsAre("small.json", "err"));
}

TEST_F(RenderCommand, WritesThePictureAloneWhereStandardStreamsAreClosed) {
  ASSERT_EQ(run({"render", "small.json", "-q", "-o", "a.exr"}).exit_code, 0);
  const std::string command =
      "cd '" + folder().string() + "' && '" + METAMER_PROGRAM + "' render small.json -o b.exr <&- >&- 2>&-";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
  EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
}

TEST_F(RenderCommand, WarnsUnlessQuiet) {
  std::string scene(small_scene);
  scene.insert(scene.find("\"entities\": [") + 13, R"({"geometry": {"type": "mesh", "mesh": "flat"}},)");
  scene.insert(
      scene.find("\"entities\""),
      R"("meshes": {"flat": {"positions": [[0,0,0],[1,0,0],[2,0,0],[0,1,0]], "indices": [[0,1,2],[0,1,3]]}},)");
  folder_.write("warn.json", scene);
  const ProgramResult loud = run({"render", "warn.json"});
  EXPECT_EQ(loud.exit_code, 0) << loud.err;
  EXPECT_THAT(loud.err, AllOf(HasSubstr("warn.json"), HasSubstr("warning: ")));
  EXPECT_EQ(run({"render", "warn.json", "--quiet"}).err, "");
}

}  // namespace
}  // namespace metamer
