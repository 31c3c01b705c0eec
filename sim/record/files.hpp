// Files that appear under their name only when they are complete: they are written as NAME.part, brought to
// the disk, and renamed. So a run that died leaves no half file under a final name, and no reader sees one.
#pragma once

#include "core/archive.hpp"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace scree {

/// A text file that is written piece by piece. Every function throws RunError with the path and the system's
/// reason (disk full, no permission...) if it fails.
class AtomicFile {
 public:
  enum class Opening {
    anew,
    again  ///< continues the file that is there, complete or not, if any; archive() says up to which byte
  };
  explicit AtomicFile(std::filesystem::path file, Opening opening = Opening::anew);
  /// Leaves NAME.part if commit() was not called: it may be all that is left of a run that died.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends the text without a buffer, so that a run can be watched while it writes. If not all of it can be
  /// written, none of it is: no half row is left.
  void write(std::string_view text);
  /// Brings the file to the disk and gives it its name.
  void commit();
  /// Returns the name of the file before commit().
  std::filesystem::path part() const;
  /// Removes the file; for use instead of commit().
  void discard();
  /// Saves how far the file is written, after bringing that to the disk; on loading, removes what was written
  /// after the state was saved.
  void archive(Archive& archive);

 private:
  void take_back(std::size_t bytes) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Writes a whole file at once.
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace scree
