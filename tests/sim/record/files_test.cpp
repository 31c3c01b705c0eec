#include "sim/record/files.hpp"

#include "core/error.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <sys/resource.h>

namespace scree {
namespace {

namespace fs = std::filesystem;

TEST(AtomicFile, AppearsOnlyWhenComplete) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "a.csv");
  file.write("one\n");
  EXPECT_FALSE(fs::exists(folder / "a.csv"));
  EXPECT_EQ(text_of(folder / "a.csv.part"), "one\n");
  file.write("two\n");
  file.commit();
  EXPECT_EQ(text_of(folder / "a.csv"), "one\ntwo\n");
  EXPECT_FALSE(fs::exists(folder / "a.csv.part"));
}

TEST(AtomicFile, KeepsTheOldFileUntilTheNewOneIsComplete) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  {
    AtomicFile file(folder / "a");
    file.write("ne");
  }
  EXPECT_EQ(text_of(folder / "a"), "old");
}

/// The message of the RunError that `act` throws.
template <class F>
std::string run_error_of(F&& act) {
  try {
    act();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

TEST(AtomicFile, ErrorsNameThePathAndTheReason) {
  const TemporaryFolder folder;
  const std::string missing = run_error_of([&] { write_file(folder / "no" / "a", "text"); });
  EXPECT_NE(missing.find((folder / "no" / "a.part").string() + ": No such file or directory"),
            std::string::npos)
      << missing;

  fs::create_directory(folder / "taken");
  write_text(folder / "taken" / "x", "");
  EXPECT_NE(run_error_of([&] { write_file(folder / "taken", "text"); }), "no error");
  EXPECT_FALSE(fs::exists(folder / "taken.part"));
}

TEST(AtomicFile, AFullDiskIsAnError) {
  const TemporaryFolder folder;
  // Linux's /dev/full fails every write with ENOSPC; it is reached through the name of the part.
  fs::create_symlink("/dev/full", folder / "a.part");
  const std::string message = run_error_of([&] { write_file(folder / "a", "text"); });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(AtomicFile, WhatDoesNotFitIsTakenBack) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "a.csv");
  file.write("1,2,3\n");
  // Files of this process may have ten bytes: of the next row four are written, and then no more.
  rlimit all = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &all), 0);
  const rlimit ten = {10, all.rlim_max};
  const auto otherwise = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &ten), 0);
  const std::string message = run_error_of([&] { file.write("4,5,6\n"); });
  setrlimit(RLIMIT_FSIZE, &all);
  std::signal(SIGXFSZ, otherwise);
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_EQ(text_of(folder / "a.csv.part"), "1,2,3\n");
  file.write("4,5,6\n");
  file.commit();
  EXPECT_EQ(text_of(folder / "a.csv"), "1,2,3\n4,5,6\n");
}

}  // namespace
}  // namespace scree
