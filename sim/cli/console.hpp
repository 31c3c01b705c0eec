// The messages of a run: to the terminal, and as plain lines to log.txt. If the terminal is gone or the log
// cannot be written, the run goes on without them.
#pragma once

#include "sim/record/files.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace scree::cli {

class Console {
 public:
  Console(const std::filesystem::path& log, AtomicFile::Opening opening);

  /// Prints a line to stdout.
  void say(std::string_view line);
  /// Prints a warning to stderr, and keeps it for the manifest.
  void warn(std::string_view line);
  /// Prints the error that ended the run to stderr.
  void error(std::string_view line);
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Whether enough wall time has passed since the last progress line for another.
  bool wants_progress() const;
  /// Prints a line of parts, the most important one first. On a terminal it has as many as fit, and the next
  /// line replaces it; elsewhere it is a line like any other, with all parts.
  void progress(const std::vector<std::string>& parts);

  /// Completes the log, unless it could not be written, which a warning has then said.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  void print(std::string_view text);
  void clear_progress();
  void log(const std::function<void()>& act);
  void complain(std::string_view line);

  AtomicFile log_;
  bool terminal_;
  bool is_heard_ = true;   ///< whether standard output can still be written
  bool is_logged_ = true;  ///< whether the log can still be written
  bool showing_progress_ = false;
  Clock::time_point last_progress_ = Clock::now();
  std::vector<std::string> warnings_;
};

/// Returns as many of the parts as fit into `width` characters, from the first on, with ", " between them.
std::string parts_within(const std::vector<std::string>& parts, std::size_t width);

/// Returns a duration (s) as a user reads it: "7.4 s", "1 min 2 s", "2 h 5 min".
std::string duration_words(double seconds);

/// Prints an error that ends the program to stderr. Takes no memory and throws nothing.
void print_error(std::string_view message);

}  // namespace scree::cli
