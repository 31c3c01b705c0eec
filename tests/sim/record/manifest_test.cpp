#include "sim/record/manifest.hpp"

#include "core/error.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

class ReadManifest : public testing::Test {
 protected:
  /// The text with one part replaced.
  std::filesystem::path file(const std::string& part = "", const std::string& by = "") const {
    std::string text = R"({"status": "done", "scene": {"hash": "0123456789abcdef"}, "space": "host",
      "program": {"commit": "abc"}, "states": [{"step": 2, "hash": "00000000000000fe"}],
      "steps": 5, "state_hash": "00000000000000ff"})";
    if (!part.empty()) text.replace(text.find(part), part.size(), by);
    write_text(folder_ / "manifest.json", text);
    return folder_ / "manifest.json";
  }
  TemporaryFolder folder_;
};

TEST_F(ReadManifest, TellsTheStatesAndTheSteps) {
  const RecordedRun run = read_manifest(file());
  EXPECT_EQ(run.commit, "abc");
  ASSERT_EQ(run.states.size(), 2u);
  EXPECT_EQ(run.states[0].step, 2);
  EXPECT_EQ(run.states[0].hash, 0xfeu);
  EXPECT_EQ(run.states[1].hash, 0xffu);
  EXPECT_EQ(steps_done(file()), 5);
  EXPECT_FALSE(steps_done(file("done", "failed")));
  EXPECT_FALSE(steps_done(folder_ / "none.json"));
}

TEST_F(ReadManifest, TheStateOfTheEndIsThereOnce) {
  EXPECT_EQ(read_manifest(file("{\"step\": 2, \"hash\": \"00000000000000fe\"}",
                               "{\"step\": 5, \"hash\": \"00000000000000ff\"}"))
                .states.size(),
            1u);
  EXPECT_EQ(read_manifest(file("{\"step\": 2,", "{\"step\": 5,")).states.size(), 2u) << "with another hash";
}

TEST_F(ReadManifest, SaysWhatIsWrongWithTheFile) {
  const auto complaint = [](const std::filesystem::path& manifest) -> std::string {
    try {
      read_manifest(manifest);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string folder = folder_.path().string();
  EXPECT_EQ(complaint(folder_ / "manifest.json"),
            folder + "/manifest.json: there is no such file; is " + folder + " a run folder?");
  EXPECT_EQ(complaint(file("{", "[")), folder + "/manifest.json: is not the manifest of a run");
  EXPECT_EQ(complaint(file("\"steps\"", "\"setps\"")),
            folder + "/manifest.json: is not the manifest of a run");
}

TEST_F(ReadManifest, WhatIsNoStepAndNoHashIsRefused) {
  for (const char* steps : {"-1", "1e300", "5.5", "\"5\"", "18446744073709551615", "true", "null"}) {
    EXPECT_THROW(read_manifest(file("5,", std::string(steps) + ",")), InputError) << steps;
    EXPECT_FALSE(steps_done(file("5,", std::string(steps) + ","))) << steps;
  }
  for (const char* hash : {"ff", "0x000000000000ff", "-0000000000000ff", "00000000000000f ",
                           "00000000000000FF", "00000000000000ff0"})
    EXPECT_THROW(read_manifest(file("00000000000000ff", hash)), InputError) << hash;
  EXPECT_FALSE(steps_done(file("\"done\"", "5")));
}

TEST_F(ReadManifest, WhatItSaysHoldsNoControlCharacters) {
  try {
    read_manifest(file("host", "\x1b[31m"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\x1b'), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace scree
