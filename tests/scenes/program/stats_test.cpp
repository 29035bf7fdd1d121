// The numbers a render reports, and what `info` says about a scene.
#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::HasSubstr;

using Reports = ProgramTest;

TEST_F(Reports, StatsHoldEveryDocumentedNumber) {
  ASSERT_EQ(run({"render", "small.json", "--stats", "s.json", "-q", "--threads", "2", "--size", "64x48", "--spp", "64"})
                .exit_code,
            0);
  const Json::Value stats = parse_json(bytes("s.json"));
  for (const char* name : {"cpu_seconds", "load_seconds", "build_seconds", "render_seconds", "embree_seconds",
                           "embree_share", "first_ray_seconds", "first_pixel_seconds", "peak_rss_bytes", "lane_fill",
                           "batch_bytes", "film_bytes", "world_bytes"}) {
    ASSERT_TRUE(stats[name].isNumeric()) << name;
    EXPECT_GT(stats[name].asDouble(), 0) << name;
  }
  EXPECT_EQ(stats["samples"].asUInt64(), 64u * 48 * 64);
  EXPECT_GE(stats["rays"]["camera"].asUInt64(), stats["samples"].asUInt64());
  EXPECT_GT(stats["rays"]["bounce"].asUInt64(), 0u);
  EXPECT_GT(stats["rays"]["shadow"].asUInt64(), 0u);
  EXPECT_EQ(stats["invalid_samples"].asUInt64(), 0u);
  EXPECT_EQ(stats["threads"].asUInt(), 2u);
  EXPECT_EQ(stats["interrupted"].asBool(), false);
  EXPECT_LE(stats["lane_fill"].asDouble(), 1);
  EXPECT_LE(stats["embree_share"].asDouble(), 1);
  EXPECT_NEAR(stats["embree_share"].asDouble(), stats["embree_seconds"].asDouble() / stats["cpu_seconds"].asDouble(),
              1e-6);
  EXPECT_GT(stats["first_pixel_seconds"].asDouble(), stats["first_ray_seconds"].asDouble());
  EXPECT_GT(stats["first_ray_seconds"].asDouble(),
            stats["load_seconds"].asDouble() + stats["build_seconds"].asDouble());
  for (const char* name : {"camera_rays", "intersect", "surface", "shadow", "accumulate"})
    EXPECT_GT(stats["systems"][name].asDouble(), 0) << name;
  EXPECT_EQ(stats["version"].asString() + "\n",
            run({"--version"}).out.substr(8, stats["version"].asString().size() + 1));
}

TEST_F(Reports, InfoCountsWhatIsInTheScene) {
  const ProgramResult table = run({"info", "small.json"});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  for (const char* words : {"16x12, 4 samples per pixel", "entities    5", "1 sphere, 2 rectangle", "2 diffuse",
                            "1 area, 1 environment", "1 Camera", "memory"})
    EXPECT_THAT(table.out, HasSubstr(words));

  const ProgramResult result = run({"info", "small.json", "--json"});
  EXPECT_EQ(result.exit_code, 0);
  const Json::Value info = parse_json(result.out);
  EXPECT_EQ(info["entities"].asUInt(), 5u);
  EXPECT_EQ(info["triangles"].asUInt(), 4u);
  EXPECT_EQ(info["materials"]["diffuse"].asUInt(), 2u);
  EXPECT_EQ(info["materials"]["dielectric"].asUInt(), 0u);
  EXPECT_EQ(info["lights"]["area"].asUInt(), 1u);
  EXPECT_EQ(info["components"]["Geometry"].asUInt(), 3u);
  EXPECT_GE(info["memory_bytes"]["film"].asUInt(), 16u * 12 * 208);
  EXPECT_EQ(info["remarks"].size(), 0u);
}

// A scene with every key has every kind of material.
TEST_F(Reports, InfoCountsEveryKindOfMaterial) {
  const ProgramResult result = run({"info", METAMER_SOURCE_DIR "/tests/scenes/native/every_key.json", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json::Value materials = parse_json(result.out)["materials"];
  EXPECT_EQ(materials.size(), 11u);
  for (const std::string& name : materials.getMemberNames()) EXPECT_GT(materials[name].asUInt(), 0u) << name;
}

TEST_F(Reports, InfoAndStatsListTheGridsOfMedia) {
  const std::string scene = METAMER_SOURCE_DIR "/tests/scenes/native/every_key.json";
  const ProgramResult result = run({"info", scene, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json::Value info = parse_json(result.out);
  EXPECT_EQ(info["components"]["MediumGrid"].asUInt(), 2u);
  ASSERT_EQ(info["grids"].size(), 5u);  // noise first, then files
  EXPECT_EQ(info["grids"][0]["name"].asString(), "emission_grid");
  EXPECT_EQ(info["grids"][0]["type"].asString(), "noise");
  const Json::Value density = info["grids"][2], color = info["grids"][3];
  EXPECT_THAT(density["name"].asString(), testing::EndsWith("puff.vdb:density"));
  EXPECT_EQ(density["type"].asString(), "float");
  EXPECT_EQ(density["voxels"].asUInt(), 512u);
  EXPECT_EQ(density["bytes"].asUInt(), 512u * 4 + 12);
  EXPECT_EQ(density["extent"][2].asUInt(), 4u);
  EXPECT_NEAR(density["mean"][0].asDouble(), 0.25 * (9 * 21 + 0) / 64, 1e-6);  // 0 to 6 nine times, and one more 0
  EXPECT_EQ(color["type"].asString(), "vec3s, 3 channels");
  EXPECT_EQ(color["mean"].size(), 3u);
  EXPECT_THAT(run({"info", scene}).out, HasSubstr("puff.vdb:density: float, 4x4x4, 512 voxels stored, "));

  ASSERT_EQ(run({"render", scene, "--stats", "s.json", "-q", "--size", "8x8", "--spp", "1"}).exit_code, 0);
  Json::Value volumes = parse_json(bytes("s.json"))["volumes"], grids = info["grids"];
  ASSERT_EQ(volumes.size(), grids.size());
  for (Json::ArrayIndex i = 0; i < grids.size(); ++i) {  // --stats writes means with nine digits
    EXPECT_NEAR(volumes[i]["mean"][0].asDouble(), grids[i]["mean"][0].asDouble(), 1e-8);
    volumes[i].removeMember("mean");
    grids[i].removeMember("mean");
  }
  EXPECT_EQ(volumes, grids);
}

TEST_F(Reports, InfoTellsWarnings) {
  std::string scene(small_scene);
  scene.insert(scene.find("\"entities\": [") + 13, R"({"geometry": {"type": "mesh", "mesh": "flat"}},)");
  scene.insert(
      scene.find("\"entities\""),
      R"("meshes": {"flat": {"positions": [[0,0,0],[1,0,0],[2,0,0],[0,1,0]], "indices": [[0,1,2],[0,1,3]]}},)");
  folder_.write("warn.json", scene);
  const ProgramResult result = run({"info", "warn.json", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json::Value info = parse_json(result.out);
  ASSERT_EQ(info["remarks"].size(), 1u) << result.out;
  EXPECT_EQ(info["remarks"][0]["severity"].asString(), "warning");
  EXPECT_EQ(info["triangles"].asUInt(), 6u);
}

}  // namespace
}  // namespace metamer
