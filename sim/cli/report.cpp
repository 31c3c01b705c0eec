// scree report: makes the page of a run again.
#include "sim/record/report/report.hpp"

#include "sim/cli/commands.hpp"
#include "sim/record/outcome.hpp"

#include <fmt/format.h>

namespace scree::cli {

int report(const std::filesystem::path& run) {
  write_report(run);
  fmt::print("{}\n", (run / report_name).string());
  return status_done;
}

}  // namespace scree::cli
