#include "sim/cli/interrupt.hpp"

#include <csignal>

namespace scree::cli {

namespace {
volatile std::sig_atomic_t caught = 0;
}

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { caught = 1; };
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return caught != 0; }

}  // namespace scree::cli
