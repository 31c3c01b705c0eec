// The folder that a run writes: made, guarded against a second run, and cleared of an earlier one when asked.
#pragma once

#include <filesystem>
#include <string>

namespace scree {

class RunFolder {
 public:
  /// Makes the folder and locks it until this object or its process dies. Throws InputError if the folder
  /// holds an earlier run and `overwrite` is false, if it holds anything else, or if another run is at work
  /// in it; RunError if it cannot be made. With `overwrite` the files that a run writes, and nothing else,
  /// are removed.
  RunFolder(std::filesystem::path folder, bool overwrite);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  /// The folder of the pictures, made by the first call. Throws RunError if it cannot be.
  std::filesystem::path frames() const;
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  void lock();

  std::filesystem::path folder_;
  int lock_ = -1;
};

}  // namespace scree
