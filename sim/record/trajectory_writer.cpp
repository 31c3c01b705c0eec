#include "sim/record/trajectory_writer.hpp"

#include "sim/record/compressed.hpp"
#include "sim/record/vtkhdf.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace scree {

namespace {

std::vector<TrajectoryColumn> columns_of(const std::vector<BodyColumnSource>& sources) {
  std::vector<TrajectoryColumn> columns;
  for (const BodyColumnSource& source : sources) columns.push_back(source.column);
  return columns;
}

std::vector<std::int32_t> present_bodies(const BodyTable& bodies) {
  std::vector<std::int32_t> rows;
  for (std::size_t k = 0; k < bodies.mobility.size(); ++k) {
    if (bodies.mobility[k] != Mobility::absent) rows.push_back(static_cast<std::int32_t>(k));
  }
  return rows;
}

}  // namespace

TrajectoryWriter::TrajectoryWriter(const Scene& scene, std::filesystem::path file,
                                   AtomicFile::Opening opening, int threads)
    : file_(std::move(file)),
      threads_(threads),
      sources_(body_columns_of(*scene.record.trajectory)),
      index_(columns_of(sources_),
             std::clamp(scene.bodies.count(), std::int64_t{1}, TrajectoryIndex::most_chunk_rows)),
      journal_(std::filesystem::path(file_).replace_extension(".journal"), opening) {}

void TrajectoryWriter::append(const Snapshot& snapshot) {
  std::vector<std::int32_t> rows = present_bodies(snapshot.bodies);
  const bool same_bodies = !index_.frames().empty() && rows == rows_;
  rows_ = std::move(rows);
  const std::int64_t per_column = index_.chunks_for(std::ssize(rows_));
  std::vector<std::int64_t> first_chunks;
  std::vector<const BodyColumnSource*> due;
  for (std::size_t c = 0; c < sources_.size(); ++c) {
    if (same_bodies && sources_[c].is_constant) {
      first_chunks.push_back(index_.first_chunk(index_.frames().size() - 1, c));
      continue;
    }
    first_chunks.push_back(std::ssize(index_.chunks()) + std::ssize(due) * per_column);
    due.push_back(&sources_[c]);
  }
  for (const std::string& chunk : chunks_of(snapshot.bodies, due)) {
    journal_.write(chunk);
    index_.add_chunk({journal_bytes_, std::ssize(chunk)});
    journal_bytes_ += std::ssize(chunk);
  }
  index_.add_frame({snapshot.step, snapshot.time, std::ssize(rows_)}, first_chunks);
}

std::vector<std::string> TrajectoryWriter::chunks_of(
    const BodyTable& bodies, const std::vector<const BodyColumnSource*>& columns) const {
  const std::int64_t size = index_.chunk_rows();
  const std::int64_t per_column = index_.chunks_for(std::ssize(rows_));
  std::vector<std::string> chunks(columns.size() * static_cast<std::size_t>(per_column));
  const auto make = [&](std::int64_t k) {
    const BodyColumnSource& column = *columns[static_cast<std::size_t>(k / per_column)];
    const FieldType& type = column.column.type;
    const std::int64_t first = k % per_column * size;
    const auto rows = std::span(rows_).subspan(
        static_cast<std::size_t>(first), static_cast<std::size_t>(std::min(size, std::ssize(rows_) - first)));
    std::vector<std::byte> numbers(static_cast<std::size_t>(size * type.row()));
    write_numbers(column, bodies, rows, numbers);
    chunks[static_cast<std::size_t>(k)] = compressed(numbers, type.width);
  };
  tbb::task_arena arena(threads_);
  arena.execute([&] { tbb::parallel_for(std::int64_t{0}, std::ssize(chunks), make); });
  return chunks;
}

void TrajectoryWriter::archive(Archive& archive) {
  archive.part("journal", journal_);
  archive("journal_bytes", journal_bytes_);
  archive("rows", rows_);
  archive.part("index", index_);
  if (archive.is_loading()) index_.expect_in_order(journal_bytes_);
}

void TrajectoryWriter::finish() { write_vtkhdf(file_, index_, journal_.part()); }

void TrajectoryWriter::drop() { journal_.discard(); }

}  // namespace scree
