// checkpoint/: the last states of a run that it can go on from.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Writes the state as HDF5: a dataset for each field, of its numbers or of records as opaque bytes, each
/// with the attribute xxh3, the checksum of its bytes. Before that stands a line with the checksum of all
/// that follows, so that nothing damaged reaches the library; other readers of HDF5 skip it. Throws RunError
/// if the file cannot be written.
void write_checkpoint(const std::filesystem::path& file, const SavedState& state);

/// Throws RunError if the file cannot be read, or is not whole: it says what is wrong.
SavedState read_checkpoint(const std::filesystem::path& file);

/// The folder with the two newest, by their steps.
class CheckpointFolder {
 public:
  explicit CheckpointFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Adds one; the one before it stays, older ones go. Throws RunError if it cannot be written.
  void add(std::int64_t step, const SavedState& state) const;
  /// The newest that is whole. `damaged`: what is wrong with newer ones.
  std::optional<SavedState> newest(std::vector<std::string>& damaged) const;
  /// Removes all. Throws RunError if that cannot be done.
  void clear() const;

 private:
  /// The newest first.
  std::vector<std::filesystem::path> files() const;

  std::filesystem::path folder_;
};

}  // namespace scree
