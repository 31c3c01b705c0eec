#include "sim/scene/frame_rows.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

namespace scree {

void FrameRows::fail_short(std::int64_t rows, std::int64_t of) const {
  lines_.fail(fmt::format("the file ends after {} of {} particles", rows, of));
}

void FrameRows::skip(const Frame& frame) {
  for (std::int64_t row = 0; row < frame.rows; ++row)
    if (!lines_.next()) fail_short(row, frame.rows);
}

void FrameRows::choose(const Frame& frame) {
  frame_ = frame;
  rewind();
}

void FrameRows::rewind() {
  lines_.go_to(frame_.place);
  left_ = frame_.rows;
}

void FrameRows::require_frame(std::optional<std::int64_t> wanted, std::int64_t frames) const {
  if (wanted.value_or(0) < frames) return;
  reader_.fail({1, 1}, fmt::format("there is no frame {}: the file has {}, from 0 on", *wanted, frames));
}

std::int64_t FrameRows::count_of(std::string_view line, const char* what) const {
  const std::string_view text = trimmed(line);
  std::int64_t count = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size() || count < 0)
    lines_.fail(fmt::format("must be {}, a whole number", what));
  return count;
}

void FrameRows::add_column(std::string name, SourceMark mark, std::optional<BodyColumn> column, double scale,
                           double offset) {
  columns_.push_back({std::move(name), mark, column, scale, offset, mobility_ == columns_.size()});
}

bool FrameRows::next(std::vector<Cell>& row) {
  while (left_ > 0) {
    if (!lines_.next()) fail_short(frame_.rows - left_, frame_.rows);
    --left_;
    split_at_blanks(lines_.text(), lines_.number(), row);
    if (row.size() != columns_.size())
      lines_.fail(fmt::format("has {} words; there are {} columns", row.size(), columns_.size()));
    if (!mobility_ || row[*mobility_].text == "0") return true;
    ++held_;
  }
  if (held_ > 0 && !counted_)
    notes_.push_back(
        fmt::format("has {} bodies that are not free, which are left out: the scene gives them", held_));
  counted_ = true;
  return false;
}

}  // namespace scree
