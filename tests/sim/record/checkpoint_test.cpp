#include "sim/record/checkpoint.hpp"

#include "core/error.hpp"
#include "core/rng.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace scree {
namespace {

namespace fs = std::filesystem;

struct Record {
  std::int32_t a = 7;
  float b[3] = {1, 2, 3};
};

/// A part with a field of every kind.
struct Part {
  std::vector<Vec3> vectors = {{1, 2, 3}, {-0.0, 1e308, std::numeric_limits<double>::quiet_NaN()}};
  std::vector<Quat> turns = {Quat(1, 2, 3, 4)};
  std::vector<Record> records = {{}, {8, {4, 5, 6}}};
  std::vector<float> floats = {1.5f, std::numeric_limits<float>::infinity()};
  std::vector<std::int32_t> nothing = {};
  std::int64_t number = -(std::int64_t{1} << 62);
  std::uint64_t natural = ~std::uint64_t{0};
  std::uint8_t byte = 200;
  bool flag = true;
  double real = 0.1;
  std::string text = "naïve\nlines";

  void archive(Archive& archive) {
    archive("vectors", vectors);
    archive("turns", turns);
    archive("records", records);
    archive("floats", floats);
    archive("nothing", nothing);
    archive("number", number);
    archive("natural", natural);
    archive("byte", byte);
    archive("flag", flag);
    archive("real", real);
    archive("text", text);
  }
};

SavedState state_of(Part part) {
  SavedState state;
  Archive::saving(state).part("outer/inner", part);
  return state;
}

bool are_equal(const SavedState& a, const SavedState& b) {
  return a.fields.size() == b.fields.size() && std::ranges::all_of(a.fields, [&](const SavedField& field) {
           const SavedField* other = b.find(field.name);
           return other != nullptr && other->type == field.type &&
                  other->bytes.size() == field.bytes.size() &&
                  std::equal(field.bytes.view().begin(), field.bytes.view().end(),
                             other->bytes.view().begin());
         });
}

TEST(Checkpoint, ReadsBackToTheBit) {
  const TemporaryFolder folder;
  const SavedState state = state_of({});
  write_checkpoint(folder / "a.h5", state);
  const SavedState read = read_checkpoint(folder / "a.h5");
  EXPECT_TRUE(are_equal(state, read));
  Part part{.vectors = {}, .records = {}, .number = 0, .flag = false, .text = {}};
  Archive::loading(read).part("outer/inner", part);
  EXPECT_TRUE(are_equal(state, state_of(part)));
  EXPECT_EQ(part.text, "naïve\nlines");
}

TEST(Checkpoint, WhateverBitIsFlippedOrByteIsMissingItIsRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.h5";
  write_checkpoint(file, state_of({}));
  const std::string whole = text_of(file);
  const std::size_t said = whole.find('\n');
  Random random(3, 0);
  for (int k = 0; k < 400; ++k) {
    std::string damaged = whole;
    // What follows the first line, up to the library's own part, is nobody's.
    const auto at = static_cast<std::size_t>(random.uniform(0.0, 1.0) * static_cast<double>(whole.size()));
    if (at > said && at < 512) continue;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << k % 8));
    write_text(file, damaged);
    EXPECT_THROW(read_checkpoint(file), RunError) << at;
    write_text(file, whole.substr(0, at));
    EXPECT_THROW(read_checkpoint(file), RunError) << at;
  }
  EXPECT_THROW(read_checkpoint(folder / "none.h5"), RunError);
}

TEST(Checkpoint, AFolderKeepsTheTwoNewestAndPassesOverWhatIsDamaged) {
  const TemporaryFolder folder;
  const CheckpointFolder checkpoints(folder / "checkpoint");
  std::vector<std::string> damaged;
  EXPECT_FALSE(checkpoints.newest(damaged));
  for (const std::int64_t step : {9, 10, 200}) checkpoints.add(step, state_of({.number = step}));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / "checkpoint")) files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_EQ(files.size(), 2u);
  const auto number = [](const SavedState& state) {
    Part part;
    Archive::loading(state).part("outer/inner", part);
    return part.number;
  };
  EXPECT_EQ(number(*checkpoints.newest(damaged)), 200);
  EXPECT_TRUE(damaged.empty());
  std::string text = text_of(files[1]);
  text[text.size() / 2] ^= 4;
  write_text(files[1], text);
  EXPECT_EQ(number(*checkpoints.newest(damaged)), 10);
  ASSERT_EQ(damaged.size(), 1u);
  EXPECT_NE(damaged[0].find(files[1].string() + ": is damaged"), std::string::npos) << damaged[0];
  checkpoints.clear();
  EXPECT_FALSE(fs::exists(folder / "checkpoint"));
}

TEST(Checkpoint, WhereItCannotBeWrittenTheErrorNamesTheFile) {
  try {
    write_checkpoint("/dev/full/a.h5", state_of({}));
    FAIL();
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace scree
