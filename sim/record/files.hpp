// Files that appear under their name only when complete: written aside as NAME.part, brought to the disk,
// renamed. A reader, or a run that died half way, never leaves or sees half a file under a final name.
#pragma once

#include <filesystem>
#include <string_view>

namespace scree {

/// A text file that grows while it is written. Everything throws RunError with the path and the system's
/// reason (disk full, no permission...).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path file);
  /// Without commit() the part stays: it may be all that is left of a run that died.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Unbuffered, so that a run can be watched as it goes.
  void write(std::string_view text);
  void commit();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// A whole file at once.
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace scree
