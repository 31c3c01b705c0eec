#include "sim/record/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace scree {

namespace {

std::vector<std::string> single_bodies(const Scene& scene) {
  std::vector<std::pair<std::int32_t, std::string>> bodies;
  for (const auto& [name, id] : scene.body_names) {
    if (!name.ends_with(']')) bodies.emplace_back(id, name);
  }
  std::ranges::sort(bodies);
  std::vector<std::string> names;
  for (auto& [id, name] : bodies) names.push_back(std::move(name));
  return names;
}

// Measures that can only be 0 in a scene have no column.
bool is_of_emission(const MeasureInfo& info) { return info.name.starts_with("emission."); }
bool is_of_removal(const MeasureInfo& info) { return info.name.starts_with("removed"); }

/// Appends the names of the columns of a measure: its own, or those of its components.
void append_names(std::vector<std::string>& names, const std::string& measure, bool is_vector) {
  if (!is_vector) return names.push_back(measure);
  for (const char* component : {".x", ".y", ".z"}) names.push_back(measure + component);
}

}  // namespace

std::vector<std::string> metric_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_table()) {
    if (info.of == MeasureSubject::run && (!scene.emitters.empty() || !is_of_emission(info)))
      append_names(names, std::string(info.name), info.is_vector());
  }
  for (const Region& region : scene.regions) {
    for (const MeasureInfo& info : measure_table()) {
      if (info.of == MeasureSubject::region && (region.removes.value_or(false) || !is_of_removal(info)))
        names.push_back(fmt::format("region.{}.{}", region.name, info.name));
    }
  }
  for (const std::string& body : single_bodies(scene)) {
    for (const char* measure : {".position", ".velocity", ".spin"}) append_names(names, body + measure, true);
  }
  return names;
}

MetricsFile::MetricsFile(const Scene& scene, const std::filesystem::path& file, AtomicFile::Opening opening)
    : file_(file, opening) {
  std::string header = "time,step";
  for (std::string name : metric_names(scene)) {
    measures_.push_back(parse_measure(name, scene));
    std::ranges::replace(name, '.', '_');
    header += ',' + name;
  }
  if (opening == AtomicFile::Opening::anew) file_.write(header + '\n');
}

void MetricsFile::write_row(const Probe& probe) {
  const Observation& now = probe.observe(true);
  std::string row = fmt::format("{},{}", now.time, now.step);
  for (const Measure& measure : measures_)
    fmt::format_to(std::back_inserter(row), ",{}", probe.value(measure));
  file_.write(row + '\n');
}

TimingFile::TimingFile(const std::filesystem::path& file, AtomicFile::Opening opening)
    : file_(file, opening) {
  if (opening == AtomicFile::Opening::anew) file_.write("time,wall,stage,seconds,calls\n");
}

double TimingFile::wall() const {
  return wall_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void TimingFile::archive(Archive& archive) {
  file_.archive(archive);
  double so_far = wall();
  archive("wall", so_far);
  if (archive.is_loading()) wall_before_ = so_far;
}

void TimingFile::write_rows(double time) {
  const double wall = this->wall();
  const std::vector<timing::Entry>& entries = timing::entries();
  written_.resize(entries.size());  // accounts are only added, and only at the end
  std::string rows;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const std::int64_t calls = entries[k].calls - written_[k].calls;
    if (calls == 0) continue;
    fmt::format_to(std::back_inserter(rows), "{},{:.6f},{},{:.9f},{}\n", time, wall, entries[k].label,
                   entries[k].seconds - written_[k].seconds, calls);
  }
  written_ = entries;
  file_.write(rows);
}

}  // namespace scree
