// The signals that stop a run. SIGINT, SIGTERM and SIGHUP (the terminal is gone) make a run stop after its
// present step, unless they were ignored when the program was started. A second one ends the process at once.
// SIGPIPE does not end it: the write itself reports that the output is not read, which is no reason to stop.
#pragma once

namespace scree::cli {

void catch_interrupts();
/// Whether a signal has come since catch_interrupts().
bool interrupted();

}  // namespace scree::cli
