#include "sim/record/files.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <tuple>
#include <unistd.h>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* what, const fs::path& file) {
  throw RunError(fmt::format("cannot {} {}: {}", what, file.string(), std::strerror(errno)));
}

/// Brings a folder to the disk: a rename is on the disk only once its folder is.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail("open", folder);
  // Some network file systems cannot sync a folder and say EINVAL; the file itself is safe by then.
  const bool failed = ::fsync(descriptor) != 0 && errno != EINVAL;
  ::close(descriptor);
  if (failed) fail("bring to the disk", folder);
}

fs::path part_of(const fs::path& file) { return fs::path(file) += ".part"; }

}  // namespace

AtomicFile::AtomicFile(fs::path file, Opening opening) : file_(std::move(file)) {
  const fs::path part = part_of(file_);
  if (opening == Opening::anew) {
    descriptor_ = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("create", part);
    return;
  }
  if (!fs::exists(part) && ::rename(file_.c_str(), part.c_str()) != 0 && errno != ENOENT)
    fail("go on with", file_);
  descriptor_ = ::open(part.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("go on with", part);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::write(std::string_view text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      take_back(done);
      errno = reason;
      fail("write", part_of(file_));
    }
    done += static_cast<std::size_t>(written);
  }
}

void AtomicFile::take_back(std::size_t bytes) const {
  const off_t length = ::lseek(descriptor_, 0, SEEK_END);
  // If even this fails there is nothing left to try: the caller fails anyway.
  if (length >= 0) std::ignore = ::ftruncate(descriptor_, length - static_cast<off_t>(bytes));
}

void AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) fail("bring to the disk", part_of(file_));
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("write", part_of(file_));
  if (::rename(part_of(file_).c_str(), file_.c_str()) != 0) fail("rename to", file_);
  sync_folder(file_.has_parent_path() ? file_.parent_path() : ".");
}

std::filesystem::path AtomicFile::part() const { return part_of(file_); }

void AtomicFile::discard() {
  if (::unlink(part_of(file_).c_str()) != 0) fail("remove", part_of(file_));
}

void AtomicFile::archive(Archive& archive) {
  std::int64_t length = ::lseek(descriptor_, 0, SEEK_END);
  if (length < 0) fail("find the end of", part_of(file_));
  if (!archive.is_loading()) {
    if (::fsync(descriptor_) != 0) fail("bring to the disk", part_of(file_));
    archive("length", length);
    return;
  }
  const std::int64_t found = length;
  archive("length", length);
  if (found < length)
    throw RunError(
        fmt::format("{}: {} bytes of {} are left, so the run cannot be continued; --overwrite starts from "
                    "the beginning",
                    part_of(file_).string(), found, length));
  if (::ftruncate(descriptor_, length) != 0) fail("shorten", part_of(file_));
}

void write_file(const fs::path& file, std::string_view text) try {
  AtomicFile whole(file);
  whole.write(text);
  whole.commit();
} catch (const RunError&) {
  ::unlink(part_of(file).c_str());
  throw;
}

}  // namespace scree
