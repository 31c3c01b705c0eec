// report.html: a run on one page, warnings first, made of what else is in its folder.
#pragma once

#include <filesystem>

namespace scree {

constexpr const char* report_name = "report.html";

/// Reads manifest.json, metrics.csv, timing.csv, scene.yaml and frames/ of the folder, and writes the page
/// beside them. Without gnuplot it has no plots, and says so. Throws InputError if the folder holds no run,
/// and RunError if the page cannot be written.
void write_report(const std::filesystem::path& folder);

}  // namespace scree
