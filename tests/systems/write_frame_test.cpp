#include "systems/write_frame.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace metamer {
namespace {

class WriteFrame : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("metamer-write-frame-" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

Film small_film() {
  Film film(3, 2);
  TileFilm tile;
  tile.reset(0, 0, 3, 2, 0, 4);
  for (uint32_t k = 0; k < 4; ++k)
    for (uint32_t p = 0; p < 5; ++p) {
      const float v = static_cast<float>(k + p);
      add_samples(tile, std::span(&p, 1), std::span(&k, 1), &v, &v, &v);
    }
  flush(film, tile);
  return film;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(WriteFrame, DevelopsMeansThroughTheMatrix) {
  const ColourMatrix swap = {{{0, 2, 0}, {0, 0, 1}, {-1, 0, 0}}};
  const Picture picture = develop(observe(small_film(), Observer::cie1931, 1), swap);
  EXPECT_EQ(picture.r[2], 2 * 3.5f);
  EXPECT_EQ(picture.g[2], 3.5f);
  EXPECT_EQ(picture.b[2], -3.5f);
  EXPECT_EQ(picture.r[5], 0);
}

TEST_F(WriteFrame, WritesWhatIsNamedAndTheSameBytesAgain) {
  WriteSettings settings;
  settings.header.software = "metamer test";
  const Film film = small_film();
  for (const char* name : {"a", "b"}) {
    settings.exr_path = path(name) + ".exr";
    settings.png_path = path(name) + ".png";
    ASSERT_EQ(write_frame(film, settings), std::nullopt);
  }
  EXPECT_EQ(bytes_of(path("a.exr")), bytes_of(path("b.exr")));
  EXPECT_EQ(bytes_of(path("a.png")), bytes_of(path("b.png")));
  EXPECT_GT(bytes_of(path("a.png")).size(), 60u);
  settings.exr_path = path("preview.exr");
  settings.png_path.clear();
  settings.checkpoint = false;
  ASSERT_EQ(write_frame(film, settings), std::nullopt);
  EXPECT_LT(bytes_of(path("preview.exr")).size(), bytes_of(path("a.exr")).size());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 5);
}

TEST_F(WriteFrame, ReportsEachFileThatFailsAndWritesTheOther) {
  WriteSettings settings;
  settings.exr_path = path("none/a.exr");
  settings.png_path = path("a.png");
  const FileError error = write_frame(small_film(), settings);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(*error,
            path("none/a.exr") + ": the folder '" + path("none") + "' cannot be used: No such file or directory");
  EXPECT_TRUE(std::filesystem::exists(path("a.png")));
}

}  // namespace
}  // namespace metamer
