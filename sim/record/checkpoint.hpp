// checkpoint/: the last states of a run that it can go on from.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Makes HDF5 take the memory that it needs besides a state's own, and keep it: where there is none any more
/// it would crash. To be called before a run.
void prepare_checkpoints();

/// Writes the state as HDF5: a dataset for each field, of its numbers or of records as opaque bytes, each
/// with the attribute xxh3, the checksum of its bytes. Before that stands what HDF5's readers skip: a line
/// with the checksum of all that follows, and a directory, a line for each field: kind, width, columns, rows,
/// place of its bytes in the file, name. Throws RunError if the file cannot be written.
void write_checkpoint(const std::filesystem::path& file, const SavedState& state);

/// Reads it by the directory. Throws RunError if the file cannot be read, is not whole, or is none: it says
/// what is wrong. Takes twice the memory of the file.
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
