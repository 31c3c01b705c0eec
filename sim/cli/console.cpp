#include "sim/cli/console.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace scree::cli {

namespace {
using namespace std::chrono_literals;
constexpr auto terminal_cadence = 200ms;  // looks smooth, and is cheap over a network
constexpr auto plain_cadence = 10s;       // keeps the log of a night's run readable

/// Returns the longest progress line: a longer one would wrap, and only its last row could be replaced.
std::size_t terminal_width() {
  winsize size = {};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col - 1U : 80U;
}

}  // namespace

Console::Console(const std::filesystem::path& log, AtomicFile::Opening opening)
    : log_(log, opening), terminal_(isatty(STDOUT_FILENO) == 1) {}

void Console::print(std::string_view text) {
  if (!is_heard_) return;
  is_heard_ = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!is_heard_)
    warn(fmt::format("nothing more can be written to standard output ({}); the run goes on",
                     std::strerror(errno)));
}

void Console::clear_progress() {
  if (!std::exchange(showing_progress_, false)) return;
  print("\r\x1b[K");  // goes to the start of the line and erases it
}

void Console::log(const std::function<void()>& act) {
  if (!is_logged_) return;
  try {
    act();
  } catch (const RunError& error) {
    is_logged_ = false;
    warn(fmt::format("the log is not complete: {}; the results are not affected", error.what()));
  }
}

void Console::say(std::string_view line) {
  clear_progress();
  print(fmt::format("{}\n", line));
  log([&] { log_.write(fmt::format("{}\n", line)); });
}

void Console::complain(std::string_view line) {
  clear_progress();
  print_error(line);
  log([&] { log_.write(fmt::format("{}\n", line)); });
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

void Console::progress(const std::vector<std::string>& parts) {
  last_progress_ = Clock::now();
  if (!terminal_) return say(fmt::format("{}", fmt::join(parts, ", ")));
  clear_progress();
  print(parts_within(parts, terminal_width()));
  showing_progress_ = is_heard_;
}

void Console::close() {
  clear_progress();
  log([&] { log_.commit(); });
}

std::string parts_within(const std::vector<std::string>& parts, std::size_t width) {
  std::string line;
  for (const std::string& part : parts) {
    const std::string with_part = line.empty() ? part : line + ", " + part;
    if (with_part.size() > width) break;
    line = with_part;
  }
  return line;
}

std::string duration_words(double seconds) {
  if (seconds < 60) return fmt::format("{:.3g} s", seconds);
  const auto whole = static_cast<std::int64_t>(seconds);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

void print_error(std::string_view message) {
  std::fprintf(stderr, "scree: %.*s\n", static_cast<int>(message.size()), message.data());
}

}  // namespace scree::cli
