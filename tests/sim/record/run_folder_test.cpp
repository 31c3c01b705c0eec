#include "sim/record/run_folder.hpp"

#include "core/error.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

namespace fs = std::filesystem;
using Earlier = RunFolder::Earlier;

TEST(RunFolder, IsMadeWithItsParents) {
  const TemporaryFolder folder;
  const RunFolder run(folder / "a/b", Earlier::refused);
  EXPECT_TRUE(fs::is_directory(folder / "a/b"));
  EXPECT_TRUE(fs::is_directory(run.frames()));
}

TEST(RunFolder, RefusesAnEarlierRunUnlessToldToOverwrite) {
  const TemporaryFolder folder;
  const fs::path path = folder / "run";
  fs::create_directories(path / "frames");
  for (const char* name : {"manifest.json", "metrics.csv.part", "frames/00000.png", "frames/note.txt"}) {
    write_text(path / name, "old");
  }
  EXPECT_THROW(RunFolder(path, Earlier::refused), InputError);
  EXPECT_EQ(text_of(path / "manifest.json"), "old");
  try {
    const RunFolder refused(path, Earlier::refused_results);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              path.string() + ": holds earlier results; --overwrite replaces them, -o DIR writes elsewhere");
  }

  const RunFolder run(path, Earlier::replaced);
  EXPECT_FALSE(fs::exists(path / "manifest.json"));
  EXPECT_FALSE(fs::exists(path / "metrics.csv.part"));
  EXPECT_FALSE(fs::exists(path / "frames/00000.png"));
  EXPECT_TRUE(fs::exists(path / "frames/note.txt")) << "not the run's to remove";
}

TEST(RunFolder, NeverTouchesAFolderThatHoldsAnythingElse) {
  const TemporaryFolder folder;
  write_text(folder / "metrics.csv", "mine");
  write_text(folder / "thesis.tex", "mine");
  EXPECT_THROW(RunFolder(folder.path(), Earlier::replaced), InputError);
  EXPECT_EQ(text_of(folder / "metrics.csv"), "mine");
  write_text(folder / "file", "");
  EXPECT_THROW(RunFolder(folder / "file", Earlier::replaced), InputError);
}

TEST(RunFolder, IsLockedWhileItLives) {
  const TemporaryFolder folder;
  {
    const RunFolder run(folder / "run", Earlier::refused);
    EXPECT_THROW(RunFolder(folder / "run", Earlier::replaced), InputError);
  }
  EXPECT_NO_THROW(RunFolder(folder / "run", Earlier::refused))
      << "the lock is gone, and an empty folder is no earlier run";
}

TEST(RunFolder, CannotBeMadeBelowAFile) {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  EXPECT_THROW(RunFolder(folder / "file/run", Earlier::refused), InputError);
}

}  // namespace
}  // namespace scree
