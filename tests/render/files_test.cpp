#include "core/error.hpp"
#include "render/movie.hpp"
#include "render/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace scree::render {
namespace {

namespace fs = std::filesystem;

// Gives each test its own folder.
class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "scree_render_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

Image gradient(int width, int height, int shift = 0) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int value : {3 * x + shift, 5 * y, x * y})
        image.rgb.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return image;
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Files, PngReadsBackAsWritten) {
  const Image image = gradient(37, 23);
  const fs::path file = folder_ / "a.png";
  write_png(file, image);
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&reader, file.c_str()));
  EXPECT_EQ(reader.width, 37u);
  EXPECT_EQ(reader.height, 23u);
  reader.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(reader));
  ASSERT_TRUE(png_image_finish_read(&reader, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, image.rgb);
  EXPECT_EQ(files(), 1u) << "something was left beside the picture";
}

TEST_F(Files, PngReplacesAnOlderOne) {
  write_png(folder_ / "a.png", gradient(8, 8));
  write_png(folder_ / "a.png", gradient(64, 64));
  EXPECT_GT(fs::file_size(folder_ / "a.png"), 500u);
}

TEST_F(Files, PngToNowhereSaysWhy) {
  const std::string message = message_of([&] { write_png(folder_ / "none" / "a.png", gradient(4, 4)); });
  EXPECT_NE(message.find("a.png"), std::string::npos) << message;
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

TEST_F(Files, PngOnAFullDiskSaysSoAndLeavesNothing) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "skipped: no /dev/full here";
  // The name of the temporary file is a link to the device on which every write fails.
  fs::create_symlink("/dev/full", folder_ / "a.png.part");
  for (const int size : {4, 400}) {
    if (!fs::is_symlink(folder_ / "a.png.part")) fs::create_symlink("/dev/full", folder_ / "a.png.part");
    const std::string message = message_of([&] { write_png(folder_ / "a.png", gradient(size, size)); });
    EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
    EXPECT_EQ(files(), 0u);
  }
}

bool have_ffmpeg() { return std::system("ffmpeg -version > /dev/null 2>&1") == 0; }

TEST_F(Files, MovieHoldsEveryFrame) {
  if (!have_ffmpeg()) GTEST_SKIP() << "skipped: no ffmpeg here";
  const fs::path frames = folder_ / "frames";
  fs::create_directory(frames);
  for (int k = 0; k < 6; ++k)
    write_png(frames / ("0000" + std::to_string(k) + ".png"), gradient(65, 48, 9 * k));
  const fs::path movie = folder_ / "movie.mp4";
  make_movie(frames, 24, movie);
  EXPECT_EQ(files(), 2u);
  // ffprobe comes with ffmpeg and counts the frames that can be decoded.
  const fs::path counted = folder_ / "counted";
  const std::string probe =
      "ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,pix_fmt,codec_name"
      " -of csv=p=0 " +
      movie.string() + " > " + counted.string();
  ASSERT_EQ(std::system(probe.c_str()), 0);
  std::string line;
  std::getline(std::ifstream(counted) >> std::ws, line);
  EXPECT_EQ(line, "h264,64,yuv420p,6");
}

TEST_F(Files, MovieOfNothingSaysWhatFfmpegSaid) {
  if (!have_ffmpeg()) GTEST_SKIP() << "skipped: no ffmpeg here";
  const std::string message = message_of([&] { make_movie(folder_ / "none", 24, folder_ / "movie.mp4"); });
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
  EXPECT_EQ(files(), 0u);
}

TEST_F(Files, MovieWithoutFfmpegSaysSo) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  const std::string message = message_of([&] { make_movie(folder_, 24, folder_ / "movie.mp4"); });
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(message.find("ffmpeg is not installed"), std::string::npos) << message;
}

}  // namespace
}  // namespace scree::render
