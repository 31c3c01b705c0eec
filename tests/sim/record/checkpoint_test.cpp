#include "sim/record/checkpoint.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/rng.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <hdf5.h>
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
  Random random(3, 0);
  for (int k = 0; k < 400; ++k) {
    std::string damaged = whole;
    const auto at = static_cast<std::size_t>(random.uniform(0.0, 1.0) * static_cast<double>(whole.size()));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << k % 8));
    write_text(file, damaged);
    EXPECT_THROW(read_checkpoint(file), RunError) << at;
    write_text(file, whole.substr(0, at));
    EXPECT_THROW(read_checkpoint(file), RunError) << at;
  }
  EXPECT_THROW(read_checkpoint(folder / "none.h5"), RunError);
}

/// The file with other bytes after its first line, and the checksum of those.
void forge(const fs::path& file, const std::string& rest) {
  write_text(file, fmt::format("{}{:016x}\n{}", checkpoint_head, hash_of(rest.data(), rest.size()), rest));
}

TEST(Checkpoint, AForgedOneIsRefusedWithTheReason) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.h5";
  forge(file, "real 8 1 1 59 a\n\n        ");
  EXPECT_EQ(read_checkpoint(file).find("a")->rows(), 1);
  for (const char* line :
       {"real 8 0 5 59 a", "real 8 1 1152921504606846976 59 a", "real 8 1 1 99999 a", "real 8 1 -1 59 a",
        "complex 8 1 1 59 a", "real 8", "real 2 1 1 59 a", "bytes 8 1 1 59 a", "integer 3 1 1 59 a",
        "bytes 1 2147483647 1 59 a", "real 8 \x1b[31m 1 59 a", "natural 1 1 60 0 a\nnatural 1 1 60 0 b"}) {
    forge(file, std::string(line) + "\n\n        ");
    try {
      read_checkpoint(file);
      FAIL() << line;
    } catch (const RunError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": is not valid: ")) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\x1b'), std::string::npos);
    }
  }
  forge(file, "real 8 1 1 59 a");
  EXPECT_THROW(read_checkpoint(file), RunError);
  EXPECT_THROW(read_checkpoint(folder.path()), RunError);
}

TEST(Checkpoint, OtherReadersOfHdf5FindTheFields) {
  const TemporaryFolder folder;
  const SavedState state = state_of({});
  write_checkpoint(folder / "a.h5", state);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(file, "outer/inner/vectors", H5P_DEFAULT);
  std::array<double, 6> numbers{};
  EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  EXPECT_EQ(numbers[2], 3);
  EXPECT_EQ(numbers[4], 1e308);
  // Numbers wider than a byte are numbers as wide.
  const hid_t number = H5Dopen2(file, "outer/inner/number", H5P_DEFAULT);
  std::int64_t whole = 0;
  EXPECT_GE(H5Dread(number, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &whole), 0);
  EXPECT_EQ(whole, -(std::int64_t{1} << 62));
  H5Dclose(number);
  const hid_t note = H5Aopen(data, "xxh3", H5P_DEFAULT);
  std::uint64_t sum = 0;
  EXPECT_GE(H5Aread(note, H5T_NATIVE_UINT64, &sum), 0);
  const SavedField* field = state.find("outer/inner/vectors");
  EXPECT_EQ(sum, hash_of(field->bytes.data(), static_cast<std::size_t>(field->bytes.size())));
  H5Aclose(note);
  H5Dclose(data);
  H5Fclose(file);
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
