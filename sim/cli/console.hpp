// What a run says: to the terminal, and as plain lines to log.txt. Words are not worth a run: where nobody
// reads them, or they cannot be written, it goes on without them.
#pragma once

#include "sim/record/files.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace scree::cli {

class Console {
 public:
  Console(const std::filesystem::path& log, AtomicFile::Opening opening);

  void say(std::string_view line);
  /// To stderr, and kept for the manifest.
  void warn(std::string_view line);
  /// What ended the run, to stderr.
  void error(std::string_view line);
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Whether enough wall time has passed since the last progress line for another.
  bool wants_progress() const;
  /// A line that the next one replaces on a terminal; elsewhere a line like any other.
  void progress(std::string_view line);

  /// The log is complete, unless it could not be written: then a warning has said so.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  void print(std::string_view text);
  void clear_progress();
  void log(const std::function<void()>& act);
  void complain(std::string_view line);

  AtomicFile log_;
  bool terminal_;
  bool is_heard_ = true;   ///< standard output takes what is said
  bool is_logged_ = true;  ///< and so does the log
  bool showing_progress_ = false;
  Clock::time_point last_progress_ = Clock::now();
  std::vector<std::string> warnings_;
};

/// An error that ends the program, to stderr. Takes no memory and throws nothing.
void print_error(std::string_view message);

}  // namespace scree::cli
