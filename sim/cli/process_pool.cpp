#include "sim/cli/process_pool.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <list>
#include <map>
#include <poll.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace scree::cli {

namespace {

using Clock = std::chrono::steady_clock;

struct Child {
  int k;
  pid_t pid;
  int pipe;
  Clock::time_point start;
  std::string text;
};

void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) _exit(1);  // the parent no longer reads
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Runs the work and ends the process. It is noexcept, because an exception that left the work would unwind
/// into a copy of the parent.
[[noreturn]] void run_child(int k, const std::function<std::string(int)>& work, pid_t parent,
                            int pipe) noexcept {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  write_all(pipe, work(k));
  _exit(0);
}

Child start(int k, const std::function<std::string(int)>& work) {
  int ends[2];
  std::fflush(nullptr);  // otherwise the child would print it again
  if (::pipe(ends) != 0)
    throw RunError(
        fmt::format("cannot start a process: no pipe to it can be made: {}", std::strerror(errno)));
  const pid_t parent = getpid();
  const pid_t pid = ::fork();
  if (pid < 0) throw RunError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (pid == 0) {
    ::close(ends[0]);
    run_child(k, work, parent, ends[1]);
  }
  ::close(ends[1]);
  return {k, pid, ends[0], Clock::now(), {}};
}

/// Appends the output that has come from a child; returns false at its end.
bool receive(Child& child) {
  char buffer[4096];
  const ssize_t got = ::read(child.pipe, buffer, sizeof buffer);
  if (got < 0) return errno == EINTR;
  child.text.append(buffer, static_cast<std::size_t>(got));
  return got > 0;
}

ProcessResult finish(Child& child) {
  int status = 0;
  ::close(child.pipe);
  while (::waitpid(child.pid, &status, 0) < 0 && errno == EINTR) {
  }
  ProcessResult result{.text = std::move(child.text),
                       .death = {},
                       .wall = std::chrono::duration<double>(Clock::now() - child.start).count()};
  if (WIFSIGNALED(status)) {
    result.death = fmt::format("its process was ended by a signal: {}", strsignal(WTERMSIG(status)));
  } else if (WEXITSTATUS(status) != 0) {
    result.death = fmt::format("its process ended with status {}", WEXITSTATUS(status));
  }
  return result;
}

void wait_for_any(const std::list<Child>& children, std::vector<pollfd>& waits) {
  waits.clear();
  for (const Child& child : children) waits.push_back({child.pipe, POLLIN, 0});
  while (::poll(waits.data(), waits.size(), -1) < 0 && errno == EINTR) {
  }
}

}  // namespace

void in_processes(int count, int at_once, const std::function<std::string(int)>& work,
                  const std::function<void(int, const ProcessResult&)>& done) {
  std::list<Child> children;
  std::vector<pollfd> waits;
  std::map<int, ProcessResult> finished;  // results that wait for those before them
  int started = 0, handed = 0;
  while (handed < count) {
    while (started < count && static_cast<int>(children.size()) < at_once) {
      children.push_back(start(started++, work));
    }
    wait_for_any(children, waits);
    auto wait = waits.begin();
    for (auto child = children.begin(); child != children.end(); ++wait) {
      const auto present = child++;
      if (wait->revents == 0 || receive(*present)) continue;
      finished.emplace(present->k, finish(*present));
      children.erase(present);
    }
    for (auto next = finished.find(handed); next != finished.end(); next = finished.find(handed)) {
      done(handed++, next->second);
      finished.erase(next);
    }
  }
}

}  // namespace scree::cli
