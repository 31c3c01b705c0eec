// metrics.csv: the measures of a run, in the same bytes on every machine; timing.csv: their cost on this one.
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

/// Returns the measures that are columns of a scene: all measures of the whole run; those of each region;
/// then position, velocity and spin of each body that has a name of its own, in the order of the scene.
/// Members of a repeat have no columns, as there can be a million of them.
std::vector<std::string> metric_names(const Scene& scene);

/// The writer of metrics.csv. A row has the time, the step, and the measures, with _ for . in their names.
/// Numbers are the shortest that read back to the same double; nan for a body that is absent.
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

/// The writer of timing.csv, with rows of time, wall, stage, seconds, calls: the time that each stage took
/// since the row before (s). A row has one stage, because a stage can run for the first time late in a run.
class TimingFile {
 public:
  explicit TimingFile(const std::filesystem::path& file,
                      AtomicFile::Opening opening = AtomicFile::Opening::anew);
  void write_rows(double time);
  void commit() { file_.commit(); }
  void archive(Archive& archive);
  /// Returns the wall time since the run began, without the time in which it was stopped (s).
  double wall() const;

 private:
  AtomicFile file_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double wall_before_ = 0;  // wall time before the run was resumed (s)
  std::vector<timing::Entry> written_;
};

}  // namespace scree
