#include "bench/broadphase/report.hpp"

#include "core/error.hpp"
#include "core/space.hpp"
#include "sim/record/build_info.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace scree::bench {

namespace {

constexpr std::array<std::string_view, 4> stages = {"initialize", "sort", "construct", "traverse"};

/// Returns the stage named in the label "broadphase.STAGE...", or stages.size() if it names none.
std::size_t stage_of(std::string_view label) {
  constexpr std::string_view prefix = "broadphase.";
  if (label.starts_with(prefix)) label.remove_prefix(prefix.size());
  label = label.substr(0, label.find('.'));
  return static_cast<std::size_t>(std::ranges::find(stages, label) - stages.begin());
}

double per_object(const Subject& subject, double x) { return x / static_cast<double>(subject.n); }

std::string machine_of(const std::string& space) {
  if (space != Host::name) return device_info().name;
  const MachineInfo machine = machine_info();
  return fmt::format("{} ({} cores)", machine.cpu, machine.cores);
}

/// Returns "label=ms" of each call, in one field.
std::string calls_field(const Measurement& result) {
  std::string field;
  for (const timing::Entry& call : result.calls)
    field += fmt::format("{}{}={:.6g}", field.empty() ? "" : ";", call.label, 1e3 * call.seconds);
  return field;
}

}  // namespace

double floor_of(const Subject& subject, const Measurement& result) {
  return (static_cast<double>(subject.n) * sizeof(Aabb) +
          static_cast<double>(result.stats.pairs) * sizeof(Pair)) /
         subject.bandwidth;
}

void print_table_head() {
  fmt::print(
      "{:<10} {:>10} {:<6} {:<17} {:<5} {:>6} {:>11} {:>8} {:>10} {:>10} {:>10} {:>9} {:>7} {:>8}  {}\n",
      "set", "n", "order", "method", "space", "levels", "pairs", "tests/n", "median ms", "min ms", "max ms",
      "ns/object", "x floor", "B/object", "checksum");
}

void print_row(const Subject& subject, const Measurement& result) {
  fmt::print(
      "{:<10} {:>10} {:<6} {:<17} {:<5} {:>6} {:>11} {:>8.2f} {:>10.3f} {:>10.3f} {:>10.3f} {:>9.2f} "
      "{:>7.1f} "
      "{:>8.1f}  {:016x}\n",
      subject.set, subject.n, subject.order, subject.method, subject.space, result.stats.levels,
      result.stats.pairs, per_object(subject, static_cast<double>(result.stats.candidates)),
      1e3 * result.median(), 1e3 * result.times.front(), 1e3 * result.times.back(),
      1e9 * per_object(subject, result.median()), result.median() / floor_of(subject, result),
      per_object(subject, result.memory), result.checksum);
}

void print_calls(const Measurement& result) {
  for (const timing::Entry& call : result.calls)
    fmt::print("       {:<40} {:>10.3f} ms\n", call.label, 1e3 * call.seconds);
}

CsvFile::CsvFile(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw InputError(path + ": cannot be written");
  fmt::print(
      file_,
      "set,n,order,method,space,levels_asked,levels,pairs,checksum,tests,repeats,median_ms,min_ms,max_ms,"
      "floor_ms,copy_GB_per_s,bytes_per_object,initialize_ms,sort_ms,construct_ms,traverse_ms,other_ms,calls,"
      "machine,commit\n");
}

CsvFile::~CsvFile() { std::fclose(file_); }

void CsvFile::write(const Subject& subject, const Measurement& result) {
  std::array<double, stages.size() + 1> stage_times{};
  for (const timing::Entry& call : result.calls) stage_times[stage_of(call.label)] += 1e3 * call.seconds;
  fmt::print(
      file_,
      "{},{},{},{},{},{},{},{},{:016x},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{:.6g},{},\"{}\",{}\n",
      subject.set, subject.n, subject.order, subject.method, subject.space, subject.levels,
      result.stats.levels, result.stats.pairs, result.checksum, result.stats.candidates, result.times.size(),
      1e3 * result.median(), 1e3 * result.times.front(), 1e3 * result.times.back(),
      1e3 * floor_of(subject, result), 1e-9 * subject.bandwidth, per_object(subject, result.memory),
      fmt::join(stage_times, ","), calls_field(result), machine_of(subject.space), build_info().commit);
  std::fflush(file_);
}

}  // namespace scree::bench
