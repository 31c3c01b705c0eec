#include "sim/record/run_folder.hpp"

#include "core/error.hpp"
#include "sim/record/final_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view lock_name = ".lock";
constexpr std::array<std::string_view, 15> file_names = {
    "manifest.json",     "scene.yaml",         "metrics.csv", "timing.csv", "final.csv",
    "trajectory.vtkhdf", "trajectory.journal", "movie.mp4",   "log.txt",    "failure.png",
    "contacts.vtkhdf",   "contacts.journal",   "report.html", "study.csv",  "study.json"};

/// Whether a study has written a file of this name: error_1.gp, error_1.svg, error_1.png, ...
bool is_plot(std::string_view name) {
  return name.starts_with("error_") &&
         (name.ends_with(".gp") || name.ends_with(".svg") || name.ends_with(".png"));
}

bool is_folder_of_a_run(std::string_view name) {
  return name == "frames" || name == "checkpoint" || name == hulls_name;
}

/// Whether a run or a study wrote this entry of its folder, under its final name or as an incomplete part.
bool is_written_by_a_run(const fs::path& entry) {
  std::string name = entry.filename().string();
  if (name.ends_with(".part")) name.resize(name.size() - std::strlen(".part"));
  return std::ranges::find(file_names, name) != file_names.end() || is_folder_of_a_run(name) || is_plot(name);
}

/// Whether the entry is a picture, a saved state or a hull, complete or not.
bool is_numbered(const fs::path& entry) {
  const std::string name = entry.filename().string();
  return name.ends_with(".png") || name.ends_with(".png.part") || name.ends_with(".h5") ||
         name.ends_with(".h5.part") || name.ends_with(".obj") || name.ends_with(".obj.part");
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != lock_name) entries.push_back(entry.path());
  }
  return entries;
}

void remove_earlier_run(const std::vector<fs::path>& entries) {
  for (const fs::path& entry : entries) {
    if (!is_folder_of_a_run(entry.filename().string())) {
      fs::remove(entry);
      continue;
    }
    for (const fs::path& file : entries_of(entry)) {
      if (is_numbered(file)) fs::remove(file);
    }
  }
}

}  // namespace

RunFolder::RunFolder(fs::path folder, Earlier earlier) : folder_(std::move(folder)) {
  try {
    if (fs::exists(folder_) && !fs::is_directory(folder_)) {
      throw InputError(fmt::format("{}: is not a folder; give another one with -o", folder_.string()));
    }
    const std::vector<fs::path> found = fs::exists(folder_) ? entries_of(folder_) : std::vector<fs::path>{};
    const auto foreign = std::ranges::find_if_not(found, is_written_by_a_run);
    if (foreign != found.end()) {
      throw InputError(fmt::format("{}: holds {}, which no run has written; give another folder with -o",
                                   folder_.string(), foreign->filename().string()));
    }
    if (!found.empty() && earlier == Earlier::refused_results)
      throw InputError(fmt::format(
          "{}: holds earlier results; --overwrite replaces them, -o DIR writes elsewhere", folder_.string()));
    if (!found.empty() && earlier == Earlier::refused) {
      throw InputError(fmt::format(
          "{}: holds an earlier run; --resume continues it, --overwrite replaces it, -o DIR keeps it",
          folder_.string()));
    }
    fs::create_directories(folder_);
  } catch (const fs::filesystem_error& error) {
    // If memory ran out, another folder would not help.
    if (error.code() == std::errc::not_enough_memory) throw std::bad_alloc();
    throw InputError(fmt::format("cannot make the run folder {}: {}; give another one with -o",
                                 folder_.string(), error.code().message()));
  }
  lock();
  if (earlier == Earlier::replaced) clear();
}

fs::path RunFolder::frames() const {
  fs::path frames = folder_ / "frames";
  std::error_code error;
  fs::create_directory(frames, error);
  if (error) throw RunError(fmt::format("cannot make {}: {}", frames.string(), error.message()));
  return frames;
}

void RunFolder::clear() const {
  try {
    remove_earlier_run(entries_of(folder_));
  } catch (const fs::filesystem_error& error) {
    throw RunError(fmt::format("cannot clear {}: {}", folder_.string(), error.code().message()));
  }
}

void RunFolder::remove_results() const {
  for (const char* name : {"manifest.json", "final.csv", "trajectory.vtkhdf", "contacts.vtkhdf", "movie.mp4",
                           "failure.png", "report.html"}) {
    std::error_code error;
    fs::remove(folder_ / name, error);
    if (error)
      throw RunError(fmt::format("cannot remove {}: {}", (folder_ / name).string(), error.message()));
  }
}

fs::path RunFolder::frame(std::int64_t number) const { return frames() / fmt::format("{:05}.png", number); }

void RunFolder::remove_frames_from(std::int64_t number) const {
  for (const fs::path& entry : entries_of(frames())) {
    const std::string name = entry.filename().string();
    if (is_numbered(entry) && (name.ends_with(".part") || std::atoll(name.c_str()) >= number)) {
      std::error_code error;
      fs::remove(entry, error);
      if (error) throw RunError(fmt::format("cannot remove {}: {}", entry.string(), error.message()));
    }
  }
}

void RunFolder::lock() {
  const fs::path file = folder_ / lock_name;
  // With close-on-exec, so that ffmpeg, which a run starts, does not keep the lock of a run that died.
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0)
    throw InputError(fmt::format("cannot create {}: {}; give another folder with -o", file.string(),
                                 std::strerror(errno)));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  ::close(lock_);
  if (reason == EWOULDBLOCK)
    throw InputError(fmt::format(
        "{}: another run is writing here; wait for it, or give another folder with -o", folder_.string()));
  throw InputError(fmt::format("cannot lock {}: {}", file.string(), std::strerror(reason)));
}

RunFolder::~RunFolder() { ::close(lock_); }

}  // namespace scree
