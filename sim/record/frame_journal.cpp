#include "sim/record/frame_journal.hpp"

#include "sim/record/compressed.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>
#include <utility>

namespace scree {

FrameJournal::FrameJournal(std::vector<TrajectoryColumn> columns, std::int64_t expected_rows, Cells cells,
                           std::filesystem::path file, AtomicFile::Opening opening, int threads)
    : cells_(cells),
      file_(std::move(file)),
      threads_(threads),
      index_(std::move(columns),
             std::clamp(expected_rows, std::int64_t{1}, TrajectoryIndex::most_chunk_rows)),
      journal_(std::filesystem::path(file_).replace_extension(".journal"), opening) {}

void FrameJournal::append(const FrameSource& source) {
  const std::int64_t per_column = index_.chunks_for(source.frame.rows);
  std::vector<std::int64_t> first_chunks;
  std::vector<std::size_t> due;
  for (std::size_t c = 0; c < index_.columns().size(); ++c) {
    if (frames() > 0 && source.is_kept(c)) {
      first_chunks.push_back(index_.first_chunk(index_.frames().size() - 1, c));
      continue;
    }
    first_chunks.push_back(std::ssize(index_.chunks()) + std::ssize(due) * per_column);
    due.push_back(c);
  }
  for (const std::string& chunk : chunks_of(source, due)) {
    journal_.write(chunk);
    index_.add_chunk({journal_bytes_, std::ssize(chunk)});
    journal_bytes_ += std::ssize(chunk);
  }
  index_.add_frame(source.frame, first_chunks);
}

std::vector<std::string> FrameJournal::chunks_of(const FrameSource& source,
                                                 const std::vector<std::size_t>& columns) const {
  const std::int64_t size = index_.chunk_rows();
  const std::int64_t per_column = index_.chunks_for(source.frame.rows);
  std::vector<std::string> chunks(columns.size() * static_cast<std::size_t>(per_column));
  const auto make = [&](std::int64_t k) {
    const std::size_t column = columns[static_cast<std::size_t>(k / per_column)];
    const FieldType& type = index_.columns()[column].type;
    const std::int64_t first = k % per_column * size;
    std::vector<std::byte> numbers(static_cast<std::size_t>(size * type.row()));
    source.write(column, first, std::min(size, source.frame.rows - first), numbers);
    chunks[static_cast<std::size_t>(k)] = compressed(numbers, type.width);
  };
  tbb::task_arena arena(threads_);
  arena.execute([&] { tbb::parallel_for(std::int64_t{0}, std::ssize(chunks), make); });
  return chunks;
}

void FrameJournal::archive(Archive& archive) {
  archive.part("journal", journal_);
  archive("journal_bytes", journal_bytes_);
  archive.part("index", index_);
  if (archive.is_loading()) index_.expect_in_order(journal_bytes_);
}

void FrameJournal::finish() { write_vtkhdf(file_, index_, cells_, journal_.part()); }

void FrameJournal::drop() { journal_.discard(); }

}  // namespace scree
