#include "sim/cli/console.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace scree::cli {

namespace {
using namespace std::chrono_literals;
constexpr auto terminal_cadence = 200ms;  // smooth to the eye, cheap over a network
constexpr auto plain_cadence = 10s;       // a night's run stays readable

/// A longer line would wrap, and only its last row could be replaced.
std::size_t terminal_width() {
  winsize size = {};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col - 1U : 80U;
}

}  // namespace

Console::Console(const std::filesystem::path& log, AtomicFile::Opening opening)
    : log_(log, opening), terminal_(isatty(STDOUT_FILENO) == 1) {}

void Console::clear_progress() {
  if (!showing_progress_) return;
  fmt::print("\r\x1b[K");  // to the start of the line; erase it
  showing_progress_ = false;
}

void Console::say(std::string_view line) {
  clear_progress();
  fmt::print("{}\n", line);
  std::fflush(stdout);
  log_.write(fmt::format("{}\n", line));
}

void Console::complain(std::string_view line) {
  clear_progress();
  std::fflush(stdout);
  print_error(line);
  log_.write(fmt::format("{}\n", line));
}

void Console::warn(std::string_view line) {
  complain(fmt::format("warning: {}", line));
  warnings_.emplace_back(line);
}

void Console::error(std::string_view line) { complain(line); }

bool Console::wants_progress() const {
  const auto since = Clock::now() - last_progress_;
  return terminal_ ? since >= terminal_cadence : since >= plain_cadence;
}

void Console::progress(std::string_view line) {
  last_progress_ = Clock::now();
  if (!terminal_) return say(line);
  clear_progress();
  fmt::print("{}", line.substr(0, terminal_width()));
  std::fflush(stdout);
  showing_progress_ = true;
}

void Console::close() {
  clear_progress();
  log_.commit();
}

void print_error(std::string_view message) { fmt::print(stderr, "scree: {}\n", message); }

}  // namespace scree::cli
