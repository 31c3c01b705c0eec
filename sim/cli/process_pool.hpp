// A pool of child processes, several at a time. The simulation's timing and thread pool exist once per
// process, and a child that crashes harms no other.
#pragma once

#include <functional>
#include <string>

namespace scree::cli {

struct ProcessResult {
  std::string text;   ///< text that the work returned
  std::string death;  ///< how the child died; empty if it ended by itself
  double wall = 0;    ///< wall time of the child (s)
};

/// Runs work(0), ..., work(count - 1) in a child process each, at most `at_once` at a time, and hands each
/// result to done(k, result) in this process, in the order of k. Neither threads nor a GPU may be in use when
/// it is called, as a child inherits neither. Children die with this process. Throws RunError if the system
/// gives no process.
void in_processes(int count, int at_once, const std::function<std::string(int)>& work,
                  const std::function<void(int, const ProcessResult&)>& done);

}  // namespace scree::cli
