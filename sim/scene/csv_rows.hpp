// The reader of tables as spreadsheets and scripts write them (RFC 4180, and common variants): a line of
// names, then rows. Cells are separated by commas, semicolons, tabs, bars or blanks, whichever the first line
// has; they may be in quotes. Lines that begin with # are comments.
#pragma once

#include "sim/scene/row_source.hpp"

namespace scree {

class CsvRows final : public RowSource {
 public:
  CsvRows(TextLines lines, const Reader& reader);

  bool next(std::vector<Cell>& row) override;
  void rewind() override { lines_.go_to(behind_head_); }
  void close() override { lines_.close(); }

 private:
  bool next_line();
  void read_head();
  RowColumn column_of(const Cell& name) const;
  void split(std::vector<Cell>& cells);
  Cell quoted_cell(std::size_t& at);
  [[noreturn]] void fail_names(const Cell& name) const;

  const Reader& reader_;
  TextLines lines_;
  TextLines::Place behind_head_;
  char parted_by_ = ',';
  int comment_ = 0;  ///< line of the last comment before the names; 0: there is none
};

}  // namespace scree
