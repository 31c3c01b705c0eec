// The program as its users meet it: a process, its exit status, what it says and what it writes.
#pragma once

#include "tests/sim/record/temporary_folder.hpp"

#include <csignal>
#include <fcntl.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace scree {

struct Finished {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out, error;
};

/// The program at work in a folder, to which relative paths refer.
class Program {
 public:
  Program(const TemporaryFolder& folder, std::vector<std::string> arguments) : folder_(folder) {
    arguments.insert(arguments.begin(), "scree");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    redirect(STDOUT_FILENO, folder_ / ".out");
    redirect(STDERR_FILENO, folder_ / ".error");
    if (chdir(folder_.path().c_str()) == 0) execv(SCREE_PROGRAM, pointers.data());
    _exit(127);
  }

  void send(int signal) const { kill(pid_, signal); }
  Finished wait() const {
    int status = 0;
    waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_ / ".out"),
            text_of(folder_ / ".error")};
  }

 private:
  static void redirect(int descriptor, const std::filesystem::path& file) {
    dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), descriptor);
  }

  const TemporaryFolder& folder_;
  pid_t pid_ = -1;
};

inline Finished scree_in(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  return Program(folder, std::move(arguments)).wait();
}

}  // namespace scree
