// The program as its users meet it: a process, its exit status, what it says and what it writes.
#pragma once

#include "tests/sim/record/temporary_folder.hpp"

#include <string>
#include <sys/types.h>
#include <vector>

namespace scree {

struct Finished {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out, error;
};

/// The program at work in a folder, to which relative paths refer.
class Program {
 public:
  Program(const TemporaryFolder& folder, std::vector<std::string> arguments);

  void send(int signal) const;
  Finished wait() const;

 private:
  const TemporaryFolder& folder_;
  pid_t pid_ = -1;
};

Finished scree_in(const TemporaryFolder& folder, std::vector<std::string> arguments);

}  // namespace scree
