#include "core/program.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace scree {

namespace {

/// A file in memory. A program that reads from one and writes to others never waits for its caller.
class Stream {
 public:
  Stream() : descriptor_(memfd_create("scree", MFD_CLOEXEC)) {
    if (descriptor_ < 0)
      throw RunError(std::string("cannot make a file in memory for a program: ") + std::strerror(errno));
  }
  ~Stream() { close(descriptor_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  int get() const { return descriptor_; }

  void fill(std::string_view text) const {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t got =
          pwrite(descriptor_, text.data() + done, text.size() - done, static_cast<off_t>(done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        throw RunError(std::string("cannot write a file in memory for a program: ") + std::strerror(errno));
      done += static_cast<std::size_t>(got);
    }
  }

  /// Returns the text, or its last `most` bytes if it is longer.
  std::string text(off_t most) const {
    const off_t size = lseek(descriptor_, 0, SEEK_END);
    const off_t from = size > most ? size - most : 0;
    std::string text(static_cast<std::size_t>(size - from), '\0');
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t got =
          pread(descriptor_, text.data() + done, text.size() - done, from + static_cast<off_t>(done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0)
        throw RunError(std::string("cannot read what a program has written: ") + std::strerror(errno));
      done += static_cast<std::size_t>(got);
    }
    return text;
  }
  std::string text() const { return text(lseek(descriptor_, 0, SEEK_END)); }

 private:
  int descriptor_;
};

/// Runs the command and waits for it. Returns the value of errno if it cannot start; otherwise `status` is
/// its status as waitpid gives it.
int spawn(const std::vector<std::string>& command, const Stream& in, const Stream& out, const Stream& words,
          int& status) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.get(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, words.get(), STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return error;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return 0;
}

constexpr off_t last_words = 2000;  // length of the program's last messages that an error quotes (bytes)

}  // namespace

std::string run_program(const std::vector<std::string>& command, std::string_view input) {
  const Stream in, out, words;
  in.fill(input);
  const std::string& name = command.front();
  int status = 0;
  const int error = spawn(command, in, out, words, status);
  if (error == ENOENT)
    throw RunError("the program " + name + " is not installed: install it and call scree again");
  if (error != 0) throw RunError(name + " does not start: " + std::strerror(error));
  if (WIFSIGNALED(status)) throw RunError(name + " was ended by signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) throw RunError(name + " failed: " + words.text(last_words));
  return out.text();
}

}  // namespace scree
