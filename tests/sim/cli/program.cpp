#include "tests/sim/cli/program.hpp"

#include <csignal>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace scree {
namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), descriptor);
}

}  // namespace

Program::Program(const TemporaryFolder& folder, std::vector<std::string> arguments) : folder_(folder) {
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

void Program::send(int signal) const { kill(pid_, signal); }

Finished Program::wait() const {
  int status = 0;
  waitpid(pid_, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_ / ".out"),
          text_of(folder_ / ".error")};
}

Finished scree_in(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  return Program(folder, std::move(arguments)).wait();
}

}  // namespace scree
