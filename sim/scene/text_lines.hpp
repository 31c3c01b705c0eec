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

/// The line without the blanks at its ends.
std::string_view trimmed(std::string_view line);

/// The words of a line that blanks part; `cells` becomes them.
void split_at_blanks(std::string_view line, int number, std::vector<Cell>& cells);

class TextLines {
 public:
  /// Throws InputError, by the reader, if the file cannot be read or is UTF-16.
  TextLines(std::filesystem::path file, const Reader& reader);

  /// False at the end of the file. Lines end with LF, CR LF or CR; the text may be changed until the next
  /// call. Throws InputError for lines that are too long or no plain text.
  bool next();
  /// The same, to the next line that is not blank.
  bool next_filled();

  std::string& text() { return text_; }
  int number() const { return number_; }  ///< of the line, from 1

  struct Place {
    std::streamoff offset = 0;
    int number = 0;
  };
  Place place() const { return {offset_, number_}; }  ///< behind the line
  /// The next line is the one behind the place, whatever became of the file's handle.
  void go_to(const Place& place);
  /// Gives the handle back: a scene may name more files than a process may hold.
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
