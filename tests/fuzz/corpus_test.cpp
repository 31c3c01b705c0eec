// Tests that every hostile input of the corpus is read or refused in this build as it should be.
#include "tests/fuzz/hostile_input.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace scree {
namespace {

void read_all(const std::string& folder, void (*read)(std::string_view)) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SCREE_SOURCE_DIR "/tests/fuzz/corpus/" + folder)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_NO_THROW(read(bytes)) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 10);
}

TEST(HostileInput, ScenesLoadOrAreRefused) { read_all("scene", read_hostile_scene); }

TEST(HostileInput, BodyFilesLoadOrAreRefused) { read_all("body_file", read_hostile_body_file); }

TEST(HostileInput, MeshesLoadOrAreRefused) {
  read_all("obj", read_hostile_obj);
  read_all("stl", read_hostile_stl);
  read_all("ply", read_hostile_ply);
}

TEST(HostileInput, PointsAreAHullOrAreRefused) { read_all("points", read_hostile_points); }

TEST(HostileInput, CheckpointsAreReadOrRefused) { read_all("checkpoint", read_hostile_checkpoint); }

TEST(HostileInput, TrajectoriesAreReadOrRefused) { read_all("trajectory", read_hostile_trajectory); }

TEST(HostileInput, TablesAreComparedOrRefused) { read_all("tables", read_hostile_tables); }

TEST(HostileInput, ManifestsAreReadOrRefused) { read_all("manifest", read_hostile_manifest); }

}  // namespace
}  // namespace scree
