#include "sim/scene/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace scree {
namespace {

constexpr std::size_t longest_line = 4095;  // largest number of bytes in a line
constexpr std::string_view blanks = " \t";
constexpr int at_end = std::ifstream::traits_type::eof();

}  // namespace

std::string_view trimmed(std::string_view line) {
  const auto first = line.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(blanks) - first + 1);
}

void split_at_blanks(std::string_view line, int number, std::vector<Cell>& cells) {
  cells.clear();
  for (std::size_t at = line.find_first_not_of(blanks); at < line.size();) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    cells.push_back({line.substr(at, end - at), {number, static_cast<int>(at) + 1}});
    at = line.find_first_not_of(blanks, end);
  }
}

TextLines::TextLines(std::filesystem::path file, const Reader& reader)
    : file_(std::move(file)), reader_(reader) {
  open();
  refuse_utf16();
  go_to({});
}

void TextLines::open() {
  errno = 0;
  stream_ = std::ifstream(file_, std::ios::binary);
  if (!stream_) reader_.fail({1, 1}, fmt::format("cannot be read: {}", std::strerror(errno)));
}

/// Fails for a file in UTF-16, which has a byte-order mark, or zero bytes beside the bytes of letters.
void TextLines::refuse_utf16() {
  std::string start(4, '\1');
  stream_.read(start.data(), 4);
  const bool marked = start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF");
  if (marked || start[0] == '\0' || start[1] == '\0')
    reader_.fail({1, 1}, "is UTF-16 text; save it as UTF-8 (in a spreadsheet: CSV UTF-8)");
  stream_.clear();
}

void TextLines::go_to(const Place& place) {
  if (!stream_.is_open()) open();
  stream_.clear();
  stream_.seekg(place.offset);
  offset_ = place.offset;
  number_ = place.number;
}

int TextLines::take() {
  const int c = stream_.rdbuf()->sbumpc();
  offset_ += c != at_end;
  return c;
}

bool TextLines::next() {
  text_.clear();
  int c = take();
  if (c == at_end) return false;
  ++number_;
  for (; c != at_end && c != '\n' && c != '\r'; c = take()) {
    if (text_.size() == longest_line) fail(fmt::format("is longer than {} bytes", longest_line));
    text_ += static_cast<char>(c);
  }
  if (c == '\r' && stream_.rdbuf()->sgetc() == '\n') take();
  if (number_ == 1 && text_.starts_with("\xEF\xBB\xBF"))
    text_.erase(0, 3);  // byte-order mark of UTF-8, from spreadsheets
  refuse_bytes();
  return true;
}

bool TextLines::next_filled() {
  while (next())
    if (!trimmed(text_).empty()) return true;
  return false;
}

void TextLines::refuse_bytes() const {
  const auto bad = std::ranges::find_if(
      text_, [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7F; });
  if (bad == text_.end()) return;
  fail(fmt::format("byte 0x{:02X} is no text of a body file", static_cast<unsigned char>(*bad)),
       static_cast<int>(bad - text_.begin()) + 1);
}

}  // namespace scree
