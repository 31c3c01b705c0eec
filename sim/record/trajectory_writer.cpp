#include "sim/record/trajectory_writer.hpp"

#include <cstddef>
#include <span>
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
    : sources_(body_columns_of(*scene.record.trajectory)),
      journal_(columns_of(sources_), scene.bodies.count(), Cells::vertices, std::move(file), opening,
               threads) {}

void TrajectoryWriter::append(const Snapshot& snapshot) {
  std::vector<std::int32_t> rows = present_bodies(snapshot.bodies);
  const bool same_bodies = rows == rows_;
  rows_ = std::move(rows);
  journal_.append(
      {.frame = {snapshot.step, snapshot.time, std::ssize(rows_)},
       .write =
           [&](std::size_t column, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
             const auto some =
                 std::span(rows_).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
             write_numbers(sources_[column], snapshot.bodies, some, out);
           },
       .is_kept = [&](std::size_t column) { return same_bodies && sources_[column].is_constant; }});
}

void TrajectoryWriter::archive(Archive& archive) {
  archive.part("journal", journal_);
  archive("rows", rows_);
}

}  // namespace scree
