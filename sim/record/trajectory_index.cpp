#include "sim/record/trajectory_index.hpp"

#include "core/error.hpp"
#include "sim/record/plain_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

namespace scree {

namespace {

// A byte of a deflated stream gives at most this many bytes (zlib's technical details), so an index cannot
// make scree take more memory than a file of its size can fill.
constexpr std::int64_t most_from_a_byte = 1032;
constexpr std::int64_t most_rows = std::numeric_limits<std::int32_t>::max();

/// Returns the number of numbers in a row of the column of this name; 0 if no trajectory of this version has
/// such a column.
int components_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, int>, 12> columns = {{{"position", 3},
                                                                         {"orientation", 4},
                                                                         {"velocity", 3},
                                                                         {"spin", 3},
                                                                         {"id", 1},
                                                                         {"size", 3},
                                                                         {"shape", 1},
                                                                         {"mobility", 1},
                                                                         {"material", 1},
                                                                         {"force", 3},
                                                                         {"point", 3},
                                                                         {"other", 1}}};
  const auto found = std::ranges::find(columns, name, &std::pair<std::string_view, int>::first);
  return found == columns.end() ? 0 : found->second;
}

/// The rest of a text, read line by line.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// Takes a line and returns the words after the first one, which gives the kind of the line. Throws
  /// RunError if the line is of another kind.
  std::string_view take(std::string_view kind) {
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    if (end == std::string_view::npos || take_word(line) != kind)
      throw RunError(fmt::format("is not valid: its index has no line of a {} where one should be", kind));
    text_.remove_prefix(end + 1);
    return line;
  }
  bool is_empty() const { return text_.empty(); }

 private:
  std::string_view text_;
};

/// Takes a count. It is at most the length of the text, as each counted item has a line.
std::int64_t take_count(Lines& lines, std::string_view kind, std::string_view text) {
  std::string_view line = lines.take(kind);
  return take_number(line, 0, std::ssize(text));
}

}  // namespace

void TrajectoryIndex::add_frame(const TrajectoryFrame& frame, std::span<const std::int64_t> first_chunks) {
  frames_.push_back(frame);
  first_chunks_.insert(first_chunks_.end(), first_chunks.begin(), first_chunks.end());
}

void TrajectoryIndex::archive(Archive& archive) {
  archive("frames", frames_);
  archive("chunks", chunks_);
  archive("first_chunks", first_chunks_);
  if (archive.is_loading())
    archive.expect(first_chunks_.size() == frames_.size() * columns_.size(), "first_chunks");
}

std::string TrajectoryIndex::text() const {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "rows {}\ncolumns {}\n", chunk_rows_, columns_.size());
  for (const auto& [name, type] : columns_) fmt::format_to(out, "column {} {}\n", words_of(type), name);
  fmt::format_to(out, "frames {}\n", frames_.size());
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    fmt::format_to(out, "frame {} {} {}", frames_[f].step, frames_[f].time, frames_[f].rows);
    for (std::size_t c = 0; c < columns_.size(); ++c) fmt::format_to(out, " {}", first_chunk(f, c));
    text += '\n';
  }
  fmt::format_to(out, "chunks {}\n", chunks_.size());
  for (const auto& [place, bytes] : chunks_) fmt::format_to(out, "chunk {} {}\n", place, bytes);
  return text;
}

TrajectoryIndex TrajectoryIndex::parse(std::string_view text, std::int64_t bytes) {
  Lines lines(text);
  std::string_view line = lines.take("rows");
  TrajectoryIndex index({}, take_number(line, 1, most_chunk_rows));
  for (std::int64_t left = take_count(lines, "columns", text); left > 0; --left) {
    line = lines.take("column");
    const FieldType type = take_type(line);
    if (type.columns != components_of(line)) throw RunError("is not valid: a column is one that none has");
    index.columns_.push_back({std::string(line), type});
  }
  for (std::int64_t left = take_count(lines, "frames", text); left > 0; --left) {
    line = lines.take("frame");
    const std::int64_t step = take_number(line, 0, std::numeric_limits<std::int64_t>::max());
    const double time = take_real(line);
    index.frames_.push_back({step, time, take_number(line, 0, most_rows)});
    for (std::size_t c = 0; c < index.columns_.size(); ++c)
      index.first_chunks_.push_back(take_number(line, 0, std::ssize(text)));
  }
  for (std::int64_t left = take_count(lines, "chunks", text); left > 0; --left) {
    line = lines.take("chunk");
    const std::int64_t place = take_number(line, 0, bytes);
    index.chunks_.push_back({place, take_number(line, 0, bytes - place)});
  }
  if (index.columns_.empty() || index.columns_[0].name != "position")
    throw RunError("is not valid: it has no places");
  if (!lines.is_empty()) throw RunError("is not valid: its index goes on after its end");
  index.expect_in_order(bytes);
  return index;
}

void TrajectoryIndex::expect_in_order(std::int64_t bytes) const {
  std::int64_t left = bytes;  // a byte belongs to at most one chunk
  for (const TrajectoryChunk& chunk : chunks_) {
    if (chunk.place < 0 || chunk.bytes < 0 || chunk.bytes > left || chunk.place > bytes - chunk.bytes)
      throw RunError("is not valid: its chunks have more bytes than the file");
    left -= chunk.bytes;
  }
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (frames_[f].rows < 0 || frames_[f].rows > most_rows)
      throw RunError("is not valid: a frame has no rows");
    const std::int64_t chunks = chunks_for(frames_[f].rows);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::int64_t first = first_chunk(f, c);
      if (first < 0 || first > std::ssize(chunks_) - chunks)
        throw RunError("is not valid: a frame has chunks that are not there");
      for (std::int64_t k = first; k < first + chunks; ++k) {
        if (chunks_[static_cast<std::size_t>(k)].bytes <
            chunk_rows_ * columns_[c].type.row() / most_from_a_byte)
          throw RunError("is not valid: a chunk has fewer bytes than its rows take");
      }
    }
  }
}

}  // namespace scree
