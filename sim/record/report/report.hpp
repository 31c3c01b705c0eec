// report.html: one page about a run, warnings first, which is made from the other files of its folder.
#pragma once

#include <filesystem>

namespace scree {

constexpr const char* report_name = "report.html";

/// Reads manifest.json, metrics.csv, timing.csv, scene.yaml and frames/ of the folder, and writes the page
/// into the folder. Without gnuplot the page has no plots, and says so. Throws InputError if the folder holds
/// no run, and RunError if the page cannot be written.
void write_report(const std::filesystem::path& folder);

}  // namespace scree
