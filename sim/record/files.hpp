// Files that appear under their name only when complete: written aside as NAME.part, brought to the disk,
// renamed. A reader, or a run that died half way, never leaves or sees half a file under a final name.
#pragma once

#include "core/archive.hpp"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace scree {

/// A text file that grows while it is written. Everything throws RunError with the path and the system's
/// reason (disk full, no permission...).
class AtomicFile {
 public:
  enum class Opening {
    anew,
    again  ///< to go on with what is there, complete or not, if anything; archive() says up to where
  };
  explicit AtomicFile(std::filesystem::path file, Opening opening = Opening::anew);
  /// Without commit() the part stays: it may be all that is left of a run that died.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Unbuffered, so that a run can be watched as it goes. All of it or, where that fails, nothing: no half
  /// row is left.
  void write(std::string_view text);
  void commit();
  /// What it is called until then.
  std::filesystem::path part() const;
  /// Removes it instead.
  void discard();
  /// What was written until the state was saved is on the disk; what was written since is gone after loading.
  void archive(Archive& archive);

 private:
  void take_back(std::size_t bytes) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// A whole file at once.
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace scree
