#include "sim/cli/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace scree::cli {

namespace {
volatile std::sig_atomic_t caught = 0;
}

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { caught = 1; };
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // Signals that nohup or a shell's background has set to be ignored stay ignored.
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return caught != 0; }

}  // namespace scree::cli
