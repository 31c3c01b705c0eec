// SIGINT and SIGTERM ask a run to stop after its present step. A second one ends the process at once.
#pragma once

namespace scree::cli {

void catch_interrupts();
/// Whether one has come since.
bool interrupted();

}  // namespace scree::cli
