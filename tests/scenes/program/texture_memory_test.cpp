// --texture-memory: large textures in files instead of in memory, and the same picture.
#include <OpenImageIO/imageio.h>

#include "tests/scenes/program/run_program.h"

namespace metamer {
namespace {

using testing::HasSubstr;

class TextureMemory : public ProgramTest {
 protected:
  // Noise, uncompressed.
  void write_image(const std::string& name, int side) const {
    const std::string path = (folder() / name).string();
    const auto file = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(side, side, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "none");
    std::vector<uint8_t> pixels(static_cast<size_t>(side) * static_cast<size_t>(side) * 3);
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(i * 2654435761u >> 15);
    ASSERT_TRUE(file && file->open(path, spec) && file->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
                file->close());
  }
  struct Rendered {
    Json::Value stats;
    std::string exr;
  };
  Rendered render(const std::string& scene, const Arguments& more) const {
    Arguments arguments = {"render", scene, "-q", "-o", "o.exr", "--stats", "s.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return {parse_json(bytes("s.json")), bytes("o.exr")};
  }
};

// Two images of 1600 x 1600 texels are 82 MB of coefficients, a third of them 0.2 MB.
TEST_F(TextureMemory, ImagesBeyondItStayInFilesAndThePictureIsTheSame) {
  write_image("a.tif", 1600);
  write_image("b.tif", 1600);
  write_image("c.tif", 100);
  const std::string square = "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]\n";
  folder_.write("s.pbrt",
                "Film \"rgb\" \"integer xresolution\" 96 \"integer yresolution\" 64\nSampler \"zsobol\" \"integer "
                "pixelsamples\" 4\n"
                "LookAt 0 0 3 0 0 0 0 1 0 Camera \"perspective\" WorldBegin LightSource \"infinite\"\n"
                "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tif\"\n"
                "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"b.tif\"\n"
                "Texture \"c\" \"float\" \"imagemap\" \"string filename\" \"c.tif\" \"string filter\" \"EWA\"\n"
                "Material \"diffuse\" \"texture reflectance\" \"a\" " +
                    square + "Translate 1 0 0.5 Material \"diffuse\" \"texture reflectance\" \"b\" " + square +
                    "Translate 0 1 0.5 Material \"conductor\" \"texture roughness\" \"c\" " + square);
  const Rendered all = render("s.pbrt", {});
  const Rendered limited = render("s.pbrt", {"--texture-memory", "40M", "--threads", "2"});
  EXPECT_TRUE(all.exr == limited.exr);
  EXPECT_TRUE(all.exr == render("s.pbrt", {"--texture-memory", "60000K", "--threads", "1", "--tile", "16"}).exr);
  constexpr uint64_t large = 1600 * 1600 * 16;
  EXPECT_EQ(all.stats["textures"]["files"].asUInt64(), 0u);
  EXPECT_GE(all.stats["textures"]["bytes"].asUInt64(), 2 * large);
  EXPECT_EQ(limited.stats["textures"]["files"].asUInt64(), 2u);
  EXPECT_EQ(limited.stats["textures"]["file_bytes"].asUInt64(), 2 * large);
  EXPECT_LT(limited.stats["textures"]["bytes"].asUInt64(), 200'000u);
  const uint64_t limit = limited.stats["textures"]["cache_limit_bytes"].asUInt64();
  EXPECT_GT(limit, uint64_t{39} << 20);
  EXPECT_LE(limit, uint64_t{40} << 20);
  EXPECT_GT(limited.stats["textures"]["cache_tiles_read"].asUInt64(), 100u);
  EXPECT_LT(limited.stats["textures"]["cache_bytes"].asUInt64(), limit + (uint64_t{4} << 20));
  // Neither the images nor their coefficients were in memory as a whole.
  EXPECT_LT(limited.stats["peak_rss_bytes"].asUInt64() + large, all.stats["peak_rss_bytes"].asUInt64());
}

TEST_F(TextureMemory, FilesGoWithTheProgram) {
  write_image("a.tif", 1700);
  folder_.write("s.json",
                R"({"metamer": 1, "settings": {"size": [8, 8], "samples": 1},
  "textures": {"a": {"type": "image", "image": "a.tif"}},
  "entities": [{"camera": {"type": "perspective", "fov": 60}},
    {"transform": {"translate": [0, 0, 2]}, "geometry": {"type": "rectangle", "width": 1, "depth": 1},
     "material": {"type": "diffuse", "reflectance": {"texture": "a"}}}]})");
  const TemporaryFolder temporary;
  const Arguments arguments = {"render",           "s.json", "-q",      "-o",     "o.exr",
                               "--texture-memory", "32M",    "--stats", "s.stats"};
  const ProgramResult result = run_program(arguments, folder(), {{"TMPDIR", temporary.path().string()}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(parse_json(bytes("s.stats"))["textures"]["files"].asUInt64(), 11u);  // 1700, 850, ..., 1
  EXPECT_THAT(names_in(temporary.path()), testing::IsEmpty());
  const ProgramResult nowhere = run_program(arguments, folder(), {{"TMPDIR", "/nowhere"}});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("can be made for textures that do not fit in memory"));
}

TEST_F(TextureMemory, SizesAreBytesWithOrWithoutUnits) {
  for (const std::string good : {"33554432", "32m", "32MiB", "0.5G", "1g", "40000K", "1T"}) {
    const bool is_good = good != "0.5G";
    EXPECT_EQ(run({"render", "small.json", "-q", "--spp", "1", "--texture-memory", good}).exit_code, is_good ? 0 : 2)
        << good;
  }
  for (const std::string bad : {"", "M", "12", "31M", "-1G", "2 G", "2X", "5iB", "99999999999T"})
    EXPECT_THAT(run({"render", "small.json", "--texture-memory", bad}).err,
                HasSubstr("--texture-memory: expected bytes, such as 512M or 2G, of at least 32M, not '" + bad + "'"));
}

}  // namespace
}  // namespace metamer
