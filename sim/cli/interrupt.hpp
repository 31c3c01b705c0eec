// SIGINT, SIGTERM and SIGHUP (its terminal is gone) ask a run to stop after its present step, but for those
// that were to be ignored when it was started. A second one ends the process at once. SIGPIPE does not end
// it: that nobody reads what a run says is told by the write, and is no reason to stop.
#pragma once

namespace scree::cli {

void catch_interrupts();
/// Whether one has come since.
bool interrupted();

}  // namespace scree::cli
