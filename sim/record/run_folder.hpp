// The folder that a run writes: it is made, locked against a second run, and cleared of an earlier one on
// request.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace scree {

class RunFolder {
 public:
  /// What becomes of an earlier run in the folder. `refused_results` is for commands that cannot continue
  /// what is there: their error does not mention --resume.
  enum class Earlier { refused, refused_results, replaced, continued };

  /// Makes the folder and locks it until this object or its process dies. Throws InputError if the folder
  /// holds an earlier run that is refused, if it holds anything else, if another run is at work in it, or if
  /// it cannot be made or written; RunError if an earlier run cannot be removed.
  RunFolder(std::filesystem::path folder, Earlier earlier);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  /// Removes the files that runs write, and nothing else.
  void clear() const;
  /// Removes the files that a run writes when it ends.
  void remove_results() const;
  /// Returns the folder of the pictures, and makes it if there is none. Throws RunError if it cannot be made.
  std::filesystem::path frames() const;
  /// Returns the file of a picture.
  std::filesystem::path frame(std::int64_t number) const;
  /// Removes the picture of this number and all later ones.
  void remove_frames_from(std::int64_t number) const;
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  void lock();

  std::filesystem::path folder_;
  int lock_ = -1;
};

}  // namespace scree
