// Measurements of the broad phase as lines of a table, and as rows of a CSV file.
#pragma once

#include "bench/broadphase/measurement.hpp"

#include <cstdint>
#include <cstdio>
#include <string>

namespace scree::bench {

/// What was measured.
struct Subject {
  std::string set;  ///< or the scene
  std::int64_t n = 0;
  std::string order;
  std::string method;
  std::string space;
  int levels = 0;        ///< asked for; 0: chosen
  double bandwidth = 0;  ///< of a copy in the space (B/s)
};

/// Time in which a copy moves as many bytes as must be read and written: the boxes and the pairs (s).
double floor_of(const Subject& subject, const Measurement& result);

void print_table_head();
void print_row(const Subject& subject, const Measurement& result);
/// The parallel calls and their times.
void print_calls(const Measurement& result);

/// A row for each measurement: what is in the table; the times of the four stages, by the labels of their
/// calls, and of the calls that name none of them; those of each call; machine and commit.
class CsvFile {
 public:
  /// Throws InputError if the file cannot be written.
  explicit CsvFile(const std::string& path);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  /// The row is in the file on return.
  void write(const Subject& subject, const Measurement& result);

 private:
  std::FILE* file_;
};

}  // namespace scree::bench
