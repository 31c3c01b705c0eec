// The lines of a text file, one at a time, in bounded memory.
#pragma once

#include "sim/scene/reader.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// A word of a line, and where it starts.
struct Cell {
  std::string_view text;
  SourceMark mark;
};

/// Returns the line without the blanks at its ends.
std::string_view trimmed(std::string_view line);

/// Splits a line at blanks into words, which replace the contents of `cells`. `number` is the number of the
/// line.
void split_at_blanks(std::string_view line, int number, std::vector<Cell>& cells);

class TextLines {
 public:
  /// Opens the file. Throws InputError through the reader if the file cannot be read or is UTF-16.
  TextLines(std::filesystem::path file, const Reader& reader);

  /// Reads the next line. Returns false at the end of the file. Lines end with LF, CR LF or CR; the text may
  /// be changed until the next call. Throws InputError for lines that are too long or no plain text.
  bool next();
  /// Reads up to the next line that is not blank. Returns false at the end of the file.
  bool next_filled();

  std::string& text() { return text_; }
  int number() const { return number_; }  ///< number of the current line, from 1

  struct Place {
    std::streamoff offset = 0;
    int number = 0;
  };
  Place place() const { return {offset_, number_}; }  ///< end of the current line
  /// Goes to a place: the next line read is the one behind it. Opens the file again if it has been closed.
  void go_to(const Place& place);
  /// Closes the file, because a scene may name more files than a process may have open.
  void close() { stream_.close(); }

  [[noreturn]] void fail(std::string_view what, int column = 1) const {
    reader_.fail({number_, column}, what);
  }

 private:
  void open();
  void refuse_utf16();
  void refuse_bytes() const;
  int take();

  std::filesystem::path file_;
  const Reader& reader_;
  std::ifstream stream_;
  std::string text_;
  std::streamoff offset_ = 0;
  int number_ = 0;
};

}  // namespace scree
