// The session of one run of the benchmark: it measures every method and number of levels, in every space, on
// every input.
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
  std::vector<std::string> inputs;   ///< names of data sets, and scene files
  std::vector<std::int64_t> counts;  ///< numbers of objects of a data set
  std::vector<std::string> spaces;
  std::vector<std::pair<std::string, BroadPhaseSettings>> methods;
  std::pair<std::string, Order> order;
  std::optional<std::pair<std::string, BroadPhaseSettings>>
      check;            ///< another method, which must find the same pairs
  bool stages = false;  ///< whether to print the parallel calls
  std::string csv;      ///< path of the CSV file; empty: none
  int repeats = 9;
  double limit = 0;  ///< longest median time (s); 0: no limit. A slower method is not measured on later
                     ///< counts of the input.
  std::int64_t copy_bytes = 0;  ///< size of the copy that measures the bandwidth of a space
};

class Session {
 public:
  /// Throws InputError if the CSV file cannot be written.
  explicit Session(const SessionSettings& settings);

  /// Prints a row for each measurement. A method that throws RunError, or for which there is no memory, gets
  /// a line that says so. Returns false if a method or a check failed.
  bool run();

 private:
  using Method = std::pair<std::string, BroadPhaseSettings>;

  /// Returns whether any method must still be measured with that many objects, and whether there is room for
  /// them.
  bool wants(const std::string& input, std::int64_t n) const;
  /// Returns the methods that were not too slow on the input so far.
  std::vector<Method> methods_for(const std::string& input, const std::string& space) const;
  void measure_all(const std::string& input, const Objects<Host>& objects);
  template <class Space>
  void measure_in(const std::string& input, const Objects<Host>& given);
  void report(const Subject& subject, const Measurement& result);
  template <class Space>
  double bandwidth_in();

  SessionSettings settings_;
  std::optional<CsvFile> csv_;
  std::map<std::string, double> bandwidth_;  ///< bandwidth of each space
  std::set<std::tuple<std::string, std::string, std::string, int>>
      slow_;  ///< slow methods: input, space, method, levels
  bool good_ = true;
};

}  // namespace scree::bench
