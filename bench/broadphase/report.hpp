// The output of broad-phase measurements, as lines of a table and as rows of a CSV file.
#pragma once

#include "bench/broadphase/measurement.hpp"

#include <cstdint>
#include <cstdio>
#include <string>

namespace scree::bench {

/// The subject of a measurement: input, method and space.
struct Subject {
  std::string set;  ///< name of the data set, or file of the scene
  std::int64_t n = 0;
  std::string order;
  std::string method;
  std::string space;
  int levels = 0;        ///< number of levels requested; 0: chosen by the method
  double bandwidth = 0;  ///< bandwidth of a copy in the space (B/s)
};

/// Returns the time in which a copy moves as many bytes as must be read and written: the boxes and the pairs
/// (s).
double floor_of(const Subject& subject, const Measurement& result);

void print_table_head();
void print_row(const Subject& subject, const Measurement& result);
/// Prints the parallel calls and their times.
void print_calls(const Measurement& result);

/// A CSV file with a row for each measurement. A row has the columns of the table; the times of the four
/// stages, by the labels of their calls, and of the calls that name no stage; the time of each call; machine
/// and commit.
class CsvFile {
 public:
  /// Throws InputError if the file cannot be written.
  explicit CsvFile(const std::string& path);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  /// Writes a row, which is in the file on return.
  void write(const Subject& subject, const Measurement& result);

 private:
  std::FILE* file_;
};

}  // namespace scree::bench
