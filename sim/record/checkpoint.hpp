// checkpoint/: the last states of a run, from which it can be continued.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// Makes HDF5 take the memory that it needs besides that of a state, and keep it: without this it would crash
/// where memory has run out. Must be called before a run.
void prepare_checkpoints();

/// How a checkpoint's file begins. The number is another one whenever the contents have changed, so that
/// files of other versions are refused at once.
inline constexpr std::string_view checkpoint_head = "scree checkpoint 10, xxh3 of what follows: ";

/// Writes the state as HDF5: a dataset for each field, of its numbers or of records as opaque bytes, each
/// with the attribute xxh3, the checksum of its bytes. Before the HDF5 part comes text that HDF5's readers
/// skip: a line with the checksum of all that follows, and a directory with a line for each field: kind,
/// width, columns, rows, position of its bytes in the file, name. Throws RunError if the file cannot be
/// written.
void write_checkpoint(const std::filesystem::path& file, const SavedState& state);

/// Reads a state by the directory. Throws RunError, which says what is wrong, if the file cannot be read, is
/// not whole, or is not a checkpoint. Takes twice the memory of the file.
SavedState read_checkpoint(const std::filesystem::path& file);

/// The folder of the checkpoints, which keeps the two with the largest numbers of steps.
class CheckpointFolder {
 public:
  explicit CheckpointFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Adds a checkpoint; the newest one before it stays, and older ones are removed. Throws RunError if it
  /// cannot be written.
  void add(std::int64_t step, const SavedState& state) const;
  /// Reads the newest checkpoint that is whole. Adds to `damaged` what is wrong with newer ones.
  std::optional<SavedState> newest(std::vector<std::string>& damaged) const;
  /// Removes all checkpoints. Throws RunError if that cannot be done.
  void clear() const;

 private:
  /// Returns the files, the newest first.
  std::vector<std::filesystem::path> files() const;

  std::filesystem::path folder_;
};

}  // namespace scree
