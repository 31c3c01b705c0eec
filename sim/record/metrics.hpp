// metrics.csv: what the run measured, in the same bytes whatever the machine; timing.csv: what it cost there.
#pragma once

#include "core/timing.hpp"
#include "sim/record/checks.hpp"
#include "sim/record/files.hpp"
#include "sim/scene/measure.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// The measures of a scene's columns: all of the whole run; those of each region; then position, velocity and
/// spin of each body that was named on its own, in the order of the scene. Members of a repeat have no
/// columns: they can be a million.
std::vector<std::string> metric_names(const Scene& scene);

/// One row per call: time, step, then the measures, with _ for . in their names. Numbers are the shortest
/// that read back to the same double; nan for a body that is not there.
class MetricsFile {
 public:
  MetricsFile(const Scene& scene, const std::filesystem::path& file,
              AtomicFile::Opening opening = AtomicFile::Opening::anew);
  void write_row(const Probe& probe);
  void commit() { file_.commit(); }
  void archive(Archive& archive) { file_.archive(archive); }

 private:
  AtomicFile file_;
  std::vector<Measure> measures_;
};

/// Rows of time, wall, stage, seconds, calls: what each stage took since the row before (s). One stage per
/// row, because a stage can run for the first time late in a run.
class TimingFile {
 public:
  explicit TimingFile(const std::filesystem::path& file,
                      AtomicFile::Opening opening = AtomicFile::Opening::anew);
  void write_rows(double time);
  void commit() { file_.commit(); }
  void archive(Archive& archive);
  /// Since the run began, but for the time in which it was stopped (s).
  double wall() const;

 private:
  AtomicFile file_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double wall_before_ = 0;  // of what the run was continued from (s)
  std::vector<timing::Entry> written_;
};

}  // namespace scree
