// The folder that a run writes: made, guarded against a second run, and cleared of an earlier one when asked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace scree {

class RunFolder {
 public:
  /// What becomes of an earlier run in the folder.
  enum class Earlier { refused, replaced, continued };

  /// Makes the folder and locks it until this object or its process dies. Throws InputError if the folder
  /// holds an earlier run that is refused, if it holds anything else, if another run is at work in it, or if
  /// it cannot be made or written; RunError if an earlier run cannot be removed.
  RunFolder(std::filesystem::path folder, Earlier earlier);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  /// Removes what runs write, and nothing else.
  void clear() const;
  /// Of that, what a run writes when it ends.
  void remove_results() const;
  /// The folder of the pictures, made by the first call. Throws RunError if it cannot be.
  std::filesystem::path frames() const;
  /// The file of a picture there.
  std::filesystem::path frame(std::int64_t number) const;
  /// Removes that of this number, and all that follow it.
  void remove_frames_from(std::int64_t number) const;
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  void lock();

  std::filesystem::path folder_;
  int lock_ = -1;
};

}  // namespace scree
