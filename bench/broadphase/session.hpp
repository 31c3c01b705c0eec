// All measurements that a call of the benchmark asks for: every method and number of levels, in every space,
// on every input.
#pragma once

#include "bench/broadphase/measurement.hpp"
#include "bench/broadphase/report.hpp"
#include "broadphase/settings.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace scree::bench {

struct SessionSettings {
  std::vector<std::string> inputs;   ///< data sets, and scene files
  std::vector<std::int64_t> counts;  ///< of the objects of a data set
  std::vector<std::string> spaces;
  std::vector<std::pair<std::string, BroadPhaseSettings>> methods;
  std::pair<std::string, Order> order;
  std::optional<std::pair<std::string, BroadPhaseSettings>>
      check;            ///< another method, which must find the same
  bool stages = false;  ///< print the parallel calls
  std::string csv;      ///< file; empty: none
  int repeats = 9;
  double limit = 0;             ///< s; 0: none. What took longer is not measured with more objects.
  std::int64_t copy_bytes = 0;  ///< by which the bandwidth of a space is measured
};

class Session {
 public:
  /// Throws InputError for a file that cannot be written.
  explicit Session(const SessionSettings& settings);

  /// Prints a row for each measurement; one that throws RunError, or for which there is no memory, gets a
  /// line that says so. False if any failed, or a check did.
  bool run();

 private:
  using Method = std::pair<std::string, BroadPhaseSettings>;

  /// Whether there is anybody left to be measured with so many objects, and room for them.
  bool wants(const std::string& input, std::int64_t n) const;
  /// Those that are not too slow for more of the input.
  std::vector<Method> methods_for(const std::string& input, const std::string& space) const;
  void measure_all(const std::string& input, const Objects<Host>& objects);
  template <class Space>
  void measure_in(const std::string& input, const Objects<Host>& given);
  void report(const Subject& subject, const Measurement& result);
  template <class Space>
  double bandwidth_in();

  SessionSettings settings_;
  std::optional<CsvFile> csv_;
  std::map<std::string, double> bandwidth_;                                ///< of each space
  std::set<std::tuple<std::string, std::string, std::string, int>> slow_;  ///< input, space, method, levels
  bool good_ = true;
};

}  // namespace scree::bench
